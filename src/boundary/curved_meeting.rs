//! Where curved edges meet: by bisection, and by differences where they run side by side.

use glam::DVec3;

use crate::{
    boundary::alongside::{Alongside, alongside},
    boundary::boundary_graph::Edge,
    boundary::lattice::LatticePoint,
    boundary::meeting::Meeting,
    curve::{CurveKind, CurveOn},
    ellipsoid::Ellipsoid,
    geodetic::LonLat,
};

/// Curves nearer than this, metres, are taken to meet: ten times the rounding of positions.
const TOUCH_M: f64 = 1e-5;

/// Pieces that lie no further, metres, beside their chords are straight enough to be crossed.
const STRAIGHT_M: f64 = 4e-6;

/// An edge's curve with the hull of the whole, which most pairs need no more than.
pub(crate) struct Traced {
    curve: CurveOn,
    hull: Hull,
}

impl Traced {
    pub(crate) fn new(ellipsoid: &Ellipsoid, edge: &Edge) -> Self {
        let curve = edge.curve().on(ellipsoid);
        let hull = Hull::of(&curve, 0.0, 1.0);
        Self { curve, hull }
    }
}

/// Pairs of pieces looked at that rounding does not tell apart: curves that meet at an angle do so in a
/// few, and what is one line for long is not worth more.
const MOST_TOGETHER: usize = 8;

/// Pairs of pieces looked at before two edges are left unclear.
const MOST_PIECES: usize = 4096;

/// Bisects both curves until their hulls part or cross. Answers how many pairs of pieces it looked at.
pub(crate) fn curved_meetings(
    edges: [&Edge; 2],
    traced: [&Traced; 2],
    found: &mut impl FnMut(Meeting),
) -> usize {
    let [first, second] = traced.map(|edge| &edge.curve);
    let mut touch = None;
    let mut crossings: Vec<DVec3> = Vec::new();
    let mut stack = vec![(traced[0].hull, traced[1].hull)];
    let mut settled: Vec<[[f64; 2]; 2]> = Vec::new();
    let (mut together, mut together_count) = (Vec::new(), 0);
    let mut pieces = 0;
    let mut place = |crossings: &mut Vec<DVec3>, t: f64| {
        crossings.push(first.ecef(t));
        let point = LatticePoint::nearest(first.lon_lat(t));
        found(Meeting::Crossing(on_grid_lines(edges, point.canonical())));
    };
    while let Some((a, b)) = stack.pop() {
        if a.distance_m(&b) > a.radius_m + b.radius_m {
            continue;
        }
        let is_within = |piece: &Hull, [t0, t1]: [f64; 2]| t0 <= piece.t0 && piece.t1 <= t1;
        let is_settled =
            |ranges: &[[f64; 2]; 2]| is_within(&a, ranges[0]) && is_within(&b, ranges[1]);
        if settled.iter().any(is_settled) {
            continue;
        }
        pieces += 1;
        if pieces == MOST_PIECES {
            found(Meeting::Unclear);
            return pieces;
        }
        if let Some(t) = a.crossing(&b) {
            place(&mut crossings, a.t0 + t * (a.t1 - a.t0));
            continue;
        }
        match alongside([first, second], [&a, &b]) {
            Some(Alongside::Apart) => continue,
            Some(Alongside::Crossing(t, ranges)) => {
                place(&mut crossings, t);
                settled.push(ranges);
                continue;
            }
            Some(Alongside::Together(ranges)) => {
                together.extend(ends_within(edges, ranges));
                together_count += 1;
                if together_count < MOST_TOGETHER {
                    continue;
                }
                break;
            }
            None => {}
        }
        if a.length_m().max(b.length_m()) < TOUCH_M {
            touch = Some((a.start, touching(edges, first, &a, &b)));
        } else if a.length_m() + a.radius_m >= b.length_m() + b.radius_m {
            stack.extend(a.parts(first).map(|part| (part, b)));
        } else {
            stack.extend(b.parts(second).map(|part| (a, part)));
        }
    }
    together.sort_unstable();
    together.dedup();
    if together_count > 0 && together.is_empty() {
        together.push(Meeting::Unclear);
    }
    together.into_iter().for_each(&mut *found);
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
    pieces
}

/// The ends of either edge within these ranges of both, where they are as good as one.
fn ends_within(edges: [&Edge; 2], ranges: [[f64; 2]; 2]) -> impl Iterator<Item = Meeting> {
    let ends = move |which: usize| {
        let ([t0, t1], edge) = (ranges[which], edges[which]);
        let ends = [(t0 == 0.0, edge.from), (t1 == 1.0, edge.to)];
        ends.into_iter().filter(|end| end.0).map(|end| end.1)
    };
    let on_second = ends(0).map(Meeting::NodeOnSecond);
    on_second.chain(ends(1).map(Meeting::NodeOnFirst))
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
pub(super) struct Hull {
    pub(super) t0: f64,
    pub(super) t1: f64,
    pub(super) start: DVec3,
    pub(super) end: DVec3,
    /// Unit vector across the wall through the chord.
    pub(super) across: DVec3,
    /// How far the curve may lie from the plane of that wall.
    deviation_m: f64,
    pub(super) radius_m: f64,
}

impl Hull {
    pub(super) fn of(curve: &CurveOn, t0: f64, t1: f64) -> Self {
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

    pub(super) fn length_m(&self) -> f64 {
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

/// Curves that leave a common node with at least this sine between them part at once.
const PARTING_SINE: f64 = 1e-2;

/// Meetings of two edges of different kinds with a common end node. Where they leave it along a
/// common tangent, as a corridor's sides and ends do, they only touch there.
pub(crate) fn meetings_beyond_common_node(
    edges: [&Edge; 2],
    traced: [&Traced; 2],
    found: &mut impl FnMut(Meeting),
) -> usize {
    let [first, second] = traced.map(|edge| &edge.curve);
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
        found(Meeting::Unclear);
        return 0;
    }
    let common = first.ellipsoid().ecef(node_position(edges[0], node), 0.0);
    curved_meetings(edges, traced, &mut |meeting| match meeting {
        Meeting::NodeOnFirst(end) | Meeting::NodeOnSecond(end) if end == node => {}
        Meeting::Crossing(point) => {
            let position = first.ellipsoid().ecef(point.lon_lat(), 0.0);
            if position.distance(common) > 4.0 * TOUCH_M / PARTING_SINE {
                found(meeting);
            }
        }
        meeting => found(meeting),
    })
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
pub(crate) fn same_circle_meetings(
    [first, second]: [&Edge; 2],
    traced: [&Traced; 2],
    mut found: impl FnMut(Meeting),
) {
    let ends_on = |arc: &Edge, traced: &Traced, other: &Edge| {
        let curve = &traced.curve;
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
    let on_first = ends_on(first, traced[0], second);
    on_first
        .into_iter()
        .for_each(|node| found(Meeting::NodeOnFirst(node)));
    let on_second = ends_on(second, traced[1], first);
    on_second
        .into_iter()
        .for_each(|node| found(Meeting::NodeOnSecond(node)));
}
