//! A chart of equal area: ellipsoid → authalic sphere → Lambert's azimuthal projection.

use glam::{DVec2, DVec3};

use crate::{ellipsoid::Ellipsoid, outline::Stretch};

/// Terms of the series in e²: at a flattening of 1/50 the next is 10⁻¹⁷.
const TERMS: usize = 12;

/// Lambert's chart about a pole on the unit sphere of equal area, in radii: areas are steradians.
/// Only the pole's antipode has no place in it.
#[derive(Clone, Debug)]
pub(crate) struct AuthalicChart {
    ellipsoid: Ellipsoid,
    /// Axes of the chart and its pole, right-handed.
    right: DVec3,
    up: DVec3,
    pole: DVec3,
    square_radius_m2: f64,
    /// sin β = s·Σ gₖ s²ᵏ of the authalic latitude β, s being the sine of the geodetic latitude.
    sine: [f64; TERMS],
    /// (1 − Σ gₖ s²ᵏ)/(1 − s²), which tells cos β without cancellation.
    cosine: [f64; TERMS],
}

impl AuthalicChart {
    /// A chart about `pole`, a unit vector of the authalic sphere.
    pub(crate) fn new(ellipsoid: &Ellipsoid, pole: DVec3) -> Self {
        // Between the equator and φ lie b²·s·Σ (k+1)/(2k+1)·(e·s)²ᵏ m² a radian of longitude.
        let e2 = ellipsoid.eccentricity_squared();
        let mut power = 1.0;
        let mut sine = std::array::from_fn(|k| {
            let term = power * (k + 1) as f64 / (2 * k + 1) as f64;
            power *= e2;
            term
        });
        let sum: f64 = sine.iter().rev().sum();
        sine = sine.map(|term: f64| term / sum);
        let cosine = std::array::from_fn(|j| sine[j + 1..].iter().rev().sum());
        let (right, up) = pole.any_orthonormal_pair();
        Self {
            ellipsoid: *ellipsoid,
            right,
            up,
            pole,
            square_radius_m2: ellipsoid.b_m * ellipsoid.b_m * sum,
            sine,
            cosine,
        }
    }

    /// Square of the authalic radius: m² a steradian.
    pub(crate) fn square_radius_m2(&self) -> f64 {
        self.square_radius_m2
    }

    /// Area of the ellipsoid, m².
    pub(crate) fn globe_m2(&self) -> f64 {
        super::GLOBE_SR * self.square_radius_m2
    }

    /// The point of the unit authalic sphere for a point of the ellipsoid given by its normal.
    pub(crate) fn authalic(&self, normal: DVec3) -> DVec3 {
        let s2 = normal.z * normal.z;
        let series = |terms: &[f64; TERMS]| terms.iter().rev().fold(0.0, |sum, c| sum * s2 + c);
        let (factor, s) = (series(&self.sine), normal.z.abs());
        // cos²β = (1 − sin β)(1 + sin β), and 1 − sin β = cos²φ·(1/(1+s) + s·…).
        let stretch = (1.0 / (1.0 + s) + s * series(&self.cosine)) * (1.0 + s * factor);
        let widening = stretch.sqrt();
        DVec3::new(normal.x * widening, normal.y * widening, normal.z * factor)
    }

    /// Where a point of the ellipsoid lies in the chart.
    pub(crate) fn place(&self, ecef_m: DVec3) -> DVec2 {
        let point = self.authalic(self.ellipsoid.normal_at_surface(ecef_m));
        // √(2/(1 + p·u)) = 2/|u + p|, which keeps its digits near the antipode.
        let scale = 2.0 / (point + self.pole).length().max(f64::MIN_POSITIVE);
        // Near the pole the difference is small and exact.
        let offset = point - self.pole;
        DVec2::new(offset.dot(self.right), offset.dot(self.up)) * scale
    }

    /// A pole whose antipode lies far from an outline.
    pub(crate) fn pole_for<S: Stretch>(ellipsoid: &Ellipsoid, stretches: &[S]) -> DVec3 {
        let chart = Self::new(ellipsoid, DVec3::Z);
        let per_stretch = (256 / stretches.len().max(1)).clamp(4, 64);
        let mut samples = Vec::with_capacity(stretches.len() * per_stretch);
        let mut vector_area = DVec3::ZERO;
        for stretch in stretches {
            let at = |k: usize| {
                let ecef_m = stretch.ecef_m(k as f64 / per_stretch as f64);
                chart.authalic(ellipsoid.normal_at_surface(ecef_m))
            };
            samples.extend((0..per_stretch).map(at));
            let own = samples[samples.len() - per_stretch..].windows(2);
            vector_area += own.map(|pair| pair[0].cross(pair[1])).sum::<DVec3>();
            let last = samples[samples.len() - 1];
            vector_area += last.cross(at(per_stretch));
        }
        let farthest = |pole: DVec3| {
            let cosines = samples.iter().map(|sample| sample.dot(pole));
            cosines.fold(1.0, f64::min)
        };
        let middle = vector_area.normalize_or(DVec3::Z);
        let mut best = (f64::NEG_INFINITY, DVec3::Z);
        for direction in directions().chain([middle]) {
            for pole in [direction, -direction] {
                let least_cosine = farthest(pole);
                if least_cosine > best.0 {
                    best = (least_cosine, pole);
                }
            }
        }
        best.1
    }
}

/// Unit vectors to the faces, edges and corners of a cube, one of each antipodal pair.
fn directions() -> impl Iterator<Item = DVec3> {
    let steps = || [-1.0, 0.0, 1.0].into_iter();
    let all = steps()
        .flat_map(move |x| steps().flat_map(move |y| steps().map(move |z| DVec3::new(x, y, z))));
    all.take(13).map(DVec3::normalize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geodetic::LonLat;

    #[test]
    fn zones_have_their_areas_and_poles_keep_their_digits() {
        let prolate = Ellipsoid {
            a_m: 1.0,
            b_m: 1.02,
        };
        for ellipsoid in [Ellipsoid::WGS84, Ellipsoid::MARS, Ellipsoid::MOON, prolate] {
            let chart = AuthalicChart::new(&ellipsoid, DVec3::Z);
            for lat_deg in [-90.0, -89.999_999, -45.0, 0.0, 1e-9, 30.0, 89.9, 90.0] {
                let normal = ellipsoid.normal(LonLat::new(77.0, lat_deg));
                let point = chart.authalic(normal);
                assert!((point.length() - 1.0).abs() < 4e-16, "{lat_deg} {point}");
                // ∫ of the meridian strip's area, by Simpson's rule.
                let strip_m2 = |lat_rad: f64| {
                    let (a2, b2) = (ellipsoid.a_m.powi(2), ellipsoid.b_m.powi(2));
                    let (sin, cos) = lat_rad.sin_cos();
                    a2 * a2 * b2 * cos / (a2 * cos * cos + b2 * sin * sin).powi(2)
                };
                let (steps, lat_rad) = (2000, lat_deg.to_radians());
                let h = lat_rad / f64::from(steps);
                let sum: f64 = (0..=steps)
                    .map(|k| {
                        let weight = match k {
                            0 => 1.0,
                            k if k == steps => 1.0,
                            k => 2.0 + 2.0 * f64::from(k % 2),
                        };
                        weight * strip_m2(h * f64::from(k))
                    })
                    .sum();
                let area_m2 = sum * h / 3.0;
                let found_m2 = point.z * chart.square_radius_m2();
                assert!(
                    (found_m2 - area_m2).abs() < 1e-12 * chart.square_radius_m2(),
                    "{lat_deg} {found_m2} {area_m2}"
                );
            }
            // At 1 nrad from the pole the chart is the surface's, to scale.
            let near = ellipsoid.surface_with_normal(DVec3::new(1e-9, 0.0, 1.0).normalize());
            let scale_m = near.x / chart.place(near).length();
            let radius_m = chart.square_radius_m2().sqrt();
            assert!((scale_m / radius_m - 1.0).abs() < 1e-14);
        }
    }
}
