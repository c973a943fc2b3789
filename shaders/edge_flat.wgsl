// The edge pass far away, where relief and the sag of chords are smaller than the pixel budget: chords are
// drawn as rectangles on the screen and measured there, without asking what surface a pixel shows.

struct FlatVertex {
    @builtin(position) position: vec4<f32>,
    // Both ends, pixels.
    @location(0) @interpolate(flat) ends: vec4<f32>,
    // Unit vector to the chord's left, pixels; metres a pixel across and along.
    @location(1) @interpolate(flat) left: vec4<f32>,
    // How far the edge reaches, pixels.
    @location(2) @interpolate(flat) limit: f32,
    // Ids, and places of both ends along the arc.
    @location(3) @interpolate(flat) sides: vec4<u32>,
}

fn flat_nowhere() -> FlatVertex {
    var out: FlatVertex;
    out.position = vec4<f32>(0.0, 0.0, 0.0, -1.0);
    return out;
}

// A surface point half way up the relief, relative to the eye.
fn middle_m(vertex: vec4<i32>, up: vec3<f32>) -> vec3<f32> {
    return relative_m(vertex) + up * 0.5 * (edge_sight.surface.x + edge_sight.surface.y);
}

fn pixels_at(clip: vec4<f32>) -> vec2<f32> {
    let size = vec2<f32>(sight.size.xy);
    return (vec2<f32>(0.5) + vec2<f32>(0.5, -0.5) * clip.xy / clip.w) * size;
}

@vertex
fn vs_flat(@builtin(vertex_index) corner: u32, @builtin(instance_index) slot: u32) -> FlatVertex {
    let first = slots[slot];
    let arc = select(first.x, 0u, first.x == NO_CHORD);
    let ids = vec2<u32>(id_of(arcs[arc].left), id_of(arcs[arc].right));
    let reach = max(reaches[ids.x], reaches[ids.y]);
    let up = up_of(vertices[slot]);
    let start = middle_m(vertices[slot], up);
    let end = middle_m(vertices[slot + 1u], up);
    let way = between_m(vertices[slot], vertices[slot + 1u]);
    let length_m = length(way);
    let behind = dot(sight_line(start), up) > 0.0 && dot(sight_line(end), up) > 0.0;
    if first.x == NO_CHORD || ids.x == ids.y || max(reach.x, reach.y) <= 0.0
        || length_m < SHORTEST_M || behind {
        return flat_nowhere();
    }
    let clip_start = frame.clip_from_relative * vec4<f32>(start, 1.0);
    let clip_end = frame.clip_from_relative * vec4<f32>(end, 1.0);
    if !PARALLEL && min(clip_start.w, clip_end.w) <= frame.slack.w {
        return flat_nowhere();
    }
    let a = pixels_at(clip_start);
    let b = pixels_at(clip_end);
    // How a metre to the left appears, and what of it is across the chord.
    let left_m = cross(up, way / length_m);
    let size = vec2<f32>(sight.size.xy);
    let stepped = frame.clip_from_relative * vec4<f32>(left_m, 0.0);
    let left_px = vec2<f32>(0.5, -0.5) * size
        * (stepped.xy - clip_start.xy / clip_start.w * stepped.w) / clip_start.w;
    let span = b - a;
    let length_px = max(length(span), 1e-6);
    // Seen along its own direction a chord has none; left will do.
    let along = select(normalize(vec2<f32>(-left_px.y, left_px.x)), span / length_px, length_px > 1e-3);
    let normal = vec2<f32>(-along.y, along.x);
    let across_px = dot(left_px, normal);
    let left = select(normal, -normal, across_px < 0.0);
    let across_m = 1.0 / max(abs(across_px), 1e-12);
    let limit = reach.y + reach.x / across_m + 1.0;
    // Round ends reach as far ahead as the edge does to the side.
    let ahead = select(-limit, limit, (corner & 1u) == 1u);
    let aside = select(-limit, limit, corner >= 2u);
    let at = select(a, b, (corner & 1u) == 1u) + ahead * along + aside * normal;
    var out: FlatVertex;
    let ndc = at / size * vec2<f32>(2.0, -2.0) + vec2<f32>(-1.0, 1.0);
    out.position = vec4<f32>(ndc, 0.0, 1.0);
    out.ends = vec4<f32>(a, b);
    out.left = vec4<f32>(left, across_m, length_m / length_px);
    out.limit = limit;
    out.sides = vec4<u32>(ids.x | (ids.y << 16u), first.y, slots[slot + 1u].y, 0u);
    return out;
}

@fragment
fn fs_flat(in: FlatVertex) -> EdgeTexel {
    let depth = depth_at(vec2<u32>(in.position.xy), 0u);
    let from_eye = from_eye_at(in.position.xy, distance_of(depth));
    if is_sky(depth) || strays(place_of(from_eye, 0.0), 0.0) {
        discard;
    }
    let from_start = in.position.xy - in.ends.xy;
    let span = in.ends.zw - in.ends.xy;
    let passed = dot(from_start, span) / max(dot(span, span), 1e-12);
    let share = saturate(passed);
    let off = length(from_start - share * span);
    if off > in.limit {
        discard;
    }
    let beyond = abs(passed - share) * length(span);
    let aside = dot(from_start, in.left.xy);
    let along = in.sides.y + u32(share * f32(in.sides.z - in.sides.y) + 0.5);
    var out: EdgeTexel;
    out.texel = vec4<u32>(
        bitcast<u32>(in.left.z * select(off, -off, aside < 0.0)),
        pack2x16float(log2(in.left.zw)),
        in.sides.x,
        along,
    );
    out.depth = min((off + BEYOND * beyond) / MOST_PX, 1.0);
    return out;
}
