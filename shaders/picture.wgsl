// Images: one array of equal size at a time.

@group(3) @binding(0) var images: texture_2d_array<f32>;
@group(3) @binding(1) var clamped: sampler;
@group(3) @binding(2) var repeated: sampler;

// How much of a pixel lies within 0 ... 1 of a coordinate that changes by `width` across it.
fn inside(at: f32, width: f32) -> f32 {
    return saturate(min(at, 1.0 - at) / max(width, 1e-9) + 0.5);
}

// An image in its place; v runs down.
fn picture(style: u32, phase: vec4<u32>, mapped: Mapped) -> vec4<f32> {
    let layer = styles[style].pattern.z;
    let wrap = styles[style].wrap;
    let fraction = mapped.uv + vec2<f32>(fraction_of(phase.y), fraction_of(phase.w));
    let at = fraction + vec2<f32>(vec2<i32>(phase.xz));
    var texel = vec4<f32>(0.0);
    if needs(NEEDS_CLAMPED) {
        texel = textureSampleGrad(images, clamped, at, layer, mapped.right, mapped.down);
        let width = abs(mapped.right) + abs(mapped.down);
        let shown = inside(at.x, width.x) * inside(at.y, width.y);
        texel *= select(1.0, shown, wrap == CLIP);
    }
    if needs(NEEDS_REPEATED) && wrap == REPEAT {
        texel = repeating(layer, fraction, mapped.right, mapped.down);
    }
    return texel * styles[style].ink.w;
}

fn repeating(layer: u32, at: vec2<f32>, right: vec2<f32>, down: vec2<f32>) -> vec4<f32> {
    return textureSampleGrad(images, repeated, fract(at), layer, right, down);
}

// An image that repeats like a hatch, at two scales while one turns into the other.
fn tiles(style: u32, phase: vec4<u32>, mapped: Mapped) -> vec4<f32> {
    let layer = styles[style].pattern.z;
    let wanted = styles[style].hatch.y;
    // One scale for both axes, so that the image keeps its shape; v counts heights of the image.
    let u_width = length(vec2<f32>(mapped.right.x, mapped.down.x));
    let v_width = length(vec2<f32>(mapped.right.y, mapped.down.y)) * styles[style].hatch.z;
    let width = sqrt(u_width * v_width);
    let u = cells_of(phase.xy, mapped.uv.x, width, wanted);
    let v = cells_of(phase.zw, mapped.uv.y, width, wanted);
    let scale = vec2<f32>(1.0, -1.0) * u.width / max(width, 1e-30);
    let right = mapped.right * scale;
    let down = mapped.down * scale;
    let fine = repeating(layer, vec2<f32>(u.at, -v.at), right, down);
    let number = vec2<f32>(vec2<u32>(u.number, v.number) & vec2<u32>(1u));
    let twice = 0.5 * vec2<f32>(u.at + number.x, -v.at - number.y);
    let coarse = repeating(layer, twice, 0.5 * right, 0.5 * down);
    return mix(fine, coarse, u.change) * styles[style].ink;
}
