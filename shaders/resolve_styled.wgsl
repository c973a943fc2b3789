// Resolving fills with patterns, fades or strokes: the fill that the counted sums name, and the surface
// point that the depth tells, make the colour.

struct Screen {
    @builtin(position) position: vec4<f32>,
    // The array of images that this draw shows, and whether it is the last of the layer.
    @location(0) @interpolate(flat) array: u32,
    @location(1) @interpolate(flat) last: u32,
}

const LAST_ARRAY: u32 = 65536u;

// The corners of the window, as a strip.
@vertex
fn vs_styled(@builtin(vertex_index) corner: u32, @builtin(instance_index) draw: u32) -> Screen {
    let greatest = vec2<bool>((corner & 1u) == 1u, corner >= 2u);
    let at = select(sight.window.xy, sight.window.zw, greatest);
    return Screen(vec4<f32>(at, 0.0, 1.0), draw % LAST_ARRAY, draw / LAST_ARRAY);
}

// Ink of a pattern that lies at a place on its map or its longitudes and latitudes.
fn ink_of(style: u32, seen: Seen) -> vec4<f32> {
    let kind = styles[style].pattern.x;
    let place = styles[style].pattern.y;
    let phase = places[place].phase;
    var mapped = on_map(places[place], seen);
    if needs(NEEDS_ANGLES) && places[place].fall.w != 0.0 {
        mapped = on_angles(places[place], seen);
    }
    var covered = 0.0;
    if needs(NEEDS_LINES | NEEDS_DOTS | NEEDS_CHECKER) {
        let hatch = styles[style].hatch;
        let u_slope = length(mapped.u_slope);
        let u = cells_of(phase.xy, mapped.uv.x, u_slope, hatch.y);
        if needs(NEEDS_LINES) && (kind == LINES || kind == CROSS) {
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
    }
    var ink = styles[style].ink * covered;
    if needs(NEEDS_TILES) && kind == TILES {
        ink = tiles(style, phase, mapped);
    }
    if needs(NEEDS_CLAMPED | NEEDS_REPEATED) && kind == PICTURE {
        ink = picture(style, phase, mapped);
    }
    return ink;
}

fn over(above: vec4<f32>, below: vec4<f32>) -> vec4<f32> {
    return above + below * (1.0 - above.w);
}

// The colour of a fill without its stroke, premultiplied.
fn paint_of(style: u32, seen: Seen) -> vec4<f32> {
    let patterned = over(ink_of(style, seen), styles[style].color);
    return over(styles[style].highlight, patterned);
}

// The colour of a fill with its own stroke over it and all that fades both; its alpha is what it hides of
// what is below. Nothing for what another draw shows.
fn color_of(fill: u32, stroke: vec4<f32>, seen: Seen, array: u32) -> vec4<f32> {
    let style = max(fill, 1u) - 1u;
    let color = faded(style, over(stroke, paint_of(style, seen)), seen);
    let shown = fill != NONE && styles[style].pattern.w == array;
    return select(vec4<f32>(0.0), color, shown);
}

fn faded(style: u32, color: vec4<f32>, seen: Seen) -> vec4<f32> {
    let left = color * opacity_of(style, seen);
    return vec4<f32>(left.xyz, left.w * styles[style].fade_sine.z);
}

// The stroke of the fill on one side of the nearest boundary.
fn stroke_of(fill: u32, edge: Edge) -> vec4<f32> {
    let style = max(fill, 1u) - 1u;
    let size = styles[style].stroke_size;
    let dash = vec4<f32>(size.zw, styles[style].dash_share, 0.0);
    let share = stroke_share(edge, fill == edge.left, size.xy, styles[style].align, dash);
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
        // Strokes of others, the one that is drawn later on top; all with the last draw, so that none paints
        // over them.
        let lower = min(edge.left, edge.right);
        let upper = max(edge.left, edge.right);
        if lower != fill {
            color = over(faded(max(lower, 1u) - 1u, stroke_of(lower, edge), seen), color);
        }
        if upper != fill {
            color = over(faded(max(upper, 1u) - 1u, stroke_of(upper, edge), seen), color);
        }
    }
    return color;
}

@fragment
fn fs_styled(in: Screen) -> @location(0) vec4<f32> {
    return styled_at(vec2<u32>(in.position.xy), 0u, in.array, in.last == 1u);
}

@fragment
fn fs_styled_sample(in: Screen, @builtin(sample_index) sample: u32) -> @location(0) vec4<f32> {
    return styled_at(vec2<u32>(in.position.xy), sample, in.array, in.last == 1u);
}
