//! Rectangles in longitude and latitude.

pub(crate) mod longitudes;

use crate::geodetic::LonLat;

/// A rectangle in geodetic longitude and latitude, degrees.
///
/// From `west_deg` eastwards to `east_deg`: one that crosses the antimeridian has the greater number in
/// the west, or an east above 180. A difference of 360 is the whole circle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
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

/// Least width and height: 0.1 mm on the Earth.
const LEAST_DEG: f64 = 1e-9;

impl Extents {
    /// All longitudes and latitudes.
    pub const GLOBE: Self = Self {
        west_deg: -180.0,
        south_deg: -90.0,
        east_deg: 180.0,
        north_deg: 90.0,
    };

    /// Whether all numbers are finite, latitudes within ±90° and in order, longitudes within a turn of
    /// ±180°, and neither side below 10⁻⁹°.
    pub fn is_valid(self) -> bool {
        let longitudes = [self.west_deg, self.east_deg];
        longitudes.iter().all(|lon_deg| lon_deg.abs() <= 540.0)
            && self.west_deg != self.east_deg
            && self.width_deg() >= LEAST_DEG
            && self.south_deg >= -90.0
            && self.north_deg - self.south_deg >= LEAST_DEG
            && self.north_deg <= 90.0
    }

    /// Degrees from west to east, above 0 and at most 360.
    pub fn width_deg(self) -> f64 {
        let width_deg = (self.east_deg - self.west_deg).rem_euclid(360.0);
        if width_deg == 0.0 { 360.0 } else { width_deg }
    }

    /// Whether the rectangle, with its edges, holds a point. Of a pole the latitude decides alone.
    pub fn contains(self, position: LonLat) -> bool {
        let LonLat { lon_deg, lat_deg } = position;
        // Longitudes in the rectangle's own turn lose no digits; the others are brought there.
        let is_between = |lon_deg: f64| {
            let east_deg = self.west_deg + self.width_deg();
            (self.west_deg..=east_deg).contains(&lon_deg)
        };
        let east_of_west_deg = (lon_deg - self.west_deg).rem_euclid(360.0);
        position.is_valid()
            && (self.south_deg..=self.north_deg).contains(&lat_deg)
            && (position.is_pole() || is_between(lon_deg) || east_of_west_deg <= self.width_deg())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn extents(west_deg: f64, south_deg: f64, east_deg: f64, north_deg: f64) -> Extents {
        Extents {
            west_deg,
            south_deg,
            east_deg,
            north_deg,
        }
    }

    #[test]
    fn widths_go_eastwards() {
        assert_eq!(Extents::GLOBE.width_deg(), 360.0);
        assert_eq!(extents(10.0, 0.0, 30.0, 1.0).width_deg(), 20.0);
        assert_eq!(extents(170.0, 0.0, -170.0, 1.0).width_deg(), 20.0);
        assert_eq!(extents(170.0, 0.0, 190.0, 1.0).width_deg(), 20.0);
        assert_eq!(extents(0.0, 0.0, 360.0, 1.0).width_deg(), 360.0);
    }

    #[test]
    fn validity_is_checked() {
        assert!(Extents::GLOBE.is_valid());
        assert!(extents(170.0, -1.0, 190.0, 1.0).is_valid());
        for bad in [
            extents(f64::NAN, 0.0, 1.0, 1.0),
            extents(0.0, 0.0, f64::INFINITY, 1.0),
            extents(0.0, f64::NAN, 1.0, 1.0),
            extents(0.0, 1.0, 1.0, 1.0),
            extents(0.0, 2.0, 1.0, 1.0),
            extents(0.0, -90.1, 1.0, 1.0),
            extents(0.0, 0.0, 1.0, 90.1),
            extents(5.0, 0.0, 5.0, 1.0),
            extents(0.0, 0.0, 541.0, 1.0),
        ] {
            assert!(!bad.is_valid(), "{bad:?}");
        }
    }

    #[test]
    fn points_are_found_in_any_turn() {
        for fiji in [
            extents(177.0, -21.0, 182.0, -12.0),
            extents(177.0, -21.0, -178.0, -12.0),
        ] {
            for lon_deg in [177.0, 179.0, 180.0, -180.0, -179.0, -178.0, 182.0, 537.0] {
                assert!(fiji.contains(LonLat::new(lon_deg, -16.0)), "{lon_deg}");
            }
            for lon_deg in [176.9, -177.9, 0.0, 182.1, f64::NAN] {
                assert!(!fiji.contains(LonLat::new(lon_deg, -16.0)), "{lon_deg}");
            }
            assert!(fiji.contains(LonLat::new(178.0, -12.0)));
            assert!(!fiji.contains(LonLat::new(178.0, -11.9)));
        }
        let north = extents(10.0, 60.0, 20.0, 90.0);
        assert!(north.contains(LonLat::new(-100.0, 90.0)));
        assert!(!north.contains(LonLat::new(-100.0, 89.0)));
        assert!(Extents::GLOBE.contains(LonLat::new(180.0, -90.0)));
    }
}
