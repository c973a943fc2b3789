//! Colours of footprints and of coverage: linear red, green, blue, and alpha.

use globefill::{CoverageColors, SensorError, coverage::CLEAR};

use crate::host::palette::linear;

pub type Color = [f32; 4];

pub const RED: Color = [1.0, 0.0, 0.0, 0.5];

/// Opacity of a single footprint.
const OPACITY: f32 = 0.25;
/// How much of the ground shows through as many footprints as usually overlap, at least.
const LEAST_SHOWN: f64 = 0.3;

/// Viridis (van der Walt and Smith, public domain), evenly spaced; sRGB.
const RAMP: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/// The opacity of a footprint where so many overlap on average.
pub fn opacity(overlap: f64) -> f32 {
    OPACITY.min((1.0 - LEAST_SHOWN.powf(1.0 / overlap.max(1.0))) as f32)
}

/// A hue for an angle, of the same lightness and chroma for all (Oklab: Björn Ottosson, 2020).
pub fn of_angle(angle_rad: f64, opacity: f32) -> Color {
    let (lightness, chroma) = (0.8_f64, 0.14_f64);
    let (sin, cos) = angle_rad.sin_cos();
    let (a, b) = (chroma * cos, chroma * sin);
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    let [red, green, blue] = [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ]
    .map(|part: f64| part.clamp(0.0, 1.0) as f32);
    [red, green, blue, opacity]
}

/// Covered ground from violet (one sensor) to yellow (`most` and more); the rest stays as it is.
pub fn coverage(most: usize) -> Result<CoverageColors, SensorError> {
    CoverageColors::ramp(CLEAR, &RAMP.map(|color| srgb(color, 0.8)), most)
}

/// Ground seen by enough sensors in green, the gaps in red.
pub fn threshold(least: usize) -> Result<CoverageColors, SensorError> {
    let (enough, gap) = (srgb([60, 200, 130], 0.45), srgb([230, 60, 50], 0.4));
    CoverageColors::threshold(least, enough, gap)
}

fn srgb(bytes: [u8; 3], alpha: f32) -> Color {
    let [red, green, blue] = bytes.map(linear);
    [red, green, blue, alpha]
}

/// A colour as on the web; without the last two digits as opaque as a footprint is by default.
pub fn parse_color(text: &str) -> Result<Color, String> {
    let digits = text.trim_start_matches('#');
    let expected = || "expected six or eight hexadecimal digits, as ff8000 or ff800080".to_owned();
    if !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return Err(expected());
    }
    let byte = |index: usize| {
        let pair = digits.get(2 * index..2 * index + 2).unwrap_or("0");
        u8::from_str_radix(pair, 16).unwrap_or_default()
    };
    let alpha = match digits.len() {
        6 => OPACITY,
        8 => f32::from(byte(3)) / 255.0,
        _ => return Err(expected()),
    };
    Ok(srgb([byte(0), byte(1), byte(2)], alpha))
}
