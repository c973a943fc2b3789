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

const NONE: u32 = 0u;
const INVALID: u32 = 0xffffffffu;

// The planes that check an id; the same as in Code::planes_of of the crate.
fn checks_of(id: u32) -> vec2<f32> {
    var mixed = (id ^ (id >> 16u)) * 0x7feb352du;
    mixed = (mixed ^ (mixed >> 15u)) * 0x846ca68bu;
    mixed ^= mixed >> 16u;
    let behind = vec2<u32>(layer.digits) + vec2<u32>(0u, 1u);
    let mask = select(vec2<u32>(0u), vec2<u32>((1u << layer.check_bits) - 1u), behind < vec2<u32>(layer.planes));
    return vec2<f32>(vec2<u32>(mixed, mixed >> layer.check_bits) & mask);
}

// Which fill the sums at a pixel name. Where faces meet within a rounding step of the surface, sums
// can be those of no fill: a digit out of range, or checks that belong to another id.
fn fill_of(sums: vec4<f32>) -> u32 {
    let plane = vec4<u32>(0u, 1u, 2u, 3u);
    let counted = select(vec4<f32>(0.0), round(sums), plane < vec4<u32>(layer.planes));
    let base = f32(layer.base);
    var number = counted.x;
    var checks = counted.yz;
    if layer.digits > 1u {
        number += counted.y * base;
        checks = counted.zw;
    }
    if layer.digits > 2u {
        number += counted.z * base * base;
        checks = vec2<f32>(counted.w, 0.0);
    }
    let is_digit = plane < vec4<u32>(layer.digits);
    let is_check = plane < vec4<u32>(layer.digits + 2u);
    let below_check = select(vec4<f32>(1.0), vec4<f32>(f32(1u << layer.check_bits)), is_check);
    let below = select(below_check, vec4<f32>(base), is_digit);
    let in_range = all(counted >= vec4<f32>(0.0)) && all(counted < below) && number <= f32(layer.fills);
    let id = u32(max(number, 0.0));
    // Nothing has no digits, and no checks.
    let expected = select(checks_of(id), vec2<f32>(0.0), number == 0.0);
    return select(INVALID, id, in_range && all(checks == expected));
}

// Steps to the pixel itself, the neighbours beside it and those across its corners, and one more: two bits
// each.
const STEPS_X: u32 = 139617u;
const STEPS_Y: u32 = 164373u;

// The fill at a pixel, or at its nearest neighbour with a valid sum.
fn fill_at(pixel: vec2<i32>, sample: u32) -> u32 {
    let last = size_px() - 1;
    var fill = INVALID;
    var step = 0u;
    // The pixel itself is asked in the loop: software walks through what follows a loop even if no lane
    // needs it.
    loop {
        let way = (vec2<u32>(STEPS_X, STEPS_Y) >> vec2<u32>(2u * step)) & vec2<u32>(3u);
        let near = clamp(pixel + vec2<i32>(way) - 1, vec2(0), last);
        fill = fill_of(load_planes(near, sample));
        step += 1u;
        continuing {
            break if fill != INVALID || step == 9u;
        }
    }
    return select(fill, NONE, fill == INVALID);
}
