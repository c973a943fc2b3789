// The counted sums, one texture with as many channels as there are planes.
@group(0) @binding(3) var planes: texture_2d<f32>;

fn size_px() -> vec2<i32> {
    return vec2<i32>(textureDimensions(planes));
}

fn load_planes(pixel: vec2<i32>, sample: u32) -> vec4<f32> {
    return textureLoad(planes, pixel, 0);
}
