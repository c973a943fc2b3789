//! Images that have their place on the globe.

use crate::{error::StyleError, extents::Extents, geodetic::LonLat, image::ImageId};

/// An image laid on the ellipsoid.
///
/// Its place does not depend on the fill that shows it: several fills may share one picture, and a fill
/// that moves reveals other parts of it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct ImageFill {
    /// The image.
    pub image: ImageId,
    /// Where it lies.
    #[cfg_attr(feature = "serde", serde(default = "over_extents"))]
    pub placement: Placement,
    /// What lies outside of it.
    #[cfg_attr(feature = "serde", serde(default))]
    pub wrap: Wrap,
    /// Turns the image about its middle, radians clockwise.
    #[cfg_attr(feature = "serde", serde(default))]
    pub rotation_rad: f32,
    /// How often the image stands side by side in its place, across and down, from 10⁻⁴ to 10⁴, with one
    /// in the very middle; less than 1 shows a part from the middle. It takes [`Wrap::Repeat`] to see more than one.
    #[cfg_attr(feature = "serde", serde(default = "once"))]
    pub repeats: [f32; 2],
    /// What the image's alpha is multiplied with, 0 … 1.
    #[cfg_attr(feature = "serde", serde(default = "opaque"))]
    pub opacity: f32,
}

/// Where an image lies.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case", deny_unknown_fields)
)]
pub enum Placement {
    /// Across longitudes and down geodetic latitudes in proportion (an equirectangular picture).
    /// None: over the extents of the fill, [`FillMesh::extents`](crate::FillMesh::extents).
    Geodetic(Option<Extents>),
    /// Across longitudes and down geocentric latitudes in proportion, as textures of spheres do. The
    /// extents are geodetic all the same.
    Spherical(Option<Extents>),
    /// On the map of [`Hatch`](crate::Hatch) about a point: for small and polar places, where
    /// longitudes converge.
    Local {
        /// Under the middle of the image.
        center: LonLat,
        /// Width and height, metres at the centre.
        size_m: [f32; 2],
    },
}

/// What lies outside an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Wrap {
    /// Nothing: the colour below.
    #[default]
    Clip,
    /// The image's edge.
    Clamp,
    /// The image again.
    Repeat,
}

fn over_extents() -> Placement {
    Placement::Geodetic(None)
}

fn once() -> [f32; 2] {
    [1.0; 2]
}

fn opaque() -> f32 {
    1.0
}

impl ImageFill {
    /// The image over the extents of the fill that shows it.
    pub fn new(image: ImageId) -> Self {
        Self {
            image,
            placement: over_extents(),
            wrap: Wrap::default(),
            rotation_rad: 0.0,
            repeats: once(),
            opacity: opaque(),
        }
    }

    pub(crate) fn check(&self) -> Result<(), StyleError> {
        let placed = match self.placement {
            Placement::Geodetic(extents) | Placement::Spherical(extents) => {
                extents.is_none_or(|extents| extents.is_valid())
            }
            Placement::Local { center, size_m } => {
                center.is_valid() && size_m.iter().all(|side| (1e-3..=4e8).contains(side))
            }
        };
        let repeats = |count: f32| (1e-4..=1e4).contains(&count);
        let checks = [
            ("pattern.placement", placed),
            ("pattern.rotation_rad", self.rotation_rad.is_finite()),
            ("pattern.repeats", self.repeats.into_iter().all(repeats)),
            ("pattern.opacity", (0.0..=1.0).contains(&self.opacity)),
        ];
        match checks.into_iter().find(|(_, sound)| !sound) {
            Some((name, _)) => Err(StyleError::OutOfRange(name)),
            None => Ok(()),
        }
    }
}
