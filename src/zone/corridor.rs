//! Corridors: what lies near a line.
//!
//! A leg's two sides and its ends square to it bound a strip; at a bend the strips leave a wedge
//! open on the outer side, which an arc closes; half discs end the line. Strips, wedges and half
//! discs cover the corridor, some of it several times. The sum of their boundaries is one ring: what
//! they have in common cancels, and on the inner side of bends the strips' ends remain, from one
//! side to the line's point and from there to the next. So the ring winds round a point as often as
//! it is covered, and what it winds round at all is the union.

use crate::{
    boundary::lattice::LatticePoint,
    curve::{
        Beside, Circle, CurveKind,
        beside::{Arrival, Path, arrive, shortest_path},
    },
    ellipsoid::Ellipsoid,
    error::ZoneError,
    geodetic::{LonLat, wrap_deg},
    zone::{
        SHORTEST_M, WIDEST_HALF, arcs, check_position,
        outline::{CORNER_M, Outline, Pen, turns_of_latitude, turns_of_longitude},
    },
};

/// Steps in which a side is searched for the places where its latitude or longitude turns back.
const SEARCH_STEP_M: f64 = 2e5;

/// A shortest path between two points of the line.
#[derive(Clone, Copy)]
struct Leg {
    from: LonLat,
    to: LonLat,
    path: Path,
}

pub(crate) fn check(
    ellipsoid: &Ellipsoid,
    points: &[LonLat],
    width_m: f64,
) -> Result<(), ZoneError> {
    for (index, &point) in points.iter().enumerate() {
        check_position(index, point)?;
    }
    if points.is_empty() {
        return Err(ZoneError::NoPoints);
    }
    let most_m = 2.0 * WIDEST_HALF * ellipsoid.a_m.min(ellipsoid.b_m);
    if !(2.0 * SHORTEST_M..=most_m).contains(&width_m) {
        return Err(ZoneError::Range {
            range_m: width_m,
            least_m: 2.0 * SHORTEST_M,
            most_m,
        });
    }
    let longest_deg = 180.0 - (0.2 + 360.0 * ellipsoid.flattening().abs());
    for (leg, pair) in points.windows(2).enumerate() {
        let normals = [pair[0], pair[1]].map(|point| ellipsoid.normal(point));
        if normals[0].angle_between(normals[1]) > longest_deg.to_radians() {
            return Err(ZoneError::AntipodalLeg { leg });
        }
    }
    Ok(())
}

/// The boundary of what lies up to `half_m` from the line through valid `points`.
pub(crate) fn outline(mut pen: Pen, points: &[LonLat], half_m: f64) -> Outline {
    // On the lattice, where the corners on the line will be.
    let points: Vec<LonLat> = points
        .iter()
        .map(|&point| LatticePoint::nearest(point).canonical().lon_lat())
        .collect();
    let legs = legs(&pen, &points);
    let (Some(first), Some(last)) = (legs.first(), legs.last()) else {
        return arcs::annulus(pen, points[0], 0.0, half_m);
    };
    let mut corner = None;
    for (index, leg) in legs.iter().enumerate() {
        pen.side(leg, half_m, corner);
        if let Some(next) = legs.get(index + 1) {
            let turn_deg = wrap_deg(next.path.start_azimuth_deg - leg.path.end_azimuth_deg);
            corner = pen.join(leg.to, leg.path.end_azimuth_deg + 90.0, turn_deg, half_m);
        }
    }
    pen.cap(last.to, last.path.end_azimuth_deg + 90.0, half_m);
    corner = None;
    for (index, leg) in legs.iter().enumerate().rev() {
        pen.side(leg, -half_m, corner);
        if index > 0 {
            let before = &legs[index - 1];
            let turn_deg = wrap_deg(before.path.end_azimuth_deg - leg.path.start_azimuth_deg);
            corner = pen.join(
                leg.from,
                leg.path.start_azimuth_deg - 90.0,
                turn_deg,
                half_m,
            );
        }
    }
    pen.cap(first.from, first.path.start_azimuth_deg - 90.0, half_m);
    Outline {
        rings: vec![pen.take_ring()],
    }
}

fn legs(pen: &Pen, points: &[LonLat]) -> Vec<Leg> {
    let Some((&first, others)) = points.split_first() else {
        return Vec::new();
    };
    let (mut from, mut legs) = (first, Vec::new());
    for &to in others {
        let path = shortest_path(pen.geodesic, from, to);
        if path.length_m >= CORNER_M {
            legs.push(Leg { from, to, path });
            from = to;
        }
    }
    legs
}

impl Pen<'_> {
    /// One side of a leg: the right one forward, the left one backward; without its end. `corner`
    /// is where it starts if that is not square to the leg's first point.
    fn side(&mut self, leg: &Leg, right_m: f64, corner: Option<LonLat>) {
        let beside = Beside {
            start: leg.from,
            azimuth_deg: leg.path.start_azimuth_deg,
            right_m,
        };
        let length_m = leg.path.length_m;
        let edge = CurveKind::Beside(beside);
        let ends = [
            (leg.from, leg.path.start_azimuth_deg, 0.0),
            (leg.to, leg.path.end_azimuth_deg, length_m),
        ];
        let (point, azimuth_deg, _) = if right_m > 0.0 { ends[0] } else { ends[1] };
        let start = corner.unwrap_or_else(|| self.square_to(point, azimuth_deg, right_m).position);
        self.push(start, edge);
        let mut stops = self.side_stops(leg, right_m);
        if right_m < 0.0 {
            stops.reverse();
        }
        for along_m in stops {
            let position = self.beside(leg, along_m, right_m).position;
            self.push(position, edge);
        }
    }

    fn square_to(&self, point: LonLat, azimuth_deg: f64, right_m: f64) -> Arrival {
        let aside_deg = 90_f64.copysign(right_m);
        arrive(self.geodesic, point, azimuth_deg + aside_deg, right_m.abs())
    }

    fn beside(&self, leg: &Leg, along_m: f64, right_m: f64) -> Arrival {
        let foot = arrive(self.geodesic, leg.from, leg.path.start_azimuth_deg, along_m);
        self.square_to(foot.position, foot.azimuth_deg, right_m)
    }

    /// Distances along a leg at which its side's latitude or longitude turns back.
    fn side_stops(&self, leg: &Leg, right_m: f64) -> Vec<f64> {
        let length_m = leg.path.length_m;
        let steps = (length_m / SEARCH_STEP_M).ceil() as u32;
        let at = |along_m| self.beside(leg, along_m, right_m);
        let mut stops = turns_of_longitude(at, 0.0, length_m, steps);
        stops.extend(turns_of_latitude(at, 0.0, length_m, steps));
        stops.sort_by(f64::total_cmp);
        let mut last_m = 0.0;
        stops.retain(|&along_m| {
            let keep = along_m > last_m + CORNER_M && along_m + CORNER_M < length_m;
            if keep {
                last_m = along_m;
            }
            keep
        });
        stops
    }

    /// From the end of one side to the start of the next, both beside the same point of the line:
    /// round the outside of the bend, or through the point. Answers where the next side starts if
    /// it is cut short.
    fn join(&mut self, point: LonLat, from_deg: f64, turn_deg: f64, half_m: f64) -> Option<LonLat> {
        let turn_rad = turn_deg.to_radians();
        let circle = Circle {
            centre: point,
            radius_m: half_m,
        };
        if turn_rad.abs() * half_m < CORNER_M {
            // The next side starts where this one ends.
            return None;
        }
        if turn_deg < 0.0 {
            self.arc(circle, from_deg, turn_deg);
            return None;
        }
        // On the inner side of slight bends the sides cross too flatly to be told apart: there they
        // are cut where they meet, on the bisector.
        let overlap_m = half_m * turn_rad * turn_rad;
        let bulge = (half_m / self.geodesic.equatorial_radius()).powi(2);
        if overlap_m < 2.0 * CORNER_M && overlap_m * bulge < 0.1 * CORNER_M {
            let reach_m = half_m / (0.5 * turn_rad).cos();
            let bisector_deg = from_deg + 0.5 * turn_deg;
            return Some(arrive(self.geodesic, point, bisector_deg, reach_m).position);
        }
        let end = self.on_circle(circle, from_deg);
        self.push(end.position, CurveKind::Geodesic);
        self.push(point, CurveKind::Geodesic);
        None
    }

    /// Half a circle round an end of the line, from the azimuth of one side to that of the other.
    fn cap(&mut self, point: LonLat, from_deg: f64, half_m: f64) {
        let circle = Circle {
            centre: point,
            radius_m: half_m,
        };
        self.arc(circle, from_deg, -180.0);
    }
}
