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
/// they are needed.
pub(crate) fn meetings<'a>(
    [first, second]: [&Edge; 2],
    traced: impl Fn() -> [&'a Traced; 2],
    mut found: impl FnMut(Meeting),
) {
    if first.kind == CurveKind::Straight && second.kind == CurveKind::Straight {
        for turns in -2..=2 {
            straight_meetings(first, second, turns, &mut found);
        }
        return;
    }
    if matches!(first.kind, CurveKind::Circle(_)) && first.kind == second.kind {
        return same_circle_meetings([first, second], traced(), found);
    }
    let shared = [second.from, second.to]
        .iter()
        .filter(|&&node| node == first.from || node == first.to)
        .count();
    match shared {
        0 => curved_meetings([first, second], traced(), &mut found),
        // From a common end two curves of one kind part for good (geodesics up to the antipode,
        // which edges never reach); how they part is looked at where they do.
        1 if first.is_also(second.kind) || second.is_also(first.kind) => {}
        1 if first.kind.is_of_zones() || second.kind.is_of_zones() => {
            meetings_beyond_common_node([first, second], traced(), &mut found);
        }
        _ => found(Meeting::Unclear),
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
    use proptest::{prelude::*, test_runner::RngSeed};

    use super::*;
    use crate::{
        boundary::boundary_graph::BoundaryGraph, curve::Curve, geodetic::LonLat, region::EdgeKind,
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
