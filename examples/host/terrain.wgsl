// Terrain: a mesh of eye-relative vertices, coloured with shaded relief.

@group(1) @binding(0) var relief_picture: texture_2d<f32>;
// In x: distance between its texels on the ground, metres.
@group(1) @binding(1) var<uniform> relief: vec4f;

// Whether there is ground outside the grid.
override beyond_grid = true;

struct Vertex {
    // ECEF metres from the eye.
    @location(0) relative_m: vec3f,
    // Place in the grid: 0 … 1 from west to east and from north to south.
    @location(1) place: vec2f,
}

struct Surface {
    @builtin(position) position: vec4f,
    @location(0) relative_m: vec3f,
    @location(1) place: vec2f,
}

@vertex
fn terrain_vertex(vertex: Vertex) -> Surface {
    let position = view.clip_from_relative * vec4f(vertex.relative_m, 1.0);
    return Surface(position, vertex.relative_m, vertex.place);
}

@fragment
fn terrain_pixel(surface: Surface) -> @location(0) vec4f {
    let relative_m = surface.relative_m;
    let distance_m = length(relative_m);
    let scaled = view.eye.xyz + relative_m * vec3f(1.0, 1.0, view.constants.y) / view.constants.x;
    let normal = normalize(scaled * vec3f(1.0, 1.0, view.constants.y));
    var color = vec3f(0.0);
    if (beyond_grid) {
        color = world_color(normal);
    }
    // Within the grid the relief; a cell beyond its edges the world picture.
    let size = vec2f(textureDimensions(relief_picture));
    let beyond = max(abs(surface.place - 0.5) - 0.5, vec2f(0.0)) * size;
    if (max(beyond.x, beyond.y) < 1.0) {
        // Texels are nodes: the first and the last centre lie on the grid's edges.
        let uv = (surface.place * (size - 1.0) + 0.5) / size;
        let level = log2(distance_m * view.north.w / relief.x);
        var shaded: vec3f;
        if (level > 0.0) {
            shaded = textureSampleLevel(relief_picture, smooth_sampler, uv, level).rgb;
        } else {
            shaded = sample_smooth(relief_picture, uv);
        }
        color = mix(shaded, color, max(beyond.x, beyond.y));
    }
    color *= ground_detail(relative_m, distance_m);
    color *= daylight(normal);
    return vec4f(through_air(color, normal, relative_m, distance_m), 1.0);
}
