//! Points spread evenly over a part of the globe.

use std::f64::consts::PI;

use globefill::LonLat;

/// `count` points within `reach_deg` of a middle: a Fibonacci spiral on the sphere. One alone is the middle.
pub fn spiral(middle: LonLat, reach_deg: f64, count: usize) -> Vec<LonLat> {
    let (sin_lat, cos_lat) = middle.lat_deg.to_radians().sin_cos();
    let golden_angle_rad = PI * (3.0 - 5.0_f64.sqrt());
    let place = |index: usize| {
        let part = (index as f64 + 0.5) / count as f64;
        let z = 1.0 - (1.0 - reach_deg.to_radians().cos()) * part;
        let (sin, cos) = (index as f64 * golden_angle_rad).sin_cos();
        let (x, y) = ((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin);
        // The spiral's axis, z, is turned towards the middle.
        let outward = cos_lat * z - sin_lat * y;
        let north = sin_lat * z + cos_lat * y;
        LonLat::new(
            x.atan2(outward).to_degrees() + middle.lon_deg,
            north.asin().to_degrees(),
        )
    };
    match count {
        1 => vec![middle],
        _ => (0..count).map(place).collect(),
    }
}
