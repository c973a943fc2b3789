// What the texels of the edge pass say, and how much of a pixel a stroke covers.

struct Edge {
    // Distance of the pixel's centre from the nearest boundary, metres, positive on its left.
    signed_m: f32,
    // Metres a pixel, across the boundary and along it.
    across_m: f32,
    along_m: f32,
    // Ids on either side; 0 for none.
    left: u32,
    right: u32,
    // Steps of 1/64 m from the start of the boundary's arc.
    along: u32,
}

// Ids of a pixel that is near no boundary; those of both sides of one differ.
const NO_EDGE: u32 = 0u;
// How a stroke lies to its fill.
const ALIGN_INNER: u32 = 0u;
const ALIGN_CENTER: u32 = 1u;
const ALIGN_OUTER: u32 = 2u;
// Steps of `along` in a metre.
const ALONG_STEPS: f32 = 64.0;

fn has_edge(texel: vec4<u32>) -> bool {
    return texel.z != NO_EDGE;
}

// Metres a pixel are kept as logarithms in 16 bits: off by 0.5 % at 1 km a pixel, by less nearer to 1 m.
fn edge_of(texel: vec4<u32>) -> Edge {
    let metres = exp2(unpack2x16float(texel.y));
    let signed_m = bitcast<f32>(texel.x);
    return Edge(signed_m, metres.x, metres.y, texel.z & 0xffffu, texel.z >> 16u, texel.w);
}

// The share of a pixel that lies to the left of the boundary.
fn side_share(edge: Edge) -> f32 {
    return clamp(edge.signed_m / edge.across_m + 0.5, 0.0, 1.0);
}

// The share of a pixel that the stroke of the fill on one side covers.
//
// width: metres and pixels, one of which is 0. dash: period in metres and in pixels, both 0 for a solid
// line, and which share of it is drawn.
fn stroke_share(edge: Edge, on_left: bool, width: vec2<f32>, align: u32, dash: vec4<f32>) -> f32 {
    let inside_px = edge.signed_m / edge.across_m * select(-1.0, 1.0, on_left);
    let width_px = width.x / edge.across_m + width.y;
    var outer_px = 0.0;
    if align == ALIGN_CENTER {
        outer_px = -0.5 * width_px;
    }
    if align == ALIGN_OUTER {
        outer_px = -width_px;
    }
    // The pixel as a box of one pixel across the boundary: also lines that are thinner keep their mean.
    let from_px = max(inside_px - 0.5, outer_px);
    let to_px = min(inside_px + 0.5, outer_px + width_px);
    return max(to_px - from_px, 0.0) * dash_share(edge, dash);
}

// The share of a pixel, as a box along the boundary, that dashes cover.
fn dash_share(edge: Edge, dash: vec4<f32>) -> f32 {
    if dash.x <= 0.0 && dash.y <= 0.0 {
        return 1.0;
    }
    let box = max(edge.along_m * ALONG_STEPS, 1e-3);
    if dash.x > 0.0 {
        let period = u32(clamp(round(dash.x * ALONG_STEPS), 1.0, 4294967040.0));
        let drawn = dash.z * f32(period);
        return pulses_share(edge.along % period, f32(period), vec3<f32>(drawn, f32(period), 0.0), box);
    }
    // The period 2^k in steps that is within a factor sqrt(2) of what is wanted on the screen. Where k
    // grows, every other dash grows at its end to twice its length, while the next ones, whose ends stay,
    // shrink to nothing: gaps are as long as before and the mean stays.
    let wanted = clamp(log2(max(dash.y * box, 1.0)), 0.0, 30.0);
    let power = min(u32(wanted), 30u);
    let grown = clamp((wanted - f32(power) - 0.5) * 4.0 + 0.5, 0.0, 1.0);
    let period = f32(1u << power);
    let drawn = dash.z * period;
    let pulses = vec3<f32>(drawn * (1.0 + grown), period + drawn * grown, drawn * (1.0 - grown));
    return pulses_share(edge.along & ((2u << power) - 1u), 2.0 * period, pulses, box);
}

// The share of a box about `at` that lies in pulses repeated after `period`: one from 0 to pulses.x, one
// from pulses.y on of length pulses.z.
fn pulses_share(at: u32, period: f32, pulses: vec3<f32>, box: f32) -> f32 {
    let mean = (pulses.x + pulses.z) / period;
    // Many periods in a box: the ends weigh little, and rounding more.
    if box > 64.0 * period {
        return mean;
    }
    let half = 0.5 * box;
    let covered = pulses_until(f32(at) + half, period, pulses) - pulses_until(f32(at) - half, period, pulses);
    return clamp(covered / box, 0.0, 1.0);
}

fn pulses_until(x: f32, period: f32, pulses: vec3<f32>) -> f32 {
    let turns = floor(x / period);
    let rest = x - turns * period;
    return turns * (pulses.x + pulses.z) + min(rest, pulses.x) + clamp(rest - pulses.y, 0.0, pulses.z);
}
