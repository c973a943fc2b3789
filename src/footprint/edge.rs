//! One edge of a footprint.

use glam::DVec3;

use super::course::Course;
use crate::{footprint::FootprintBound, geodetic::LonLat};

/// One smooth piece of the boundary of a footprint, from t = 0 to t = 1, the footprint on its left.
///
/// It is evaluated from the sensor itself at any t, never interpolated. Its speed is smooth, but not
/// even: where a cone all but touches the limb it is fast.
#[derive(Clone, Debug)]
pub struct FootprintEdge {
    bound: FootprintBound,
    radii_m: DVec3,
    /// Its ends in coordinates divided by the radii.
    pub(super) from: DVec3,
    pub(super) to: DVec3,
    course: Course,
}

impl FootprintEdge {
    pub(super) fn new(
        bound: FootprintBound,
        radii_m: DVec3,
        (from, to): (DVec3, DVec3),
        course: Course,
    ) -> Self {
        Self {
            bound,
            radii_m,
            from,
            to,
            course,
        }
    }

    /// What ends the footprint along this edge.
    pub fn bound(&self) -> FootprintBound {
        self.bound
    }

    /// Position, metres in ECEF, at height 0, at parameter `t`, 0 … 1 (others are taken to the nearer
    /// end). At t = 1 it is bit for bit that of the next edge at t = 0.
    pub fn ecef_m(&self, t: f64) -> DVec3 {
        self.unit(t) * self.radii_m
    }

    /// Longitude, −180° … 180°, and latitude at parameter `t`, 0 … 1.
    pub fn lon_lat(&self, t: f64) -> LonLat {
        let normal = self.unit(t) / self.radii_m;
        LonLat::new(
            normal.y.atan2(normal.x).to_degrees(),
            normal.z.atan2(normal.x.hypot(normal.y)).to_degrees(),
        )
    }

    fn unit(&self, t: f64) -> DVec3 {
        if t <= 0.0 {
            self.from
        } else if t >= 1.0 {
            self.to
        } else {
            self.course.unit(t)
        }
    }
}
