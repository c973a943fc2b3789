//! Satellites on their orbits.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};
use globefill::{Ellipsoid, Pose};
use sgp4::{Constants, Elements, MinutesSinceEpoch, iau_epoch_to_sidereal_time};

const MINUTES_PER_JULIAN_YEAR: f64 = 365.25 * 24.0 * 60.0;
/// Of the Earth against the mean equinox, 1/s (Vallado, Fundamentals of Astrodynamics).
const EARTH_RATE_RAD_S: f64 = 7.292_115_146_706_98e-5;

/// Satellites that can be propagated, and when it all starts: at the newest of their epochs.
pub struct Constellation {
    satellites: Vec<Satellite>,
    /// Right ascension of the ascending node of every satellite, radians: what plane it moves in.
    pub nodes_rad: Vec<f64>,
    /// Julian years since J2000, UTC.
    start_years: f64,
    ellipsoid: Ellipsoid,
}

struct Satellite {
    constants: Constants,
    /// From its epoch to the start.
    age_min: f64,
}

impl Constellation {
    pub fn new(elements: &[Elements], ellipsoid: &Ellipsoid) -> Result<Self, String> {
        let newest = elements
            .iter()
            .max_by_key(|elements| elements.datetime)
            .ok_or("there are no element sets")?;
        let satellite = |elements: &Elements| {
            let constants = Constants::from_elements(elements).map_err(|e| e.to_string())?;
            let age = elements
                .datetime_to_minutes_since_epoch(&newest.datetime)
                .map_err(|e| e.to_string())?;
            Ok(Satellite {
                constants,
                age_min: age.0,
            })
        };
        let satellites = elements
            .iter()
            .map(|elements| {
                satellite(elements)
                    .map_err(|error: String| format!("satellite {}: {error}", elements.norad_id))
            })
            .collect::<Result<_, String>>()?;
        Ok(Self {
            satellites,
            nodes_rad: elements
                .iter()
                .map(|elements| elements.right_ascension.to_radians())
                .collect(),
            start_years: newest.epoch(),
            ellipsoid: *ellipsoid,
        })
    }

    /// Every satellite's pose so many minutes after the start: it looks straight down, up along its
    /// track over the ground.
    pub fn poses(&self, minutes: f64) -> Vec<Option<Pose>> {
        let years = self.start_years + minutes / MINUTES_PER_JULIAN_YEAR;
        // UTC stands for UT1 and polar motion is left out: less than half a kilometre on the ground.
        let sidereal_rad = iau_epoch_to_sidereal_time(years) % TAU;
        let ecef_from_teme = DMat3::from_rotation_z(-sidereal_rad);
        self.satellites
            .iter()
            .map(|satellite| satellite.pose(minutes, ecef_from_teme, &self.ellipsoid))
            .collect()
    }
}

impl Satellite {
    fn pose(&self, minutes: f64, ecef_from_teme: DMat3, ellipsoid: &Ellipsoid) -> Option<Pose> {
        let at = MinutesSinceEpoch(self.age_min + minutes);
        let teme = self.constants.propagate(at).ok()?;
        let apex_ecef_m = ecef_from_teme * DVec3::from(teme.position) * 1e3;
        let turning_m_s = DVec3::Z.cross(apex_ecef_m) * EARTH_RATE_RAD_S;
        let velocity_m_s = ecef_from_teme * DVec3::from(teme.velocity) * 1e3 - turning_m_s;
        let (_, height_m) = ellipsoid.geodetic(apex_ecef_m);
        (height_m > 0.0).then(|| Pose {
            up: velocity_m_s,
            ..Pose::nadir(ellipsoid, apex_ecef_m)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::walker;

    /// In a frame that turns with the Earth the derivative of the position is the velocity.
    #[test]
    fn up_is_along_the_track_over_the_ground() {
        let shell = walker::shell(12, 3, 550e3, 53.0).unwrap();
        let constellation = Constellation::new(&shell, &Ellipsoid::WGS84).unwrap();
        let second_min = 1.0 / 60.0;
        let positions = |minutes: f64| {
            let poses = constellation.poses(minutes).into_iter();
            poses.map(|pose| pose.expect("in orbit").apex_ecef_m)
        };
        for minutes in [0.0, 17.0, 300.0] {
            let steps = positions(minutes - second_min)
                .zip(positions(minutes + second_min))
                .map(|(from, to)| (to - from) / 2.0);
            for (step_m_s, pose) in steps.zip(constellation.poses(minutes)) {
                let up = pose.expect("in orbit").up;
                assert!((up - step_m_s).length() < 0.02, "{up} {step_m_s}");
            }
        }
    }
}
