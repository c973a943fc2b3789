//! Circles spread over one side of the globe that drift eastwards.

use globefill::{Ellipsoid, LonLat, Pose};

use crate::host::spiral::spiral;

/// Around which the circles' middles lie, and how far from it they lie at most.
const MIDDLE: LonLat = LonLat::new(10.0, 20.0);
const SPREAD_DEG: f64 = 65.0;
const RADIUS_M: f64 = 800e3;
const MEAN_EARTH_RADIUS_M: f64 = 6_371_008.8;
const DRIFT_DEG: f64 = 0.2;

/// The middles, and the height of the sensors above them.
pub struct Circles {
    middles: Vec<LonLat>,
    height_m: f64,
}

impl Circles {
    /// Points in a Fibonacci spiral, evenly spread.
    pub fn new(count: usize, height_m: f64) -> Self {
        Self {
            middles: spiral(MIDDLE, SPREAD_DEG, count),
            height_m,
        }
    }

    pub fn len(&self) -> usize {
        self.middles.len()
    }

    /// Of cones that cut circles of the radius out of a sphere as large as the Earth; out of the
    /// ellipsoid within 1 %.
    pub fn half_angle_rad(&self) -> f64 {
        let arc_rad = RADIUS_M / MEAN_EARTH_RADIUS_M;
        let apex = 1.0 + self.height_m / MEAN_EARTH_RADIUS_M;
        arc_rad.sin().atan2(apex - arc_rad.cos())
    }

    /// Straight above the middles, looking down.
    pub fn poses(&self, frame: i32) -> impl Iterator<Item = Pose> {
        let drift_deg = DRIFT_DEG * f64::from(frame);
        self.middles.iter().map(move |middle| {
            let foot = LonLat::new(middle.lon_deg + drift_deg, middle.lat_deg);
            let apex_ecef_m = Ellipsoid::WGS84.ecef(foot, self.height_m);
            Pose::nadir(&Ellipsoid::WGS84, apex_ecef_m)
        })
    }
}
