// How the fills of a layer look, and where this view's eye finds their patterns.

struct Style {
    // Kind of pattern and what else fits, see kind_of ... is_additive; index of its place; layer and number
    // of its image's array.
    pattern: vec4<u32>,
    // Premultiplied colours with highlight and opacity: where there is no ink,
    paper: vec4<f32>,
    // and where there is ink alone. Under images: the colour without highlight and opacity.
    inked: vec4<f32>,
    // What images are multiplied by: of opacity and of what the highlight leaves.
    tint: vec4<f32>,
    // Share of ink; spacing in pixels, 0 where the place says it in metres; height over width of a tile;
    // opacity.
    hatch: vec4<f32>,
    // Distance and pixel size where the fill is gone, each with the opacity gained per metre from there.
    fade: vec4<f32>,
    // The same of the sine of the angle of view. z: share of dashes of the stroke.
    fade_sine: vec4<f32>,
    // Premultiplied colour.
    stroke: vec4<f32>,
    // Of the stroke: width in metres or pixels; period of dashes in metres or pixels.
    stroke_size: vec4<f32>,
}

// Kinds of patterns.
const PLAIN: u32 = 0u;
const LINES: u32 = 1u;
const CROSS: u32 = 2u;
const DOTS: u32 = 3u;
const CHECKER: u32 = 4u;
const TILES: u32 = 5u;
const PICTURE: u32 = 6u;

// What lies outside an image.
const CLIP: u32 = 0u;
const REPEAT: u32 = 2u;

fn kind_of(style: u32) -> u32 {
    return styles[style].pattern.x & 7u;
}

fn wrap_of(style: u32) -> u32 {
    return (styles[style].pattern.x >> 4u) & 3u;
}

// Whether the stroke lies inside, half and half, or outside.
fn align_of(style: u32) -> u32 {
    return (styles[style].pattern.x >> 6u) & 3u;
}

// Whether the fill hides nothing of what is below.
fn is_additive(style: u32) -> bool {
    return (styles[style].pattern.x & 256u) != 0u;
}

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
    // u and v at G, in 2^-32: whole and fraction of each. On longitudes and latitudes those of the middle.
    phase: vec4<u32>,
}

// u and v of the middle of an image.
const MIDDLE = vec4<u32>(0u, 0x80000000u, 0u, 0x80000000u);

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
const NEEDS_ADDITIVE: u32 = 2048u;
const NEEDS_MAPS: u32 = 4096u;
// Images on a colour that is not the paper, and of several arrays.
const NEEDS_INKED: u32 = 8192u;
const NEEDS_ARRAYS: u32 = 16384u;
// Images on geocentric latitudes; turned ones.
const NEEDS_SPHERES: u32 = 32768u;
const NEEDS_TURNS: u32 = 65536u;
const NEEDS_HATCHES: u32 = NEEDS_LINES | NEEDS_DOTS | NEEDS_CHECKER;
const NEEDS_IMAGES: u32 = NEEDS_TILES | NEEDS_CLAMPED | NEEDS_REPEATED;

fn needs(what: u32) -> bool {
    return (NEEDS & what) != 0u;
}

// What fading leaves of a fill.
fn faded(style: u32, seen: Seen) -> f32 {
    var left = 1.0;
    if needs(NEEDS_FADES) {
        let fade = styles[style].fade;
        let sine = styles[style].fade_sine;
        let pixel = seen.along * length(sight.down.xyz);
        left = saturate((distance_from_eye(seen.from_eye) - fade.x) * fade.y)
            * saturate((pixel - fade.z) * fade.w)
            * saturate((sine_of(seen) - sine.x) * sine.y);
    }
    return left;
}
