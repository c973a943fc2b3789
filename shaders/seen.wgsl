// The surface point that a pixel shows, with as little arithmetic as patterns need: where its foot point
// lies, and how quantities on the surface change from pixel to pixel.

struct Seen {
    // From the eye, metres.
    from_eye: vec3<f32>,
    // Its foot point, from the eye's foot point.
    from_foot: vec3<f32>,
    // Along the normal there, about as long as the ellipsoid's radius.
    normal: vec3<f32>,
    // The line of sight, at unit distance along the view axis; how much larger pixels are than there.
    ray: vec3<f32>,
    along: f32,
    // Steps of the line of sight to the pixel to the right and below that stay level with the surface are
    // right - lean.x * ray and down - lean.y * ray.
    lean: vec2<f32>,
}

// With M = diag(1, 1, (a/b)^2), a point P stands on F where (1 + tau M) F = P, and with the eye E on G,
// (1 + tau M)(F - G) = (P - E) - (tau - tau_eye) M G: no large numbers cancel. The tau below is exact on
// a sphere; elsewhere it is off by a part in 10^5 of height over radius, along the normal: F lies beside
// the true foot point by 2e-9 m for a height of 9 km, 1 um for 90 km, 1 mm for 1 000 km.
fn seen_at(at_px: vec2<f32>, depth: f32) -> Seen {
    var seen: Seen;
    seen.ray = ray_at(at_px);
    let distance = distance_of(depth);
    seen.along = scale_at(distance);
    seen.from_eye = from_eye_at(at_px, distance);
    let a = sight.ellipsoid.x;
    let squash = sight.ellipsoid.y;
    let tau_eye = sight.ellipsoid.z;
    let m = vec3<f32>(1.0, 1.0, squash);
    let scaled = m * seen.from_eye;
    let outside = sight.eye_gradient.w + dot(sight.eye_gradient.xyz, seen.from_eye)
        + dot(scaled, seen.from_eye) * (1.0 / a);
    let relative = max(outside * (1.0 / a), -0.9);
    let gradient = 0.5 * a * sight.eye_gradient.xyz + scaled;
    let tau = relative * (a * a) * (1.0 + relative)
        / ((1.0 + sqrt(1.0 + relative)) * dot(gradient, gradient));
    let level = seen.from_eye - (tau - tau_eye) * sight.foot_gradient.xyz;
    let taller = vec2<f32>(1.0 + tau, 1.0 + tau * squash);
    seen.from_foot = level * (taller.yyx * (1.0 / (taller.x * taller.y)));
    seen.normal = sight.foot_gradient.xyz + m * seen.from_foot;
    // At the limb a pixel spans any length; and slopes of a terrain are seen less obliquely than the level
    // ground they stand on. The normal is longer than a by 0.3 % at most.
    let rise = dot(seen.ray, seen.normal);
    let least = sight.bounds.w * a;
    let steep = select(max(rise, least), min(rise, -least), rise < 0.0);
    let across = vec2<f32>(
        dot(sight.right.xyz, seen.normal),
        dot(sight.down.xyz, seen.normal),
    );
    seen.lean = across * (1.0 / steep);
    return seen;
}

// How a quantity changes per pixel to the right and down, by its gradient along the surface, per metre.
// That foot points lie closer together than what stands on them, by a part in 700 on the highest
// mountain, is left out.
fn slope_of(seen: Seen, gradient: vec3<f32>) -> vec2<f32> {
    let across = vec2<f32>(dot(gradient, sight.right.xyz), dot(gradient, sight.down.xyz));
    return seen.along * (across - seen.lean * dot(gradient, seen.ray));
}

// Sine of the angle between the line of sight and the ellipsoid's tangent plane.
fn sine_of(seen: Seen) -> f32 {
    return abs(dot(normalize(seen.ray), normalize(seen.normal)));
}
