// A globe: the ellipsoid, met by the line of sight of every pixel. Reversed depth, infinitely far.
struct Sight {
    // From (x, y, 1) of clip space to the direction of sight, in the ellipsoid's scaled frame.
    directions: mat3x3<f32>,
    // The eye, divided by the radii; and the near plane, metres.
    eye: vec3<f32>,
    near_m: f32,
}
@group(0) @binding(0) var<uniform> sight: Sight;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) clip: vec2<f32>,
}

@vertex
fn whole_picture(@builtin(vertex_index) index: u32) -> Corner {
    let clip = vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return Corner(vec4<f32>(clip, 0.0, 1.0), clip);
}

struct Pixel {
    @location(0) color: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn globe(corner: Corner) -> Pixel {
    let way = sight.directions * vec3<f32>(corner.clip, 1.0);
    // |eye + s way|² = 1, where s are metres along the view axis.
    let a = dot(way, way);
    let b = dot(sight.eye, way);
    let c = dot(sight.eye, sight.eye) - 1.0;
    let root = b * b - a * c;
    if root < 0.0 || b > 0.0 {
        discard;
    }
    let distance_m = c / (sqrt(root) - b);
    let normal = normalize(sight.eye + distance_m * way);
    let light = 0.3 + 0.7 * max(dot(normal, normalize(vec3<f32>(0.8, 0.3, 0.5))), 0.0);
    return Pixel(vec4<f32>(vec3<f32>(0.05, 0.1, 0.22) * light, 1.0), sight.near_m / distance_m);
}
