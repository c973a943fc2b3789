// Steps of 1/128 m; w holds three fractions of 10 bits, in 2^-17 m.

struct Stored {
    @location(0) steps: vec4<i32>,
    @location(1) fill_and_end: u32,
}

fn relative(stored: Stored) -> vec3<f32> {
    // Exact: differences stay below 2^31.
    let steps = stored.steps.xyz - eye.steps.xyz;
    let packed = stored.steps.w;
    let fraction = vec3<i32>(packed & 1023, (packed >> 10u) & 1023, (packed >> 20u) & 1023);
    let below = vec3<f32>(fraction - eye.fraction.xyz) / 131072.0;
    return vec3<f32>(steps) / 128.0 + (below + eye.remainder.xyz);
}

fn ecef(stored: Stored) -> vec3<f32> {
    return vec3<f32>(stored.steps.xyz) / 128.0;
}
