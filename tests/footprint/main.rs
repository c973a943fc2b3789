//! Footprints against ray casting and angles.

mod draws;
mod truth;
mod winding;

use globefill::{Footprint, FootprintBound, FootprintEdge, glam::DVec3};

use crate::{
    draws::{Draws, case},
    truth::Truth,
    winding::Outline,
};

/// Distance at which the two sides of a curve are told apart, metres.
const GATE_M: f64 = 0.01;

/// Directions along the curve and to its left at `t`, if it moves there.
fn heading(edge: &FootprintEdge, truth: &Truth, t: f64) -> Option<(DVec3, DVec3)> {
    let along = edge.ecef_m(t + 1e-5) - edge.ecef_m(t - 1e-5);
    let up = truth.normal(edge.ecef_m(t));
    let left = up.cross(along).try_normalize()?;
    Some((left.cross(up), left))
}

/// The least distance, of decades of metres, at which what bounds the edge is met on the left and not
/// on the right. Infinite if none up to the gate.
fn distance_m(truth: &Truth, bound: FootprintBound, point_m: DVec3, left: DVec3, slack: f64) -> f64 {
    let margin = |offset_m: f64| truth.margin(bound, truth.on_ground(point_m + left * offset_m));
    (0..=16)
        .map(|step| GATE_M * 10_f64.powf(-0.5 * (16 - step) as f64))
        .find(|&offset_m| margin(offset_m) >= -slack && margin(-offset_m) < slack)
        .unwrap_or(f64::INFINITY)
}

/// Whether the sensor sees something within the gate of a point: looked for to its left, and along the
/// curve both ways at ever smaller angles to it, since the corners of footprints can be sharp.
fn sees_near(truth: &Truth, point_m: DVec3, (along, left): (DVec3, DVec3)) -> bool {
    let turns = (0..40).map(|step| 0.5 * std::f64::consts::PI * 10_f64.powf(-0.2 * f64::from(step)));
    truth.sees_nearly(point_m) || turns
        .flat_map(|turn| [(turn, along), (turn, -along)])
        .flat_map(|(turn, along)| [1.0, 0.1, 1e-2, 1e-3, 1e-4].map(|part| (turn, along, part * GATE_M)))
        .any(|(turn, along, reach_m)| {
            let offset = left * turn.sin() + along * turn.cos();
            truth.sees_nearly(truth.on_ground(point_m + offset * reach_m))
        })
}

#[derive(Default, Debug)]
struct Tally {
    worst_m: f64,
    points: usize,
    loops: [usize; 5],
    judged: usize,
    skipped: usize,
    specks: usize,
    undecided: usize,
    undecided_limb: f64,
}

fn check_curves(truth: &Truth, footprint: &Footprint, draws: &mut Draws, tally: &mut Tally) -> Vec<String> {
    let mut wrong = Vec::new();
    for closed in &footprint.loops {
        for (k, edge) in closed.edges.iter().enumerate() {
            let next = &closed.edges[(k + 1) % closed.edges.len()];
            if edge.ecef_m(1.0) != next.ecef_m(0.0) {
                wrong.push(format!("open after edge {k}"));
            }
            let parts = (0..8).map(|part| f64::from(part) / 8.0);
            let length_m: f64 = parts.map(|t| (edge.ecef_m(t + 0.125) - edge.ecef_m(t)).length()).sum();
            if length_m < 1e-4 {
                tally.specks += 1;
                continue;
            }
            for _ in 0..4 {
                let t = match draws.below(4) {
                    0 => draws.log(1e-9, 0.1),
                    1 => 1.0 - draws.log(1e-9, 0.1),
                    _ => draws.real(0.0, 1.0),
                };
                let point_m = edge.ecef_m(t);
                assert!(truth.height_m(point_m).abs() < 1e-8, "not on the ground");
                let Some(heading) = heading(edge, truth, t) else {
                    wrong.push(format!("{:?} {t} stands still", edge.bound()));
                    continue;
                };
                let mut distance_m = distance_m(truth, edge.bound(), point_m, heading.1, 0.0);
                if distance_m > GATE_M {
                    distance_m = self::distance_m(truth, edge.bound(), point_m, heading.1, truth.rounding_rad(point_m));
                    tally.undecided += 1;
 if truth.margin(FootprintBound::Limb, point_m) > 1e-4 {println!("undecided {:?} {:?} {:?} {:?}", edge.bound(), truth.margins(point_m), distance_m, (point_m-truth.apex_m).length());}
                    tally.undecided_limb = tally.undecided_limb.max(truth.margin(FootprintBound::Limb, point_m));
                }
                tally.points += 1;
                tally.worst_m = tally.worst_m.max(distance_m);
                if distance_m > GATE_M || !sees_near(truth, point_m, heading) {
                    wrong.push(format!("{:?} at {t} of edge {k}: {distance_m} {:?}", edge.bound(), truth.margins(point_m)));
                }
            }
        }
    }
    wrong
}

fn check_inside(truth: &Truth, footprint: &Footprint, draws: &mut Draws, tally: &mut Tally) -> Vec<String> {
    let outline = Outline::of(footprint);
    let apex = truth.apex_m / truth.case.ellipsoid.radii_m();
    let middle = apex.normalize();
    let across = middle.any_orthonormal_vector();
    let limb_rad = (apex.length_squared() - 1.0).sqrt().atan2(1.0);
    let edges: Vec<_> = footprint.loops.iter().flat_map(|closed| &closed.edges).collect();
    let mut wrong = Vec::new();
    for number in 0..80 {
        let point_m = match number % 4 {
            0 | 1 => truth.cast(truth.direction(draws)),
            2 if !edges.is_empty() => {
                let point_m = edges[draws.below(edges.len())].ecef_m(draws.real(0.0, 1.0));
                let reach_m = outline.tolerance_m * draws.log(5.0, 5e3);
                Some(truth.on_ground(point_m + draws.direction() * reach_m))
            }
            _ => {
                let turn = draws.real(0.0, 7.0);
                let off_rad = limb_rad * [draws.real(0.0, 1.02), 1.0 - draws.log(1e-6, 1.0)][draws.below(2)];
                let side = across * turn.cos() + middle.cross(across) * turn.sin();
                let unit = middle * off_rad.cos() + side * off_rad.sin();
                Some(unit * truth.case.ellipsoid.radii_m())
            }
        };
        let Some(point_m) = point_m else { continue };
        let Some(winding) = outline.winding(point_m) else {
            tally.skipped += 1;
            continue;
        };
        if truth.cannot_tell(point_m) {
            tally.skipped += 1;
            continue;
        }
        tally.judged += 1;
        let sees = truth.sees(point_m);
        if winding != i32::from(sees) {
            wrong.push(format!("winding {winding} about {point_m}: {:?}", truth.margins(point_m)));
        }
    }
    wrong
}

fn check(cases: std::ops::Range<u64>, case: impl Fn(u64) -> draws::Case) {
    let mut tally = Tally::default();
    let mut failures = 0;
    for number in cases {
        let truth = Truth::new(case(number));
        let footprint = truth.case.sensor.footprint(&truth.case.ellipsoid).unwrap();
        let mut draws = Draws(number);
        tally.loops[footprint.loops.len().min(4)] += 1;
        let mut wrong = check_curves(&truth, &footprint, &mut draws, &mut tally);
        wrong.extend(check_inside(&truth, &footprint, &mut draws, &mut tally));
        if !wrong.is_empty() {
            failures += 1;
            if failures < 25 {
            let bounds: Vec<Vec<_>> = footprint.loops.iter().map(|closed| closed.edges.iter().map(|e| e.bound()).collect()).collect();
            println!("case {number}: {:?} {:?} {:?} {:?}\n {bounds:?}\n  {}", truth.case.view, truth.case.sensor.pose, truth.case.sensor.min_elevation_rad, truth.case.ellipsoid, wrong[..wrong.len().min(4)].join("\n  "));
            }
        }
    }
    println!("{failures} failures, {tally:?}");
    assert_eq!(failures, 0);
}

fn cases() -> u64 { std::env::var("CASES").map_or(1500, |c| c.parse().unwrap()) }

#[test]
fn outlines_are_where_the_sensor_begins_to_see() {
    check(0..cases(), case);
}

#[test]
fn fields_of_view_that_touch_the_horizon() {
    check(0..cases(), draws::touching);
}
#[test]
#[ignore]
fn one() {
    let number = std::env::var("ONE").unwrap().parse().unwrap();
    let truth = Truth::new(draws::touching(number));
    println!("{:?}", truth.case);
    let footprint = truth.case.sensor.footprint(&truth.case.ellipsoid).unwrap();
    for l in &footprint.loops { for e in &l.edges {
        for t in [0.0, 1e-12, 1e-3, 0.5, 0.999, 1.0] {
        println!("{:?} {t} {} {:?}", e.bound(), e.ecef_m(t), truth.margins(e.ecef_m(t)));
        }
    } }
}
