//! Patterns that repeat: hatching.

use crate::{
    error::StyleError,
    geodetic::LonLat,
    image::ImageId,
    length::Length,
    style::{check_color, check_length},
};

/// A pattern that repeats in two directions on the ellipsoid.
///
/// It lies on a map about its [`anchor`](Self::anchor): the ellipsoid seen from the anchor's antipode,
/// on the anchor's tangent plane (stereographic, conformal on a sphere). Straight lines there and
/// distances are true at the anchor; c radians away distances are drawn smaller by cos²(c/2), which is
/// 0.2 % at 600 km and one half at 90°. The map has no seam but the antipode itself: neither poles nor
/// the antimeridian show.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Hatch {
    /// What repeats.
    pub kind: HatchKind,
    /// Red, green, blue, alpha of the lines, dots or dark squares, as in
    /// [`FillStyle::color`](crate::FillStyle::color), over which it lies.
    /// What [`HatchKind::Image`] is multiplied with.
    pub color: [f32; 4],
    /// From line to line, from dot to dot, the side of a square, the width of an image.
    ///
    /// In metres it is that at the anchor. In pixels, it is met within a factor √2 anywhere on the
    /// screen at any distance: the pattern repeats every 2ᵏ m, at each pixel in each of its two
    /// directions (of an image: once for both) for the k that fits best, and while k changes every other
    /// line grows and the ones between vanish. Over terrain, slopes are taken to be seen at 12° or more:
    /// level ground that is seen more obliquely shows the pattern closer.
    pub spacing: Length,
    /// Which share of the surface lines or dots cover, 0 … 1; it is kept at every scale.
    /// Of crossed lines: each family. Of dots: at most 0.6. Checkers and images do not ask it.
    pub share: f32,
    /// Angle of the lines, radians clockwise from north at the anchor.
    pub angle_rad: f32,
    /// Where the pattern is true, and a line or dot lies. None: the middle of the fill
    /// ([`FillMesh::centroid`](crate::FillMesh::centroid)), so fills that are to share one pattern need
    /// an anchor in common.
    pub anchor: Option<LonLat>,
}

/// What repeats.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum HatchKind {
    /// Parallel lines.
    #[default]
    Lines,
    /// Two families of lines at right angles.
    Cross,
    /// Dots on a square grid.
    Dots,
    /// Squares like those of a chess board.
    Checker,
    /// An image.
    Image(ImageId),
}

impl Default for Hatch {
    fn default() -> Self {
        Self {
            kind: HatchKind::Lines,
            color: [0.0, 0.0, 0.0, 1.0],
            spacing: Length::Pixels(12.0),
            share: 0.25,
            angle_rad: std::f32::consts::FRAC_PI_4,
            anchor: None,
        }
    }
}

/// Most of the surface that dots cover without touching while every other one grows.
const MOST_DOTS: f32 = 0.6;

impl Hatch {
    pub(crate) fn check(&self) -> Result<(), StyleError> {
        check_color("pattern.color", self.color)?;
        check_length("pattern.spacing", self.spacing)?;
        let most = match self.kind {
            HatchKind::Dots => MOST_DOTS,
            _ => 1.0,
        };
        if !(0.0..=most).contains(&self.share) {
            return Err(StyleError::OutOfRange("pattern.share"));
        }
        if !self.angle_rad.is_finite() {
            return Err(StyleError::OutOfRange("pattern.angle_rad"));
        }
        if self.anchor.is_some_and(|anchor| !anchor.is_valid()) {
            return Err(StyleError::OutOfRange("pattern.anchor"));
        }
        Ok(())
    }
}
