// Resolving fills with patterns, fades or strokes: the fill that the counted sums name, and the surface
// point that the depth tells, make the colour.

@group(2) @binding(1) var<uniform> sight_bound: Sight;

// What shaders know of the eye. It travels with the vertices, though it is the same for all: software reads
// a uniform anew for every lane of a vector, which took as long as the rest of a hatch.
var<private> sight: Sight;

struct Screen {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) ray: vec4<f32>,
    @location(1) @interpolate(flat) right: vec4<f32>,
    @location(2) @interpolate(flat) down: vec4<f32>,
    @location(3) @interpolate(flat) depth: vec4<f32>,
    @location(4) @interpolate(flat) ellipsoid: vec4<f32>,
    @location(5) @interpolate(flat) eye_gradient: vec4<f32>,
    @location(6) @interpolate(flat) foot_gradient: vec4<f32>,
    @location(7) @interpolate(flat) bounds: vec4<f32>,
    // Width and height; the array of images that this draw shows, and whether it is the last of the layer.
    @location(8) @interpolate(flat) draw: vec4<u32>,
    @location(9) @interpolate(flat) layer: vec4<u32>,
}

const LAST_ARRAY: u32 = 65536u;

// The corners of the window, as a strip.
@vertex
fn vs_styled(@builtin(vertex_index) corner: u32, @builtin(instance_index) draw: u32) -> Screen {
    let greatest = vec2<bool>((corner & 1u) == 1u, corner >= 2u);
    let seen_from = sight_bound;
    return Screen(
        vec4<f32>(select(seen_from.window.xy, seen_from.window.zw, greatest), 0.0, 1.0),
        seen_from.ray,
        seen_from.right,
        seen_from.down,
        seen_from.depth,
        seen_from.ellipsoid,
        seen_from.eye_gradient,
        seen_from.foot_gradient,
        seen_from.bounds,
        vec4<u32>(seen_from.size.xy, draw % LAST_ARRAY, draw / LAST_ARRAY),
        known_of_layer(),
    );
}

fn take_sight(in: Screen) {
    known = in.layer;
    sight.ray = in.ray;
    sight.right = in.right;
    sight.down = in.down;
    sight.depth = in.depth;
    sight.ellipsoid = in.ellipsoid;
    sight.eye_gradient = in.eye_gradient;
    sight.foot_gradient = in.foot_gradient;
    sight.bounds = in.bounds;
    sight.size = vec4<u32>(in.draw.xy, 0u, 0u);
}

// How much of a pixel is ink of a hatch that lies at a place on its map.
fn ink_share(style: u32, phase: vec4<u32>, mapped: Mapped) -> f32 {
    let kind = kind_of(style);
    let hatch = styles[style].hatch;
    let u_slope = length(mapped.u_slope);
    let u = cells_of(phase.xy, mapped.uv.x, u_slope, hatch.y);
    var covered = 0.0;
    // Where there is one kind, it need not be asked for: other fills have no share of ink.
    let only_lines = !needs(NEEDS_DOTS | NEEDS_CHECKER);
    if needs(NEEDS_LINES) && (only_lines || kind == LINES || kind == CROSS) {
        covered = lines(u, hatch.x);
    }
    if needs(NEEDS_ACROSS) {
        let v_slope = length(mapped.v_slope);
        let v = cells_of(phase.zw, mapped.uv.y, v_slope, hatch.y);
        if needs(NEEDS_LINES) && kind == CROSS {
            covered = 1.0 - (1.0 - covered) * (1.0 - lines(v, hatch.x));
        }
        if needs(NEEDS_DOTS) && kind == DOTS {
            let u_cells = mapped.u_slope * (u.width / max(u_slope, 1e-30));
            let v_cells = mapped.v_slope * (v.width / max(v_slope, 1e-30));
            covered = dots(u, v, u_cells, v_cells, hatch.x);
        }
        if needs(NEEDS_CHECKER) && kind == CHECKER {
            covered = 0.5 + 0.5 * checker_wave(u) * checker_wave(v);
        }
    }
    return covered;
}

fn over(above: vec4<f32>, below: vec4<f32>) -> vec4<f32> {
    return above + below * (1.0 - above.w);
}

// The colour of a fill without its stroke, premultiplied, with its opacity.
fn paint_of(style: u32, seen: Seen) -> vec4<f32> {
    var paint = styles[style].paper;
    if !needs(NEEDS_HATCHES | NEEDS_IMAGES) {
        return paint;
    }
    let place = styles[style].pattern.y;
    var phase = MIDDLE;
    var mapped: Mapped;
    if needs(NEEDS_MAPS) {
        phase = places[place].phase;
        mapped = on_map(places[place], seen);
    }
    if needs(NEEDS_ANGLES) && (!needs(NEEDS_MAPS) || places[place].fall.w != 0.0) {
        mapped = on_angles(places[place], seen);
    }
    var inked = paint;
    if needs(NEEDS_HATCHES | NEEDS_INKED) {
        inked = styles[style].inked;
    }
    if needs(NEEDS_HATCHES) {
        paint = mix(paint, inked, ink_share(style, phase, mapped));
    }
    if needs(NEEDS_IMAGES) {
        let kind = kind_of(style);
        var texel = vec4<f32>(0.0);
        if needs(NEEDS_TILES) && kind == TILES {
            texel = tiles(style, phase, mapped);
        }
        if needs(NEEDS_CLAMPED | NEEDS_REPEATED) && kind == PICTURE {
            texel = picture(style, phase, mapped);
        }
        paint += texel - inked * texel.w;
    }
    return paint;
}

// The colour of a fill with its own stroke over it and all that fades both; its alpha is what it hides of
// what is below. Nothing for what another draw shows.
fn color_of(fill: u32, stroke: vec4<f32>, seen: Seen, array: u32) -> vec4<f32> {
    let style = max(fill, 1u) - 1u;
    var color = paint_of(style, seen);
    if needs(NEEDS_STROKES) {
        color = stroke * styles[style].hatch.w + color * (1.0 - stroke.w);
    }
    var shown = fill != NONE;
    if needs(NEEDS_ARRAYS) {
        shown = shown && styles[style].pattern.w == array;
    }
    return select(vec4<f32>(0.0), left_of(style, color, seen), shown);
}

// What is left of a colour after fading; its alpha becomes what it hides of what is below.
fn left_of(style: u32, color: vec4<f32>, seen: Seen) -> vec4<f32> {
    var left = color;
    if needs(NEEDS_FADES) {
        left *= faded(style, seen);
    }
    if needs(NEEDS_ADDITIVE) && is_additive(style) {
        left.w = 0.0;
    }
    return left;
}

// The stroke of a fill that is not the one at the pixel.
fn stroke_beside(fill: u32, edge: Edge, seen: Seen) -> vec4<f32> {
    let style = max(fill, 1u) - 1u;
    return left_of(style, stroke_of(fill, edge) * styles[style].hatch.w, seen);
}

// The stroke of the fill on one side of the nearest boundary.
fn stroke_of(fill: u32, edge: Edge) -> vec4<f32> {
    let style = max(fill, 1u) - 1u;
    let size = styles[style].stroke_size;
    let dash = vec4<f32>(size.zw, styles[style].fade_sine.z, 0.0);
    let share = stroke_share(edge, fill == edge.left, size.xy, align_of(style), dash);
    return select(vec4<f32>(0.0), styles[style].stroke * share, fill != NONE);
}

// The nearest boundary, on the side of which the counted fill is right wherever the pixel's middle is
// clearly on one.
fn edge_at(texel: vec4<u32>, fill: u32) -> Edge {
    var edge = edge_of(texel);
    let clearly = abs(edge.signed_m) > 0.75 * edge.across_m;
    if clearly && fill == edge.left && fill != edge.right {
        edge.signed_m = abs(edge.signed_m);
    }
    if clearly && fill == edge.right && fill != edge.left {
        edge.signed_m = -abs(edge.signed_m);
    }
    return edge;
}

fn styled_at(pixel: vec2<u32>, sample: u32, array: u32, last: bool) -> vec4<f32> {
    let fill = fill_at(vec2<i32>(pixel), sample);
    if !needs(NEEDS_SMOOTH | NEEDS_STROKES) && fill == NONE {
        discard;
    }
    let depth = depth_at(pixel, sample);
    let seen = seen_at(vec2<f32>(pixel) + sample_px(sample), depth);
    if !needs(NEEDS_SMOOTH | NEEDS_STROKES) {
        return color_of(fill, vec4<f32>(0.0), seen, array);
    }
    let texel = textureLoad(edges, vec2<i32>(pixel), 0);
    let edge = edge_at(texel, fill);
    let measured = has_edge(texel) && !is_sky(depth);
    let beside = measured && (fill == edge.left || fill == edge.right);
    var own = vec4<f32>(0.0);
    if needs(NEEDS_STROKES) && beside {
        own = stroke_of(fill, edge);
    }
    var color = color_of(fill, own, seen, array);
    let other = select(edge.left, edge.right, fill == edge.left);
    if needs(NEEDS_SMOOTH) && beside {
        let left = side_share(edge);
        let share = select(1.0 - left, left, fill == edge.left);
        color = mix(color_of(other, vec4<f32>(0.0), seen, array), color, share);
    }
    if needs(NEEDS_STROKES) && measured && last {
        // Strokes of others; all with the last draw, so that none paints over them.
        let lower = min(edge.left, edge.right);
        let upper = max(edge.left, edge.right);
        if lower != fill {
            color = over(stroke_beside(lower, edge, seen), color);
        }
        if upper != fill {
            color = over(stroke_beside(upper, edge, seen), color);
        }
    }
    return color;
}

@fragment
fn fs_styled(in: Screen) -> @location(0) vec4<f32> {
    take_sight(in);
    return styled_at(vec2<u32>(in.position.xy), 0u, in.draw.z, in.draw.w == 1u);
}

@fragment
fn fs_styled_sample(in: Screen, @builtin(sample_index) sample: u32) -> @location(0) vec4<f32> {
    take_sight(in);
    return styled_at(vec2<u32>(in.position.xy), sample, in.draw.z, in.draw.w == 1u);
}
