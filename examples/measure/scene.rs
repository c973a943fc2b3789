//! What is drawn, and from where.

use glam::UVec2;
use globefill::{FieldOfView, LonLat, Region};

use crate::host::camera::Viewpoint;

/// Field of view of the picture's longer side, degrees.
const LONG_SIDE_DEG: f64 = 60.0;

/// One scene.
#[derive(Clone, Debug)]
pub struct Scene {
    pub name: String,
    pub viewpoint: Viewpoint,
    pub regions: Vec<Region>,
    /// [`globefill::MeshOptions::tolerance_m`].
    pub tolerance_m: f64,
    pub sensors: Option<Sensors>,
    /// Whether fills lie over each other in no order.
    pub unordered: bool,
    /// How high above the ellipsoid the ground lies, everywhere, metres.
    pub ground_m: f64,
    /// What positions in single precision are relative to.
    pub origin: LonLat,
}

/// Sensors of one kind that look straight down.
#[derive(Clone, Debug)]
pub struct Sensors {
    pub field_of_view: FieldOfView,
    pub height_m: f64,
    pub feet: Vec<LonLat>,
    /// How far east they move from frame to frame.
    pub step_deg: f64,
}

impl Scene {
    pub fn new(name: impl Into<String>, viewpoint: Viewpoint, regions: Vec<Region>) -> Self {
        Self {
            name: name.into(),
            viewpoint,
            regions,
            tolerance_m: 5.0,
            sensors: None,
            unordered: false,
            ground_m: 0.0,
            origin: viewpoint.foot,
        }
    }

    /// Vertical field of view, degrees.
    pub fn fov_deg(&self, size_px: UVec2) -> f64 {
        let long = (0.5 * LONG_SIDE_DEG.to_radians()).tan();
        let share = f64::from(size_px.y) / f64::from(size_px.max_element());
        2.0 * (long * share).atan().to_degrees()
    }
}

/// A viewpoint that looks straight down.
pub fn nadir(lon_deg: f64, lat_deg: f64, height_m: f64) -> Viewpoint {
    Viewpoint {
        foot: LonLat::new(lon_deg, lat_deg),
        height_m,
        heading_deg: 0.0,
        pitch_deg: -90.0,
    }
}
