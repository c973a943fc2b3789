//! The oracle's own geodesy: nothing here is shared with the crate but the numbers a and b.

use glam::DVec3;
use globefill::{Ellipsoid, LonLat};

/// An oblate ellipsoid of revolution or a sphere.
#[derive(Clone, Copy, Debug)]
pub struct Figure {
    pub a_m: f64,
    pub b_m: f64,
    e2: f64,
}

impl Figure {
    pub fn new(ellipsoid: Ellipsoid) -> Self {
        let (a_m, b_m) = (ellipsoid.a_m, ellipsoid.b_m);
        assert!(b_m <= a_m, "the oracle knows oblate figures only");
        Self {
            a_m,
            b_m,
            e2: (a_m - b_m) * (a_m + b_m) / (a_m * a_m),
        }
    }

    pub fn normal(&self, p: LonLat) -> DVec3 {
        let (lon, lat) = (p.lon_deg.to_radians(), p.lat_deg.to_radians());
        // sin of the colatitude keeps the pole exact, where cos(90°) would not be 0.
        let axis_distance = (90.0 - p.lat_deg.abs()).to_radians().sin();
        DVec3::new(
            axis_distance * lon.cos(),
            axis_distance * lon.sin(),
            lat.sin(),
        )
    }

    pub fn ecef(&self, p: LonLat, height_m: f64) -> DVec3 {
        let normal = self.normal(p);
        let prime_vertical_m = self.a_m / (1.0 - self.e2 * normal.z * normal.z).sqrt();
        DVec3::new(
            (prime_vertical_m + height_m) * normal.x,
            (prime_vertical_m + height_m) * normal.y,
            (prime_vertical_m * (1.0 - self.e2) + height_m) * normal.z,
        )
    }

    /// Geodetic foot point and height: H. Vermeille, An analytical method to transform geocentric
    /// into geodetic coordinates, J. Geodesy 85 (2011) 105–117, outside the evolute (deeper than
    /// 43 km from the centre of the Earth it is not asked).
    pub fn geodetic(&self, ecef_m: DVec3) -> (LonLat, f64) {
        let axis_distance_m = ecef_m.x.hypot(ecef_m.y);
        let e2 = self.e2;
        let p = (axis_distance_m / self.a_m).powi(2);
        let q = (1.0 - e2) * (ecef_m.z / self.a_m).powi(2);
        let r = (p + q - e2 * e2) / 6.0;
        let evolute = 8.0 * r * r * r + e2 * e2 * p * q;
        assert!(evolute > 0.0, "{ecef_m} lies inside the evolute");
        let l = (evolute.sqrt() + (e2 * e2 * p * q).sqrt()).powi(2).cbrt();
        let u = r + 0.5 * l + 2.0 * r * r / l;
        let v = (u * u + e2 * e2 * q).sqrt();
        let w = e2 * (u + v - q) / (2.0 * v);
        let k = (u + v) / ((w * w + u + v).sqrt() + w);
        let d = k * axis_distance_m / (k + e2);
        let length = d.hypot(ecef_m.z);
        let lat_rad = 2.0 * ecef_m.z.atan2(length + d);
        let height_m = (k + e2 - 1.0) / k * length;
        let lon_deg = ecef_m.y.atan2(ecef_m.x).to_degrees();
        (LonLat::new(lon_deg, lat_rad.to_degrees()), height_m)
    }

    /// Isometric latitude ψ: a rhumb line is straight in (longitude, ψ).
    pub fn isometric_rad(&self, lat_deg: f64) -> f64 {
        let lat = lat_deg.to_radians();
        let e = self.e2.sqrt();
        lat.tan().asinh() - e * (e * lat.sin()).atanh()
    }

    /// Latitude of an isometric latitude. The fixed point gains a factor e² each round.
    pub fn latitude_deg(&self, isometric_rad: f64) -> f64 {
        let e = self.e2.sqrt();
        let mut sin = isometric_rad.tanh();
        for _ in 0..10 {
            sin = (isometric_rad + e * (e * sin).atanh()).tanh();
        }
        (isometric_rad + e * (e * sin).atanh())
            .sinh()
            .atan()
            .to_degrees()
    }

    /// Area between the equator and `lat_deg`, divided by that of the hemisphere; odd.
    pub fn area_share(&self, lat_deg: f64) -> f64 {
        let q = |sin: f64| {
            if self.e2 == 0.0 {
                return 2.0 * sin;
            }
            let e = self.e2.sqrt();
            (1.0 - self.e2) * (sin / (1.0 - self.e2 * sin * sin) + (e * sin).atanh() / e)
        };
        q(lat_deg.to_radians().sin()) / q(1.0)
    }

    /// Where the ray `eye + t · direction` enters the ellipsoid `height_m` larger in both axes.
    pub fn first_hit(&self, eye_m: DVec3, direction: DVec3, height_m: f64) -> Option<f64> {
        let (near, _) = self.hits(eye_m, direction, height_m)?;
        (near > 0.0).then_some(near)
    }

    /// Both parameters at which the ray's line meets the ellipsoid `height_m` larger.
    pub fn hits(&self, eye_m: DVec3, direction: DVec3, height_m: f64) -> Option<(f64, f64)> {
        let (a, b) = (self.a_m + height_m, self.b_m + height_m);
        let scale = DVec3::new(1.0 / a, 1.0 / a, 1.0 / b);
        let (o, d) = (eye_m * scale, direction * scale);
        let (qa, qb) = (d.dot(d), o.dot(d));
        let qc = (o.length() - 1.0) * (o.length() + 1.0);
        // The foot of the perpendicular gives the discriminant without cancellation at the limb.
        let miss = (o - d * (qb / qa)).length();
        let discriminant = qa * (1.0 - miss) * (1.0 + miss);
        if discriminant < 0.0 {
            return None;
        }
        let root = discriminant.sqrt();
        let (first, second) = if qb < 0.0 {
            (qc / (-qb + root), (-qb + root) / qa)
        } else {
            ((-qb - root) / qa, -qc / (qb + root))
        };
        Some((first, second))
    }
}
