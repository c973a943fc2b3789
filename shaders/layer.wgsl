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
    // Base of the checks.
    check_base: u32,
    // Premultiplied colours by id - 1.
    colors: array<vec4<f32>>,
}

@group(0) @binding(0) var<storage, read> layer: Layer;

const NONE: u32 = 0u;
const INVALID: u32 = 0xffffffffu;

// The planes an id should sum to; the same as Code::planes_of in the crate.
fn planes_of(id: u32) -> vec4<f32> {
    var digits = vec4<u32>(0u);
    digits[0] = id % layer.base;
    var mixed = (id ^ (id >> 16u)) * 0x7feb352du;
    mixed = (mixed ^ (mixed >> 15u)) * 0x846ca68bu;
    mixed ^= mixed >> 16u;
    let checks = vec2<u32>(mixed, mixed / layer.check_base) % layer.check_base;
    if layer.digits > 1u {
        digits[1] = (id / layer.base) % layer.base;
    }
    if layer.digits > 2u {
        digits[2] = id / (layer.base * layer.base);
    }
    if layer.planes > layer.digits {
        digits[layer.digits] = checks.x;
    }
    if layer.planes > layer.digits + 1u {
        digits[layer.digits + 1u] = checks.y;
    }
    return vec4<f32>(digits);
}

// Which fill the sums at a pixel name. Where faces meet within a rounding step of the surface, sums
// can be those of no fill: a digit out of range, or checks that belong to another id.
fn fill_of(sums: vec4<f32>) -> u32 {
    let mask = vec4<f32>(vec4<u32>(0u, 1u, 2u, 3u) < vec4<u32>(layer.planes));
    let counted = round(sums) * mask;
    if all(counted == vec4<f32>(0.0)) {
        return NONE;
    }
    let base = f32(layer.base);
    var number = counted.x;
    if layer.digits > 1u {
        number += counted.y * base;
    }
    if layer.digits > 2u {
        number += counted.z * base * base;
    }
    if number < 1.0 || number > f32(layer.fills) {
        return INVALID;
    }
    let id = u32(number);
    return select(INVALID, id, all(planes_of(id) == counted));
}

// The fill at a pixel, or at its nearest neighbour with a valid sum.
fn fill_at(pixel: vec2<i32>, sample: u32) -> u32 {
    let here = fill_of(load_planes(pixel, sample));
    if here != INVALID {
        return here;
    }
    let last = size_px() - 1;
    for (var step = 0; step < 8; step += 1) {
        // The four edge neighbours first, then the corners.
        let ring = array<vec2<i32>, 8>(
            vec2(-1, 0), vec2(1, 0), vec2(0, -1), vec2(0, 1),
            vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(1, 1),
        );
        let near = fill_of(load_planes(clamp(pixel + ring[step], vec2(0), last), sample));
        if near != INVALID {
            return near;
        }
    }
    return NONE;
}
