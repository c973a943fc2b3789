//! How a fill looks.

use crate::{
    error::StyleError,
    hatch::{Hatch, HatchKind},
    image::ImageId,
    image_fill::ImageFill,
    length::Length,
    stroke::Stroke,
};

/// How a fill looks: from below a colour, a pattern on it, a highlight, and a stroke along its boundary.
///
/// Patterns, strokes and fades, and smooth edges, need all meshes of a renderer on one ellipsoid.
///
/// What a style does not use costs nothing: a frame of colours alone is drawn by a pipeline that
/// knows no patterns, strokes or fades, and needs no surface positions.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct FillStyle {
    /// Red, green, blue, alpha, 0 … 1, not premultiplied, written to the colour target as they are:
    /// linear values for an sRGB format.
    pub color: [f32; 4],
    /// Laid over the colour, which shows through where the pattern is transparent.
    pub pattern: Option<Pattern>,
    /// Laid over colour and pattern alike, in the same units; alpha 0 for none. To show that a fill is
    /// selected without touching the rest of its style.
    pub highlight: [f32; 4],
    /// A line along the boundary.
    pub stroke: Option<Stroke>,
    /// What the whole fill, its stroke included, is multiplied with, 0 … 1.
    pub opacity: f32,
    /// Where the fill, its stroke included, fades.
    pub fade: Fade,
    /// How the fill meets what is below.
    pub blend: Blend,
    /// Where fills overlap, the greater lies on top; equal ones in the order of insertion. Without meaning
    /// for [`Blend::Unordered`].
    pub z_index: i32,
    /// Whether the fill is drawn at all.
    pub visible: bool,
}

impl Default for FillStyle {
    fn default() -> Self {
        Self {
            color: [1.0, 0.8, 0.1, 0.5],
            pattern: None,
            highlight: [0.0; 4],
            stroke: None,
            opacity: 1.0,
            fade: Fade::default(),
            blend: Blend::Alpha,
            z_index: 0,
            visible: true,
        }
    }
}

/// What may lie over a fill's colour.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Pattern {
    /// Lines, crossed lines, dots, a checker or an image of one's own, repeated.
    Hatch(Hatch),
    /// A picture that has its place on the globe.
    Image(ImageFill),
}

impl Pattern {
    /// The image it shows.
    pub fn image(&self) -> Option<ImageId> {
        match self {
            Self::Hatch(Hatch {
                kind: HatchKind::Image(image),
                ..
            }) => Some(*image),
            Self::Hatch(_) => None,
            Self::Image(fill) => Some(fill.image),
        }
    }
}

impl FillStyle {
    /// The same style with its image, if it shows one, exchanged for what `image` answers.
    ///
    /// For styles that were written to a file: the images in them are those of the renderer that they
    /// were set in, and are to be inserted anew.
    pub fn map_image(mut self, image: impl FnOnce(ImageId) -> ImageId) -> Self {
        match &mut self.pattern {
            Some(Pattern::Hatch(Hatch {
                kind: HatchKind::Image(shown),
                ..
            })) => *shown = image(*shown),
            Some(Pattern::Image(fill)) => fill.image = image(fill.image),
            Some(Pattern::Hatch(_)) | None => {}
        }
        self
    }
}

/// How a fill meets what is below it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Blend {
    /// Over it: premultiplied alpha.
    #[default]
    Alpha,
    /// Added to it, like light.
    Additive,
    /// Mixed, in no order, with all others of this kind that cover the point, as filters that lie on each
    /// other: together they are as opaque as one on the other, and their colours count by optical depth,
    /// −ln(1 − α). For zones that overlap by the hundred: however many do, they are counted together.
    ///
    /// They lie above fills of the other kinds and below sensors, and cannot be picked in the picture; a
    /// [`Locator`](crate::Locator) tells which are at a point. Colours are clamped to 0 … 1, alphas to 0.99.
    /// They have no pattern, stroke or fade, and their boundaries are as hard as samples make them.
    Unordered,
}

/// Where a fill fades, decided at each pixel; the ramps that are given multiply.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Fade {
    /// By the distance from the eye to the surface, metres.
    pub distance_m: Option<Ramp>,
    /// By the length that a pixel spans across the line of sight, metres: the same for a far eye as for
    /// a wide angle of view.
    pub pixel_m: Option<Ramp>,
    /// By the angle between the line of sight and the ellipsoid's tangent plane, radians: π/2 where
    /// looking straight down, 0 at the limb. Between the two in proportion to its sine.
    pub angle_rad: Option<Ramp>,
}

/// Full opacity at one value, none at the other, in between in proportion. Either may be the greater.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Ramp {
    /// Here and beyond nothing fades.
    pub full: f32,
    /// Here and beyond nothing is left.
    pub gone: f32,
}

/// Sines of the angles of a fade differ by no less.
const LEAST_SINES: f32 = 1e-6;

impl Ramp {
    /// Whether the way from one end to the other can be told in single precision.
    fn is_sound(self) -> bool {
        let span = (self.full - self.gone).abs();
        let largest = self.full.abs().max(self.gone.abs());
        span.is_finite() && span >= 1e-6 * largest && span >= 1e-9
    }
}

impl FillStyle {
    /// Whether anything of the fill is drawn.
    pub(crate) fn shows(&self) -> bool {
        let painted = self.color[3] > 0.0 || self.highlight[3] > 0.0;
        let patterned = self.pattern.is_some_and(|pattern| match pattern {
            Pattern::Hatch(hatch) => hatch.color[3] > 0.0,
            Pattern::Image(image) => image.opacity > 0.0,
        });
        let stroked = self.stroke.is_some_and(|stroke| stroke.color[3] > 0.0);
        self.visible && self.opacity > 0.0 && (painted || patterned || stroked)
    }

    /// Colour, highlight, opacity and blend of a solid fill in one: premultiplied, with the alpha that
    /// hides what is below.
    pub(crate) fn solid_color(&self) -> [f32; 4] {
        let mut parts = self.shown(premultiplied(self.color));
        if self.blend == Blend::Additive {
            parts[3] = 0.0;
        }
        parts
    }

    /// A premultiplied colour under the highlight, with the opacity.
    pub(crate) fn shown(&self, color: [f32; 4]) -> [f32; 4] {
        over(premultiplied(self.highlight), color).map(|part| self.opacity * part)
    }

    /// Checks all that does not depend on the renderer.
    pub(crate) fn check(&self) -> Result<(), StyleError> {
        check_color("color", self.color)?;
        check_color("highlight", self.highlight)?;
        let plain = self.pattern.is_none() && self.stroke.is_none() && self.fade == Fade::default();
        if self.blend == Blend::Unordered && !plain {
            return Err(StyleError::UnorderedIsPlain);
        }
        check_share("opacity", self.opacity)?;
        let ramps = [
            ("fade.distance_m", self.fade.distance_m),
            ("fade.pixel_m", self.fade.pixel_m),
            ("fade.angle_rad", self.fade.angle_rad),
        ];
        for (name, ramp) in ramps {
            if ramp.is_some_and(|ramp| !ramp.is_sound()) {
                return Err(StyleError::OutOfRange(name));
            }
        }
        let quarter = 0.0..=std::f32::consts::FRAC_PI_2;
        if let Some(Ramp { full, gone }) = self.fade.angle_rad
            && !(quarter.contains(&full)
                && quarter.contains(&gone)
                && (full.sin() - gone.sin()).abs() >= LEAST_SINES)
        {
            return Err(StyleError::OutOfRange("fade.angle_rad"));
        }
        match &self.pattern {
            Some(Pattern::Hatch(hatch)) => hatch.check()?,
            Some(Pattern::Image(image)) => image.check()?,
            None => {}
        }
        self.stroke.as_ref().map_or(Ok(()), Stroke::check)
    }
}

/// A colour's parts are finite and its alpha is a share.
pub(crate) fn check_color(name: &'static str, color: [f32; 4]) -> Result<(), StyleError> {
    if color.iter().all(|part| part.is_finite()) {
        check_share(name, color[3])
    } else {
        Err(StyleError::OutOfRange(name))
    }
}

pub(crate) fn check_share(name: &'static str, share: f32) -> Result<(), StyleError> {
    if (0.0..=1.0).contains(&share) {
        Ok(())
    } else {
        Err(StyleError::OutOfRange(name))
    }
}

pub(crate) fn check_length(name: &'static str, length: Length) -> Result<(), StyleError> {
    if length.is_sound() {
        Ok(())
    } else {
        Err(StyleError::OutOfRange(name))
    }
}

/// One premultiplied colour over another.
pub(crate) fn over(above: [f32; 4], below: [f32; 4]) -> [f32; 4] {
    std::array::from_fn(|part| above[part] + below[part] * (1.0 - above[3]))
}

/// A colour multiplied by its alpha.
pub(crate) fn premultiplied([red, green, blue, alpha]: [f32; 4]) -> [f32; 4] {
    [red * alpha, green * alpha, blue * alpha, alpha]
}
