// A corner of a volume face, clipped by the near plane as usual. Depth has no far plane.

struct Face {
    @builtin(position) @invariant position: vec4<f32>,
    // Seen from outside the volume of the left piece.
    @location(0) @interpolate(flat) weight: vec4<f32>,
}

fn face(vertex: vec4<i32>, drawn: u32, weight: vec4<f32>) -> Face {
    return Face(clip(vertex, drawn), weight);
}
