// How the fills of a layer look, and where this view's eye finds their patterns.

struct Style {
    // Premultiplied colours.
    color: vec4<f32>,
    highlight: vec4<f32>,
    // Of lines, dots, squares; of images alpha alone, for all parts.
    ink: vec4<f32>,
    stroke: vec4<f32>,
    // What of: see PLAIN ... PICTURE; index of its place; layer and number of its image's array.
    pattern: vec4<u32>,
    // Share of ink; spacing in pixels, 0 where the place says it in metres; height over width of a tile;
    // opacity.
    hatch: vec4<f32>,
    // Distance and pixel size where the fill is gone, each with the opacity gained per metre from there.
    fade: vec4<f32>,
    // The same of the sine of the angle of view. z: how much of what is below the fill hides.
    fade_sine: vec4<f32>,
    // Of the stroke: width in metres or pixels; period of dashes in metres or pixels.
    stroke_size: vec4<f32>,
    // Share of dashes.
    dash_share: f32,
    // Whether the stroke lies inside, half and half, or outside.
    align: u32,
    // What lies outside an image.
    wrap: u32,
    unused: u32,
}

// Kinds of patterns.
const PLAIN: u32 = 0u;
const LINES: u32 = 1u;
const CROSS: u32 = 2u;
const DOTS: u32 = 3u;
const CHECKER: u32 = 4u;
const TILES: u32 = 5u;
const PICTURE: u32 = 6u;

const CLIP: u32 = 0u;
const REPEAT: u32 = 2u;

// Where a pattern lies, as seen from the eye's foot point G. All gradients are per metre there.
struct Placed {
    // On a map: gradient of u, and how near G is to the anchor (1 there, 0 at its antipode). On longitudes
    // and latitudes: those of G from the middle, radians; what z is stretched by in latitudes; 1.
    u: vec4<f32>,
    // On a map: gradient of v; 0. Else how much u and v change with longitude and latitude: u by both,
    // then v by both.
    v: vec4<f32>,
    // On a map: gradient of the nearness; w: whether on longitudes and latitudes.
    fall: vec4<f32>,
    // u and v at G, in 2^-32: whole and fraction of each.
    phase: vec4<u32>,
}

@group(1) @binding(0) var<storage, read> styles: array<Style>;
@group(1) @binding(1) var<storage, read> places: array<Placed>;
// What the edge pass wrote.
@group(1) @binding(2) var edges: texture_2d<u32>;

// What the fills of the layer need, a bit for each: the rest is compiled away.
override NEEDS: u32 = 0u;
const NEEDS_LINES: u32 = 1u;
const NEEDS_ACROSS: u32 = 2u;
const NEEDS_DOTS: u32 = 4u;
const NEEDS_CHECKER: u32 = 8u;
const NEEDS_TILES: u32 = 16u;
const NEEDS_CLAMPED: u32 = 32u;
const NEEDS_REPEATED: u32 = 64u;
const NEEDS_ANGLES: u32 = 128u;
const NEEDS_FADES: u32 = 256u;
const NEEDS_STROKES: u32 = 512u;
const NEEDS_SMOOTH: u32 = 1024u;

fn needs(what: u32) -> bool {
    return (NEEDS & what) != 0u;
}

// Full opacity, or what fading leaves of it.
fn opacity_of(style: u32, seen: Seen) -> f32 {
    var opacity = styles[style].hatch.w;
    if needs(NEEDS_FADES) {
        let fade = styles[style].fade;
        let sine = styles[style].fade_sine;
        let pixel = seen.along * length(sight.down.xyz);
        opacity *= saturate((distance_from_eye(seen.from_eye) - fade.x) * fade.y)
            * saturate((pixel - fade.z) * fade.w)
            * saturate((sine_of(seen) - sine.x) * sine.y);
    }
    return opacity;
}
