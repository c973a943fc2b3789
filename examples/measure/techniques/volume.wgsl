// Faces of volumes, summed where the scene's surface hides them.

struct Face {
    @invariant @builtin(position) position: vec4<f32>,
    // A fill's number: low and high byte, and one for every face.
    @location(0) @interpolate(flat) code: vec3<f32>,
}

fn face(from_eye: vec3<f32>, fill: u32) -> Face {
    let number = fill + 1u;
    let code = vec3<f32>(f32(number & 255u), f32(number >> 8u), 1.0);
    return Face(eye.clip_from_relative * vec4<f32>(from_eye, 1.0), code);
}

@fragment
fn weigh(face: Face, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let code = vec4<f32>(face.code, 0.0);
    return select(code, -code, front);
}
