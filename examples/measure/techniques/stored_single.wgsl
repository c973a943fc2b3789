// Single precision from an origin.

struct Stored {
    @location(0) position: vec3<f32>,
    @location(1) fill_and_end: u32,
}

fn relative(stored: Stored) -> vec3<f32> {
    return eye.from_eye.xyz + stored.position;
}

fn ecef(stored: Stored) -> vec3<f32> {
    return eye.origin.xyz + stored.position;
}
