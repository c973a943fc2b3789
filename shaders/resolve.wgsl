// Resolving: the counted sums name the fill at each pixel; its colour goes to the host's target.

// Premultiplied colours by id - 1: two to an element, 16 bits a channel, where they are few and ordinary.
@group(0) @binding(1) var<uniform> packed_colors: array<vec4<u32>, 512>;
@group(0) @binding(2) var<storage, read> colors: array<vec4<f32>>;

// Whether the packed colours are read: software and some GPUs read uniforms several times as fast.
override FEW: bool = false;

struct Screen {
    @builtin(position) position: vec4<f32>,
    // It travels with the vertices: software reads a uniform anew for every lane of a vector.
    @location(0) @interpolate(flat) known: vec4<u32>,
}

@vertex
fn vs_resolve(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> Screen {
    return Screen(window_corner(vertex, instance), known_of_layer());
}

fn color_of(fill: u32) -> vec4<f32> {
    let index = fill - 1u;
    if FEW {
        let at = 2u * (index & 1u);
        let pair = vec2<u32>(packed_colors[index / 2u][at], packed_colors[index / 2u][at + 1u]);
        return vec4<f32>(unpack2x16unorm(pair.x), unpack2x16unorm(pair.y));
    }
    return colors[index];
}

fn color_at(in: Screen, sample: u32) -> vec4<f32> {
    known = in.known;
    let fill = fill_at(vec2<i32>(in.position.xy), sample);
    if fill == NONE {
        discard;
    }
    return color_of(fill);
}

@fragment
fn fs_resolve(in: Screen) -> @location(0) vec4<f32> {
    return color_at(in, 0u);
}

@fragment
fn fs_resolve_sample(in: Screen, @builtin(sample_index) sample: u32) -> @location(0) vec4<f32> {
    return color_at(in, sample);
}
