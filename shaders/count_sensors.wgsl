// Reading back: how many sensors cover the surface at one pixel.

struct Answer {
    pixel: vec2<u32>,
    // Written here: the number of sensors.
    covering: u32,
    unused: u32,
}

@group(1) @binding(0) var<storage, read_write> answer: Answer;

@compute @workgroup_size(1)
fn cs_count() {
    let depth = depth_at(answer.pixel, 0u);
    var covering = 0u;
    if !is_sky(depth) {
        let at_px = vec2<f32>(answer.pixel) + sample_px(0u);
        let place = place_of(from_eye_at(at_px, distance_of(depth)), 0.0);
        let asked = select(sight.counts.x, 0u, strays(place, 0.0));
        for (var sensor = 0u; sensor < asked; sensor += 1u) {
            covering += select(0u, 1u, covers(sensor, place));
        }
    }
    answer.covering = covering;
}
