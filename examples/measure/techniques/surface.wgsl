// Caps that lie on the ellipsoid.

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) color: vec4<f32>,
}

@vertex
fn corner(@location(0) position: vec3<f32>, @location(1) color: vec4<f32>) -> Corner {
    var clip = eye.clip_from_relative * vec4<f32>(eye.from_eye.xyz + position, 1.0);
    // Triangles sag below the ellipsoid: their depths are those of something nearer.
    let nearer = max(0.5 * clip.w, clip.w - eye.depth.z);
    if clip.w > 0.0 {
        clip.z = clip.w * (eye.depth.x + eye.depth.y / nearer);
    }
    return Corner(clip, color);
}

@fragment
fn paint(corner: Corner) -> @location(0) vec4<f32> {
    return corner.color;
}
