//! Footprints of random sensors against ray casting and angles.

use std::f64::consts::{FRAC_PI_2, PI};

use globefill::{Footprint, FootprintBound, FootprintEdge, glam::DVec3};

use crate::{
    draws::{Case, Draws},
    truth::Truth,
    winding::Outline,
};

/// Distance within which a curve must be true, metres on the ground.
const GATE_M: f64 = 0.01;

/// What was found over many sensors.
#[derive(Default, Debug)]
pub struct Tally {
    /// By what bounds an edge: points judged, and the least decade and half of metres at which the
    /// sensor begins to see on the left and not on the right, for the worst.
    worst_m: [(usize, f64); 4],
    /// The same of edges of the field of view within a few hundred metres of the limb, where a rounded
    /// angle is up to decimetres on the ground.
    worst_at_limb_m: (usize, f64),
    /// Points of edges where rounding of the judge decides for centimetres across, and the greatest
    /// elevation of the apex there, radians.
    undecided: (usize, f64),
    /// Points with nothing seen within the gate, but each bound met there: where two curves all but
    /// touch, a corner may be off along both.
    slivers: usize,
    /// Greatest distance, metres, from an end of an edge to where its inside tends.
    jump_m: f64,
    /// Edges shorter than a tenth of a millimetre, of which only the ends are judged.
    specks: usize,
    /// Sensors by their number of loops.
    loops: [usize; 4],
    /// Points of the ground for which the winding number was judged, and those too near the outline.
    winding: (usize, usize),
    failures: Vec<String>,
}

/// Judges `cases` of `case`; fails with the first that are wrong.
pub fn judge(cases: u64, case: impl Fn(u64) -> Case) {
    let mut tally = Tally::default();
    for number in 0..cases {
        let truth = Truth::new(case(number));
        let footprint = truth
            .case
            .sensor
            .footprint(&truth.case.ellipsoid)
            .expect("a sensor that can be");
        let mut draws = Draws(number);
        tally.loops[footprint.loops.len().min(3)] += 1;
        let before = tally.failures.len();
        tally.check_curves(&truth, &footprint, &mut draws);
        tally.check_inside(&truth, &footprint, &mut draws);
        if tally.failures.len() > before {
            tally
                .failures
                .insert(before, format!("case {number}: {:?}", truth.case));
        }
    }
    let failures = std::mem::take(&mut tally.failures);
    // Where two curves all but touch, rounding moves their corner along both.
    assert!(tally.jump_m < 1.0, "the ends of an edge are off it");
    println!("{cases} sensors: {tally:#?}");
    let shown = &failures[..failures.len().min(20)];
    assert!(failures.is_empty(), "{}", shown.join("\n"));
}

impl Tally {
    /// Closed loops of curves that are where their bound is met on the left, not on the right, and next
    /// to what is seen.
    fn check_curves(&mut self, truth: &Truth, footprint: &Footprint, draws: &mut Draws) {
        for closed in &footprint.loops {
            for (k, edge) in closed.edges.iter().enumerate() {
                let next = &closed.edges[(k + 1) % closed.edges.len()];
                if edge.ecef_m(1.0) != next.ecef_m(0.0) {
                    self.failures.push(format!("open after edge {k}"));
                }
                self.check_corner(truth, edge, next);
                for (end, t) in [(0.0, 1e-9), (1.0, 1.0 - 1e-9)] {
                    let jump_m = (edge.ecef_m(t) - edge.ecef_m(end)).length();
                    let jump_m = jump_m - 1e-8 * length_m(edge);
                    self.jump_m = self.jump_m.max(jump_m);
                }
                if length_m(edge) < 1e-4 {
                    self.specks += 1;
                    continue;
                }
                for _ in 0..4 {
                    let t = match draws.below(4) {
                        0 => draws.log(1e-9, 0.1),
                        1 => 1.0 - draws.log(1e-9, 0.1),
                        _ => draws.real(0.0, 1.0),
                    };
                    self.check_point(truth, edge, t);
                }
            }
        }
    }

    /// A corner lies on both curves.
    fn check_corner(&mut self, truth: &Truth, edge: &FootprintEdge, next: &FootprintEdge) {
        let corner_m = edge.ecef_m(1.0);
        let reach_m = (corner_m - truth.apex_m).length();
        for bound in [edge.bound(), next.bound()] {
            let off_m = truth.margin(bound, corner_m).abs() * reach_m;
            let slack_m = truth.rounding_rad(corner_m) * reach_m;
            // A margin of elevation counts on the ground, of the view across the line of sight.
            if off_m > 1e-4 + 4.0 * slack_m {
                self.failures
                    .push(format!("corner {off_m} m off {bound:?}"));
            }
        }
    }

    fn check_point(&mut self, truth: &Truth, edge: &FootprintEdge, t: f64) {
        let (point_m, bound) = (edge.ecef_m(t), edge.bound());
        let position = edge.lon_lat(t);
        let again_m = truth.case.ellipsoid.ecef(position, 0.0);
        if truth.height_m(point_m).abs() > 1e-8 || (again_m - point_m).length() > 1e-7 {
            self.failures
                .push(format!("{point_m} is not on the ground"));
        }
        let Some(heading) = heading(edge, truth, t) else {
            self.failures.push(format!("{bound:?} stands still at {t}"));
            return;
        };
        let kind = match bound {
            FootprintBound::OuterCone | FootprintBound::InnerCone => 0,
            FootprintBound::Side(_) => 1,
            FootprintBound::Limb => 2,
            FootprintBound::MinElevation => 3,
        };
        let distance = distance_m(truth, bound, point_m, heading.1, 0.0);
        let rounding_rad = truth.rounding_rad(point_m);
        let elevation_rad = truth.margin(FootprintBound::Limb, point_m);
        if let Some(distance_m) = distance {
            let worst = if kind < 2 && elevation_rad < 1e-4 {
                &mut self.worst_at_limb_m
            } else {
                &mut self.worst_m[kind]
            };
            *worst = (worst.0 + 1, worst.1.max(distance_m));
        } else if distance_m(truth, bound, point_m, heading.1, rounding_rad).is_some() {
            self.undecided.0 += 1;
            self.undecided.1 = self.undecided.1.max(elevation_rad);
        } else {
            let margins = truth.margins(point_m);
            self.failures
                .push(format!("{bound:?} at {t} is not where it is: {margins:?}"));
        }
        if sees_near(truth, point_m, heading) {
            return;
        }
        if meets_each(truth, point_m, heading) {
            self.slivers += 1;
            return;
        }
        let margins = truth.margins(point_m);
        self.failures
            .push(format!("nothing seen at {t} of {bound:?}: {margins:?}"));
    }

    /// Winding numbers of the loops against the definition, over the whole visible cap, along rays
    /// through the field of view and its edges, near the outline and near the limb.
    fn check_inside(&mut self, truth: &Truth, footprint: &Footprint, draws: &mut Draws) {
        let outline = Outline::of(footprint);
        let edges: Vec<_> = footprint
            .loops
            .iter()
            .flat_map(|closed| &closed.edges)
            .collect();
        for number in 0..80 {
            let point_m = match number % 4 {
                0 | 1 => truth.cast(truth.direction(draws)),
                2 if !edges.is_empty() => {
                    let point_m = edges[draws.below(edges.len())].ecef_m(draws.real(0.0, 1.0));
                    let reach_m = outline.tolerance_m * draws.log(5.0, 5e3);
                    Some(truth.on_ground(point_m + draws.direction() * reach_m))
                }
                _ => Some(cap_point_m(truth, draws)),
            };
            let Some(point_m) = point_m else { continue };
            match outline.winding(point_m) {
                Some(winding) if !truth.cannot_tell(point_m) => {
                    self.winding.0 += 1;
                    let position = truth.case.ellipsoid.geodetic(point_m).0;
                    let sees = truth.sees(point_m);
                    if winding != i32::from(sees) || sees != footprint.contains(position) {
                        let margins = truth.margins(point_m);
                        self.failures
                            .push(format!("winding {winding} about {point_m}: {margins:?}"));
                    }
                }
                _ => self.winding.1 += 1,
            }
        }
    }
}

/// A point of the visible cap, often near the limb, sometimes a little behind.
fn cap_point_m(truth: &Truth, draws: &mut Draws) -> DVec3 {
    let radii_m = truth.case.ellipsoid.radii_m();
    let apex = truth.apex_m / radii_m;
    let middle = apex.normalize();
    let across = middle.any_orthonormal_vector();
    let limb_rad = (apex.length_squared() - 1.0).sqrt().atan2(1.0);
    let turn = draws.real(-PI, PI);
    let part = [draws.real(0.0, 1.02), 1.0 - draws.log(1e-6, 1.0)][draws.below(2)];
    let side = across * turn.cos() + middle.cross(across) * turn.sin();
    let off_rad = limb_rad * part;
    (middle * off_rad.cos() + side * off_rad.sin()) * radii_m
}

fn length_m(edge: &FootprintEdge) -> f64 {
    (0..8)
        .map(|part| f64::from(part) / 8.0)
        .map(|t| (edge.ecef_m(t + 0.125) - edge.ecef_m(t)).length())
        .sum()
}

/// Unit vectors along the curve and to its left at `t`, if it moves there.
fn heading(edge: &FootprintEdge, truth: &Truth, t: f64) -> Option<(DVec3, DVec3)> {
    let along = edge.ecef_m(t + 1e-5) - edge.ecef_m(t - 1e-5);
    let up = truth.normal(edge.ecef_m(t));
    let left = up.cross(along).try_normalize()?;
    Some((left.cross(up), left))
}

/// The least distance, of half decades of metres up to the gate, at which `bound` is met on the left and
/// not on the right.
fn distance_m(
    truth: &Truth,
    bound: FootprintBound,
    point_m: DVec3,
    left: DVec3,
    slack_rad: f64,
) -> Option<f64> {
    let margin = |offset_m: f64| truth.margin(bound, truth.on_ground(point_m + left * offset_m));
    (0..=16)
        .map(|step| GATE_M * 10_f64.powf(-0.5 * f64::from(16 - step)))
        .find(|&offset_m| margin(offset_m) >= -slack_rad && margin(-offset_m) < slack_rad)
}

/// Whether the sensor sees something within the gate of a point: looked for to its left, and along the
/// curve both ways at ever smaller angles to it, since the corners of footprints can be sharp.
fn sees_near(truth: &Truth, point_m: DVec3, (along, left): (DVec3, DVec3)) -> bool {
    let turns = (0..40).map(|step| FRAC_PI_2 * 10_f64.powf(-0.2 * f64::from(step)));
    truth.sees_nearly(point_m)
        || turns
            .flat_map(|turn| [(turn, along), (turn, -along)])
            .flat_map(|way| [1.0, 0.1, 1e-2, 1e-3, 1e-4].map(|part| (way, part * GATE_M)))
            .any(|((turn, along), reach_m)| {
                let offset = left * turn.sin() + along * turn.cos();
                truth.sees_nearly(truth.on_ground(point_m + offset * reach_m))
            })
}

/// Whether every bound is met somewhere within the gate of a point.
fn meets_each(truth: &Truth, point_m: DVec3, (along, left): (DVec3, DVec3)) -> bool {
    let around: Vec<_> = (0..16)
        .map(|step| f64::from(step) * PI / 8.0)
        .map(|turn| (left * turn.sin() + along * turn.cos()) * GATE_M)
        .map(|offset| truth.margins(truth.on_ground(point_m + offset)))
        .collect();
    let bounds = truth.margins(point_m).len();
    (0..bounds).all(|bound| around.iter().any(|margins| margins[bound].1 >= 0.0))
}
