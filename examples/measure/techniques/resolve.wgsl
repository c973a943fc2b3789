// From sums to colours.

@group(0) @binding(0) var sums: texture_2d<f32>;
@group(0) @binding(1) var<storage, read> colors: array<vec4<f32>>;

@vertex
fn whole_picture(@builtin(vertex_index) k: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(k & 1u) * 4.0 - 1.0, f32(k >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn resolve(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let sum = textureLoad(sums, vec2<i32>(at.xy), 0);
    let number = u32(max(sum.x + 256.0 * sum.y, 0.0));
    if sum.z != 1.0 || number == 0u || number > arrayLength(&colors) {
        discard;
    }
    return colors[number - 1u];
}
