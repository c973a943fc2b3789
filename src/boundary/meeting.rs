//! Where two edges meet: exactly for straight edges, by bisection for curved ones.

use crate::{
    boundary::boundary_graph::Edge,
    boundary::curved_meeting::{
        Traced, curved_meetings, meetings_beyond_common_node, same_circle_meetings,
    },
    boundary::lattice::{LatticePoint, TURN, orientation},
    boundary::lattice_box::LatticeBox,
    curve::{CurveKind, CurveOn},
    ellipsoid::Ellipsoid,
};

/// What two edges have in common besides shared end nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Meeting {
    /// They cross at an inner point of both.
    Crossing(LatticePoint),
    /// This end node of the second edge lies exactly on the first.
    NodeOnFirst(u32),
    /// This end node of the first edge lies exactly on the second.
    NodeOnSecond(u32),
    /// They come too close to say.
    Unclear,
}

/// Calls `found` for everything that two edges have in common. `traced` gives their curves where
/// they are needed. Answers how many pairs of pieces of curves it looked at.
pub(crate) fn meetings<'a>(
    [first, second]: [&Edge; 2],
    traced: impl Fn() -> [&'a Traced; 2],
    mut found: impl FnMut(Meeting),
) -> usize {
    if first.kind == CurveKind::Straight && second.kind == CurveKind::Straight {
        for turns in -2..=2 {
            straight_meetings(first, second, turns, &mut found);
        }
        return 0;
    }
    if matches!(first.kind, CurveKind::Circle(_)) && first.kind == second.kind {
        same_circle_meetings([first, second], traced(), found);
        return 0;
    }
    let shared = [second.from, second.to]
        .iter()
        .filter(|&&node| node == first.from || node == first.to)
        .count();
    match shared {
        0 => curved_meetings([first, second], traced(), &mut found),
        // From a common end two curves of one kind part for good (geodesics up to the antipode,
        // which edges never reach); how they part is looked at where they do.
        1 if first.is_also(second.kind) || second.is_also(first.kind) => 0,
        1 if first.kind.is_of_zones() || second.kind.is_of_zones() => {
            meetings_beyond_common_node([first, second], traced(), &mut found)
        }
        _ => {
            found(Meeting::Unclear);
            0
        }
    }
}

/// Meetings of two straight edges on the lon/lat plane, the second moved by whole turns.
fn straight_meetings(first: &Edge, second: &Edge, turns: i64, found: &mut impl FnMut(Meeting)) {
    let (a, b) = (first.start, first.end);
    let (c, d) = (second.start.turned(turns), second.end.turned(turns));
    if a.lon.max(b.lon) < c.lon.min(d.lon) || c.lon.max(d.lon) < a.lon.min(b.lon) {
        return;
    }
    let (c_side, d_side) = (orientation(a, b, c).signum(), orientation(a, b, d).signum());
    if c_side * d_side > 0 {
        return;
    }
    let (a_side, b_side) = (orientation(c, d, a).signum(), orientation(c, d, b).signum());
    if a_side * b_side > 0 {
        return;
    }
    for (side, point, node) in [(c_side, c, second.from), (d_side, d, second.to)] {
        if side == 0 && is_between(a, b, point) && node != first.from && node != first.to {
            found(Meeting::NodeOnFirst(node));
        }
    }
    for (side, point, node) in [(a_side, a, first.from), (b_side, b, first.to)] {
        if side == 0 && is_between(c, d, point) && node != second.from && node != second.to {
            found(Meeting::NodeOnSecond(node));
        }
    }
    if c_side * d_side < 0 && a_side * b_side < 0 {
        let (c_area, d_area) = (orientation(a, b, c) as f64, orientation(a, b, d) as f64);
        let t = c_area / (c_area - d_area);
        let along = |from: i64, to: i64| from + ((to - from) as f64 * t).round() as i64;
        let point = LatticePoint::new(along(c.lon, d.lon), along(c.lat, d.lat));
        found(Meeting::Crossing(point.canonical()));
    }
}

/// Whether a point on the line through `a` and `b` lies strictly between them.
fn is_between(a: LatticePoint, b: LatticePoint, point: LatticePoint) -> bool {
    let within = |low: i64, high: i64, x: i64| (low.min(high)..=low.max(high)).contains(&x);
    within(a.lon, b.lon, point.lon) && within(a.lat, b.lat, point.lat) && point != a && point != b
}

/// Whether an edge, in any turn, runs over a longitude by the half-open rule (its western end
/// counts, its eastern does not) and does so north of `point`.
pub(crate) fn passes_north_of(ellipsoid: &Ellipsoid, edge: &Edge, point: LatticePoint) -> bool {
    let (west, east) = if edge.turn() >= 0 {
        (edge.start, edge.end)
    } else {
        (edge.end, edge.start)
    };
    let edge_box = LatticeBox::around(edge);
    if edge_box.north < point.lat {
        return false;
    }
    let first_turn = (west.lon - point.lon).div_euclid(TURN);
    let mut turned = point.turned(first_turn);
    while turned.lon < west.lon {
        turned = turned.turned(1);
    }
    if turned.lon >= east.lon {
        return false;
    }
    if edge_box.south > point.lat {
        return true;
    }
    match edge.kind {
        CurveKind::Straight => orientation(west, east, turned) < 0,
        _ => latitude_at(&edge.curve().on(ellipsoid), edge, turned) > turned.lon_lat().lat_deg,
    }
}

/// Latitude, degrees, of a curved edge at the longitude of `point`, which it runs over.
fn latitude_at(curve: &CurveOn, edge: &Edge, point: LatticePoint) -> f64 {
    let share = (point.lon - edge.start.lon) as f64 / edge.turn() as f64;
    if edge.kind == CurveKind::Rhumb {
        return curve.lon_lat(share).lat_deg;
    }
    // The longitude of the others is monotonous but not linear.
    let wanted_deg = point.lon_lat().lon_deg - edge.start.lon_lat().lon_deg;
    let start_deg = curve.lon_lat(0.0).lon_deg;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let passed = (curve.lon_lat(middle).lon_deg - start_deg - wanted_deg) * edge.turn() as f64;
        if passed < 0.0 {
            low = middle
        } else {
            high = middle
        }
    }
    curve.lon_lat(0.5 * (low + high)).lat_deg
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::{prelude::*, test_runner::RngSeed};

    use super::*;
    use crate::{
        boundary::boundary_graph::BoundaryGraph,
        curve::{Beside, Curve},
        geodetic::LonLat,
        region::EdgeKind,
    };

    fn edges(kind: EdgeKind, lines: [[(f64, f64); 2]; 2]) -> [Edge; 2] {
        let mut graph = BoundaryGraph::default();
        lines.map(|line| {
            let [a, b] = line.map(|(lon, lat)| LonLat::new(lon, lat));
            let edge = graph.insert_curve(&Curve::between(kind, a, b)).unwrap();
            graph.walk(edge)
        })
    }

    fn all(kind: EdgeKind, lines: [[(f64, f64); 2]; 2]) -> Vec<Meeting> {
        let [first, second] = edges(kind, lines);
        let mut all = Vec::new();
        let traced = [&first, &second].map(|edge| Traced::new(&Ellipsoid::WGS84, edge));
        meetings(
            [&first, &second],
            || [&traced[0], &traced[1]],
            |meeting| all.push(meeting),
        );
        all
    }

    #[test]
    fn straight_edges_meet_exactly() {
        let straight = |a, b| all(EdgeKind::Straight, [a, b]);
        let point = |lon, lat| LatticePoint::nearest(LonLat::new(lon, lat)).canonical();
        assert_eq!(
            straight([(179.0, 0.0), (-179.0, 2.0)], [(180.0, 0.0), (180.0, 2.0)]),
            [Meeting::Crossing(point(180.0, 1.0))]
        );
        assert_eq!(
            straight([(179.0, 0.0), (-179.0, 0.0)], [(180.0, 0.0), (180.0, 2.0)]),
            [Meeting::NodeOnFirst(2)]
        );
        assert_eq!(
            straight([(0.0, 0.0), (3.0, 3.0)], [(1.0, 1.0), (9.0, 9.0)]),
            [Meeting::NodeOnFirst(2), Meeting::NodeOnSecond(1)]
        );
        assert_eq!(
            straight([(0.0, 0.0), (3.0, 3.0)], [(3.0, 3.0), (9.0, 9.0)]),
            []
        );
        assert_eq!(
            straight([(0.0, 0.0), (3.0, 3.0)], [(1.0, 1.1), (9.0, 9.0)]),
            []
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

        #[test]
        fn curved_edges_meet_where_straight_ones_do_when_short(
            lon_deg in -180.0..180.0_f64,
            lat_deg in -80.0..80.0_f64,
            scale in 0.001..0.1_f64,
            ends in prop::array::uniform4((-1.0..1.0_f64, -1.0..1.0_f64)),
        ) {
            // In a chart of the middle latitude all three kinds are nearly straight lines.
            let widen = 1.0 / lat_deg.to_radians().cos();
            let place = |p: (f64, f64)| (lon_deg + scale * widen * p.0, lat_deg + scale * p.1);
            let lines = [[place(ends[0]), place(ends[1])], [place(ends[2]), place(ends[3])]];
            let cross = |o: (f64, f64), a: (f64, f64), b: (f64, f64)| {
                (a.0 - o.0) * (b.1 - o.1) - (a.1 - o.1) * (b.0 - o.0)
            };
            let sides = [
                cross(ends[0], ends[1], ends[2]), cross(ends[0], ends[1], ends[3]),
                cross(ends[2], ends[3], ends[0]), cross(ends[2], ends[3], ends[1]),
            ];
            prop_assume!(sides.iter().all(|side| side.abs() > 0.05));
            let crossing = sides[0] * sides[1] < 0.0 && sides[2] * sides[3] < 0.0;
            for kind in [EdgeKind::Geodesic, EdgeKind::Rhumb, EdgeKind::Straight] {
                let found = all(kind, lines);
                prop_assert_eq!(found.len(), usize::from(crossing), "{:?} {:?}", kind, &found);
                prop_assert!(!found.contains(&Meeting::Unclear));
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, rng_seed: RngSeed::Fixed(2), ..ProptestConfig::default() })]

        /// On the sphere planes through the centre tell which great circles cross.
        #[test]
        fn great_circles_micrometres_beside_each_other_cross_or_not(
            from in (-180.0..180.0_f64, -70.0..70.0_f64),
            azimuth_rad in 0.0..std::f64::consts::TAU,
            length_rad in 0.01..2.0_f64,
            within in (0.0..0.3_f64, 0.7..1.0_f64),
            aside in (-5.0..1.0_f64, -5.0..1.0_f64, any::<(bool, bool)>()),
        ) {
            let sphere = Ellipsoid::sphere(6.4e6);
            let start = sphere.normal(LonLat::new(from.0, from.1));
            let east = DVec3::Z.cross(start).normalize();
            let (sin, cos) = azimuth_rad.sin_cos();
            let ahead = east * sin + start.cross(east) * cos;
            let across = ahead.cross(start);
            let at = |share: f64, aside_m: f64| {
                let (sin, cos) = (share * length_rad).sin_cos();
                let point = start * cos + ahead * sin + across * (aside_m / sphere.a_m);
                let lat_deg = point.z.atan2(point.x.hypot(point.y)).to_degrees();
                (point.y.atan2(point.x).to_degrees(), lat_deg)
            };
            let (a, b, signs) = aside;
            let aside_m = |exponent: f64, minus| if minus { -1.0 } else { 1.0 } * 10_f64.powf(exponent);
            let lines = [
                [at(0.0, 0.0), at(1.0, 0.0)],
                [at(within.0, aside_m(a, signs.0)), at(within.1, aside_m(b, signs.1))],
            ];
            let edges = edges(EdgeKind::Geodesic, lines);
            // Lattice points are beside what was asked for.
            let ends = [0, 1].map(|k| {
                let curve = edges[k].curve().on(&sphere);
                [curve.ecef(0.0), curve.ecef(1.0)]
            });
            let sides = |plane: [DVec3; 2], points: [DVec3; 2]| {
                let normal = plane[0].cross(plane[1]).normalize();
                points.map(|point| point.dot(normal))
            };
            let [of_second, of_first] = [sides(ends[0], ends[1]), sides(ends[1], ends[0])];
            prop_assume!(of_second.iter().chain(&of_first).all(|side_m| side_m.abs() > 3e-6));
            let crosses = [of_first, of_second].iter().all(|[a, b]| a * b < 0.0);
            let traced = [0, 1].map(|k| Traced::new(&sphere, &edges[k]));
            let mut found = Vec::new();
            meetings([&edges[0], &edges[1]], || [&traced[0], &traced[1]], |meeting| found.push(meeting));
            // Crossings at less than 10⁻¹⁰ are not always seen.
            let is_flat = a.max(b) < -4.0 && signs.0 != signs.1;
            if is_flat && found == [Meeting::Unclear] {
                return Ok(());
            }
            prop_assert_eq!(found.len(), usize::from(crosses), "{:?} {:?}", of_second, &found);
            for meeting in found {
                let Meeting::Crossing(point) = meeting else {
                    panic!("{meeting:?}")
                };
                let point = sphere.ecef(point.lon_lat(), 0.0);
                for side_m in [0, 1].map(|k| sides(ends[k], [point; 2])[0]) {
                    prop_assert!(side_m.abs() < 4e-6, "{side_m}");
                }
            }
        }
    }

    #[test]
    fn curves_of_all_kinds_beside_each_other_for_long_are_told_apart() {
        for kind in [EdgeKind::Geodesic, EdgeKind::Rhumb] {
            for aside_deg in [1e-3, 1e-6, 1e-8] {
                let lines = |turn: f64| {
                    let far = (60.0, 30.0 + turn * aside_deg);
                    [[(0.0, 10.0), (60.0, 30.0)], [(0.0, 10.0 + aside_deg), far]]
                };
                assert_eq!(all(kind, lines(1.0)), [], "{kind:?} {aside_deg}");
                let [Meeting::Crossing(_)] = all(kind, lines(-1.0))[..] else {
                    panic!("{kind:?} {aside_deg}")
                };
            }
        }
    }

    #[test]
    fn sides_of_a_corridor_round_half_the_globe_part_in_few_pieces() {
        let at = |lon, lat| LonLat::new(lon, lat);
        let side = |right_m, end: LonLat| {
            let beside = Beside {
                start: at(0.0, 0.0),
                azimuth_deg: 90.0,
                right_m,
            };
            // South is to the right of who goes east along the equator.
            let south_deg = right_m / Ellipsoid::WGS84.ecef(at(0.0, 0.0), 0.0).x;
            let aside_deg = -south_deg.to_degrees() / (1.0 - 0.006_694_38);
            let [from, to] = [0.0, end.lon_deg].map(|lon_deg| at(lon_deg, aside_deg));
            Curve::between(CurveKind::Beside(beside), from, to)
        };
        for apart_m in [1e3, 1.0, 1e-3] {
            let mut graph = BoundaryGraph::default();
            let end = at(89.0, 0.0);
            let [first, second] = [-0.5, 0.5].map(|share| {
                let edge = graph.insert_curve(&side(share * apart_m, end)).unwrap();
                graph.walk(edge)
            });
            let traced = [&first, &second].map(|edge| Traced::new(&Ellipsoid::WGS84, edge));
            let mut found = Vec::new();
            let pieces = meetings(
                [&first, &second],
                || [&traced[0], &traced[1]],
                |meeting| found.push(meeting),
            );
            assert_eq!(found, [], "{apart_m}");
            assert!(pieces < 2_000, "{apart_m}: {pieces}");
        }
    }

    #[test]
    fn long_geodesics_cross() {
        let crossing = all(
            EdgeKind::Geodesic,
            [[(-70.0, 40.0), (70.0, 40.0)], [(1.0, 89.0), (1.0, 50.0)]],
        );
        let [Meeting::Crossing(point)] = crossing[..] else {
            panic!("{crossing:?}")
        };
        assert!((point.lon_lat().lon_deg - 1.0).abs() < 1e-9);
        let passed = all(
            EdgeKind::Geodesic,
            [[(-70.0, 40.0), (70.0, 40.0)], [(1.0, 60.0), (1.0, 50.0)]],
        );
        assert_eq!(passed, []);
    }

    #[test]
    fn north_is_told_for_all_kinds() {
        for kind in [EdgeKind::Geodesic, EdgeKind::Rhumb, EdgeKind::Straight] {
            let [edge, _] = edges(
                kind,
                [[(170.0, 10.0), (-150.0, 12.0)], [(0.0, 0.0), (1.0, 1.0)]],
            );
            for walked in [edge, edge.reversed()] {
                let north = |lon: f64, lat: f64| {
                    let point = LatticePoint::nearest(LonLat::new(lon, lat)).canonical();
                    passes_north_of(&Ellipsoid::WGS84, &walked, point)
                };
                assert!(north(170.0, 9.9) && !north(-150.0, 9.9), "half-open");
                assert!(north(180.0, 9.9) && north(-170.0, 9.9) && !north(169.0, 9.9));
                assert!(!north(-170.0, 14.0) && !north(175.0, 12.0));
            }
        }
    }
}
