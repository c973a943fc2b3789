//! The order of edges round a node.

use std::cmp::Ordering;

use glam::DVec3;

use crate::{
    boundary::boundary_graph::{BoundaryGraph, DirectedEdge},
    ellipsoid::Ellipsoid,
    region::EdgeKind,
};

/// Headings nearer than this, radians, are not told apart where curves of different kinds leave a node: they
/// bend differently.
const UNCLEAR_RAD: f64 = 1e-6;
/// Rounding of positions, metres, which blurs the headings of short edges more than that, and those of one
/// kind.
const ROUNDING_M: f64 = 4e-9;

/// Sorts edges that start at one node counter-clockwise, seen from outside the ellipsoid. Answers
/// whether their order is certain.
pub(crate) fn sort_counter_clockwise(
    ellipsoid: &Ellipsoid,
    graph: &BoundaryGraph,
    edges: &mut [DirectedEdge],
) -> bool {
    let Some(&first) = edges.first() else {
        return true;
    };
    let at_pole = graph.nodes[graph.start_node(first) as usize].is_pole();
    let straight = edges
        .iter()
        .all(|&edge| graph.walk(edge).kind == EdgeKind::Straight);
    if straight && !at_pole {
        edges.sort_by(|&a, &b| compare_on_plane(graph, a, b));
        // Noding leaves no two different straight edges that start the same way.
        return true;
    }
    let step_m = if at_pole {
        1.0
    } else {
        first_step_m(ellipsoid, graph, edges)
    };
    let blurred_rad = ROUNDING_M / step_m;
    let unclear_rad = |a: DirectedEdge, b: DirectedEdge| {
        // Two curves of one kind that leave a node in different directions part there for good.
        if !at_pole && are_alike(graph, a, b) {
            blurred_rad
        } else {
            UNCLEAR_RAD.max(blurred_rad)
        }
    };
    let heading = |edge| {
        if at_pole {
            polar_heading(graph, edge)
        } else {
            curved_heading(ellipsoid, graph, edge, step_m)
        }
    };
    let mut sorted: Vec<_> = edges.iter().map(|&edge| (heading(edge), edge)).collect();
    sorted.sort_by(|a, b| a.0.0.total_cmp(&b.0.0).then(a.0.1.total_cmp(&b.0.1)));
    for (place, (_, edge)) in edges.iter_mut().zip(&sorted) {
        *place = *edge;
    }
    let close = |a: &((f64, f64), DirectedEdge), b: &((f64, f64), DirectedEdge)| {
        let tied = (b.0.0 - a.0.0).abs() < unclear_rad(a.1, b.1);
        tied && !(at_pole && straight && b.0.1 != a.0.1)
    };
    let ring_closes = sorted.len() > 2 && {
        let (low, high) = (sorted[0], sorted[sorted.len() - 1]);
        low.0.0 + std::f64::consts::TAU - high.0.0 < unclear_rad(low.1, high.1)
    };
    !ring_closes && !sorted.windows(2).any(|pair| close(&pair[0], &pair[1]))
}

/// Whether two edges are edges of one kind.
fn are_alike(graph: &BoundaryGraph, a: DirectedEdge, b: DirectedEdge) -> bool {
    let (a, b) = (graph.walk(a), graph.walk(b));
    a.is_also(b.kind) || b.is_also(a.kind)
}

/// Straight edges by their direction on the lon/lat plane, exactly, from east.
fn compare_on_plane(graph: &BoundaryGraph, a: DirectedEdge, b: DirectedEdge) -> Ordering {
    let direction = |edge| {
        let edge = graph.walk(edge);
        (edge.turn(), edge.end.lat - edge.start.lat)
    };
    let (a, b) = (direction(a), direction(b));
    let lower_half = |(x, y): (i64, i64)| y < 0 || y == 0 && x < 0;
    let cross = i128::from(a.0) * i128::from(b.1) - i128::from(a.1) * i128::from(b.0);
    lower_half(a).cmp(&lower_half(b)).then(0.cmp(&cross))
}

/// At a pole: the meridian, then, between straight edges of one meridian, how they bend off it.
fn polar_heading(graph: &BoundaryGraph, edge: DirectedEdge) -> (f64, f64) {
    let edge = graph.walk(edge);
    let meridian = edge.start.lon_lat().lon_deg.to_radians();
    let bend = edge.turn() as f64 / (edge.end.lat - edge.start.lat).abs() as f64;
    // From below, east is clockwise.
    if edge.start.lat > 0 {
        (meridian, bend)
    } else {
        (-meridian, -bend)
    }
}

/// Elsewhere: the direction of the curve's first `step_m`.
fn curved_heading(
    ellipsoid: &Ellipsoid,
    graph: &BoundaryGraph,
    edge: DirectedEdge,
    step_m: f64,
) -> (f64, f64) {
    let position = graph.position(graph.start_node(edge));
    let curve = graph.walk(edge).curve().on(ellipsoid);
    let start = curve.ecef(0.0);
    let length_m = start.distance(curve.ecef(1.0)).max(1e-9 * ellipsoid.a_m);
    let step = curve.ecef((step_m / length_m).min(1.0)) - start;
    let (sin, cos) = position.lon_deg.to_radians().sin_cos();
    let east = DVec3::new(-sin, cos, 0.0);
    let north = ellipsoid.normal(position).cross(east);
    (step.dot(north).atan2(step.dot(east)), 0.0)
}

/// A metre, or a part of the shortest edge: the same for all, so that of curves which leave along a
/// common tangent the more bent one is seen as such.
fn first_step_m(ellipsoid: &Ellipsoid, graph: &BoundaryGraph, edges: &[DirectedEdge]) -> f64 {
    let ecef = |node: u32| ellipsoid.ecef(graph.position(node), 0.0);
    edges
        .iter()
        .map(|&edge| ecef(graph.start_node(edge)).distance(ecef(graph.end_node(edge))))
        .fold(1.0, |least: f64, length_m| least.min(0.2 * length_m))
        .max(1e-12 * ellipsoid.a_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{curve::Curve, geodetic::LonLat};

    #[test]
    fn order_is_counter_clockwise_for_all_kinds_and_at_the_poles() {
        let star = |kind, center: LonLat, tips: &[(f64, f64)]| {
            let mut graph = BoundaryGraph::default();
            let mut edges: Vec<_> = tips
                .iter()
                .map(|&(lon, lat)| {
                    let curve = Curve::between(
                        kind,
                        LonLat::new(
                            if center.is_pole() {
                                lon
                            } else {
                                center.lon_deg
                            },
                            center.lat_deg,
                        ),
                        LonLat::new(lon, lat),
                    );
                    graph.insert_curve(&curve).unwrap()
                })
                .collect();
            let expected = edges.clone();
            edges.reverse();
            edges.swap(0, 1);
            assert!(sort_counter_clockwise(
                &Ellipsoid::WGS84,
                &graph,
                &mut edges
            ));
            let first = edges.iter().position(|&edge| edge == expected[0]).unwrap();
            edges.rotate_left(first);
            assert_eq!(edges, expected);
        };
        for kind in [EdgeKind::Straight, EdgeKind::Rhumb, EdgeKind::Geodesic] {
            let tips = [
                (181.0, 10.0),
                (180.0, 12.0),
                (178.0, 10.5),
                (179.0, 9.0),
                (182.0, 3.0),
            ];
            star(kind, LonLat::new(180.0, 10.0), &tips);
            star(
                kind,
                LonLat::new(0.0, 90.0),
                &[(-170.0, 80.0), (-3.0, 70.0), (60.0, 80.0), (180.0, 1.0)],
            );
            star(
                kind,
                LonLat::new(0.0, -90.0),
                &[(-170.0, -80.0), (180.0, -1.0), (60.0, -80.0), (-3.0, -70.0)],
            );
        }
    }

    /// A rhumb line along a parallel and one that ends 2e-6° north of it, half the way round the Earth.
    #[test]
    fn directions_of_one_kind_are_told_apart() {
        let mut graph = BoundaryGraph::default();
        let from = LonLat::new(20.0, 86.0);
        let tips = [(-160.0, 86.0), (-159.92, 86.000_002), (20.0, 80.0)];
        let mut edges = tips.map(|(lon_deg, lat_deg)| {
            let to = LonLat::new(lon_deg, lat_deg);
            graph
                .insert_curve(&Curve::between(EdgeKind::Rhumb, from, to))
                .unwrap()
        });
        let ellipsoid = Ellipsoid::WGS84;
        assert!(sort_counter_clockwise(&ellipsoid, &graph, &mut edges));
    }

    #[test]
    fn curved_ties_are_uncertain() {
        let mut graph = BoundaryGraph::default();
        let (from, far) = (LonLat::new(0.0, 10.0), LonLat::new(20.0, 15.0));
        let whole = Curve::between(EdgeKind::Geodesic, from, far);
        let half = whole.on(&Ellipsoid::WGS84).lon_lat(0.5);
        let mut edges = [far, half, LonLat::new(0.0, 5.0)].map(|to| {
            graph
                .insert_curve(&Curve::between(EdgeKind::Geodesic, from, to))
                .unwrap()
        });
        assert!(!sort_counter_clockwise(
            &Ellipsoid::WGS84,
            &graph,
            &mut edges
        ));
    }
}
