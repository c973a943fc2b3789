//! The apex and its rays where the ellipsoid is the unit sphere.

use glam::DVec3;

use crate::ellipsoid::Ellipsoid;

/// The apex in coordinates divided by the radii. Planes stay planes there and tangents tangents, so
/// the limb and every plane section are circles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScaledApex {
    pub radii_m: DVec3,
    pub apex_ecef_m: DVec3,
    /// The apex S, |S| > 1.
    pub apex: DVec3,
    /// S² − 1, the power of the apex: the square of the length of its tangents.
    pub power: f64,
}

impl ScaledApex {
    pub(crate) fn new(ellipsoid: &Ellipsoid, apex_ecef_m: DVec3) -> Self {
        let radii_m = ellipsoid.radii_m();
        let apex = apex_ecef_m / radii_m;
        Self {
            radii_m,
            apex_ecef_m,
            apex,
            power: apex.length_squared() - 1.0,
        }
    }

    /// From the apex to the surface point `unit`, metres in ECEF.
    pub(crate) fn line_m(&self, unit: DVec3) -> DVec3 {
        unit * self.radii_m - self.apex_ecef_m
    }

    /// Bilinear form whose square is |D|²(1 − q²), q the distance of the line along D from the centre:
    /// positive if the line hits, 0 if it is tangent.
    pub(crate) fn hit_form(&self, one: DVec3, other: DVec3) -> f64 {
        // Written with the moment S × D: (S·D)² − (S² − 1)D² would cancel S² times as much.
        one.dot(other) - self.apex.cross(one).dot(self.apex.cross(other))
    }

    /// 1 − q² of the ray along an ECEF direction, −1 if it looks away: positive if it hits.
    pub(crate) fn hit_margin(&self, direction: DVec3) -> f64 {
        let scaled = direction / self.radii_m;
        if self.apex.dot(scaled) >= 0.0 {
            return -1.0;
        }
        self.hit_form(scaled, scaled) / scaled.length_squared()
    }

    /// Where the ray along an ECEF direction hits first; a ray that misses is taken to the limb.
    pub(crate) fn hit(&self, direction: DVec3) -> DVec3 {
        let scaled = direction / self.radii_m;
        self.hit_at(scaled, self.hit_form(scaled, scaled))
    }

    /// [`Self::hit`] of a scaled direction whose square in [`Self::hit_form`] is known.
    pub(crate) fn hit_at(&self, scaled: DVec3, hit_form: f64) -> DVec3 {
        // Of the two forms of a quadratic's root this is the one in which nothing cancels: the power
        // over the farther root. A tangent has −S·D = √(S² − 1)·|D|, rays that hit have more.
        let tangent = (self.power * scaled.length_squared()).sqrt();
        let farther = (-self.apex.dot(scaled)).max(tangent) + hit_form.max(0.0).sqrt();
        (self.apex + scaled * (self.power / farther)).normalize()
    }
}
