// Resolving unordered fills: the sum of their weights at each pixel becomes a colour. Each absorbs like a
// filter; colours are weighted by optical depth.

struct Mixture {
    // x: optical depth of one unit of the sums.
    unit: vec4<f32>,
}

@group(0) @binding(0) var<uniform> mixture: Mixture;

struct MixedScreen {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) unit: f32,
}

@vertex
fn vs_mixture(
    @builtin(vertex_index) vertex: u32,
    @builtin(instance_index) instance: u32,
) -> MixedScreen {
    return MixedScreen(window_corner(vertex, instance), mixture.unit.x);
}

fn mixed(in: MixedScreen, sample: u32) -> vec4<f32> {
    let sums = load_planes(vec2<i32>(in.position.xy), sample);
    // Below zero where faces meet within a rounding step of the surface.
    if sums.w <= 0.0 {
        discard;
    }
    let alpha = 1.0 - exp(-sums.w * in.unit);
    return vec4<f32>(clamp(sums.xyz / sums.w, vec3<f32>(0.0), vec3<f32>(1.0)) * alpha, alpha);
}

@fragment
fn fs_mixture(in: MixedScreen) -> @location(0) vec4<f32> {
    return mixed(in, 0u);
}

@fragment
fn fs_mixture_sample(in: MixedScreen, @builtin(sample_index) sample: u32) -> @location(0) vec4<f32> {
    return mixed(in, sample);
}
