// Every vertex is there twice: one raised beforehand, one on the ellipsoid, pushed below the ground here.

@vertex
fn corner(stored: Stored) -> Face {
    let as_stored = relative(stored);
    let down = normal_at(ecef(stored)) * bottom_m(as_stored);
    let from_eye = select(as_stored + down, as_stored, (stored.fill_and_end & 1u) == 1u);
    return face(from_eye, stored.fill_and_end >> 1u);
}
