//! How far the ground is seen at all: to the limb, or to the least elevation.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;

use super::{bracketed_root::bracketed_root, scaled_apex::ScaledApex};
use crate::{footprint::FootprintBound, sensor::Aim};

/// The closed curve round the ground the apex sees, counter-clockwise from outside.
///
/// It is only ever one of two: on the ellipsoid an elevation above 0 lies in front of the limb, the
/// limb is at elevation 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Horizon {
    pub apex: ScaledApex,
    /// Unit vector the curve goes round, and two across it: right-handed.
    middle: DVec3,
    across: [DVec3; 2],
    /// Radians, above 0; none for the limb.
    min_elevation_rad: Option<f64>,
}

impl Horizon {
    /// None if only the foot point of the apex is high enough.
    pub(super) fn new(aim: &Aim, min_elevation_rad: Option<f64>) -> Option<Self> {
        let apex = ScaledApex::new(&aim.ellipsoid, aim.apex_ecef_m);
        let min_elevation_rad = min_elevation_rad.filter(|&elevation_rad| elevation_rad > 0.0);
        let middle = match min_elevation_rad {
            Some(elevation_rad) if elevation_rad >= FRAC_PI_2 => return None,
            // The apex is in the zenith of its geodetic foot point: small regions are about that.
            Some(_) => {
                let (foot, _) = aim.ellipsoid.geodetic(aim.apex_ecef_m);
                aim.ellipsoid.ecef(foot, 0.0) / apex.radii_m
            }
            None => apex.apex,
        }
        .normalize();
        let across = middle.any_orthonormal_vector();
        Some(Self {
            apex,
            middle,
            across: [across, middle.cross(across)],
            min_elevation_rad,
        })
    }

    pub(super) fn is_limb(&self) -> bool {
        self.min_elevation_rad.is_none()
    }

    pub(super) fn bound(&self) -> FootprintBound {
        if self.is_limb() {
            FootprintBound::Limb
        } else {
            FootprintBound::MinElevation
        }
    }

    /// A direction well inside, in ECEF.
    pub(super) fn middle_direction(&self) -> DVec3 {
        self.apex.line_m(self.middle)
    }

    /// Degree of a Fourier series that a linear function of the curve is exactly, or to 10⁻¹².
    pub(super) fn degree(&self) -> usize {
        if self.is_limb() { 1 } else { 6 }
    }

    /// The point at an angle round the middle, radians, as a unit vector in scaled coordinates.
    pub(super) fn unit(&self, angle_rad: f64) -> DVec3 {
        let (sin, cos) = angle_rad.sin_cos();
        let across = self.across[0] * cos + self.across[1] * sin;
        match self.min_elevation_rad {
            // S·P = 1.
            None => {
                let distance = self.apex.apex.length();
                (self.middle + across * self.apex.power.sqrt()) / distance
            }
            Some(least_rad) => self.unit_at_elevation(across, least_rad),
        }
    }

    /// Where a great circle of the unit sphere from the foot point reaches the least elevation. From
    /// π/2 at the foot point the elevation falls all the way to 0 at the limb.
    fn unit_at_elevation(&self, across: DVec3, least_rad: f64) -> DVec3 {
        let unit = |turn_rad: f64| {
            let (sin, cos) = turn_rad.sin_cos();
            self.middle * cos + across * sin
        };
        let (up, side) = (self.apex.apex.dot(self.middle), self.apex.apex.dot(across));
        let beyond = (up * up + side * side - 1.0).max(0.0).sqrt();
        let limb_rad = side.atan2(up) + beyond.atan2(1.0);
        let above = |turn_rad: f64| self.elevation_rad(unit(turn_rad)) - least_rad;
        let (at_foot, at_limb) = (above(0.0), above(limb_rad));
        if at_foot <= 0.0 {
            return self.middle;
        }
        if at_limb >= 0.0 {
            return unit(limb_rad);
        }
        unit(bracketed_root((0.0, at_foot), (limb_rad, at_limb), above))
    }

    /// Elevation of the apex, radians, above the plane at right angles to the geodetic normal.
    fn elevation_rad(&self, unit: DVec3) -> f64 {
        let (normal, to_apex) = (unit / self.apex.radii_m, -self.apex.line_m(unit));
        // Of an arc tangent: the arc sine is blind near the zenith.
        normal.dot(to_apex).atan2(normal.cross(to_apex).length())
    }

    /// How far inside the horizon an ECEF direction meets the ground; negative outside.
    pub(super) fn margin(&self, direction: DVec3) -> f64 {
        let hit = self.apex.hit_margin(direction);
        match self.min_elevation_rad {
            Some(_) if hit < 0.0 => hit.min(-1.0),
            Some(least_rad) => self.elevation_rad(self.apex.hit(direction)) - least_rad,
            None => hit,
        }
    }

    /// What rounding may do to an angle, radians, seen from the apex at a point of the curve.
    pub(super) fn rounding_rad(&self, lines_m: &[DVec3]) -> f64 {
        let nearest_m = lines_m.iter().map(|line_m| line_m.length());
        let nearest_m = nearest_m.fold(f64::INFINITY, f64::min);
        let numbers_m = self.apex.radii_m.x + self.apex.apex_ecef_m.length();
        2.0 * f64::EPSILON * (1.0 + numbers_m / nearest_m)
    }

    /// Lines from the apex to points evenly round the curve, metres.
    pub(super) fn sample_lines_m(&self) -> Vec<DVec3> {
        let count = if self.is_limb() { 8 } else { 40 };
        (0..count)
            .map(|step| {
                self.apex
                    .line_m(self.unit(TAU * step as f64 / count as f64))
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        ellipsoid::Ellipsoid,
        field_of_view::FieldOfView,
        geodetic::LonLat,
        sensor::{Pose, Sensor},
    };

    /// The curve of an elevation is one value for each direction only if this holds.
    #[test]
    fn the_elevation_falls_from_the_foot_point_to_the_limb() {
        for flattening in [0.0, 0.02, -0.02] {
            let ellipsoid = Ellipsoid {
                a_m: 6.4e6,
                b_m: 6.4e6 * (1.0 - flattening),
            };
            for (lat_deg, height_m) in [0.0, 20.0, 45.0, 80.0, 90.0]
                .into_iter()
                .flat_map(|lat_deg| [1e2, 1e4, 1e6, 3e7, 1e9].map(|height_m| (lat_deg, height_m)))
            {
                let apex_m = ellipsoid.ecef(LonLat::new(7.0, lat_deg), height_m);
                let pose = Pose::nadir(&ellipsoid, apex_m);
                let sensor = Sensor::new(pose, FieldOfView::conic(1.0).unwrap());
                let aim = sensor.aim(&ellipsoid).unwrap();
                let horizon = Horizon::new(&aim, Some(1e-9)).unwrap();
                for step in 0..16 {
                    let angle_rad = TAU * f64::from(step) / 16.0;
                    let limb = horizon.unit(angle_rad);
                    let turn_rad = limb.angle_between(horizon.middle);
                    let across = (limb - horizon.middle * limb.dot(horizon.middle)).normalize();
                    let elevations = (0..=100).map(|part| {
                        let (sin, cos) = (turn_rad * f64::from(part) / 100.0).sin_cos();
                        horizon.elevation_rad(horizon.middle * cos + across * sin)
                    });
                    let elevations: Vec<_> = elevations.collect();
                    assert!(elevations.is_sorted_by(|one, next| one > next));
                }
            }
        }
    }
}
