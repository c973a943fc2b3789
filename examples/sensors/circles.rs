//! Circles spread over one side of the globe that drift eastwards.

use std::f64::consts::PI;

use globefill::{Ellipsoid, LonLat, Pose};

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
        let (sin_lat, cos_lat) = MIDDLE.lat_deg.to_radians().sin_cos();
        let golden_angle_rad = PI * (3.0 - 5.0_f64.sqrt());
        let middle = |index: usize| {
            let part = (index as f64 + 0.5) / count as f64;
            let z = 1.0 - (1.0 - SPREAD_DEG.to_radians().cos()) * part;
            let (sin, cos) = (index as f64 * golden_angle_rad).sin_cos();
            let (x, y) = ((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin);
            // The spiral's axis, z, is turned towards the middle.
            let outward = cos_lat * z - sin_lat * y;
            let north = sin_lat * z + cos_lat * y;
            LonLat::new(
                x.atan2(outward).to_degrees() + MIDDLE.lon_deg,
                north.asin().to_degrees(),
            )
        };
        Self {
            middles: (0..count).map(middle).collect(),
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
