// Every vertex is there twice: one raised beforehand, one on the ellipsoid, pushed below the ground here.

@vertex
fn corner(@location(0) position: vec3<f32>, @location(1) fill_and_end: u32) -> Face {
    let on_surface = eye.from_eye.xyz + position;
    let down = normal_at(position) * bottom_m(on_surface);
    let from_eye = select(on_surface + down, on_surface, (fill_and_end & 1u) == 1u);
    return face(from_eye, fill_and_end >> 1u);
}
