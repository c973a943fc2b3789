//! Bounding caps on the unit sphere that the ellipsoid becomes when divided by its radii.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use crate::{ellipsoid::Ellipsoid, fill_mesh::Bounds};

impl Bounds {
    /// A cap that holds the points, all chords and triangles between them, and what lies within
    /// `margin_m` of those.
    ///
    /// A cap smaller than a hemisphere holds the great arcs and spherical triangles between its
    /// points; a greater one is taken to be the whole sphere.
    pub(crate) fn around(
        ellipsoid: &Ellipsoid,
        ecef_m: impl Iterator<Item = DVec3> + Clone,
        margin_m: f64,
    ) -> Self {
        let inverse_radii = ellipsoid.radii_m().recip();
        let unit = ecef_m.map(|point| (point * inverse_radii).normalize());
        let sum: DVec3 = unit.clone().sum();
        let axis = sum.try_normalize().unwrap_or(DVec3::Z);
        // The angle from the chord: the cosine of a small angle knows it to 10⁻⁸ only.
        let chord_squared = unit
            .map(|point| point.distance_squared(axis))
            .fold(0.0, f64::max);
        let half_chord = 0.5 * chord_squared.sqrt();
        let margin = margin_m / ellipsoid.a_m.min(ellipsoid.b_m) + 1e-12;
        let radius_rad = 2.0 * half_chord.min(1.0).asin() + margin;
        Self {
            axis,
            radius_rad: if radius_rad < FRAC_PI_2 {
                radius_rad
            } else {
                PI
            },
        }
    }

    /// Everything.
    pub(crate) fn globe() -> Self {
        Self {
            axis: DVec3::Z,
            radius_rad: PI,
        }
    }
}
