// The counted sums, one multisampled texture a plane.
@group(0) @binding(3) var first: texture_multisampled_2d<f32>;
@group(0) @binding(4) var second: texture_multisampled_2d<f32>;
@group(0) @binding(5) var third: texture_multisampled_2d<f32>;
@group(0) @binding(6) var fourth: texture_multisampled_2d<f32>;

fn size_px() -> vec2<i32> {
    return vec2<i32>(textureDimensions(first));
}

fn load_planes(pixel: vec2<i32>, sample: u32) -> vec4<f32> {
    return vec4<f32>(
        textureLoad(first, pixel, i32(sample)).x,
        textureLoad(second, pixel, i32(sample)).x,
        textureLoad(third, pixel, i32(sample)).x,
        textureLoad(fourth, pixel, i32(sample)).x,
    );
}
