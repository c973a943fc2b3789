//! The points that sensors and surface are measured from in single precision.

use glam::DVec3;

use crate::ellipsoid::Ellipsoid;

/// The eye, its foot point, and what surface.wgsl needs of them.
///
/// "Outside" of a point P is P·M·P/a − a with M = diag(1, 1, (a/b)²), metres: 0 on the ellipsoid and
/// about twice the height near by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reference {
    pub ellipsoid: Ellipsoid,
    pub eye_ecef_m: DVec3,
    pub foot_ecef_m: DVec3,
    pub eye_height_m: f64,
    /// eye = (1 + τ M) · foot.
    pub tau: f64,
    pub outside_m: f64,
    /// |M · foot| / a.
    pub stretch: f64,
}

impl Reference {
    pub(crate) fn new(ellipsoid: Ellipsoid, eye_ecef_m: DVec3) -> Self {
        let (foot, eye_height_m) = ellipsoid.geodetic(eye_ecef_m);
        let foot_ecef_m = ellipsoid.ecef(foot, 0.0);
        let scaled = |point: DVec3| point * scale(&ellipsoid);
        let stretch = scaled(foot_ecef_m).length() / ellipsoid.a_m;
        let radii_m = ellipsoid.radii_m();
        let eye = eye_ecef_m / radii_m;
        Self {
            ellipsoid,
            eye_ecef_m,
            foot_ecef_m,
            eye_height_m,
            tau: eye_height_m / (stretch * ellipsoid.a_m),
            outside_m: (eye.length_squared() - 1.0) * ellipsoid.a_m,
            stretch,
        }
    }

    /// M times a point.
    pub(crate) fn scaled(&self, point_m: DVec3) -> DVec3 {
        point_m * scale(&self.ellipsoid)
    }
}

/// The diagonal of M.
fn scale(ellipsoid: &Ellipsoid) -> DVec3 {
    let ratio = ellipsoid.a_m / ellipsoid.b_m;
    DVec3::new(1.0, 1.0, ratio * ratio)
}
