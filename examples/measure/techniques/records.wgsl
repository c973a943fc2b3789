// One stream of triples: (a, b, c) becomes a top and a bottom cap, (a, b, b) two triangles of wall.
// Six corners of every record are fetched, as many as a geometry shader would have put out.

// xyz: metres from the origin.
@group(0) @binding(1) var<storage, read> vertices: array<vec4<f32>>;
// xyz: a triple. w: its fill.
@group(0) @binding(2) var<storage, read> records: array<vec4<u32>>;

// Two bits a corner: which of the triple, from the first corner up.
// Caps: a b c above, a c b below. Walls: a b b, a b a.
const OF_CAP: u32 = 0x624u;
const OF_WALL: u32 = 0x114u;
// One bit a corner: above.
const CAP_ABOVE: u32 = 0x07u;
const WALL_ABOVE: u32 = 0x34u;

@vertex
fn corner(@builtin(vertex_index) k: u32) -> Face {
    let record = records[k / 6u];
    let turn = k % 6u;
    let is_wall = record.y == record.z;
    let which = (select(OF_CAP, OF_WALL, is_wall) >> (2u * turn)) & 3u;
    let above = (select(CAP_ABOVE, WALL_ABOVE, is_wall) >> turn) & 1u;
    let position = vertices[record[which]].xyz;
    let on_surface = eye.from_eye.xyz + position;
    let height = select(bottom_m(on_surface), eye.heights.x, above == 1u);
    return face(on_surface + normal_at(eye.origin.xyz + position) * height, record.w);
}
