//! Images that have their place on the globe.

use crate::{error::StyleError, extents::Extents, geodetic::LonLat, image::ImageId};

/// An image laid on the ellipsoid.
///
/// Its place does not depend on the fill that shows it: several fills may share one picture, and a fill
/// that moves reveals other parts of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageFill {
    /// The image.
    pub image: ImageId,
    /// Where it lies.
    pub placement: Placement,
    /// What lies outside of it.
    pub wrap: Wrap,
    /// Turns the image about its middle, radians clockwise.
    pub rotation_rad: f32,
    /// How often the image stands side by side in its place, across and down, from 10⁻⁴ to 10⁴, with one
    /// in the very middle; less than 1 shows a part from the middle. It takes [`Wrap::Repeat`] to see more than one.
    pub repeats: [f32; 2],
    /// What the image's alpha is multiplied with, 0 … 1.
    pub opacity: f32,
}

/// Where an image lies.
#[derive(Clone, Copy, Debug, PartialEq)]
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
pub enum Wrap {
    /// Nothing: the colour below.
    #[default]
    Clip,
    /// The image's edge.
    Clamp,
    /// The image again.
    Repeat,
}

impl ImageFill {
    /// The image over the extents of the fill that shows it.
    pub fn new(image: ImageId) -> Self {
        Self {
            image,
            placement: Placement::Geodetic(None),
            wrap: Wrap::default(),
            rotation_rad: 0.0,
            repeats: [1.0; 2],
            opacity: 1.0,
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
