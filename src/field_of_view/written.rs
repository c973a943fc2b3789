//! Fields of view as files hold them.

use glam::DVec3;

use super::{FieldOfView, Shape};
use crate::error::SensorError;

/// The arguments of the constructors that make a field of view.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum Written {
    Conic { half_angle_rad: f64 },
    Annular { inner_rad: f64, half_angle_rad: f64 },
    // Only read: what is written are its corners.
    Rectangular { right_rad: f64, up_rad: f64 },
    Convex { corners: Vec<DVec3> },
}

impl From<FieldOfView> for Written {
    fn from(field_of_view: FieldOfView) -> Self {
        match field_of_view.0 {
            Shape::Cone {
                inner_rad: 0.0,
                half_angle_rad,
            } => Self::Conic { half_angle_rad },
            Shape::Cone {
                inner_rad,
                half_angle_rad,
            } => Self::Annular {
                inner_rad,
                half_angle_rad,
            },
            Shape::Pyramid { corners, .. } => Self::Convex {
                corners: corners.to_vec(),
            },
        }
    }
}

impl TryFrom<Written> for FieldOfView {
    type Error = SensorError;

    fn try_from(written: Written) -> Result<Self, SensorError> {
        match written {
            Written::Conic { half_angle_rad } => Self::conic(half_angle_rad),
            Written::Annular {
                inner_rad,
                half_angle_rad,
            } => Self::annular(inner_rad, half_angle_rad),
            Written::Rectangular { right_rad, up_rad } => Self::rectangular(right_rad, up_rad),
            Written::Convex { corners } => Self::convex(&corners),
        }
    }
}
