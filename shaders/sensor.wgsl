// What a sensor covers, as the least of several slacks: signed distances, metres, positive inside.
// Each is its value at a reference point, rounded from f64, plus a difference formed from the way to
// that point. The reference is the eye for footprints from the apex and the eye's foot point for
// footprints along the normal.

struct Sensor {
    // Boresight; w: sine of the half-angle.
    axis: vec4<f32>,
    // From the boresight to the reference, at right angles to it; w: cosine of the half-angle.
    across: vec4<f32>,
    // Slack of the outer and of the inner cone at the reference; sine and cosine of the inner angle.
    cone: vec4<f32>,
    // Gradient of the slack of the limb's plane; w: that slack at the reference.
    limb: vec4<f32>,
    // From the apex to the reference; w: sine of the least elevation, -1 for none.
    line: vec4<f32>,
    // x: slack of the elevation at the reference; y: by how much sqrt(outside) lifts a point over
    // the limb's plane, w: slack at the reference with that; z: 1 if covering from the apex, 0 along
    // the normal.
    rise: vec4<f32>,
    // Weights: red, green, blue times optical depth, and optical depth.
    weight: vec4<u32>,
    // Its planes: first, count.
    planes: vec4<u32>,
}

@group(0) @binding(1) var<storage, read> sensors: array<Sensor>;
// Inward normal and slack at the reference.
@group(0) @binding(2) var<storage, read> planes: array<vec4<f32>>;

// Bounds of the least slack at a place, as far as that is known.
fn slack_of(index: u32, place: Place) -> vec2<f32> {
    let sensor = sensors[index];
    let apex = sensor.rise.z;
    let to = select(place.from_foot, place.from_eye, apex > 0.5);
    let radius = select(place.foot_known, place.known, apex > 0.5);
    let along = dot(sensor.axis.xyz, to);
    let beside = to - along * sensor.axis.xyz;
    let out = length(sensor.across.xyz + beside) + length(sensor.across.xyz);
    let outward = dot(beside, 2.0 * sensor.across.xyz + beside) / max(out, 1e-30);
    let outer = sensor.cone.x + sensor.axis.w * along - sensor.across.w * outward;
    let inner = sensor.cone.w * outward - sensor.cone.z * along - sensor.cone.y;
    var least = min(outer, inner);
    for (var k = 0u; k < sensor.planes.y; k += 1u) {
        let plane = planes[sensor.planes.x + k];
        least = min(least, plane.w + dot(plane.xyz, to));
    }
    var bounds = vec2<f32>(least - radius, least + radius);
    let on_limb = vec2<f32>(sensor.limb.w);
    let over_limb = sensor.rise.w + sensor.rise.y * place.over;
    let limb = select(on_limb, over_limb, place.outside) + dot(sensor.limb.xyz, to);
    let limb_spread = radius * length(sensor.limb.xyz);
    bounds = min(bounds, limb + vec2<f32>(-limb_spread, limb_spread));
    // A loop, since software rasterisers walk through an `if` that no lane takes.
    for (var once = sensor.line.w > -1.0; once; once = false) {
        let distance = length(sensor.line.xyz + to);
        let nearer = length(sensor.line.xyz);
        let longer = dot(to, 2.0 * sensor.line.xyz + to) / max(distance + nearer, 1e-30);
        let sine = sensor.line.w;
        let stretch_eye = place.stretch - place.stretched;
        let elevation = sensor.rise.x + dot(sensor.limb.xyz, place.from_foot)
            - stretch_eye * (apex * place.above_eye + sine * longer)
            - place.stretched * (apex * place.height + sine * distance);
        let reach = place.foot_known;
        let spread = reach * 1.05 * (2.0 + (distance + reach) / sight.ellipsoid.w);
        bounds = min(bounds, elevation + vec2<f32>(-spread, spread));
    }
    return bounds;
}

fn covers(index: u32, place: Place) -> bool {
    return slack_of(index, place).x >= 0.0;
}
