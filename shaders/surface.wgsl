// From the depth at a pixel to the surface point and its foot point on the ellipsoid. Everything is a
// difference from the eye or from the eye's foot point, formed without cancellation, so that positions
// are off by a few roundings of the distance to the eye.

// Metres along ECEF axes.
struct Sight {
    // Ray at unit distance along the view axis through the middle of the picture, and its change per
    // pixel to the right and down; where lines of sight are parallel, their direction, and how their start
    // changes. w: from the eye to the host's eye.
    ray: vec4<f32>,
    right: vec4<f32>,
    down: vec4<f32>,
    // Depth d lies at distance y / ((d - z) - x) along the view axis, or ((d - z) - x) / y where lines of
    // sight are parallel, or (2^(x d) - 1) y + z where depths are logarithmic; w is the depth of the sky.
    depth: vec4<f32>,
    // x: equatorial radius a; y: (a/b)^2; z: tau of the eye, see place_of; w: polar radius b.
    ellipsoid: vec4<f32>,
    // The eye times (1, 1, (a/b)^2) * 2 / a; w: its outside (see place_of).
    eye_gradient: vec4<f32>,
    // The eye's foot point times (1, 1, (a/b)^2).
    foot_gradient: vec4<f32>,
    // Width, height.
    size: vec4<u32>,
    // Tiles across and down, number of tiles; and the same of blocks.
    tiles: vec4<u32>,
    blocks: vec4<u32>,
    // Sensors, pages, colours of the coverage, whether gaps are coloured.
    counts: vec4<u32>,
    // Lowest and highest surface, see strays; z: optical depth of one unit of weight; w: the least sine
    // of obliqueness, see pixel.wgsl.
    bounds: vec4<f32>,
    // What holds all that is drawn, in clip space: least x and y, greatest x and y.
    window: vec4<f32>,
}

// What the sensors of the frame need: the rest is compiled away.
// Some cover from the apex,
override APEXES: bool = false;
// have an inner cone,
override INNER_CONES: bool = false;
// have a field of view with corners,
override CORNERS: bool = false;
// or a least elevation.
override ELEVATIONS: bool = false;

// Below this the eye's outside and its differences are of the size of the distances seen.
const NEAR_M: f32 = 2e5;
// A radius about a foot point that holds all others.
const EVERYWHERE: f32 = 1e12;

// A surface point.
struct Place {
    // From the eye.
    from_eye: vec3<f32>,
    // Its foot point, from the eye's foot point.
    from_foot: vec3<f32>,
    // Height above the ellipsoid, and its difference from the eye's.
    height: f32,
    above_eye: f32,
    // |foot point * (1, 1, (a/b)^2)| / a, and its difference from the eye's.
    stretch: f32,
    stretched: f32,
    // Whether it may lie above the ellipsoid at its lowest and at its highest, and then bounds of
    // sqrt(outside), less the eye's; see place_of.
    outside: vec2<bool>,
    over: vec2<f32>,
    // It and its foot point lie within these of where they are said to be.
    known: f32,
    foot_known: f32,
}

fn ray_at(at_px: vec2<f32>) -> vec3<f32> {
    if PARALLEL {
        return sight.ray.xyz;
    }
    let from_middle = at_px - 0.5 * vec2<f32>(sight.size.xy);
    return sight.ray.xyz + from_middle.x * sight.right.xyz + from_middle.y * sight.down.xyz;
}

// What lies at a distance along the view axis, from the eye.
fn from_eye_at(at_px: vec2<f32>, distance: f32) -> vec3<f32> {
    let along = ray_at(at_px) * distance;
    if PARALLEL {
        let from_middle = at_px - 0.5 * vec2<f32>(sight.size.xy);
        return along + (from_middle.x * sight.right.xyz + from_middle.y * sight.down.xyz);
    }
    return along;
}

// How much larger what a pixel spans is than at unit distance.
fn scale_at(distance: f32) -> f32 {
    return select(distance, 1.0, PARALLEL);
}

// The way that light takes to a place, which is its place relative to the eye, or of some length.
fn sight_line(from_eye: vec3<f32>) -> vec3<f32> {
    return select(from_eye, sight.ray.xyz, PARALLEL);
}

// How far a place is from the host's eye.
fn distance_from_eye(from_eye: vec3<f32>) -> f32 {
    if PARALLEL {
        return length(from_eye - vec3<f32>(sight.ray.w, sight.right.w, sight.down.w));
    }
    return length(from_eye);
}

fn is_sky(depth: f32) -> bool {
    return depth == sight.depth.w;
}

// Distance along the view axis.
fn distance_of(depth: f32) -> f32 {
    if LOGARITHMIC {
        return (exp2(depth * sight.depth.x) - 1.0) * sight.depth.y + sight.depth.z;
    }
    let step = (depth - sight.depth.z) - sight.depth.x;
    return select(sight.depth.y / step, step / sight.depth.y, PARALLEL);
}

// The surface point `from_eye`, known to `radius`.
//
// With M = diag(1, 1, (a/b)^2), a point P = (1 + tau M) F stands on its foot point F, at the height
// tau |M F|. Subtracting the same for the eye E and its foot point G gives
// (1 + tau M)(F - G) = (P - E) - (tau - tau_eye) M G: Newton's method on tau, until F lies on the
// ellipsoid, has no large numbers to cancel. "Outside" is P M P / a - a, twice the height near by.
fn place_of(from_eye: vec3<f32>, radius: f32) -> Place {
    let a = sight.ellipsoid.x;
    let m = vec3<f32>(1.0, 1.0, sight.ellipsoid.y);
    let tau_eye = sight.ellipsoid.z;
    let outside_eye = sight.eye_gradient.w;
    let farther = dot(from_eye, sight.eye_gradient.xyz) + dot(from_eye, m * from_eye) / a;
    let outside = outside_eye + farther;
    let relative = max(outside / a, -0.9);
    // Exact on a sphere, and to first order in height and flattening: metres off at 100 km, of which
    // one step of Newton's method, squaring the error, leaves less than a micrometre.
    let point_gradient = 0.5 * a * sight.eye_gradient.xyz + m * from_eye;
    let steep = dot(point_gradient, point_gradient) / (a * (a + outside));
    var more = relative / ((1.0 + sqrt(1.0 + relative)) * steep) - tau_eye;
    var from_foot: vec3<f32>;
    var normal: vec3<f32>;
    for (var step = 0; step < 2; step += 1) {
        let shrink = 1.0 / (1.0 + (tau_eye + more) * m);
        from_foot = shrink * (from_eye - more * sight.foot_gradient.xyz);
        normal = sight.foot_gradient.xyz + m * from_foot;
        // Twice the dot product with the mean of both gradients: P M P - G M G.
        let off = dot(from_foot, sight.foot_gradient.xyz + normal);
        more += select(0.0, 0.5 * off / dot(normal, shrink * normal), step == 0);
    }
    var place: Place;
    place.from_eye = from_eye;
    place.from_foot = from_foot;
    let stretch_eye = length(sight.foot_gradient.xyz) / a;
    place.stretch = length(normal) / a;
    place.stretched = dot(m * from_foot, normal + sight.foot_gradient.xyz)
        / (a * a * (place.stretch + stretch_eye));
    place.height = (tau_eye + more) * a * place.stretch;
    place.above_eye = a * (tau_eye * place.stretched + more * place.stretch);
    place.known = radius;
    place.foot_known = foot_radius(place.height, radius);
    if APEXES {
        // What rounding can lift off the ellipsoid must not be lifted over the limb; from four times that
        // the height counts in full.
        let unit = 3e-7 * length(from_eye);
        let heights = place.height + 1.05 * vec2<f32>(-radius, radius);
        let levels = min(heights, max((heights - unit) * (4.0 / 3.0), vec2<f32>(0.0)));
        place.outside = levels > vec2<f32>(0.0);
        let spread = radius * (2.1 + (2.1 * length(from_eye) + 1.1 * radius) / a);
        let grown = farther + vec2<f32>(-spread, spread) - 2.0 * place.stretch * (heights - levels);
        place.over = vec2<f32>(
            root_over(place, normal, max(levels.x, 0.0), grown.x),
            root_over(place, normal, max(levels.y, 0.0), grown.y),
        );
    }
    return place;
}

// How far foot points lie from that of a point `height` above the ellipsoid if what stands on them lies
// within `radius` of it: feet spread below the surface, without bound where curvature has its centre.
fn foot_radius(height: f32, radius: f32) -> f32 {
    let deepest = max(radius - height, 0.0);
    let a = sight.ellipsoid.x;
    let b = sight.ellipsoid.w;
    let left = 1.0 - deepest * max(a, b) / (min(a, b) * min(a, b));
    return select(EVERYWHERE, radius / left, left > 0.3);
}

// Whether something within `radius` of a place lies so far above or below the host's surface that it is
// none of it: a satellite, a sky dome. A generous hundredth of the distance is for coarse meshes.
fn strays(place: Place, radius: f32) -> bool {
    let slack = 0.01 * length(place.from_eye) - radius;
    return place.height < sight.bounds.x - slack || place.height > sight.bounds.y + slack;
}

// sqrt(outside), less the eye's: of a point `level` above the ellipsoid, whose outside is `farther`
// more than the eye's.
fn root_over(place: Place, normal: vec3<f32>, level: f32, farther: f32) -> f32 {
    let outside_eye = sight.eye_gradient.w;
    let root_eye = sqrt(max(outside_eye, 0.0));
    if outside_eye > 0.0 && outside_eye < NEAR_M {
        return farther / (sqrt(max(outside_eye + farther, 0.0)) + root_eye);
    }
    // Of a high eye the outside has grown faster than its distance; that of the height is better.
    let upright = normalize(normal);
    let m = vec3<f32>(1.0, 1.0, sight.ellipsoid.y);
    let curved = level * dot(upright, m * upright) / sight.ellipsoid.x;
    return sqrt(level * (2.0 * place.stretch + curved)) - root_eye;
}
