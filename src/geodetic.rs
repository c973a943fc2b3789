//! Positions in geodetic longitude and latitude.

/// A point on an ellipsoid in geodetic longitude and latitude, in degrees, as GeoJSON writes it.
///
/// Longitudes that differ by 360° name the same point; at ±90° latitude every longitude does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct LonLat {
    /// Geodetic longitude, degrees east.
    pub lon_deg: f64,
    /// Geodetic latitude, degrees north, −90 … 90.
    pub lat_deg: f64,
}

impl LonLat {
    /// The point at `lon_deg` east and `lat_deg` north.
    pub const fn new(lon_deg: f64, lat_deg: f64) -> Self {
        Self { lon_deg, lat_deg }
    }

    /// Whether both numbers are finite and the latitude lies in −90° … 90°.
    pub fn is_valid(self) -> bool {
        self.lon_deg.is_finite() && self.lat_deg.abs() <= 90.0
    }

    /// Whether the point is one of the poles.
    pub fn is_pole(self) -> bool {
        self.lat_deg.abs() == 90.0
    }

    /// The same point named uniquely: longitude in (−180°, 180°], 0 at the poles, no negative zero.
    pub fn canonical(self) -> Self {
        if self.is_pole() {
            return Self::new(0.0, self.lat_deg);
        }
        let turned = wrap_deg(self.lon_deg);
        let lon_deg = if turned == -180.0 { 180.0 } else { turned };
        // `+ 0.0` turns −0 into +0, so that equal points have equal bits.
        Self::new(lon_deg + 0.0, self.lat_deg + 0.0)
    }
}

/// An angle in degrees brought to [−180°, 180°], exact for angles already there.
pub(crate) fn wrap_deg(angle_deg: f64) -> f64 {
    if angle_deg.abs() <= 180.0 {
        return angle_deg;
    }
    // The IEEE remainder is exact, so a point written as 190° or −170° gets equal bits.
    let turned = angle_deg % 360.0;
    if turned > 180.0 {
        turned - 360.0
    } else if turned < -180.0 {
        turned + 360.0
    } else {
        turned
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn canonical_names_are_unique() {
        for (a, b) in [
            (LonLat::new(180.0, 5.0), LonLat::new(-180.0, 5.0)),
            (LonLat::new(190.5, 5.0), LonLat::new(-169.5, 5.0)),
            (LonLat::new(0.0, 0.0), LonLat::new(-0.0, -0.0)),
            (LonLat::new(12.0, 90.0), LonLat::new(-77.0, 90.0)),
            (LonLat::new(720.25, 1.0), LonLat::new(0.25, 1.0)),
        ] {
            let (a, b) = (a.canonical(), b.canonical());
            assert_eq!(a.lon_deg.to_bits(), b.lon_deg.to_bits());
            assert_eq!(a.lat_deg.to_bits(), b.lat_deg.to_bits());
        }
    }
}
