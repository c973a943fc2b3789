//! A stereographic map of the unit sphere.

use glam::{DVec2, DVec3};

/// Stereographic projection of the unit sphere from `pole` onto the plane through its centre.
///
/// Conformal, orientation-preserving as seen from outside; the antipode of the pole maps to the
/// origin, and a distance on the sphere is 2/(1 + |p|²) times that in the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chart {
    pole: DVec3,
    right: DVec3,
    up: DVec3,
}

impl Chart {
    /// The chart that projects from the unit vector `pole`, the only point without an image.
    pub(super) fn new(pole: DVec3) -> Self {
        let (right, down) = pole.any_orthonormal_pair();
        // Seen from outside over the antipode, right × up points at the viewer.
        Self {
            pole,
            right,
            up: -down,
        }
    }

    /// The point of the sphere that maps to the origin.
    pub(super) fn centre(&self) -> DVec3 {
        -self.pole
    }

    /// Maps a point of the unit sphere; the pole itself goes far out, but stays finite.
    pub(super) fn project(&self, point: DVec3) -> DVec2 {
        // Differences to the nearer of pole and centre are exact, so close points keep their digits.
        let above = point + self.pole;
        let (offset, one_minus_cos) = if point.dot(self.pole) < 0.0 {
            (above, 2.0 - 0.5 * above.length_squared())
        } else {
            let below = point - self.pole;
            (below, 0.5 * below.length_squared())
        };
        let plane = DVec2::new(offset.dot(self.right), offset.dot(self.up));
        plane / one_minus_cos.max(1e-32)
    }

    /// Maps back onto the unit sphere.
    pub(super) fn unproject(&self, plane: DVec2) -> DVec3 {
        let squared = plane.length_squared();
        let sum = 2.0 * (plane.x * self.right + plane.y * self.up) - (1.0 - squared) * self.pole;
        (sum / (1.0 + squared)).normalize()
    }

    /// How much longer lengths on the sphere are than in the plane, at `plane`.
    pub(super) fn scale(plane: DVec2) -> f64 {
        2.0 / (1.0 + plane.length_squared())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    #[test]
    fn unproject_inverts_project_to_the_rounding() {
        for pole in [DVec3::Z, -DVec3::Z, DVec3::new(0.6, -0.64, 0.48), DVec3::X] {
            let chart = Chart::new(pole);
            for distance_rad in [1e-9, 1e-6, 1e-3, 0.5, 1.5, 2.5, PI - 1e-3, PI - 1e-7, PI] {
                for azimuth_rad in [0.0, 1.0, 2.0, 5.0] {
                    let (sin, cos) = f64::sin_cos(azimuth_rad);
                    let flat = chart.right * cos + chart.up * sin;
                    let point = chart.pole * distance_rad.cos() + flat * distance_rad.sin();
                    let point = point.normalize();
                    let again = chart.unproject(chart.project(point));
                    assert!(
                        again.distance(point) < 5e-16,
                        "{pole} {distance_rad} {azimuth_rad}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_pole_itself_stays_finite() {
        for pole in [DVec3::Z, DVec3::X, DVec3::new(0.6, -0.64, 0.48).normalize()] {
            assert!(Chart::new(pole).project(pole).is_finite());
        }
    }

    #[test]
    fn counter_clockwise_stays_counter_clockwise() {
        for pole in [DVec3::Z, -DVec3::Z, DVec3::new(0.6, -0.64, 0.48), DVec3::Y] {
            let chart = Chart::new(pole);
            let centre = chart.centre();
            let east = centre.any_orthonormal_vector();
            let north = centre.cross(east);
            let corner = |k: f64| {
                let (sin, cos) = (k * TAU / 3.0).sin_cos();
                chart.project((centre + 0.1 * (east * cos + north * sin)).normalize())
            };
            let [a, b, c] = [0.0, 1.0, 2.0].map(corner);
            assert!((b - a).perp_dot(c - a) > 0.0);
        }
    }
}
