//! Lines along the boundaries of fills.

use crate::{
    error::StyleError,
    length::Length,
    style::{check_color, check_length},
};

/// A line along the boundary of a fill, smooth-edged, on the surface like the fill itself.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Stroke {
    /// Red, green, blue, alpha, as in [`FillStyle::color`](crate::FillStyle::color); over the fill.
    pub color: [f32; 4],
    /// How wide the line is: up to 200 km or 256 px.
    pub width: Length,
    /// On which side of the boundary it lies.
    pub align: Align,
    /// Dashes. None: solid.
    pub dash: Option<Dash>,
}

/// On which side of a boundary its stroke lies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Align {
    /// In the fill.
    #[default]
    Inner,
    /// Half in the fill, half outside.
    Center,
    /// Outside the fill.
    Outer,
}

/// Dashes along a boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Dash {
    /// From the start of a dash to the start of the next. In pixels it is met within a factor √2, like
    /// the spacing of a [`Hatch`](crate::Hatch).
    pub period: Length,
    /// Which share of the period is drawn, 0 … 1.
    pub share: f32,
}

impl Default for Stroke {
    fn default() -> Self {
        Self {
            color: [1.0, 1.0, 1.0, 1.0],
            width: Length::Pixels(2.0),
            align: Align::default(),
            dash: None,
        }
    }
}

/// Widest strokes: distances are measured from the plane of a chord, which the ellipsoid leaves, and
/// every boundary is drawn as wide.
const MOST_M: f32 = 2e5;
const MOST_PX: f32 = 256.0;

impl Stroke {
    pub(crate) fn check(&self) -> Result<(), StyleError> {
        check_color("stroke.color", self.color)?;
        check_length("stroke.width", self.width)?;
        let wide = match self.width {
            Length::Metres(metres) => metres > MOST_M,
            Length::Pixels(pixels) => pixels > MOST_PX,
        };
        if wide {
            return Err(StyleError::OutOfRange("stroke.width"));
        }
        if let Some(dash) = self.dash {
            check_length("stroke.dash.period", dash.period)?;
            if !(0.0..=1.0).contains(&dash.share) {
                return Err(StyleError::OutOfRange("stroke.dash.share"));
            }
        }
        Ok(())
    }
}
