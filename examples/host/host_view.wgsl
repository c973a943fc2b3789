// What every shader of the host's ground shares: the view, the air, and colours of the ground.
//
// The ellipsoid is intersected in a scaled space where it is the unit sphere: e the eye and d a
// ray of length 1 along the view axis, both in equatorial radii with z stretched by a/b. All that
// is linear in the pixel's position comes from the CPU, computed in f64.

struct HostView {
    // d of the middle of the picture, and its change per unit of x and y in clip space; in w: e·d.
    ray_x: vec4f,
    ray_y: vec4f,
    ray_0: vec4f,
    // e × d, likewise.
    moment_x: vec4f,
    moment_y: vec4f,
    moment_0: vec4f,
    // e, and |e|² − 1.
    eye: vec4f,
    // Clip space from eye-relative ECEF metres.
    clip_from_relative: mat4x4f,
    // Unit vector to the sun, ECEF; in w: level of detail of the globe's picture.
    sun: vec4f,
    // East and north at the eye's foot point, ECEF; in w: strength of the detail, pixel size at 1 m.
    east: vec4f,
    north: vec4f,
    // Offset (x, y) and size (z) of the fine detail's tile, metres; in w: of the tile's texels.
    detail_fine: vec4f,
    detail_coarse: vec4f,
    // Equatorial radius in metres; a/b; depth = z + w / distance in metres.
    constants: vec4f,
    // Picture size, pixels; depth of the sky; thickness of the air as drawn, metres.
    picture: vec4f,
}

@group(0) @binding(0) var<uniform> view: HostView;
@group(0) @binding(1) var globe_picture: texture_2d<f32>;
@group(0) @binding(2) var detail_noise: texture_2d<f32>;
@group(0) @binding(3) var smooth_sampler: sampler;

// Whether the world picture's texels are larger than the pixels, and whether the ground gets detail:
// constants, because software adapters run both sides of a branch.
override magnified = false;
override detailed = false;

const PI = 3.14159265;

struct Ray {
    direction: vec3f,
    // Coefficients of |e + t·d|² = 1: a·t² + 2·b·t + c = 0.
    a: f32,
    b: f32,
    // (b² − a·c): positive where the ray meets the ellipsoid.
    discriminant: f32,
    // Squared distance of the ray's line from the centre, times a.
    moment_squared: f32,
}

fn ray_at(ndc: vec2f) -> Ray {
    let ray = view.ray_0 + ndc.x * view.ray_x + ndc.y * view.ray_y;
    let moment = view.moment_0.xyz + ndc.x * view.moment_x.xyz + ndc.y * view.moment_y.xyz;
    var out: Ray;
    out.direction = ray.xyz;
    out.a = dot(ray.xyz, ray.xyz);
    out.b = ray.w;
    out.moment_squared = dot(moment, moment);
    // Equal by Lagrange's identity. The first loses nothing near the ground, where c is tiny; the
    // second loses nothing far away, where b² and a·c are huge.
    let c = view.eye.w;
    out.discriminant = select(
        out.a - out.moment_squared, out.b * out.b - out.a * c, abs(c) < 1.0);
    return out;
}

// Distance along the ray to the ellipsoid, in equatorial radii; negative where it is missed.
fn hit(ray: Ray) -> f32 {
    if (ray.discriminant < 0.0) {
        return -1.0;
    }
    let c = view.eye.w;
    let root = sqrt(ray.discriminant);
    if (c < 0.0) {
        // The eye is inside: the way out. The form without cancellation depends on the sign of b.
        return select(c / (-ray.b - root), (root - ray.b) / ray.a, ray.b < 0.0);
    }
    return select(-1.0, c / (root - ray.b), ray.b < 0.0);
}

fn depth_at(distance_m: f32) -> f32 {
    return view.constants.z + view.constants.w / distance_m;
}

// Arc tangent on all four quadrants, within 2·10⁻⁵ rad (Hastings 1955, sheet 12); the builtin one
// of some software adapters is worse, and undefined on the axes.
fn angle_of(y: f32, x: f32) -> f32 {
    let ratio = min(abs(x), abs(y)) / max(max(abs(x), abs(y)), 1e-30);
    let s = ratio * ratio;
    var angle = ratio * (0.99997726 + s * (-0.33262347 + s * (0.19354346
        + s * (-0.11643287 + s * (0.05265332 - s * 0.01172120)))));
    angle = select(angle, PI / 2.0 - angle, abs(y) > abs(x));
    angle = select(angle, PI - angle, x < 0.0);
    return select(angle, -angle, y < 0.0);
}

// Where the surface point with this unit normal lies in the world picture.
fn world_uv(normal: vec3f) -> vec2f {
    let lon = angle_of(normal.y, normal.x);
    let lat = angle_of(normal.z, length(normal.xy));
    return vec2f(0.5 + lon / (2.0 * PI), 0.5 - lat / PI);
}

// Cubic B-spline by four bilinear samples (Sigg & Hadwiger, GPU Gems 2, ch. 20), for pictures much
// coarser than the pixels.
fn sample_smooth(picture: texture_2d<f32>, uv: vec2f) -> vec3f {
    let size = vec2f(textureDimensions(picture));
    let position = uv * size - 0.5;
    let base = floor(position);
    let f = position - base;
    let w0 = (1.0 - f) * (1.0 - f) * (1.0 - f) / 6.0;
    let w1 = (4.0 - 6.0 * f * f + 3.0 * f * f * f) / 6.0;
    let w3 = f * f * f / 6.0;
    let w2 = 1.0 - w0 - w1 - w3;
    let low = (base - 0.5 + w1 / (w0 + w1)) / size;
    let high = (base + 1.5 + w3 / (w2 + w3)) / size;
    let weight_low = w0 + w1;
    let a = textureSampleLevel(picture, smooth_sampler, vec2f(low.x, low.y), 0.0).rgb;
    let b = textureSampleLevel(picture, smooth_sampler, vec2f(high.x, low.y), 0.0).rgb;
    let c = textureSampleLevel(picture, smooth_sampler, vec2f(low.x, high.y), 0.0).rgb;
    let d = textureSampleLevel(picture, smooth_sampler, vec2f(high.x, high.y), 0.0).rgb;
    return mix(mix(d, c, weight_low.x), mix(b, a, weight_low.x), weight_low.y);
}

// The picture as a background: bright deserts toned down, colours a little paler.
fn map_tone(color: vec3f) -> vec3f {
    let grey = dot(color, vec3f(0.21, 0.72, 0.07));
    return mix(vec3f(grey), color, 0.85) * 1.25 / (1.0 + 0.7 * grey);
}

fn world_color(normal: vec3f) -> vec3f {
    let uv = world_uv(normal);
    if (magnified) {
        return map_tone(sample_smooth(globe_picture, uv));
    }
    return map_tone(textureSampleLevel(globe_picture, smooth_sampler, uv, view.sun.w).rgb);
}

// Brightness of invented ground detail at an eye-relative place, around 1.
fn ground_detail(relative_m: vec3f, distance_m: f32) -> f32 {
    if (!detailed) {
        return 1.0;
    }
    let place = vec2f(dot(relative_m, view.east.xyz), dot(relative_m, view.north.xyz));
    let pixel_m = distance_m * view.north.w;
    let fine = textureSampleLevel(detail_noise, smooth_sampler,
        (place + view.detail_fine.xy) / view.detail_fine.z,
        log2(max(pixel_m / view.detail_fine.w, 1.0))).r;
    let coarse = textureSampleLevel(detail_noise, smooth_sampler,
        (place + view.detail_coarse.xy) / view.detail_coarse.z,
        log2(max(pixel_m / view.detail_coarse.w, 1.0))).r;
    return 1.0 + view.east.w * (0.5 * fine + coarse - 0.75);
}

// Light on the ground: dim, so that the fills stand out, and never dark.
fn daylight(normal: vec3f) -> f32 {
    return 0.22 + 0.66 * smoothstep(-0.35, 1.0, dot(normal, view.sun.xyz));
}

const SPACE = vec3f(0.0025, 0.0035, 0.0075);
const ZENITH = vec3f(0.07, 0.21, 0.52);
const HORIZON = vec3f(0.45, 0.60, 0.78);

// The air between the eye and the ground, over the ground's colour.
fn through_air(color: vec3f, normal: vec3f, direction: vec3f, distance_m: f32) -> vec3f {
    let cosine = abs(dot(normal, normalize(direction)));
    let path_m = min(distance_m, 9e3 / max(cosine, 0.015));
    return mix(color, HORIZON, 0.9 * (1.0 - exp(-path_m / 1.6e5)));
}

// What is seen where there is no ground: air near the horizon, then stars.
fn sky_color(ray: Ray) -> vec3f {
    let eye_radius = length(view.eye.xyz);
    let lowest = select(eye_radius, sqrt(ray.moment_squared / ray.a), ray.b < 0.0);
    let height_m = max(lowest - 1.0, 0.0) * view.constants.x;
    let sine = max(ray.b / (sqrt(ray.a) * eye_radius), 0.0);
    let air = exp(-height_m / view.picture.w) * (0.12 / (0.12 + sine));
    let high = saturate((eye_radius - 1.0) * view.constants.x / 6e4 - 0.2);
    let stars = star_light(ray.direction) * (1.0 - min(air * 3.0, 1.0)) * high;
    let glow = mix(ZENITH, HORIZON, air * air);
    return mix(SPACE + stars, glow, 1.0 - exp(-3.0 * air));
}

// A sparse field of stars, fixed in ECEF: one cell of a cube-face grid in ninety holds one.
fn star_light(direction: vec3f) -> vec3f {
    let size = abs(direction);
    let major = max(size.x, max(size.y, size.z));
    var face = direction / major;
    var index = 0.0;
    var place = face.yz;
    if (size.y == major) {
        index = 2.0;
        place = face.zx;
    }
    if (size.z == major) {
        index = 4.0;
        place = face.xy;
    }
    index += select(0.0, 1.0, dot(face, vec3f(1.0)) < 0.0);
    let grid = (place + 1.0) * 90.0;
    let random = fract(sin(vec3f(dot(floor(grid), vec2f(12.9898, 78.233)) + index)
        * vec3f(1.0, 1.31, 1.73)) * vec3f(43758.547, 24634.635, 31257.137));
    let offset = (fract(grid) - 0.25 - 0.5 * random.xy) / 90.0;
    let pixels = length(offset) / view.north.w;
    let bright = random.z * 90.0 - 89.0;
    return vec3f(0.75, 0.82, 1.0) * max(bright, 0.0) * saturate(1.3 - pixels) * 0.7;
}

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(linear, sample) ndc: vec2f,
}

// One triangle over the whole picture, at the sky's depth.
@vertex
fn whole_picture(@builtin(vertex_index) index: u32) -> Corner {
    let ndc = vec2f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0);
    return Corner(vec4f(ndc, view.picture.z, 1.0), ndc);
}

// Clip-space position of a pixel's centre, from its exact framebuffer position.
fn ndc_of(position: vec4f) -> vec2f {
    return vec2f(2.0, -2.0) * position.xy / view.picture.xy + vec2f(-1.0, 1.0);
}

// What is seen where no ground was drawn.
@fragment
fn sky_pixel(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(sky_color(ray_at(ndc_of(position))), 1.0);
}
