//! Colours by how many sensors cover a point.

use crate::error::SensorError;

/// Most colours of [`CoverageColors`].
pub const MAX_COLORS: usize = 65_536;

/// Red, green, blue, alpha, 0 … 1, not premultiplied.
type Color = [f32; 4];

/// No colour at all.
pub const CLEAR: Color = [0.0; 4];

/// Colours by how many sensors cover a surface point: entry k for k sensors, the last for more.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "Vec<Color>", into = "Vec<Color>")
)]
pub struct CoverageColors(Vec<Color>);

#[cfg(feature = "serde")]
impl TryFrom<Vec<Color>> for CoverageColors {
    type Error = SensorError;

    fn try_from(colors: Vec<Color>) -> Result<Self, SensorError> {
        Self::table(colors)
    }
}

#[cfg(feature = "serde")]
impl From<CoverageColors> for Vec<Color> {
    fn from(colors: CoverageColors) -> Self {
        colors.0
    }
}

impl CoverageColors {
    /// A colour for every count from 0 up; the last serves for all greater counts.
    ///
    /// # Errors
    /// [`SensorError::Color`] if a part of a colour is not within 0 … 1, [`SensorError::Colors`] unless
    /// there are 1 … [`MAX_COLORS`].
    pub fn table(colors: Vec<Color>) -> Result<Self, SensorError> {
        if !(1..=MAX_COLORS).contains(&colors.len()) {
            return Err(SensorError::Colors(colors.len()));
        }
        colors.iter().try_for_each(check)?;
        Ok(Self(colors))
    }

    /// A ramp: `gap` where no sensor looks, then through `stops`, evenly spaced from one sensor to
    /// `most` sensors and more.
    ///
    /// # Errors
    /// As [`table`](Self::table), for `stops` and `most`.
    pub fn ramp(gap: Color, stops: &[Color], most: usize) -> Result<Self, SensorError> {
        if stops.is_empty() || !(1..MAX_COLORS).contains(&most) {
            return Err(SensorError::Colors(stops.len().min(most)));
        }
        let last = stops.len() - 1;
        let at = |count: usize| {
            let part = (count - 1) as f32 / (most - 1).max(1) as f32 * last as f32;
            let stop = (part as usize).min(last.saturating_sub(1));
            let (from, to) = (stops[stop], stops[(stop + 1).min(last)]);
            std::array::from_fn(|k| from[k] + (to[k] - from[k]) * (part - stop as f32))
        };
        Self::table([gap].into_iter().chain((1..=most).map(at)).collect())
    }

    /// N-fold coverage: `enough` where at least `least` sensors look, `gap` elsewhere.
    ///
    /// # Errors
    /// As [`table`](Self::table); `least` must be at least 1.
    pub fn threshold(least: usize, enough: Color, gap: Color) -> Result<Self, SensorError> {
        if !(1..MAX_COLORS).contains(&least) {
            return Err(SensorError::Colors(least));
        }
        let mut colors = vec![gap; least];
        colors.push(enough);
        Self::table(colors)
    }

    /// Whether a surface point that no sensor covers is coloured.
    pub(crate) fn colors_gaps(&self) -> bool {
        self.0[0][3] > 0.0
    }

    /// The colours, premultiplied.
    pub(crate) fn premultiplied(&self) -> impl Iterator<Item = Color> {
        self.0.iter().map(|&[r, g, b, a]| [r * a, g * a, b * a, a])
    }
}

/// Checks that all parts of a colour are within 0 … 1.
pub(crate) fn check(color: &Color) -> Result<(), SensorError> {
    if color.iter().all(|part| (0.0..=1.0).contains(part)) {
        Ok(())
    } else {
        Err(SensorError::Color(*color))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: Color = [1.0, 0.0, 0.0, 1.0];
    const BLUE: Color = [0.0, 0.0, 1.0, 1.0];

    #[test]
    fn a_ramp_runs_from_one_to_most() {
        let ramp = CoverageColors::ramp(CLEAR, &[RED, BLUE], 5).unwrap();
        assert_eq!(ramp.0.len(), 6);
        assert_eq!(ramp.0[0], CLEAR);
        assert_eq!(ramp.0[1], RED);
        assert_eq!(ramp.0[3], [0.5, 0.0, 0.5, 1.0]);
        assert_eq!(ramp.0[5], BLUE);
        assert!(!ramp.colors_gaps());
        assert_eq!(
            CoverageColors::ramp(CLEAR, &[RED], 1).unwrap().0,
            [CLEAR, RED]
        );
    }

    #[test]
    fn a_threshold_is_a_step() {
        let fourfold = CoverageColors::threshold(4, BLUE, RED).unwrap();
        assert_eq!(fourfold.0, [RED, RED, RED, RED, BLUE]);
        assert!(fourfold.colors_gaps());
    }

    #[test]
    fn bad_colors_are_named() {
        assert_eq!(
            CoverageColors::table(vec![RED, [2.0, 0.0, 0.0, 1.0]]),
            Err(SensorError::Color([2.0, 0.0, 0.0, 1.0]))
        );
        assert!(CoverageColors::table(vec![[f32::NAN; 4]]).is_err());
        assert_eq!(CoverageColors::table(vec![]), Err(SensorError::Colors(0)));
        assert_eq!(
            CoverageColors::threshold(0, RED, BLUE),
            Err(SensorError::Colors(0))
        );
        assert_eq!(
            CoverageColors::ramp(RED, &[], 3),
            Err(SensorError::Colors(0))
        );
    }
}
