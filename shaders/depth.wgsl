@group(2) @binding(0) var depth_texture: texture_depth_2d;

const SAMPLES: u32 = 1u;

fn depth_at(pixel: vec2<u32>, sample: u32) -> f32 {
    return textureLoad(depth_texture, pixel, 0);
}

fn sample_px(sample: u32) -> vec2<f32> {
    return vec2<f32>(0.5);
}
