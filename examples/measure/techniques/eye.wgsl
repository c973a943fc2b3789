// What the yardsticks share: the camera, and how far volumes reach.

struct Eye {
    // From metres relative to the eye, along ECEF axes, to clip space.
    clip_from_relative: mat4x4<f32>,
    // From the eye to the origin that positions are counted from, m.
    from_eye: vec4<f32>,
    // That origin, ECEF m.
    origin: vec4<f32>,
    // Surface position times this is along the geodetic normal.
    normal_scale: vec4<f32>,
    // x: top, m. y: bottom, m. z: how far the bottom is pushed down per metre from the eye. w: the most of it, m.
    heights: vec4<f32>,
    // Depth is x + y / distance. z: how much nearer than they are surfaces are tested, m.
    depth: vec4<f32>,
}

@group(0) @binding(0) var<uniform> eye: Eye;

fn normal_at(position: vec3<f32>) -> vec3<f32> {
    return normalize((eye.origin.xyz + position) * eye.normal_scale.xyz);
}

// How far below the ellipsoid the bottom lies, negative.
fn bottom_m(from_eye: vec3<f32>) -> f32 {
    return min(eye.heights.y, -min(eye.heights.z * length(from_eye), eye.heights.w));
}
