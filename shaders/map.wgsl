// Coordinates of patterns. What is known exactly at the eye's foot point is carried to the pixel by
// differences, so that coordinates are off by a few roundings of the way between the two.

// Coordinates u and v of a pattern at a pixel, and how they change per pixel to the right and down.
struct Mapped {
    // From those at the eye's foot point.
    uv: vec2<f32>,
    right: vec2<f32>,
    down: vec2<f32>,
}

// On the map about an anchor: the ellipsoid seen from the anchor's antipode on the anchor's tangent
// plane. u = L(F) / D(F) with L and D linear, so that the difference from G is
// ((L - u(G) D) . (F - G)) / D(F), and nothing large cancels.
fn on_map(placed: Placed, seen: Seen) -> Mapped {
    let from_foot = seen.place.from_foot;
    let nearness = max(placed.u.w + dot(placed.fall.xyz, from_foot), 1e-9);
    let uv = vec2<f32>(dot(placed.u.xyz, from_foot), dot(placed.v.xyz, from_foot)) / nearness;
    let u = (placed.u.xyz - uv.x * placed.fall.xyz) / nearness;
    let v = (placed.v.xyz - uv.y * placed.fall.xyz) / nearness;
    return Mapped(
        uv,
        vec2<f32>(dot(u, seen.span.right), dot(v, seen.span.right)),
        vec2<f32>(dot(u, seen.span.down), dot(v, seen.span.down)),
    );
}

const PI: f32 = 3.14159265;

// On longitudes and latitudes, from the middle of the image. With z stretched, the latitude is the angle of
// (radius, z): geodetic if stretched by (a/b)^2, as the normal is, geocentric if not.
fn on_angles(placed: Placed, seen: Seen) -> Mapped {
    let stretch = placed.u.z;
    let from_foot = seen.place.from_foot;
    let foot = vec3<f32>(sight.foot_gradient.xy, sight.foot_gradient.z / sight.ellipsoid.y * stretch);
    let point = foot + vec3<f32>(from_foot.xy, from_foot.z * stretch);
    let radius_foot = length(foot.xy);
    let radius = max(length(point.xy), 1e-3);
    let wider = dot(from_foot.xy, foot.xy + point.xy) / (radius_foot + radius);
    // Of an eye right above a pole the longitude is 0.
    let meridian = select(foot.xy, vec2<f32>(1.0, 0.0), radius_foot == 0.0);
    let turned = angle_of(
        meridian.x * from_foot.y - meridian.y * from_foot.x,
        dot(meridian, point.xy),
    );
    let higher = angle_of(
        radius_foot * from_foot.z * stretch - wider * foot.z,
        radius_foot * radius + foot.z * point.z,
    );
    let lon = placed.u.x + turned;
    let angles = vec2<f32>(lon - 2.0 * PI * round(lon / (2.0 * PI)), placed.u.y + higher);
    let uv = vec2<f32>(dot(placed.v.xy, angles), dot(placed.v.zw, angles));
    let right = angles_along(point, radius, seen.span.right * vec3<f32>(1.0, 1.0, stretch));
    let down = angles_along(point, radius, seen.span.down * vec3<f32>(1.0, 1.0, stretch));
    return Mapped(
        uv,
        vec2<f32>(dot(placed.v.xy, right), dot(placed.v.zw, right)),
        vec2<f32>(dot(placed.v.xy, down), dot(placed.v.zw, down)),
    );
}

// How longitude and latitude change on the way.
fn angles_along(point: vec3<f32>, radius: f32, way: vec3<f32>) -> vec2<f32> {
    let outward = dot(point.xy, way.xy) / radius;
    return vec2<f32>(
        (point.x * way.y - point.y * way.x) / (radius * radius),
        (radius * way.z - outward * point.z) / dot(point, point),
    );
}
