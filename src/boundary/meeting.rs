//! Where two edges meet: exactly for straight edges, by bisection for curved ones.

use glam::DVec3;

use crate::{
    boundary::boundary_graph::Edge,
    boundary::edge_grid::LatticeBox,
    boundary::lattice::{LatticePoint, TURN, orientation},
    curve::{CurveKind, CurveOn},
    ellipsoid::Ellipsoid,
    geodetic::LonLat,
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

/// Calls `found` for everything that two edges have in common.
pub(crate) fn meetings(
    ellipsoid: &Ellipsoid,
    first: &Edge,
    second: &Edge,
    mut found: impl FnMut(Meeting),
) {
    if first.kind == CurveKind::Straight && second.kind == CurveKind::Straight {
        for turns in -2..=2 {
            straight_meetings(first, second, turns, &mut found);
        }
        return;
    }
    if matches!(first.kind, CurveKind::Circle(_)) && first.kind == second.kind {
        return same_circle_meetings(ellipsoid, first, second, found);
    }
    let shared = [second.from, second.to]
        .iter()
        .filter(|&&node| node == first.from || node == first.to)
        .count();
    match shared {
        0 => {
            let curves = [first, second].map(|edge| edge.curve().on(ellipsoid));
            curved_meetings([first, second], &curves[0], &curves[1], &mut found);
        }
        // From a common end two curves of one kind part for good (geodesics up to the antipode,
        // which edges never reach); how they part is looked at where they do.
        1 if first.is_also(second.kind) || second.is_also(first.kind) => {}
        1 if first.kind.is_of_zones() || second.kind.is_of_zones() => {
            let curves = [first, second].map(|edge| edge.curve().on(ellipsoid));
            meetings_beyond_common_node([first, second], &curves[0], &curves[1], &mut found);
        }
        _ => found(Meeting::Unclear),
    }
}

/// Curves that leave a common node with at least this sine between them part at once.
const PARTING_SINE: f64 = 1e-2;

/// Meetings of two edges of different kinds with a common end node. Where they leave it along a
/// common tangent, as a corridor's sides and ends do, they only touch there.
fn meetings_beyond_common_node(
    edges: [&Edge; 2],
    first: &CurveOn,
    second: &CurveOn,
    found: &mut impl FnMut(Meeting),
) {
    let node = if edges[0].from == edges[1].from || edges[0].from == edges[1].to {
        edges[0].from
    } else {
        edges[0].to
    };
    let shorter_m = [first, second]
        .map(|curve| curve.ecef(0.0).distance(curve.ecef(1.0)))
        .into_iter()
        .fold(1.0, f64::min);
    let headings = [(edges[0], first), (edges[1], second)].map(|(edge, curve)| {
        let length_m = curve.ecef(0.0).distance(curve.ecef(1.0));
        let share = 0.01 * shorter_m / length_m;
        let (at, on) = if edge.from == node {
            (0.0, share)
        } else {
            (1.0, 1.0 - share)
        };
        (curve.ecef(on) - curve.ecef(at)).normalize_or_zero()
    });
    if headings[0].cross(headings[1]).length() < PARTING_SINE {
        return found(Meeting::Unclear);
    }
    let common = first.ellipsoid().ecef(node_position(edges[0], node), 0.0);
    curved_meetings(edges, first, second, &mut |meeting| match meeting {
        Meeting::NodeOnFirst(end) | Meeting::NodeOnSecond(end) if end == node => {}
        Meeting::Crossing(point) => {
            let position = first.ellipsoid().ecef(point.lon_lat(), 0.0);
            if position.distance(common) > 4.0 * TOUCH_M / PARTING_SINE {
                found(meeting);
            }
        }
        meeting => found(meeting),
    });
}

fn node_position(edge: &Edge, node: u32) -> LonLat {
    let end = if edge.from == node {
        edge.start
    } else {
        edge.end
    };
    end.lon_lat()
}

/// Arcs of one circle do not cross: they have an end of one in common with the other, or nothing.
fn same_circle_meetings(
    ellipsoid: &Ellipsoid,
    first: &Edge,
    second: &Edge,
    mut found: impl FnMut(Meeting),
) {
    let ends_on = |arc: &Edge, other: &Edge| {
        let curve = arc.curve().on(ellipsoid);
        let nodes = [(other.from, other.start), (other.to, other.end)];
        nodes
            .into_iter()
            .filter(|&(node, _)| node != arc.from && node != arc.to)
            .filter(|(_, point)| {
                let t = curve.parameter_on_circle(point.lon_lat());
                t.is_some_and(|t| t > 0.0 && t < 1.0)
            })
            .map(|(node, _)| node)
            .collect::<Vec<_>>()
    };
    let on_first = ends_on(first, second);
    on_first
        .into_iter()
        .for_each(|node| found(Meeting::NodeOnFirst(node)));
    let on_second = ends_on(second, first);
    on_second
        .into_iter()
        .for_each(|node| found(Meeting::NodeOnSecond(node)));
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

/// Curves nearer than this, metres, are taken to meet: ten times the rounding of positions.
const TOUCH_M: f64 = 1e-5;

/// Pieces that lie no further, metres, beside their chords are straight enough to be crossed.
const STRAIGHT_M: f64 = 4e-6;

/// Bisects both curves until their hulls part or cross.
fn curved_meetings(
    edges: [&Edge; 2],
    first: &CurveOn,
    second: &CurveOn,
    found: &mut impl FnMut(Meeting),
) {
    let mut touch = None;
    let mut crossings: Vec<DVec3> = Vec::new();
    let mut stack = vec![(Hull::of(first, 0.0, 1.0), Hull::of(second, 0.0, 1.0))];
    let mut budget = 4096;
    while let Some((a, b)) = stack.pop() {
        if a.distance_m(&b) > a.radius_m + b.radius_m {
            continue;
        }
        budget -= 1;
        if budget == 0 {
            return found(Meeting::Unclear);
        }
        if let Some(t) = a.crossing(&b) {
            let t = a.t0 + t * (a.t1 - a.t0);
            crossings.push(first.ecef(t));
            let point = LatticePoint::nearest(first.lon_lat(t));
            found(Meeting::Crossing(on_grid_lines(edges, point.canonical())));
        } else if a.length_m().max(b.length_m()) < TOUCH_M {
            touch = Some((a.start, touching(edges, first, &a, &b)));
        } else if a.length_m() + a.radius_m >= b.length_m() + b.radius_m {
            stack.extend(a.parts(first).map(|part| (part, b)));
        } else {
            stack.extend(b.parts(second).map(|part| (a, part)));
        }
    }
    // All pieces next to a touching point touch: it is one. Those next to a crossing may, too.
    let is_new = |&(at, _): &(DVec3, Meeting)| {
        crossings
            .iter()
            .all(|crossing| crossing.distance(at) > 4.0 * TOUCH_M)
    };
    touch
        .filter(is_new)
        .into_iter()
        .for_each(|(_, meeting)| found(meeting));
}

/// What short pieces that touch have in common: an end of one edge, or else a crossing so flat that
/// it could not be seen.
fn touching(edges: [&Edge; 2], first: &CurveOn, a: &Hull, b: &Hull) -> Meeting {
    let node_of = |edge: &Edge, hull: &Hull| match (hull.t0 == 0.0, hull.t1 == 1.0) {
        (true, _) => Some(edge.from),
        (_, true) => Some(edge.to),
        _ => None,
    };
    if let Some(node) = node_of(edges[1], b) {
        return Meeting::NodeOnFirst(node);
    }
    if let Some(node) = node_of(edges[0], a) {
        return Meeting::NodeOnSecond(node);
    }
    let point = LatticePoint::nearest(first.lon_lat(a.t0)).canonical();
    Meeting::Crossing(on_grid_lines(edges, point))
}

/// A point common to two edges, put exactly on those that are meridians or parallels: splitting
/// them there must not bend them.
fn on_grid_lines(edges: [&Edge; 2], mut point: LatticePoint) -> LatticePoint {
    for edge in edges.iter().filter(|edge| edge.kind == CurveKind::Straight) {
        if edge.turn() == 0 {
            point.lon = edge.start.lon;
        }
        if edge.start.lat == edge.end.lat {
            point.lat = edge.start.lat;
        }
    }
    point
}

/// A piece of a curve: it lies within `radius_m` of its chord.
#[derive(Clone, Copy)]
struct Hull {
    t0: f64,
    t1: f64,
    start: DVec3,
    end: DVec3,
    /// Unit vector across the wall through the chord.
    across: DVec3,
    /// How far the curve may lie from the plane of that wall.
    deviation_m: f64,
    radius_m: f64,
}

impl Hull {
    fn of(curve: &CurveOn, t0: f64, t1: f64) -> Self {
        let (start, end) = (curve.ecef(t0), curve.ecef(t1));
        let deviation_m = curve.deviation_bound_m(t0, t1);
        let ellipsoid = curve.ellipsoid();
        let up = ellipsoid.normal_at_surface(start) + ellipsoid.normal_at_surface(end);
        let sag_m = ellipsoid.chord_sag_m(start.distance(end));
        Self {
            t0,
            t1,
            start,
            end,
            across: (end - start).cross(up).normalize_or_zero(),
            deviation_m,
            radius_m: deviation_m + sag_m,
        }
    }

    fn length_m(&self) -> f64 {
        self.start.distance(self.end)
    }

    /// Not halves: inputs have so many symmetries that curves would often meet at the cut.
    fn parts(&self, curve: &CurveOn) -> [Self; 2] {
        let cut = self.t0 + 0.4857 * (self.t1 - self.t0);
        [Self::of(curve, self.t0, cut), Self::of(curve, cut, self.t1)]
    }

    /// Where along this piece, 0 … 1, the other one crosses it, if each surely has its ends on
    /// both sides of the other.
    fn crossing(&self, other: &Self) -> Option<f64> {
        let sides = |plane: &Self, line: &Self| {
            let sides = [line.start, line.end].map(|p| (p - plane.start).dot(plane.across));
            let clear = sides
                .iter()
                .all(|side| side.abs() > plane.deviation_m * 1.01 + 1e-7);
            (clear && sides[0] * sides[1] < 0.0).then_some(sides)
        };
        // Longer pieces are so bent that "on both sides" need not mean a single crossing, and the
        // chords' common point would lie beside the curves': here by some 10⁻⁶ m at most.
        let is_bent = |piece: &Self| piece.length_m() > 20.0 || piece.deviation_m > STRAIGHT_M;
        if is_bent(self) || is_bent(other) {
            return None;
        }
        sides(self, other)?;
        let [start, end] = sides(other, self)?;
        Some(start / (start - end))
    }

    /// Distance, metres, between the two chords.
    fn distance_m(&self, other: &Self) -> f64 {
        let (u, v) = (self.end - self.start, other.end - other.start);
        let w = self.start - other.start;
        let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
        let (uw, vw) = (u.dot(w), v.dot(w));
        let ratio = |a: f64, b: f64| {
            if b > 0.0 {
                (a / b).clamp(0.0, 1.0)
            } else {
                0.0
            }
        };
        let at = |s: f64, t: f64| (w + u * s - v * t).length();
        // The nearest points are inside both, or at an end of one.
        let determinant = uu * vv - uv * uv;
        let s = ratio(uv * vw - vv * uw, determinant);
        let t = ratio(s * uv + vw, vv);
        let s = ratio(t * uv - uw, uu);
        [
            at(s, t),
            at(0.0, ratio(vw, vv)),
            at(1.0, ratio(uv + vw, vv)),
            at(ratio(-uw, uu), 0.0),
            at(ratio(uv - uw, uu), 1.0),
        ]
        .into_iter()
        .fold(f64::INFINITY, f64::min)
    }
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
    use crate::{boundary::boundary_graph::BoundaryGraph, curve::Curve, region::EdgeKind};

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
        meetings(&Ellipsoid::WGS84, &first, &second, |meeting| {
            all.push(meeting)
        });
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
