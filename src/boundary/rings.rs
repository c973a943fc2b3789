//! Rings as the caller wrote them → directed edges between lattice nodes.

use crate::{
    boundary::boundary_graph::{BoundaryGraph, DirectedEdge},
    boundary::lattice::{LatticePoint, POLE, TURN},
    curve::Curve,
    ellipsoid::Ellipsoid,
    error::RegionError,
    geodetic::LonLat,
    region::EdgeKind,
    repair::{Place, Repair, RepairKind},
};

/// A ring walked as the caller wrote it.
#[derive(Clone, Debug, Default)]
pub(crate) struct RingWalk {
    pub(crate) edges: Vec<DirectedEdge>,
    /// For each edge the index of the input vertex where it, or the edge it is part of, starts.
    pub(crate) vertices: Vec<u32>,
}

impl RingWalk {
    pub(crate) fn push(&mut self, edge: Option<DirectedEdge>, vertex: usize) {
        // An edge without length (between two names of a pole) bounds nothing.
        if let Some(edge) = edge {
            self.edges.push(edge);
            self.vertices.push(vertex as u32);
        }
    }
}

/// Checks a ring and adds its edges to the graph.
///
/// Vertices are rounded to the lattice (1.6 µm on Earth), equal neighbours become one, the ring is
/// closed; what changed is reported. `place` names the ring.
pub(crate) fn walk_ring(
    ring: &[LonLat],
    kind: EdgeKind,
    ellipsoid: &Ellipsoid,
    place: Place,
    graph: &mut BoundaryGraph,
    repairs: &mut Vec<Repair>,
) -> Result<RingWalk, RegionError> {
    let points = distinct_points(ring, place, repairs)?;
    let mut walk = RingWalk {
        edges: Vec::with_capacity(points.len()),
        vertices: Vec::with_capacity(points.len()),
    };
    let nodes: Vec<u32> = points.iter().map(|&(_, point)| graph.node(point)).collect();
    for (index, &(vertex, point)) in points.iter().enumerate() {
        let next = (index + 1) % points.len();
        let curve = Curve::between(kind, point.lon_lat(), points[next].1.lon_lat());
        match kind {
            EdgeKind::Geodesic => {
                let place = Place { vertex, ..place };
                walk_geodesic(&curve, ellipsoid, place, graph, &mut walk)?;
            }
            EdgeKind::Straight if curve.turn_deg.abs() > 180.0 => {
                walk_long_way(&curve, vertex, graph, &mut walk);
            }
            EdgeKind::Rhumb | EdgeKind::Straight => {
                let ends = [nodes[index], nodes[next]];
                walk.push(graph.insert_curve_between(&curve, ends), vertex);
            }
        }
    }
    Ok(walk)
}

/// The ring's vertices on the lattice, each with its index, without repetitions and unclosed.
fn distinct_points(
    ring: &[LonLat],
    place: Place,
    repairs: &mut Vec<Repair>,
) -> Result<Vec<(usize, LatticePoint)>, RegionError> {
    let mut points: Vec<(usize, LatticePoint)> = Vec::with_capacity(ring.len());
    for (vertex, &position) in ring.iter().enumerate() {
        let place = Place { vertex, ..place };
        if !position.is_valid() {
            return Err(RegionError::InvalidVertex {
                place,
                lon_deg: position.lon_deg,
                lat_deg: position.lat_deg,
            });
        }
        let point = LatticePoint::nearest(position);
        if points.last().is_some_and(|&(_, last)| last == point) {
            repairs.push(Repair {
                place,
                kind: RepairKind::Duplicate,
            });
        } else {
            points.push((vertex, point));
        }
    }
    if points.len() > 1 && points.last().map(|p| p.1) == points.first().map(|p| p.1) {
        points.pop();
    } else if points.len() >= 3 && !is_closed_by_turn(&points) {
        repairs.push(Repair {
            place,
            kind: RepairKind::Unclosed,
        });
    }
    // Two names of one point are two vertices here: a polar cap may be written as a box whose
    // sides coincide.
    let distinct = match points.len() {
        0..=2 => points.len(),
        many => {
            let (first, second) = (points[0].1, points[1].1);
            let third = points
                .iter()
                .any(|&(_, point)| point != first && point != second);
            if third { many } else { 2 }
        }
    };
    if distinct < 3 {
        return Err(RegionError::ShortRing { place, distinct });
    }
    Ok(points)
}

/// Whether the ring's last vertex is another name of its first.
fn is_closed_by_turn(points: &[(usize, LatticePoint)]) -> bool {
    match (points.first(), points.last()) {
        (Some(first), Some(last)) => first.1.canonical() == last.1.canonical(),
        _ => false,
    }
}

/// A geodesic edge; one that runs over a pole gets a node there, where its longitude jumps.
pub(crate) fn walk_geodesic(
    curve: &Curve,
    ellipsoid: &Ellipsoid,
    place: Place,
    graph: &mut BoundaryGraph,
    walk: &mut RingWalk,
) -> Result<(), RegionError> {
    if is_nearly_antipodal(ellipsoid, curve.from, curve.to) {
        return Err(RegionError::AntipodalEdge { place });
    }
    if curve.turn_deg.abs() < 180.0 {
        walk.push(graph.insert_curve(curve), place.vertex);
        return Ok(());
    }
    let pole = if curve.from.lat_deg + curve.to.lat_deg > 0.0 {
        POLE
    } else {
        -POLE
    };
    let pole = LatticePoint::new(0, pole).lon_lat();
    for (from, to) in [(curve.from, pole), (pole, curve.to)] {
        let half = Curve::between(EdgeKind::Geodesic, from, to);
        walk.push(graph.insert_curve(&half), place.vertex);
    }
    Ok(())
}

/// Whether the shortest path between two points is not unique, or so ill-conditioned that nearby
/// points have quite another one: within twice the radius of the astroid (f·180°) round the antipode.
fn is_nearly_antipodal(ellipsoid: &Ellipsoid, from: LonLat, to: LonLat) -> bool {
    if (from.lat_deg + to.lat_deg).abs() > 10.0 {
        return false;
    }
    let limit_deg: f64 = 0.1 + 360.0 * ellipsoid.flattening().abs();
    let cosine = ellipsoid.normal(from).dot(ellipsoid.normal(to));
    cosine < -limit_deg.min(90.0).to_radians().cos()
}

/// A straight edge of a whole turn, in thirds: what goes round needs nodes on its way.
fn walk_long_way(curve: &Curve, vertex: usize, graph: &mut BoundaryGraph, walk: &mut RingWalk) {
    let start = LatticePoint::nearest(curve.from);
    let rise = LatticePoint::nearest(curve.to).lat - start.lat;
    let turn = if curve.turn_deg > 0.0 { TURN } else { -TURN };
    let at =
        |third: i64| LatticePoint::new(start.lon + turn * third / 3, start.lat + rise * third / 3);
    for third in 0..3 {
        walk.push(
            graph.insert(EdgeKind::Straight, at(third), at(third + 1)),
            vertex,
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walk(kind: EdgeKind, ring: &[(f64, f64)]) -> Result<(usize, Vec<RepairKind>), RegionError> {
        let ring: Vec<_> = ring
            .iter()
            .map(|&(lon, lat)| LonLat::new(lon, lat))
            .collect();
        let mut repairs = Vec::new();
        let mut graph = BoundaryGraph::default();
        let place = Place::default();
        let walk = walk_ring(
            &ring,
            kind,
            &Ellipsoid::WGS84,
            place,
            &mut graph,
            &mut repairs,
        )?;
        for (edge, next) in walk.edges.iter().zip(walk.edges.iter().cycle().skip(1)) {
            assert_eq!(
                graph.end_node(*edge),
                graph.start_node(*next),
                "walks are closed"
            );
        }
        Ok((
            walk.edges.len(),
            repairs.iter().map(|repair| repair.kind).collect(),
        ))
    }

    #[test]
    fn rings_are_closed_and_cleaned() {
        use RepairKind::{Duplicate, Unclosed};
        let straight = |ring: &[(f64, f64)]| walk(EdgeKind::Straight, ring).unwrap();
        let triangle = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)];
        assert_eq!(straight(&triangle), (3, vec![Unclosed]));
        assert_eq!(
            straight(&[triangle[0], triangle[1], triangle[2], triangle[0]]),
            (3, vec![])
        );
        let doubled = [
            triangle[0],
            triangle[1],
            triangle[1],
            triangle[2],
            triangle[0],
        ];
        assert_eq!(straight(&doubled), (3, vec![Duplicate]));
        // Natural Earth's way to close Antarctica: the edge along −90° has no length.
        let box_ = [
            (-180.0, -60.0),
            (-180.0, -90.0),
            (180.0, -90.0),
            (180.0, -60.0),
            (-180.0, -60.0),
        ];
        assert_eq!(straight(&box_), (5, vec![]));
    }

    #[test]
    fn hopeless_rings_are_named() {
        let straight = |ring: &[(f64, f64)]| walk(EdgeKind::Straight, ring).unwrap_err();
        let short = |distinct| RegionError::ShortRing {
            place: Place::default(),
            distinct,
        };
        assert_eq!(straight(&[]), short(0));
        assert_eq!(straight(&[(1.0, 1.0), (1.0, 1.0)]), short(1));
        assert_eq!(
            straight(&[(1.0, 1.0), (2.0, 1.0), (1.0, 1.0), (2.0, 1.0)]),
            short(2)
        );
        let place = Place {
            vertex: 1,
            ..Place::default()
        };
        for bad in [(1.0, 91.0), (f64::INFINITY, 0.0), (f64::NAN, 0.0)] {
            assert!(matches!(
                straight(&[(0.0, 0.0), bad, (2.0, 0.0)]),
                RegionError::InvalidVertex { place: at, .. } if at == place
            ));
        }
        let antipodal = walk(
            EdgeKind::Geodesic,
            &[(0.0, 50.0), (0.0, 10.0), (179.9, -10.1)],
        );
        assert_eq!(antipodal, Err(RegionError::AntipodalEdge { place }));
        assert!(
            walk(
                EdgeKind::Geodesic,
                &[(0.0, 50.0), (0.0, 10.0), (178.0, -10.1)]
            )
            .is_ok()
        );
    }

    #[test]
    fn geodesics_over_a_pole_get_a_node_there() {
        let over = walk(
            EdgeKind::Geodesic,
            &[(0.0, 50.0), (180.0, 50.0), (90.0, 50.0)],
        )
        .unwrap();
        assert_eq!(over.0, 4);
    }
}
