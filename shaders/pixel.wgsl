// What a pixel spans on the surface, by ray differentials: differences between neighbouring pixels
// would break at silhouettes and jump from triangle to triangle of a terrain.

struct Span {
    // How the foot point moves, metres per pixel to the right and down.
    right: vec3<f32>,
    down: vec3<f32>,
    // Sine of the angle between the line of sight and the ellipsoid's tangent plane.
    sine: f32,
}

fn up_at(place: Place) -> vec3<f32> {
    let m = vec3<f32>(1.0, 1.0, sight.ellipsoid.y);
    return normalize(sight.foot_gradient.xyz + m * place.from_foot);
}

// The surface is taken as level at `place`, seen along `ray`, and on terrain as no more
// oblique than sight.bounds.w (a sine): slopes are steeper than the level ground they stand on. That feet
// are nearer to each other than what stands on them, a part in 700 on the highest mountain, is left out.
// `scale` is scale_at the distance.
fn span_of(ray: vec3<f32>, scale: f32, place: Place) -> Span {
    let up = up_at(place);
    let sine = abs(dot(ray, up)) / length(ray);
    let rise = max(sine, sight.bounds.w) * length(ray);
    let along = ray * select(1.0, -1.0, dot(ray, up) < 0.0) / rise;
    return Span(
        scale * (sight.right.xyz - along * dot(sight.right.xyz, up)),
        scale * (sight.down.xyz - along * dot(sight.down.xyz, up)),
        sine,
    );
}
