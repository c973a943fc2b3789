// Patterns that repeat: how much of a pixel is ink. A pattern repeats along u and v with periods of one
// unit, or of 2^k units with k chosen at each pixel so that it looks as wide as asked for. Averages over
// the pixel are exact for lines and squares, and for dots but for their bend within a pixel.

// Halfway from one k to the next, where the period looks 2^0.5 too small, every other line grows and the
// rest vanish: from 2^0.42 to 2^0.58.
const CHANGE_FROM: f32 = 1.338;
const CHANGE_TO: f32 = 1.495;

// Periods along one axis.
struct Cells {
    // Where the pixel is, in periods from the last line whose number is `number`.
    at: f32,
    // The lowest two bits of it.
    number: u32,
    // Width of the pixel, in periods.
    width: f32,
    // How far the lines with odd numbers have vanished, 0 ... 1.
    change: f32,
}

// `phase`: whole and fraction of the coordinate at the eye's foot point; `from_foot`: the difference from
// there; `slope`: how much it changes per pixel; `wanted`: the period in pixels, 0 for one unit.
fn cells_of(phase: vec2<u32>, from_foot: f32, slope: f32, wanted: f32) -> Cells {
    let fitting = clamp(wanted * slope, 1e-7, 5e8);
    // fitting = 2^k * rest with rest in 1 ... 2: what a float consists of.
    let bits = bitcast<u32>(fitting);
    let exponent = select(bits >> 23u, 127u, wanted == 0.0);
    let rest = bitcast<f32>((bits & 0x7fffffu) | 0x3f800000u);
    let scale = bitcast<f32>((254u - exponent) << 23u);
    // The coordinate divided by 2^k: the same bits, shifted. Those of a shift by 0 or 32 are left out.
    let left = max(127u, exponent) - exponent;
    let right = exponent - min(127u, exponent);
    let whole = select(phase.x >> right, (phase.x << left) | (phase.y >> (32u - left)), left > 0u);
    let carried = select(phase.y << left, (phase.y >> right) | (phase.x << (32u - right)), right > 0u);
    let change = select(smoothstep(CHANGE_FROM, CHANGE_TO, rest), 0.0, wanted == 0.0);
    return Cells(from_foot * scale + fraction_of(carried), whole, slope * scale, change);
}

fn fraction_of(bits: u32) -> f32 {
    return f32(bits >> 8u) / 16777216.0;
}

// Length of the part of 2 * reach about `at` that lies within `half` of 0.
fn overlap(at: f32, reach: f32, half: f32) -> f32 {
    return max(min(at + reach, half) - max(at - reach, -half), 0.0);
}

// Where pixels are wider than a period, only the mean is left.
fn blur(width: f32) -> f32 {
    return smoothstep(0.7, 1.0, width);
}

// Lines that cover `share`.
fn lines(cells: Cells, share: f32) -> f32 {
    let nearest = round(cells.at);
    let at = abs(cells.at - nearest);
    let odd = ((cells.number + u32(i32(nearest))) & 1u) == 1u;
    let change = select(cells.change, -cells.change, odd);
    let here = 0.5 * share * (1.0 + change);
    let beside = 0.5 * share * (1.0 - change);
    // Wider pixels are blurred.
    let width = clamp(cells.width, 1e-6, 1.0);
    let reach = 0.5 * width;
    let covered = overlap(at, reach, here) + overlap(at - 1.0, reach, beside)
        + overlap(at + 1.0, reach, beside);
    return mix(covered / width, share, blur(cells.width));
}

// A wave that is 1 on even and -1 on odd squares.
fn squares(at: f32, number: u32, width: f32) -> f32 {
    let nearest = round(at);
    let odd = ((number + u32(i32(nearest))) & 1u) == 1u;
    let rising = clamp((at - nearest) * 2.0 / clamp(width, 1e-6, 1.0), -1.0, 1.0);
    return select(rising, -rising, odd) * (1.0 - blur(width));
}

fn checker_wave(cells: Cells) -> f32 {
    let fine = squares(cells.at, cells.number, cells.width);
    let coarse_at = 0.5 * (cells.at + f32(cells.number & 1u));
    let coarse = squares(coarse_at, cells.number >> 1u, 0.5 * cells.width);
    return mix(fine, coarse, cells.change);
}

// How much of a pixel the dot at a grid point covers, or 0 if it belongs to another: dots do not touch.
fn dot_at(grid: vec2<f32>, u: Cells, v: Cells, u_slope: vec2<f32>, v_slope: vec2<f32>, radius: f32) -> f32 {
    let at = vec2<f32>(u.at, v.at) - grid;
    let number = vec2<u32>(u.number, v.number) + vec2<u32>(vec2<i32>(grid));
    let odd = (number & vec2<u32>(1u)) == vec2<u32>(1u);
    let change = vec2<f32>(u.change, v.change);
    let grown = select(1.0 + change, vec2<f32>(1.0), odd);
    let shrunk = select(vec2<f32>(1.0), sqrt(1.0 - change), odd);
    let radii = max(radius * grown * shrunk.x * shrunk.y, vec2<f32>(1e-4));
    // Distances from the middle and to the edge beyond, pixels: of a function that is 1 at the edge, by its
    // slope.
    let scaled = at / radii;
    let level = max(length(scaled), 1e-3);
    let slope = scaled / (level * radii);
    let radius_px = 1.0 / max(length(slope.x * u_slope + slope.y * v_slope), 1e-9);
    // A ramp of 1 px about the edge of a disc covers 1/12 px^2 more than the disc; smaller discs than that
    // is good for are drawn paler.
    let drawn = max(radius_px, 0.5);
    let trimmed = sqrt(drawn * drawn - 1.0 / 12.0);
    let paler = radius_px / drawn;
    return saturate(trimmed - level * radius_px + 0.5) * paler * paler;
}

// The nearest number of a line that grows.
fn growing(cells: Cells) -> f32 {
    let odd = f32(cells.number & 1u);
    return 2.0 * round(0.5 * (cells.at + odd)) - odd;
}

// Dots: ellipses on the grid of both axes' lines, that grow with the lines that grow. A grown one reaches
// beyond half way to its neighbours.
fn dots(u: Cells, v: Cells, u_slope: vec2<f32>, v_slope: vec2<f32>, share: f32) -> f32 {
    let radius = sqrt(share / PI);
    let near = vec2<f32>(round(u.at), round(v.at));
    let even = vec2<f32>(growing(u), growing(v));
    let here = dot_at(near, u, v, u_slope, v_slope, radius);
    let beside = dot_at(vec2<f32>(even.x, near.y), u, v, u_slope, v_slope, radius);
    let above = dot_at(vec2<f32>(near.x, even.y), u, v, u_slope, v_slope, radius);
    let both = dot_at(even, u, v, u_slope, v_slope, radius);
    let covered = max(max(here, beside), max(above, both));
    return mix(covered, share, blur(1.6 * max(u.width, v.width)));
}
