// The edge pass: for each pixel near a boundary the nearest one, and how far it is.
//
// Around the wall of every boundary chord a prism is drawn that holds all surface within the chord's
// reach. Its back faces alone are drawn, untested against the host's depth, so the eye may be inside;
// each fragment measures from the surface point it sees to the chord, and the nearest chord wins by
// depth, which holds the distance in pixels; of distances on the ground, in pixels of their mean size.
//
// Ends of chords and surface are both taken from the eye's foot point: the former exactly, from fixed
// point, the latter as place_of gives it. Their difference is then off by a few roundings of the distance
// to the eye or, seen from far away, of the distance between foot points, whichever is greater. Comparing
// surface points instead would add the rounding of lowering them: no better near by, worse from the Moon.

struct EdgeSight {
    // The eye's foot point in steps of 1/128 m, what the steps leave over in 2^-17 m, and metres from the
    // true one to the encoded one.
    foot: vec4<i32>,
    foot_fraction: vec4<i32>,
    foot_remainder: vec4<f32>,
    // The view axis; w: the most metres that a pixel spans across it at unit distance, or at any where
    // lines of sight are parallel.
    axis: vec4<f32>,
    // Lowest and highest surface, m.
    surface: vec4<f32>,
    // Base and number of the digits of an id.
    code: vec4<u32>,
}

@group(3) @binding(0) var<uniform> edge_sight: EdgeSight;
// By id of the layer, 0 for none: how far its edges are asked for, metres and pixels, which add up.
@group(3) @binding(1) var<storage, read> reaches: array<vec2<f32>>;
// By slot: the arc of the chord that starts there, or NO_CHORD; steps of 1/64 m from the arc's start.
@group(3) @binding(2) var<storage, read> slots: array<vec2<u32>>;

const NO_CHORD: u32 = 0xffffffffu;

// Corners of a cube as a strip of fourteen: which are ahead, to the left, on top.
const AHEAD: u32 = 0x287au;
const LEFT: u32 = 0x02afu;
const ABOVE: u32 = 0x31e3u;
// Shorter chords have no direction; their neighbours' round ends cover them.
const SHORTEST_M: f32 = 2e-5;
// By how much a chord that a pixel lies beyond is put behind one that ends at the same vertex.
const BEYOND: f32 = 1e-3;
// Depth 1, pixels: farther than any edge reaches.
const MOST_PX: f32 = 131072.0;
// The most by which pixels towards the horizon are taken to reach farther.
const FARTHEST: f32 = 4.0;

struct Chord {
    a: vec4<i32>,
    b: vec4<i32>,
    arc: u32,
    // Places of both ends along the arc.
    along: vec2<u32>,
}

struct EdgeVertex {
    @builtin(position) position: vec4<f32>,
    // Ends of the chord, from the eye's foot point; w: its length, and the metres of its reach.
    @location(0) @interpolate(flat) start: vec4<f32>,
    @location(1) @interpolate(flat) end: vec4<f32>,
    // Unit vectors along the chord and to its left; w: the pixels of its reach.
    @location(2) @interpolate(flat) ahead: vec4<f32>,
    @location(3) @interpolate(flat) left: vec4<f32>,
    // Ids, and places of both ends along the arc.
    @location(4) @interpolate(flat) sides: vec4<u32>,
}

struct EdgeTexel {
    // Signed distance, logarithms of metres a pixel, ids, place along the arc: see stroke.wgsl.
    @location(0) texel: vec4<u32>,
    @builtin(frag_depth) depth: f32,
}

// From the eye's foot point; see relative_m.
fn from_foot_m(vertex: vec4<i32>) -> vec3<f32> {
    let below = vec3<f32>(fractions_of(vertex) - edge_sight.foot_fraction.xyz) / 131072.0;
    let steps = vec3<f32>(vertex.xyz - edge_sight.foot.xyz) / 128.0;
    return steps + (below + edge_sight.foot_remainder.xyz);
}

fn fractions_of(vertex: vec4<i32>) -> vec3<i32> {
    return vec3<i32>(vertex.w & 1023, (vertex.w >> 10u) & 1023, (vertex.w >> 20u) & 1023);
}

// Exact but for rounding to single precision, however far both are from the eye.
fn between_m(a: vec4<i32>, b: vec4<i32>) -> vec3<f32> {
    let below = vec3<f32>(fractions_of(b) - fractions_of(a)) / 131072.0;
    return vec3<f32>(b.xyz - a.xyz) / 128.0 + below;
}

fn id_of(piece_plus_one: u32) -> u32 {
    let digits = vec4<u32>(code_digits(piece_plus_one));
    let base = edge_sight.code.x;
    var id = digits.x;
    if edge_sight.code.y > 1u {
        id += digits.y * base;
    }
    if edge_sight.code.y > 2u {
        id += digits.z * base * base;
    }
    return id;
}

// How far, metres, `px` pixels reach on level ground at a point, at most. Towards the horizon they reach
// farther than they would on a plane seen all over like here: by 1 / (1 - share of the way to the horizon),
// as far as that is drawn; where the ground falls away, no farther than the curved ground allows.
fn spread_m(from_eye: vec3<f32>, up: vec3<f32>, px: f32) -> f32 {
    if PARALLEL {
        // The ground falls away from under its tangent plane by the square of the way.
        let sine = max(-dot(sight.ray.xyz, up), sight.bounds.w);
        let across = px * edge_sight.axis.w;
        let falling = 1.0 - 2.0 * across / (sight.ellipsoid.w * sine * sine);
        let level = 2.0 * across / (sine * (1.0 + sqrt(max(falling, 0.0))));
        return min(level, sqrt(2.0 * across * sight.ellipsoid.w));
    }
    let distance = length(from_eye);
    let sine = max(-dot(from_eye, up) / distance, sight.bounds.w);
    let across = px * edge_sight.axis.w * distance;
    let way = across / (distance * sine);
    let level = across / (sine * max(1.0 - way, 1.0 / FARTHEST));
    return min(level, sqrt(2.0 * across * sight.ellipsoid.w));
}

// The chord's reach at one of its ends. Along the chord what is needed is convex, so that between the
// ends it is less than in proportion.
fn reach_m(vertex: vec4<i32>, up: vec3<f32>, reach: vec2<f32>) -> f32 {
    let surface = relative_m(vertex);
    let px = reach.y + 1.0;
    let low = spread_m(surface + up * edge_sight.surface.x, up, px);
    let high = spread_m(surface + up * edge_sight.surface.y, up, px);
    // The margin is for heights and curvature, which spread feet, and for rounding.
    return 1.1 * (reach.x + max(low, high)) + 2.0 * edge_sight.axis.w * scale_at(length(surface));
}

// Whether the ground hides all surface within `reach` of a vertex: the eye is so far below its horizon
// that even the highest surface, raised over the lowest, does not show.
fn hidden(vertex: vec4<i32>, up: vec3<f32>, reach: f32) -> bool {
    let surface = relative_m(vertex);
    let distance = length(surface);
    let line = sight_line(surface);
    let sine = -dot(line, up) / length(line);
    let lowest = min(edge_sight.surface.x, frame.heights.y);
    let relief = edge_sight.surface.y - lowest + frame.heights.z * distance + 100.0;
    let radius = sight.ellipsoid.w;
    return sine < -1.2 * (reach / radius + sqrt(2.0 * relief / radius)) - 0.01;
}

fn up_of(vertex: vec4<i32>) -> vec3<f32> {
    return normalize(vec3<f32>(vertex.xyz) * frame.normal_scale.xyz);
}

// Behind the eye, so that nothing is drawn.
fn nowhere() -> EdgeVertex {
    var out: EdgeVertex;
    out.position = vec4<f32>(0.0, 0.0, 0.0, -1.0);
    return out;
}

fn prism(chord: Chord, corner: u32) -> EdgeVertex {
    let ids = vec2<u32>(id_of(arcs[chord.arc].left), id_of(arcs[chord.arc].right));
    let reach = max(reaches[ids.x], reaches[ids.y]);
    let way = between_m(chord.a, chord.b);
    let length_m = length(way);
    if ids.x == ids.y || max(reach.x, reach.y) <= 0.0 || length_m < SHORTEST_M {
        return nowhere();
    }
    let ahead = way / length_m;
    let up_a = up_of(chord.a);
    let up_b = up_of(chord.b);
    let left = normalize(cross(up_a + up_b, ahead));
    let reach_a = reach_m(chord.a, up_a, reach);
    let reach_b = reach_m(chord.b, up_b, reach);
    let widest = max(reach_a, reach_b);
    if hidden(chord.a, up_a, widest) && hidden(chord.b, up_b, widest) {
        return nowhere();
    }
    let at_end = ((AHEAD >> corner) & 1u) == 1u;
    let to_left = ((LEFT >> corner) & 1u) == 1u;
    let on_top = ((ABOVE >> corner) & 1u) == 1u;
    var vertex = chord.a;
    var up = up_a;
    var spread = reach_a;
    if at_end {
        vertex = chord.b;
        up = up_b;
        spread = reach_b;
    }
    var position = extruded_m(vertex, select(BOTTOM, TOP, on_top));
    position += ahead * select(-spread, spread, at_end) + left * select(-spread, spread, to_left);
    // Within its reach the ground falls away, and what is added for a host's depth and mesh grows.
    let distance = length(position);
    let slack = spread * (frame.slack.y + frame.slack.z * (2.0 * distance + spread));
    let fall = slack + spread * (frame.heights.z + 1.2 * spread / sight.ellipsoid.w);
    position += up * select(-fall, slack, on_top);

    var out: EdgeVertex;
    out.position = frame.clip_from_relative * vec4<f32>(position, 1.0);
    // Clipped at the near distance, before which nothing is seen, and nowhere else.
    out.position.z = select(frame.slack.w, 0.5, PARALLEL);
    out.start = vec4<f32>(from_foot_m(chord.a), length_m);
    out.end = vec4<f32>(from_foot_m(chord.b), reach.x);
    out.ahead = vec4<f32>(ahead, reach.y);
    out.left = vec4<f32>(left, 0.0);
    out.sides = vec4<u32>(ids.x | (ids.y << 16u), chord.along, 0u);
    return out;
}

// Stored chords: that of a slot runs to the next slot.
@vertex
fn vs_chord(
    @builtin(vertex_index) corner: u32,
    @builtin(instance_index) slot: u32,
) -> EdgeVertex {
    let start = slots[slot];
    if start.x == NO_CHORD {
        return nowhere();
    }
    let along = vec2<u32>(start.y, slots[slot + 1u].y);
    return prism(Chord(vertices[slot], vertices[slot + 1u], start.x, along), corner);
}

// The pieces that stand for refined chords.
@vertex
fn vs_segment(
    @builtin(vertex_index) corner: u32,
    @location(0) a: vec4<i32>,
    @location(1) b: vec4<i32>,
    @location(2) rest: vec4<u32>,
) -> EdgeVertex {
    return prism(Chord(a, b, rest.x, rest.yz), corner);
}

// The point of a chord that is nearest to a pixel.
struct Nearest {
    // How far it is, metres, and pixels by which chords are ranked.
    off: f32,
    off_px: f32,
    // Metres a pixel, across the chord and along it.
    across: f32,
    along: f32,
    // Metres from the chord's start to where the chord's line is nearest, and by how many such pixels that
    // is beyond an end.
    passed: f32,
    beyond_px: f32,
}

// A change of a place on level ground, from pixel to pixel.
fn change_of(gradient: vec3<f32>, span: Span) -> vec2<f32> {
    return vec2<f32>(dot(gradient, span.right), dot(gradient, span.down));
}

// A way on level ground as pixels to the right and down, as large as they are here.
fn pixels_of(way: vec3<f32>, span: Span) -> vec2<f32> {
    let normal = cross(span.right, span.down);
    let turned = vec2<f32>(dot(cross(way, span.down), normal), dot(cross(span.right, way), normal));
    return turned / dot(normal, normal);
}

// What is nearest in metres must win. Seen obliquely, a vertex ahead may be fewer pixels away than the
// boundary beside: chords are ranked by pixels that are as large in all directions.
fn nearest_on_ground(in: EdgeVertex, foot: vec3<f32>, span: Span) -> Nearest {
    let from_start = foot - in.start.xyz;
    let side = dot(from_start, in.left.xyz);
    let passed = dot(from_start, in.ahead.xyz);
    let beyond = max(max(-passed, passed - in.start.w), 0.0);
    var off = abs(side);
    var away = in.left.xyz;
    if beyond > 0.0 {
        // The same bits for all chords that end there.
        let to_end = select(foot - in.end.xyz, from_start, passed < 0.0);
        off = length(to_end);
        away = to_end / off;
    }
    let across = length(change_of(away, span));
    let area = length(cross(span.right, span.down));
    let mean = sqrt(area);
    return Nearest(off, off / mean, across, area / across, passed, beyond / mean);
}

// Level ground is projected to the screen: the inverse of the distance along the view axis is linear there,
// and so is a distance from a line divided by that distance.
//
// Beyond an end the end is nearest on the screen, but seldom on the ground, where the way to it may be many
// times as long as that across the boundary. Metres are therefore those across the chord there too: where
// the next chord goes on in nearly the same direction, they go on as well.
fn nearest_on_screen(in: EdgeVertex, foot: vec3<f32>, span: Span, distance: f32) -> Nearest {
    let from_start = foot - in.start.xyz;
    let side = dot(from_start, in.left.xyz);
    let receding = select(change_of(edge_sight.axis.xyz, span) / distance, vec2<f32>(0.0), PARALLEL);
    let slope = change_of(in.left.xyz, span) - side * receding;
    var across = length(slope);
    // To the nearest point of the chord's line, in pixels and on the ground, where lengths are greater by
    // 1 / nearer. Beyond the horizon there is no such point.
    let aim_px = -side / (across * across) * slope;
    let nearer = max(1.0 - dot(receding, aim_px), 1.0 / 64.0);
    let aim = span.right * aim_px.x + span.down * aim_px.y;
    let passed = dot(from_start + aim / nearer, in.ahead.xyz);
    let beyond = max(max(-passed, passed - in.start.w), 0.0);
    let line_px = vec2<f32>(-slope.y, slope.x) / across;
    let line = (span.right * line_px.x + span.down * line_px.y) * nearer + aim * dot(receding, line_px);
    let along = abs(dot(line, in.ahead.xyz)) / (nearer * nearer);
    var off = abs(side);
    var off_px = off / across;
    var beyond_px = 0.0;
    if beyond > 0.0 {
        // The same bits for all chords that end there.
        let to_end = select(foot - in.end.xyz, from_start, passed < 0.0);
        let end_distance = max(distance - dot(edge_sight.axis.xyz, to_end), distance / 64.0);
        let nearer_end = select(distance / end_distance, 1.0, PARALLEL);
        off_px = length(pixels_of(to_end, span)) * nearer_end;
        beyond_px = sqrt(max(off_px * off_px - dot(aim_px, aim_px), 0.0));
        // Where the end would be seen if the ground were level between: the scale of `side`.
        let level_px = length(vec2<f32>(length(aim_px), min(beyond / along, off_px)));
        across *= clamp(level_px / max(off_px, 1e-6), 0.25, 4.0);
        off = off_px * across;
    }
    return Nearest(off, off_px, across, along, passed, beyond_px);
}

@fragment
fn fs_edge(in: EdgeVertex) -> EdgeTexel {
    let pixel = vec2<u32>(in.position.xy);
    let depth = depth_at(pixel, 0u);
    if is_sky(depth) {
        discard;
    }
    let at_px = vec2<f32>(pixel) + sample_px(0u);
    let distance = distance_of(depth);
    let place = place_of(from_eye_at(at_px, distance), 0.0);
    let span = span_of(ray_at(at_px), scale_at(distance), place);
    // At the centre of the pixel, on ground as level as the sample's.
    let aside_px = vec2<f32>(0.5) - sample_px(0u);
    let foot = place.from_foot + aside_px.x * span.right + aside_px.y * span.down;

    var near: Nearest;
    // Metres are measured on the ground, pixels on the screen.
    if in.end.w > 0.0 {
        near = nearest_on_ground(in, foot, span);
    } else {
        near = nearest_on_screen(in, foot, span, distance);
    }
    let limit = in.end.w + (in.ahead.w + 1.0) * near.across;
    if strays(place, 0.0) || !(near.off <= limit) {
        discard;
    }
    let share = clamp(near.passed / in.start.w, 0.0, 1.0);
    let along = in.sides.y + u32(share * f32(in.sides.z - in.sides.y) + 0.5);
    let side = dot(foot - in.start.xyz, in.left.xyz);
    var out: EdgeTexel;
    out.texel = vec4<u32>(
        bitcast<u32>(select(near.off, -near.off, side < 0.0)),
        pack2x16float(log2(vec2<f32>(near.across, near.along))),
        in.sides.x,
        along,
    );
    out.depth = min((near.off_px + BEYOND * near.beyond_px) / MOST_PX, 1.0);
    return out;
}
