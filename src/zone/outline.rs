//! A zone's boundary: rings of true curves, and the pen that draws them.

use geographiclib_rs::Geodesic;

use crate::{
    curve::{
        Circle, CurveKind,
        beside::{Arrival, arrive},
    },
    ellipsoid::Ellipsoid,
    geodetic::{LonLat, wrap_deg},
};

/// Corners nearer than this, metres, are one.
pub(crate) const CORNER_M: f64 = 1e-4;
/// What passes a pole nearer than this, metres, passes through it.
const POLE_M: f64 = 2e-5;

/// A corner of a ring, and what its edge to the next corner follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corner {
    pub(crate) position: LonLat,
    pub(crate) edge: CurveKind,
}

/// The boundary of a zone.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Outline {
    /// The zone lies to the left of every ring. Between corners neither longitude nor latitude
    /// turns back.
    ///
    /// A ring may cross itself (a corridor's does): it winds round what is inside at least once
    /// leftward, and not at all round what is outside.
    pub(crate) rings: Vec<Vec<Corner>>,
}

/// Draws arcs and geodesics into a ring.
#[derive(Clone)]
pub(crate) struct Pen<'a> {
    pub(crate) geodesic: &'a Geodesic,
    pub(crate) ring: Vec<Corner>,
}

impl<'a> Pen<'a> {
    pub(crate) fn new(geodesic: &'a Geodesic) -> Self {
        let ring = Vec::new();
        Self { geodesic, ring }
    }

    /// The ring drawn so far; the pen begins another one.
    pub(crate) fn take_ring(&mut self) -> Vec<Corner> {
        std::mem::take(&mut self.ring)
    }

    pub(crate) fn ellipsoid(&self) -> Ellipsoid {
        let a_m = self.geodesic.equatorial_radius();
        Ellipsoid {
            a_m,
            b_m: a_m * (1.0 - self.geodesic.flattening()),
        }
    }

    pub(crate) fn push(&mut self, position: LonLat, edge: CurveKind) {
        self.ring.push(Corner { position, edge });
    }

    /// Draws the arc that starts at azimuth `from_deg` and turns by `sweep_deg` (negative:
    /// counter-clockwise), up to, not including, its end.
    pub(crate) fn arc(&mut self, circle: Circle, from_deg: f64, sweep_deg: f64) {
        let stops_deg = self.arc_stops(circle, from_deg, sweep_deg);
        for azimuth_deg in [from_deg].into_iter().chain(stops_deg) {
            let arrival = self.on_circle(circle, azimuth_deg);
            match self.pole_at(arrival.position) {
                None => self.push(arrival.position, CurveKind::Circle(circle)),
                Some(pole_deg) => self.through_pole(circle, azimuth_deg, sweep_deg, pole_deg),
            }
        }
    }

    pub(crate) fn on_circle(&self, circle: Circle, azimuth_deg: f64) -> Arrival {
        arrive(self.geodesic, circle.centre, azimuth_deg, circle.radius_m)
    }

    /// Latitude of the pole that a position is, if it is one.
    fn pole_at(&self, position: LonLat) -> Option<f64> {
        let beside_m = (90.0 - position.lat_deg.abs()).to_radians() * self.ellipsoid().a_m;
        (beside_m < POLE_M).then(|| 90_f64.copysign(position.lat_deg))
    }

    /// A pole on the circle has two names: the meridian on which the arc comes, and that on which
    /// it goes. Both are square to the centre's.
    fn through_pole(&mut self, circle: Circle, azimuth_deg: f64, sweep_deg: f64, pole_deg: f64) {
        let southward = azimuth_deg.to_radians().cos() < 0.0;
        let from_east = (sweep_deg < 0.0) != southward;
        let side_deg = if from_east { 90.0 } else { -90.0 };
        for aside_deg in [side_deg, -side_deg] {
            let lon_deg = wrap_deg(wrap_deg(circle.centre.lon_deg) + aside_deg);
            self.push(LonLat::new(lon_deg, pole_deg), CurveKind::Circle(circle));
        }
    }

    /// Azimuths inside an arc at which it is cut: quarters, where latitude turns back, and where
    /// longitude does, in the arc's order.
    fn arc_stops(&self, circle: Circle, from_deg: f64, sweep_deg: f64) -> Vec<f64> {
        let mut azimuths_deg = vec![0.0, 90.0, 180.0, 270.0];
        // East and west are mirror images.
        for azimuth_deg in turns_of_longitude(|deg| self.on_circle(circle, deg), 0.0, 180.0, 48) {
            azimuths_deg.extend([azimuth_deg, 360.0 - azimuth_deg]);
        }
        let shift_deg = |azimuth_deg: f64| {
            let shift_deg = ((azimuth_deg - from_deg) * sweep_deg.signum()).rem_euclid(360.0);
            (shift_deg, azimuth_deg)
        };
        let mut stops: Vec<(f64, f64)> = azimuths_deg.into_iter().map(shift_deg).collect();
        stops.sort_by(|a, b| a.0.total_cmp(&b.0));
        let apart_deg = (CORNER_M / circle.radius_m.min(1e6)).to_degrees();
        let mut last_deg = 0.0;
        stops.retain(|&(shift_deg, _)| {
            let keep = shift_deg > last_deg + apart_deg && shift_deg + apart_deg < sweep_deg.abs();
            if keep {
                last_deg = shift_deg;
            }
            keep
        });
        stops
            .into_iter()
            .map(|(_, azimuth_deg)| azimuth_deg)
            .collect()
    }
}

/// Parameters between `low` and `high` at which a curve at fixed distance runs along a meridian:
/// where the paths to it arrive due east or west.
pub(crate) fn turns_of_longitude(
    arrival: impl Fn(f64) -> Arrival,
    low: f64,
    high: f64,
    steps: u32,
) -> Vec<f64> {
    sign_changes(
        |x| arrival(x).azimuth_deg.to_radians().cos(),
        low,
        high,
        steps,
    )
}

/// Parameters at which such a curve runs along a parallel.
pub(crate) fn turns_of_latitude(
    arrival: impl Fn(f64) -> Arrival,
    low: f64,
    high: f64,
    steps: u32,
) -> Vec<f64> {
    sign_changes(
        |x| arrival(x).azimuth_deg.to_radians().sin(),
        low,
        high,
        steps,
    )
}

fn sign_changes(value: impl Fn(f64) -> f64, low: f64, high: f64, steps: u32) -> Vec<f64> {
    let at = |step: u32| low + (high - low) * f64::from(step) / f64::from(steps);
    let values: Vec<f64> = (0..=steps).map(|step| value(at(step))).collect();
    let mut changes = Vec::new();
    for (step, pair) in (0..).zip(values.windows(2)) {
        if (pair[0] < 0.0) == (pair[1] < 0.0) {
            continue;
        }
        let (mut a, mut b) = (at(step), at(step + 1));
        for _ in 0..60 {
            let middle = 0.5 * (a + b);
            if (value(middle) < 0.0) == (pair[0] < 0.0) {
                a = middle;
            } else {
                b = middle;
            }
        }
        changes.push(0.5 * (a + b));
    }
    changes
}
