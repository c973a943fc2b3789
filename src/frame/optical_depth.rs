//! How much of what lies below is absorbed, in a measure that adds up.

/// Greatest opacity that is drawn: more would need endless optical depth.
const MOST_OPAQUE: f32 = 0.99;

/// Optical depth of an opacity: −ln(1 − α).
pub(crate) fn optical_depth(alpha: f32) -> f64 {
    -f64::from(1.0 - alpha.min(MOST_OPAQUE)).ln()
}
