// Counting: each fragment that lies behind the scene's surface adds its face's weight. The depth
// test is z-fail, so what is in front, clipped by the near plane or around the eye never matters.

struct Planes {
    @location(0) first: f32,
    @location(1) second: f32,
    @location(2) third: f32,
    @location(3) fourth: f32,
}

fn winding(weight: vec4<f32>, front_facing: bool) -> vec4<f32> {
    let outside_seen = front_facing == (frame.eye_remainder.w > 0.0);
    return select(weight, -weight, outside_seen);
}

// One target with as many channels as the code has planes.
@fragment
fn fs_count_packed(
    @location(0) @interpolate(flat) weight: vec4<f32>,
    @builtin(front_facing) front_facing: bool,
) -> @location(0) vec4<f32> {
    return winding(weight, front_facing);
}

// One single-channel target a plane: 32-bit floats with more channels cannot be multisampled.
@fragment
fn fs_count_separate(
    @location(0) @interpolate(flat) weight: vec4<f32>,
    @builtin(front_facing) front_facing: bool,
) -> Planes {
    let sum = winding(weight, front_facing);
    return Planes(sum.x, sum.y, sum.z, sum.w);
}

// Painting the code of one fill where the stencil counted.
@fragment
fn fs_cover_packed(@location(0) @interpolate(flat) weight: vec4<f32>) -> @location(0) vec4<f32> {
    return abs(weight);
}

@fragment
fn fs_cover_separate(@location(0) @interpolate(flat) weight: vec4<f32>) -> Planes {
    let code = abs(weight);
    return Planes(code.x, code.y, code.z, code.w);
}

// No fill's code: resolve looks at the neighbours.
@fragment
fn fs_reject_packed() -> @location(0) vec4<f32> {
    return vec4<f32>(-1.0);
}

@fragment
fn fs_reject_separate() -> Planes {
    return Planes(-1.0, -1.0, -1.0, -1.0);
}
