// Picking: which fill of a layer covers one pixel. Layers are asked one after the other and add to the
// same answer.

struct Answer {
    pixel: vec2<u32>,
    // Layers that have answered.
    layers: u32,
    unused: u32,
    // What was found in each layer, the lowest first: an id, or NONE.
    fills: array<u32>,
}

@group(1) @binding(0) var<storage, read_write> answer: Answer;

@compute @workgroup_size(1)
fn cs_pick() {
    known = known_of_layer();
    answer.fills[answer.layers] = fill_at(vec2<i32>(answer.pixel), 0u);
    answer.layers += 1u;
}
