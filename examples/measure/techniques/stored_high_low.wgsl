// Two numbers of single precision that add up. Differences of the high ones are exact near the eye.

struct Stored {
    @location(0) high: vec3<f32>,
    @location(1) fill_and_end: u32,
    @location(2) low: vec3<f32>,
}

fn relative(stored: Stored) -> vec3<f32> {
    return (stored.high - eye.high.xyz) + (stored.low - eye.low.xyz);
}

fn ecef(stored: Stored) -> vec3<f32> {
    return stored.high;
}
