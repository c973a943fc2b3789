// The vertex-pulling extruder. Inputs lie on the ellipsoid; what is drawn is raised over the terrain
// or pushed below it. Interior triangles arrive as cap-only inputs (a, b, c) and become a top and a
// bottom cap; boundary edges arrive as degenerate wall inputs (a, b, b) and become two triangles.
// With vertices in arc order the wall input (i, i + 1, i + 1) is implied by i and takes no memory.

struct Frame {
    // From metres relative to the eye, along ECEF axes: x and y of clip space, distance along the view
    // axis, w. Where lines of sight are parallel a point near the surface stands for the eye.
    clip_from_relative: mat4x4<f32>,
    // The eye in steps of 1/128 m.
    eye: vec4<i32>,
    // What the steps leave over, in 2^-17 m.
    eye_fraction: vec4<i32>,
    // xyz: metres from the true eye to the encoded one. w: +1, or -1 where the projection mirrors.
    eye_remainder: vec4<f32>,
    // Surface position times this is along the geodetic normal: (1, 1, (a/b)^2, 0).
    normal_scale: vec4<f32>,
    // x: top, m. y: bottom, m. z: how far the bottom is pushed down per metre from the eye.
    // w: the most that z and slack may add, m.
    heights: vec4<f32>,
    // Added above and below for the host's depth steps: x + y * distance + z * distance^2, m.
    // w: distance of the near plane, m.
    slack: vec4<f32>,
    // Depth before the division by w: x * distance + y.
    depth: vec4<f32>,
    // xyz: a direction. Where it times the surface position, 256 m by 256 m, is below w, all is hidden by the
    // horizon: tops are as low as bottoms there.
    beyond: vec4<i32>,
}

// How a vertex is drawn.
const BOTTOM: u32 = 0u;
const TOP: u32 = 1u;
const AS_IS: u32 = 2u;

// A boundary arc. Its slots hold its vertices; one more, the break, separates it from the next.
struct Arc {
    // Pieces on either side, plus one; 0 for none.
    left: u32,
    right: u32,
}

// Boundary slots that share a first arc in `arc_at`.
const BLOCK: u32 = 64u;
// Set in a slot's byte where it is the break behind its arc.
const BREAK: u32 = 0x80u;

@group(0) @binding(0) var<uniform> frame: Frame;
// Fixed point: xyz in 1/128 m, w three 10-bit fractions of 2^-17 m (x lowest).
@group(1) @binding(0) var<storage, read> vertices: array<vec4<i32>>;
// The arc of every slot: for each block its first arc, then a byte a slot, which counts from there. Behind the
// boundary lie the caps' interior vertices; those of a piece count as an arc with that piece on its left.
@group(1) @binding(1) var<storage, read> arc_at: array<u32>;
@group(1) @binding(2) var<storage, read> arcs: array<Arc>;
// Winding code of each piece, plus one, in this view and layer: four digits of 8 bits, or four weights of 16.
@group(1) @binding(3) var<storage, read> codes: array<u32>;

// Whether weights are summed.
override WEIGHTS: bool = false;
// Bits of a check that is summed in one plane with its id, above it; 0 for planes of their own.
override JOINED: u32 = 0u;

fn relative_m(vertex: vec4<i32>) -> vec3<f32> {
    // Exact: the eye is clamped so that the differences stay below 2^31.
    let steps = vertex.xyz - frame.eye.xyz;
    let fractions = vec3<i32>(vertex.w & 1023, (vertex.w >> 10u) & 1023, (vertex.w >> 20u) & 1023);
    let below = vec3<f32>(fractions - frame.eye_fraction.xyz) / 131072.0;
    return vec3<f32>(steps) / 128.0 + (below + frame.eye_remainder.xyz);
}

fn extruded_m(vertex: vec4<i32>, drawn: u32) -> vec3<f32> {
    let surface_m = relative_m(vertex);
    if drawn == AS_IS {
        return surface_m;
    }
    let normal = normalize(vec3<f32>(vertex.xyz) * frame.normal_scale.xyz);
    let distance_m = length(surface_m);
    let slack_m = min(
        frame.slack.x + distance_m * (frame.slack.y + distance_m * frame.slack.z),
        frame.heights.w,
    );
    let pushed_m = min(frame.heights.z * distance_m, frame.heights.w);
    let bottom_m = min(frame.heights.y, -pushed_m) - slack_m;
    let top_m = frame.heights.x + slack_m;
    let along = frame.beyond.xyz * (vertex.xyz >> vec3<u32>(15u));
    let is_flat = along.x + along.y + along.z < frame.beyond.w;
    return surface_m + normal * select(bottom_m, top_m, drawn == TOP && !is_flat);
}

fn clip(vertex: vec4<i32>, drawn: u32) -> vec4<f32> {
    var position = frame.clip_from_relative * vec4<f32>(extruded_m(vertex, drawn), 1.0);
    // Far away z and w differ by little: from w alone, which is the distance of perspectives, depth is
    // rounded once instead of three times.
    let distance = select(position.w, position.z, PARALLEL);
    position.z = frame.depth.x * distance + frame.depth.y;
    return position;
}

fn code_digits(piece_plus_one: u32) -> vec4<f32> {
    if WEIGHTS {
        let low = codes[2u * piece_plus_one];
        let high = codes[2u * piece_plus_one + 1u];
        return vec4<f32>(vec4<u32>(low & 0xffffu, low >> 16u, high & 0xffffu, high >> 16u));
    }
    return digits_of(codes[piece_plus_one]);
}

fn digits_of(code: u32) -> vec4<f32> {
    if JOINED > 0u {
        let check = (code >> 8u) & ((1u << JOINED) - 1u);
        return vec4<f32>(f32(((code & 255u) << JOINED) | check), 0.0, 0.0, 0.0);
    }
    return vec4<f32>(vec4<u32>(code & 255u, (code >> 8u) & 255u, (code >> 16u) & 255u, code >> 24u));
}

fn arc_weight(arc: u32) -> vec4<f32> {
    return code_digits(arcs[arc].left) - code_digits(arcs[arc].right);
}

struct SlotArc {
    arc: u32,
    is_break: bool,
}

fn arc_of(slot: u32) -> SlotArc {
    let block = (slot / BLOCK) * (BLOCK / 4u + 1u);
    let own = arc_at[block + 1u + (slot % BLOCK) / 4u] >> (8u * (slot % 4u));
    return SlotArc(arc_at[block] + (own & (BREAK - 1u)), (own & BREAK) != 0u);
}

// A corner of a cap, whose piece has so many digits. The bottom cap is the top's triangle seen from below.
fn cap_corner(vertex: u32, digits: vec4<f32>, bottom: bool) -> Face {
    let weight = digits * select(1.0, -1.0, bottom);
    return face(vertices[vertex], select(TOP, BOTTOM, bottom), weight);
}

// Cap-only inputs of one piece. index = 2 * vertex + side; instance = 2 * piece + (1 for the bottom cap).
@vertex
fn vs_cap(@builtin(vertex_index) index: u32, @builtin(instance_index) instance: u32) -> Face {
    return cap_corner(index >> 1u, code_digits((instance >> 1u) + 1u), (instance & 1u) == 1u);
}

// Cap-only inputs of many pieces: each lies on that side, 1 for the right, of the arcs of its vertices.
@vertex
fn vs_caps(@builtin(vertex_index) index: u32, @builtin(instance_index) bottom: u32) -> Face {
    let vertex = index >> 1u;
    let arc = arcs[arc_of(vertex).arc];
    let piece = select(arc.left, arc.right, (index & 1u) == 1u);
    return cap_corner(vertex, code_digits(piece), bottom == 1u);
}

struct WallCorner {
    arc: u32,
    slot: u32,
    drawn: u32,
}

// Corner k of the strip: top and bottom of slot k / 2. Between two arcs the strip collapses into
// triangles without area: down the end of one arc, over, and up the start of the next.
fn wall_corner(k: u32) -> WallCorner {
    let slot = k >> 1u;
    let top = (k & 1u) == 0u;
    let own = arc_of(slot);
    if !own.is_break {
        return WallCorner(own.arc, slot, select(BOTTOM, TOP, top));
    }
    if top {
        return WallCorner(own.arc, slot - 1u, BOTTOM);
    }
    return WallCorner(own.arc, slot + 1u, TOP);
}

// Degenerate wall inputs, as a triangle strip over boundary slots.
@vertex
fn vs_wall(@builtin(vertex_index) k: u32) -> Face {
    let corner = wall_corner(k);
    return face(vertices[corner.slot], corner.drawn, arc_weight(corner.arc));
}

// Refined walls: an index is 4 * vertex + how it is drawn; `vertices` is the patch's own buffer.
@vertex
fn vs_patch(@builtin(vertex_index) index: u32, @builtin(instance_index) arc: u32) -> Face {
    return face(vertices[index >> 2u], index & 3u, arc_weight(arc));
}

// The same walls where the stencil has counted and a single piece is to be painted.
@vertex
fn vs_wall_cover(@builtin(vertex_index) k: u32, @builtin(instance_index) piece: u32) -> Face {
    let corner = wall_corner(k);
    return face(vertices[corner.slot], corner.drawn, code_digits(piece + 1u));
}

@vertex
fn vs_patch_cover(@builtin(vertex_index) index: u32, @builtin(instance_index) piece: u32) -> Face {
    return face(vertices[index >> 2u], index & 3u, code_digits(piece + 1u));
}
