// A layer of mutually disjoint fills: the counted sums of a pixel name the fill that covers it.

struct Layer {
    // Fills in this layer; ids are 1 ... fills.
    fills: u32,
    // Base of the digits of an id.
    base: u32,
    // Number of digits: the first planes.
    digits: u32,
    // Number of planes: those after the digits check the id.
    planes: u32,
    // Bits of a check.
    check_bits: u32,
}

@group(0) @binding(0) var<uniform> layer: Layer;

// The same, where pipelines are made for a shape of codes: the rest of decoding is compiled away. Else 0.
override DIGITS: u32 = 0u;
override PLANES: u32 = 0u;
override CHECK_BITS: u32 = 0u;
// Bits of a check that is summed in one plane with its id, above it; 0 for planes of their own.
override JOINED: u32 = 0u;

fn digits() -> u32 {
    if DIGITS > 0u {
        return DIGITS;
    }
    return layer.digits;
}

fn checks() -> u32 {
    if PLANES > 0u {
        return PLANES - DIGITS;
    }
    return layer.planes - layer.digits;
}

fn check_bits() -> u32 {
    if CHECK_BITS > 0u {
        return CHECK_BITS;
    }
    return layer.check_bits;
}

const NONE: u32 = 0u;
const INVALID: u32 = 0xffffffffu;

// What differs from layer to layer of one shape: fills, base, and the last column and row of the picture.
var<private> known: vec4<u32>;

fn known_of_layer() -> vec4<u32> {
    return vec4<u32>(layer.fills, layer.base, vec2<u32>(size_px() - 1));
}

// Where the checks of an id are taken from; as in Code::planes_of of the crate. Zero for nothing.
fn mixed_of(id: u32) -> u32 {
    var mixed = (id ^ (id >> 16u)) * 0x7feb352du;
    mixed = (mixed ^ (mixed >> 15u)) * 0x846ca68bu;
    return mixed ^ (mixed >> 16u);
}

// Whether the planes behind the digits are those that check an id. They are all zero for nothing.
fn are_checked(id: u32, found: vec2<f32>) -> bool {
    let mixed = mixed_of(id);
    let mask = (1u << check_bits()) - 1u;
    var checked = true;
    if checks() > 0u {
        checked = found.x == f32(mixed & mask);
    }
    if checks() > 1u {
        checked = checked && found.y == f32((mixed >> check_bits()) & mask);
    }
    return checked;
}

// Which fill the sums at a pixel name; they are integers. Where faces meet within a rounding step of the
// surface, sums can be those of no fill: a digit out of range, or checks that belong to another id.
fn fill_of(sums: vec4<f32>) -> u32 {
    if JOINED > 0u {
        // Below zero is beyond all as well.
        let sum = bitcast<u32>(i32(sums.x));
        let id = sum >> JOINED;
        let checked = ((sum ^ mixed_of(id)) & ((1u << JOINED) - 1u)) == 0u;
        return select(INVALID, id, id <= known.x && checked);
    }
    let base = f32(known.y);
    var number = sums.x;
    var found = sums.yz;
    var in_range = true;
    if digits() > 1u {
        in_range = all(sums.xy >= vec2<f32>(0.0)) && all(sums.xy < vec2<f32>(base));
        number += sums.y * base;
        found = sums.zw;
    }
    if digits() > 2u {
        in_range = in_range && sums.z >= 0.0 && sums.z < base;
        number += sums.z * base * base;
        found = vec2<f32>(sums.w, 0.0);
    }
    // Below zero is beyond all as well.
    let id = bitcast<u32>(i32(number));
    in_range = in_range && id <= known.x;
    return select(INVALID, id, in_range && are_checked(id, found));
}

// Steps to the pixel itself, then around it from its left to its left, and one more: two bits each.
const STEPS_X: u32 = 27201u;
const STEPS_Y: u32 = 435205u;

// The fill at a pixel. Where its sums are not valid, a boundary passes through it: the fill that two of its
// neighbours show, next to each other but for invalid ones. On either side of a boundary there are three. What
// one shows alone may be thinner than a pixel, and not be here; it is taken if there is nothing else.
fn fill_at(pixel: vec2<i32>, sample: u32) -> u32 {
    let last = vec2<i32>(known.zw);
    var fill = INVALID;
    var step = 0u;
    // The pixel itself is asked in the loop: software walks through what follows a loop even if no lane
    // needs it.
    loop {
        let way = (vec2<u32>(STEPS_X, STEPS_Y) >> vec2<u32>(2u * step)) & vec2<u32>(3u);
        let near = clamp(pixel + vec2<i32>(way) - 1, vec2(0), last);
        let found = fill_of(load_planes(near, sample));
        let settled = found != INVALID && (step == 0u || found == fill);
        fill = select(found, fill, found == INVALID);
        step += 1u;
        if settled || step == 10u {
            break;
        }
    }
    return select(fill, NONE, fill == INVALID);
}
