// The bare globe: every pixel's ray meets the exact ellipsoid.

struct Ground {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

fn ground_along(ndc: vec2f) -> Ground {
    let ray = ray_at(ndc);
    let t = hit(ray);
    let distance_m = t * view.constants.x;
    let depth = depth_at(distance_m);
    // Behind the near plane there is nothing to see, as for any other geometry.
    let is_seen = t > 0.0 && depth >= 0.0 && depth <= 1.0;
    let scaled = view.eye.xyz + t * ray.direction;
    let normal = normalize(scaled * vec3f(1.0, 1.0, view.constants.y));
    let direction = ray.direction * vec3f(1.0, 1.0, 1.0 / view.constants.y);
    var color = world_color(normal) * ground_detail(direction * distance_m, distance_m);
    color *= daylight(normal);
    color = through_air(color, normal, direction, distance_m);
    return Ground(vec4f(color, 1.0), select(view.picture.z, depth, is_seen));
}

@fragment
fn globe_pixel(@builtin(position) position: vec4f) -> Ground {
    return ground_along(ndc_of(position));
}

// With several samples a pixel each has its own ray, or the limb and the depth would be wrong.
@fragment
fn globe_sample(corner: Corner) -> Ground {
    return ground_along(corner.ndc);
}
