// Images: one array of equal size at a time.

@group(3) @binding(0) var images: texture_2d_array<f32>;
@group(3) @binding(1) var clamped: sampler;
@group(3) @binding(2) var repeated: sampler;

// How much of a pixel lies within 0 ... 1 of a coordinate that changes by `width` across it.
fn inside(at: f32, width: f32) -> f32 {
    let pixels = 1.0 / max(width, 1e-9);
    return clamp(at * pixels, -0.5, 0.5) + clamp((1.0 - at) * pixels, -0.5, 0.5);
}

// An image in its place; v runs down.
fn picture(style: u32, phase: vec4<u32>, mapped: Mapped) -> vec4<f32> {
    let layer = styles[style].pattern.z;
    let wrap = wrap_of(style);
    let fraction = mapped.uv + vec2<f32>(fraction_of(phase.y), fraction_of(phase.w));
    let at = fraction + vec2<f32>(vec2<i32>(phase.xz));
    var texel = vec4<f32>(0.0);
    if needs(NEEDS_CLAMPED) {
        texel = sampled(clamped, at, layer, mapped);
        let u_width = abs(mapped.u_slope.x) + abs(mapped.u_slope.y);
        let v_width = abs(mapped.v_slope.x) + abs(mapped.v_slope.y);
        let shown = inside(at.x, u_width) * inside(at.y, v_width);
        texel *= select(1.0, shown, wrap == CLIP);
    }
    if needs(NEEDS_REPEATED) && wrap == REPEAT {
        texel = sampled(repeated, fract(fraction), layer, mapped);
    }
    return texel * styles[style].tint.w;
}

// An image that repeats like a hatch, at two scales while one turns into the other.
fn tiles(style: u32, phase: vec4<u32>, mapped: Mapped) -> vec4<f32> {
    let layer = styles[style].pattern.z;
    let wanted = styles[style].hatch.y;
    // One scale for both axes, so that the image keeps its shape; v counts heights of the image.
    let u_slope = length(mapped.u_slope);
    let v_slope = length(mapped.v_slope) * styles[style].hatch.z;
    let slope = sqrt(u_slope * v_slope);
    let u = cells_of(phase.xy, mapped.uv.x, slope, wanted);
    let v = cells_of(phase.zw, mapped.uv.y, slope, wanted);
    let scale = u.width / max(slope, 1e-30);
    let fine = Mapped(vec2<f32>(u.at, -v.at), mapped.u_slope * scale, -mapped.v_slope * scale);
    let number = vec2<f32>(vec2<u32>(u.number, v.number) & vec2<u32>(1u));
    let twice = 0.5 * vec2<f32>(u.at + number.x, -v.at - number.y);
    let coarse = Mapped(twice, 0.5 * fine.u_slope, 0.5 * fine.v_slope);
    let finely = sampled(repeated, fract(fine.uv), layer, fine);
    let coarsely = sampled(repeated, fract(coarse.uv), layer, coarse);
    return mix(finely, coarsely, u.change) * styles[style].tint;
}

// Most samples along what a pixel spans of an image; what is longer is blurred.
const MOST_TAPS: f32 = 8.0;

// Logarithm of a positive number, straight between powers of two: 0.09 below the true one at most.
fn log2_of(number: f32) -> f32 {
    return f32(bitcast<i32>(number) - 0x3f800000) / 8388608.0;
}

// Levels with the middle third between two blended: most pixels need one.
fn sharper(level: f32) -> f32 {
    let lower = floor(level);
    return lower + saturate(3.0 * (level - lower) - 1.0);
}

// The mean of an image over what a pixel spans: samples as fine as its shorter side along the longer.
fn sampled(filtering: sampler, at: vec2<f32>, layer: u32, mapped: Mapped) -> vec4<f32> {
    let right = vec2<f32>(mapped.u_slope.x, mapped.v_slope.x);
    let down = vec2<f32>(mapped.u_slope.y, mapped.v_slope.y);
    let size = vec2<f32>(textureDimensions(images));
    let across = vec2<f32>(dot(right * size, right * size), dot(down * size, down * size));
    let long = select(right, down, across.y > across.x);
    let longer = max(across.x, across.y);
    // The parallelogram of both sides has the area of longer times shorter.
    let area = abs(right.x * down.y - right.y * down.x) * size.x * size.y;
    // As often as the shorter side goes into the longer, but once where that is within a texel.
    let most = clamp(longer, 1.0, MOST_TAPS);
    let taps = floor(clamp(longer / max(area, 1e-12), 1.0, most));
    let share = 1.0 / taps;
    // Texels as long as the mean of the shorter side and the way between samples, by ratio: neither is more
    // than 1.41 times as long or as short, but for ways that are longer still.
    let texel = max(area, 0.5 * longer * share) * share;
    let level = sharper(0.5 * log2_of(max(texel, 1e-12)));
    var sum = vec4<f32>(0.0);
    var tap = 0.5;
    // There is one at least: asked for at the end, and not in a `continuing`, software takes none too many.
    loop {
        sum += textureSampleLevel(images, filtering, at + (tap * share - 0.5) * long, layer, level);
        tap += 1.0;
        if tap >= taps {
            break;
        }
    }
    return sum * share;
}
