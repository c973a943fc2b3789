//! What every sensor sees around the nadir.

use glam::DVec3;
use globefill::{FieldOfView, SensorError};

use crate::cli::{Arguments, SensorKind};

/// The field of view that the command line asks for.
pub fn new(arguments: &Arguments) -> Result<FieldOfView, SensorError> {
    let half_angle_rad = arguments.half_angle.to_radians();
    match arguments.sensor {
        SensorKind::Conic => FieldOfView::conic(half_angle_rad),
        // A push-broom: wide to both sides, short along the track.
        SensorKind::Rectangular => {
            FieldOfView::rectangular(half_angle_rad, (0.25 * half_angle_rad.tan()).atan())
        }
        SensorKind::Custom => {
            let corners: [DVec3; 6] = std::array::from_fn(|corner| {
                let (sin, cos) = (60_f64.to_radians() * corner as f64).sin_cos();
                let reach = half_angle_rad.tan();
                DVec3::new(reach * cos, reach * sin, 1.0)
            });
            FieldOfView::convex(&corners)
        }
    }
}
