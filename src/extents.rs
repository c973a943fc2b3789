//! Rectangles in longitude and latitude.

/// A rectangle in geodetic longitude and latitude, degrees.
///
/// From `west_deg` eastwards to `east_deg`: one that crosses the antimeridian has the greater number in
/// the west, or an east above 180. A difference of 360 is the whole circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extents {
    /// Western edge.
    pub west_deg: f64,
    /// Southern edge.
    pub south_deg: f64,
    /// Eastern edge.
    pub east_deg: f64,
    /// Northern edge.
    pub north_deg: f64,
}

impl Extents {
    /// All longitudes and latitudes.
    pub const GLOBE: Self = Self {
        west_deg: -180.0,
        south_deg: -90.0,
        east_deg: 180.0,
        north_deg: 90.0,
    };

    /// Whether all numbers are finite, latitudes within ±90° and in order, longitudes within a turn of
    /// ±180° and not the same.
    pub fn is_valid(self) -> bool {
        let longitudes = [self.west_deg, self.east_deg];
        longitudes.iter().all(|lon_deg| lon_deg.abs() <= 540.0)
            && self.west_deg != self.east_deg
            && self.south_deg >= -90.0
            && self.south_deg < self.north_deg
            && self.north_deg <= 90.0
    }

    /// Degrees from west to east, above 0 and at most 360.
    pub fn width_deg(self) -> f64 {
        let width_deg = (self.east_deg - self.west_deg).rem_euclid(360.0);
        if width_deg == 0.0 { 360.0 } else { width_deg }
    }
}
