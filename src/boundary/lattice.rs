//! The lattice that vertices are rounded to, so that topology is decided in exact integers.

use crate::geodetic::{LonLat, wrap_deg};

/// Lattice steps in a degree: 2³⁶, so that a step is 1.6 µm on Earth.
///
/// Coarse enough that coordinates which went through a text file (180.000 000 000 000 06, or two
/// neighbours that print one vertex differently in the 14th digit) meet again; so fine that nobody
/// can see it: 0.001 px from a metre above the ground.
const STEPS_PER_DEG: f64 = (1_u64 << 36) as f64;
/// A whole turn in lattice steps.
pub(crate) const TURN: i64 = 360 << 36;
/// The latitude of the north pole in lattice steps.
pub(crate) const POLE: i64 = 90 << 36;

/// A point of the lon/lat plane in lattice steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct LatticePoint {
    pub(crate) lon: i64,
    pub(crate) lat: i64,
}

impl LatticePoint {
    pub(crate) const fn new(lon: i64, lat: i64) -> Self {
        Self { lon, lat }
    }

    /// The lattice point nearest to a valid position, in the turn it was written in as long as that
    /// is within two turns of 0.
    pub(crate) fn nearest(position: LonLat) -> Self {
        let lon_deg = if position.lon_deg.abs() <= 720.0 {
            position.lon_deg
        } else {
            wrap_deg(position.lon_deg)
        };
        Self {
            lon: (lon_deg * STEPS_PER_DEG).round() as i64,
            lat: (position.lat_deg * STEPS_PER_DEG).round() as i64,
        }
    }

    /// The lattice point that a position is which came from one.
    pub(crate) fn exactly(position: LonLat) -> Self {
        Self {
            lon: steps(position.lon_deg),
            lat: steps(position.lat_deg),
        }
    }

    /// The same point in degrees, exactly.
    pub(crate) fn lon_lat(self) -> LonLat {
        LonLat::new(
            self.lon as f64 / STEPS_PER_DEG,
            self.lat as f64 / STEPS_PER_DEG,
        )
    }

    pub(crate) fn is_pole(self) -> bool {
        self.lat.abs() == POLE
    }

    /// The unique name of the point: longitude in (−180°, 180°], 0 at the poles.
    pub(crate) fn canonical(self) -> Self {
        let lon = if self.is_pole() { 0 } else { wrap(self.lon) };
        Self { lon, ..self }
    }

    /// The point `turns` whole turns further east.
    pub(crate) fn turned(self, turns: i64) -> Self {
        Self {
            lon: self.lon + turns * TURN,
            ..self
        }
    }
}

/// The longitude brought to (−180°, 180°].
pub(crate) fn wrap(lon: i64) -> i64 {
    if lon > -TURN / 2 && lon <= TURN / 2 {
        return lon;
    }
    let turned = lon.rem_euclid(TURN);
    if turned > TURN / 2 {
        turned - TURN
    } else {
        turned
    }
}

/// Lattice steps of a multiple of a step given in degrees, exactly.
pub(crate) fn steps(angle_deg: f64) -> i64 {
    (angle_deg * STEPS_PER_DEG) as i64
}

/// Twice the signed area of the triangle (a, b, c): positive when c lies left of a → b.
pub(crate) fn orientation(a: LatticePoint, b: LatticePoint, c: LatticePoint) -> i128 {
    let (ux, uy) = (b.lon - a.lon, b.lat - a.lat);
    let (vx, vy) = (c.lon - a.lon, c.lat - a.lat);
    i128::from(ux) * i128::from(vy) - i128::from(uy) * i128::from(vx)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_joins_what_text_tore_apart() {
        let join = |a: (f64, f64), b: (f64, f64)| {
            let [a, b] =
                [a, b].map(|(lon, lat)| LatticePoint::nearest(LonLat::new(lon, lat)).canonical());
            assert_eq!(a, b);
        };
        // Russia at 110m.
        join(
            (180.000_000_000_000_06, 71.515_714_336_428_29),
            (-180.0, 71.515_714_336_428_27),
        );
        join((0.0, 90.0), (123.0, 90.0));
        join((540.0, 1.0), (180.0, 1.0));
        join((360.0 * 1e6 + 7.0, 1.0), (7.0, 1.0));
    }

    #[test]
    fn lattice_points_survive_degrees() {
        for lon in [-TURN / 2 + 1, -1, 0, 1, 12_345_678_901, TURN / 2] {
            let point = LatticePoint::new(lon, POLE - 1);
            assert_eq!(LatticePoint::nearest(point.lon_lat()), point);
            assert_eq!(steps(point.lon_lat().lon_deg), lon);
        }
    }
}
