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

@group(0) @binding(0) var<storage, read> sensors: array<Sensor>;
// Inward normal and slack at the reference.
@group(0) @binding(1) var<storage, read> planes: array<vec4<f32>>;

// Bounds of the least slack at a place, as far as that is known.
fn slack_of(index: u32, place: Place) -> vec2<f32> {
    var from_apex = false;
    var to = place.from_foot;
    var radius = place.foot_known;
    if APEXES {
        from_apex = sensors[index].rise.z > 0.5;
        to = select(to, place.from_eye, from_apex);
        radius = select(radius, place.known, from_apex);
    }
    var least = cone_slack(index, to);
    if CORNERS {
        let list = sensors[index].planes;
        for (var k = list.x; k < list.x + list.y; k += 1u) {
            least = min(least, planes[k].w + dot(planes[k].xyz, to));
        }
    }
    let known = vec2<f32>(-radius, radius);
    var bounds = min(least + known, limb_slack(index, to, place, known));
    if ELEVATIONS {
        // A loop that runs once or never: software rasterisers walk through an `if` that no lane takes.
        for (var once = sensors[index].line.w > -1.0; once; once = false) {
            bounds = min(bounds, elevation_slack(index, to, place, from_apex));
        }
    }
    return bounds;
}

// Distance from the outer cone inwards, or from the inner one outwards if that is less.
fn cone_slack(index: u32, to: vec3<f32>) -> f32 {
    let axis = sensors[index].axis;
    let across = sensors[index].across;
    let along = dot(axis.xyz, to);
    let beside = to - along * axis.xyz;
    let out = length(across.xyz + beside) + length(across.xyz);
    let outward = dot(beside, 2.0 * across.xyz + beside) / max(out, 1e-30);
    let outer = sensors[index].cone.x + axis.w * along - across.w * outward;
    if !INNER_CONES {
        return outer;
    }
    let cone = sensors[index].cone;
    return min(outer, cone.w * outward - cone.z * along - cone.y);
}

fn limb_slack(index: u32, to: vec3<f32>, place: Place, known: vec2<f32>) -> vec2<f32> {
    let plane = sensors[index].limb;
    var slack = vec2<f32>(plane.w);
    if APEXES {
        let over_limb = sensors[index].rise.w + sensors[index].rise.y * place.over;
        slack = select(slack, over_limb, place.outside);
    }
    return slack + dot(plane.xyz, to) + known * length(plane.xyz);
}

fn elevation_slack(index: u32, to: vec3<f32>, place: Place, from_apex: bool) -> vec2<f32> {
    let line = sensors[index].line;
    let distance = length(line.xyz + to);
    let longer = dot(to, 2.0 * line.xyz + to) / max(distance + length(line.xyz), 1e-30);
    let stretch_eye = place.stretch - place.stretched;
    let height = select(0.0, place.height, from_apex);
    let above_eye = select(0.0, place.above_eye, from_apex);
    let slack = sensors[index].rise.x + dot(sensors[index].limb.xyz, place.from_foot)
        - stretch_eye * (above_eye + line.w * longer)
        - place.stretched * (height + line.w * distance);
    let reach = place.foot_known;
    let spread = reach * 1.05 * (2.0 + (distance + reach) / sight.ellipsoid.w);
    return slack + vec2<f32>(-spread, spread);
}

fn covers(index: u32, place: Place) -> bool {
    return slack_of(index, place).x >= 0.0;
}
