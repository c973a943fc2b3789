//! Circles, annuli and sectors.

use crate::{
    curve::{Circle, CurveKind, beside::arrive},
    geodetic::LonLat,
    zone::outline::{Outline, Pen},
};

/// Longest piece of a radius, metres: longitude does not turn by more than half a turn on it.
const MAX_RADIUS_PIECE_M: f64 = 5e6;

/// The whole turn between two distances, the lesser of which may be 0.
pub(crate) fn annulus(mut pen: Pen, centre: LonLat, min_m: f64, max_m: f64) -> Outline {
    let circle = |radius_m| Circle { centre, radius_m };
    pen.arc(circle(max_m), 0.0, -360.0);
    let mut rings = vec![pen.take_ring()];
    if min_m > 0.0 {
        pen.arc(circle(min_m), 0.0, 360.0);
        rings.push(pen.take_ring());
    }
    Outline { rings }
}

/// The part between two azimuths: out along the second, back along the outer arc, in along the
/// first, and forth along the inner arc.
pub(crate) fn sector(
    mut pen: Pen,
    centre: LonLat,
    [min_m, max_m]: [f64; 2],
    from_deg: f64,
    sweep_deg: f64,
) -> Outline {
    let circle = |radius_m| Circle { centre, radius_m };
    let to_deg = from_deg + sweep_deg;
    pen.arc(circle(max_m), to_deg, -sweep_deg);
    radius(&mut pen, centre, from_deg, max_m, min_m);
    if min_m > 0.0 {
        pen.arc(circle(min_m), from_deg, sweep_deg);
    }
    radius(&mut pen, centre, to_deg, min_m, max_m);
    Outline {
        rings: vec![pen.take_ring()],
    }
}

/// Along an azimuth from one distance to another, up to, not including, its end.
fn radius(pen: &mut Pen, centre: LonLat, azimuth_deg: f64, from_m: f64, to_m: f64) {
    let pieces = ((to_m - from_m).abs() / MAX_RADIUS_PIECE_M).ceil().max(1.0);
    for piece in 0..pieces as u32 {
        let distance_m = from_m + (to_m - from_m) * f64::from(piece) / pieces;
        let position = if distance_m == 0.0 {
            centre
        } else {
            arrive(pen.geodesic, centre, azimuth_deg, distance_m).position
        };
        pen.push(position, CurveKind::Geodesic);
    }
}
