//! Lengths on the ground or on the screen.

/// A length of a pattern or of a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Length {
    /// Metres on the ellipsoid.
    Metres(f32),
    /// Pixels of the picture.
    Pixels(f32),
}

/// What lengths may be: from a millimetre to ten times round the Earth, from 1/64 px to more than any
/// screen.
const METRES: std::ops::RangeInclusive<f32> = 1e-3..=4e8;
const PIXELS: std::ops::RangeInclusive<f32> = 1.0 / 64.0..=65536.0;

impl Length {
    /// Whether it is one that can be drawn: 10⁻³ … 4·10⁸ m or 1/64 … 65 536 px.
    pub fn is_sound(self) -> bool {
        match self {
            Self::Metres(metres) => METRES.contains(&metres),
            Self::Pixels(pixels) => PIXELS.contains(&pixels),
        }
    }
}
