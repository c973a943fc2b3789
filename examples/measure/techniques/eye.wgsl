// What the yardsticks share: the camera, and how far volumes reach.

struct Eye {
    // From metres relative to the eye, along ECEF axes, to clip space.
    clip_from_relative: mat4x4<f32>,
    // From the eye to the origin that positions are counted from, m.
    from_eye: vec4<f32>,
    // That origin, ECEF m.
    origin: vec4<f32>,
    // The eye as two numbers that add up, ECEF m.
    high: vec4<f32>,
    low: vec4<f32>,
    // The eye in steps of 1/128 m, and what they leave over, in 2^-17 m and in metres.
    steps: vec4<i32>,
    fraction: vec4<i32>,
    remainder: vec4<f32>,
    // Surface position times this is along the normal that columns stand on.
    normal_scale: vec4<f32>,
    // x: top, m. y: bottom, m. z: how far the bottom is pushed down per metre from the eye. w: the most of it, m.
    heights: vec4<f32>,
    // Depth is x + y / distance. z: how much nearer than they are surfaces are tested, m.
    depth: vec4<f32>,
}

@group(0) @binding(0) var<uniform> eye: Eye;

fn normal_at(ecef: vec3<f32>) -> vec3<f32> {
    return normalize(ecef * eye.normal_scale.xyz);
}

// How far below the ellipsoid the bottom lies, negative.
fn bottom_m(from_eye: vec3<f32>) -> f32 {
    return min(eye.heights.y, -min(eye.heights.z * length(from_eye), eye.heights.w));
}
