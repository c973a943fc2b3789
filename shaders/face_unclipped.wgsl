// A corner of a volume face where depth has a far plane: nothing may be clipped there, so depth
// clipping is off. That turns the near plane off too, and walls that pass through the eye would be
// drawn up to w = 0; so they are clipped at the near plane by distance.

struct Face {
    @builtin(position) @invariant position: vec4<f32>,
    @builtin(clip_distances) near: array<f32, 1>,
    // Seen from outside the volume of the left piece.
    @location(0) @interpolate(flat) weight: vec4<f32>,
}

fn face(vertex: vec4<i32>, drawn: u32, weight: vec4<f32>) -> Face {
    let position = clip(vertex, drawn);
    // frame.slack.w is the near distance, and w the distance along the view axis.
    return Face(position, array<f32, 1>(position.w - frame.slack.w), weight);
}
