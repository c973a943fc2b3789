// Resolving: the counted sums name the fill at each pixel; its colour goes to the host's target.

// Premultiplied colours by id - 1.
@group(0) @binding(1) var<storage, read> colors: array<vec4<f32>>;

fn color_at(pixel: vec2<i32>, sample: u32) -> vec4<f32> {
    let fill = fill_at(pixel, sample);
    if fill == NONE {
        discard;
    }
    return colors[fill - 1u];
}

@fragment
fn fs_resolve(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {
    return color_at(vec2<i32>(pixel.xy), 0u);
}

@fragment
fn fs_resolve_sample(
    @builtin(position) pixel: vec4<f32>,
    @builtin(sample_index) sample: u32,
) -> @location(0) vec4<f32> {
    return color_at(vec2<i32>(pixel.xy), sample);
}
