//! Isometric latitude: the northing of Mercator's chart, in which rhumb lines are straight.

use crate::ellipsoid::Ellipsoid;

/// Isometric latitude on one ellipsoid, radians: ψ(φ) = asinh(tan φ) − e·atanh(e·sin φ).
#[derive(Clone, Copy, Debug)]
pub(crate) struct IsometricLatitude {
    eccentricity_squared: f64,
}

impl IsometricLatitude {
    pub(crate) fn new(ellipsoid: &Ellipsoid) -> Self {
        Self {
            eccentricity_squared: ellipsoid.eccentricity_squared(),
        }
    }

    /// ψ at the geodetic latitude `latitude_rad`, which is not a pole.
    pub(crate) fn at(self, latitude_rad: f64) -> f64 {
        latitude_rad.tan().asinh() - self.flattening_term(latitude_rad.sin())
    }

    /// ψ(to) − ψ(from), without cancellation however near the two are.
    pub(crate) fn difference(self, from_rad: f64, to_rad: f64) -> f64 {
        if (to_rad - from_rad).abs() > 0.1 {
            return self.at(to_rad) - self.at(from_rad);
        }
        let (half, mean) = (0.5 * (to_rad - from_rad), 0.5 * (to_rad + from_rad));
        let sin_difference = 2.0 * mean.cos() * half.sin();
        let reduced =
            sin_difference / (1.0 - self.eccentricity_squared * from_rad.sin() * to_rad.sin());
        2.0 * (half.sin() / mean.cos()).atanh() - self.flattening_term(reduced)
    }

    /// Geodetic latitude, radians, at isometric latitude `isometric`.
    pub(crate) fn latitude(self, isometric: f64) -> f64 {
        // u = asinh(tan φ) solves u = ψ + e·atanh(e·tanh u); the slope differs from 1 by e² at most.
        let mut u = isometric;
        for _ in 0..8 {
            let sin = u.tanh();
            let slope = 1.0
                - self.eccentricity_squared * (1.0 - sin * sin)
                    / (1.0 - self.eccentricity_squared * sin * sin);
            let step = (u - isometric - self.flattening_term(sin)) / slope;
            u -= step;
            if step.abs() <= 1e-16 * u.abs() {
                break;
            }
        }
        u.sinh().atan()
    }

    /// e·atanh(e·x), which for prolate ellipsoids is −|e|·atan(|e|·x).
    fn flattening_term(self, x: f64) -> f64 {
        let eccentricity = self.eccentricity_squared.abs().sqrt();
        if self.eccentricity_squared >= 0.0 {
            eccentricity * (eccentricity * x).atanh()
        } else {
            -eccentricity * (eccentricity * x).atan()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn latitude_inverts_isometric_latitude() {
        let prolate = Ellipsoid {
            a_m: 1.0,
            b_m: 1.01,
        };
        for ellipsoid in [Ellipsoid::WGS84, Ellipsoid::MARS, Ellipsoid::MOON, prolate] {
            let isometric = IsometricLatitude::new(&ellipsoid);
            for lat_deg in [-89.0, -60.0, -1e-7, 0.0, 1.0, 45.0, 88.0] {
                let latitude = f64::to_radians(lat_deg);
                assert!((isometric.latitude(isometric.at(latitude)) - latitude).abs() < 3e-16);
                for other in [1.0, latitude + 0.01, latitude + 1e-9, -latitude] {
                    let coarse = isometric.at(other) - isometric.at(latitude);
                    // The tangent near a pole carries the rounding of its angle 57 times.
                    assert!((isometric.difference(latitude, other) - coarse).abs() < 6e-14);
                }
                let near = isometric.difference(latitude, latitude + 1e-9);
                let (sin, e2) = (latitude.sin(), ellipsoid.eccentricity_squared());
                let slope = (1.0 - e2) / ((1.0 - e2 * sin * sin) * latitude.cos());
                assert!((near / ((latitude + 1e-9 - latitude) * slope) - 1.0).abs() < 1e-7);
            }
        }
    }
}
