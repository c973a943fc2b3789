@group(2) @binding(0) var depth_texture: texture_depth_multisampled_2d;

const SAMPLES: u32 = 4u;

fn depth_at(pixel: vec2<u32>, sample: u32) -> f32 {
    return textureLoad(depth_texture, pixel, i32(sample));
}

// The standard positions of four samples in a pixel.
fn sample_px(sample: u32) -> vec2<f32> {
    let positions = array<vec2<f32>, 4>(
        vec2(0.375, 0.125), vec2(0.875, 0.375), vec2(0.125, 0.625), vec2(0.625, 0.875),
    );
    return positions[sample];
}
