//! Zones → directed edges between lattice nodes, and what they bound.

use crate::{
    boundary::authalic::Authalic,
    boundary::boundary_graph::BoundaryGraph,
    boundary::inside::{Boundary, direct},
    boundary::lattice::LatticePoint,
    boundary::noding::PolygonWalk,
    boundary::rings::{RingWalk, walk_geodesic},
    boundary::simple_loops::Component,
    boundary::winding::loops_round_winding,
    curve::Curve,
    ellipsoid::Ellipsoid,
    error::RegionError,
    region::{EdgeKind, Inside},
    repair::Place,
    zone::{Zone, outline::Corner},
};

/// Checks a zone and adds its edges to the graph.
pub(crate) fn walk_zone(
    zone: &Zone,
    ellipsoid: &Ellipsoid,
    place: Place,
    graph: &mut BoundaryGraph,
) -> Result<PolygonWalk, RegionError> {
    let outline = zone
        .outline(ellipsoid)
        .map_err(|error| RegionError::Zone { place, error })?;
    let rings = outline.rings.iter().enumerate();
    let rings = rings
        .map(|(ring, corners)| walk_corners(corners, ellipsoid, Place { ring, ..place }, graph))
        .collect::<Result<_, _>>()?;
    Ok(PolygonWalk {
        place,
        rings,
        is_zone: true,
    })
}

/// Adds the edges of a zone's ring to the graph; corners are rounded to the lattice.
fn walk_corners(
    corners: &[Corner],
    ellipsoid: &Ellipsoid,
    place: Place,
    graph: &mut BoundaryGraph,
) -> Result<RingWalk, RegionError> {
    let points: Vec<LatticePoint> = corners
        .iter()
        .map(|corner| LatticePoint::nearest(corner.position))
        .collect();
    let mut walk = RingWalk::default();
    for (vertex, corner) in corners.iter().enumerate() {
        let next = points[(vertex + 1) % points.len()];
        if points[vertex].canonical() == next.canonical() {
            continue;
        }
        let curve = Curve::between(corner.edge, points[vertex].lon_lat(), next.lon_lat());
        if corner.edge == EdgeKind::Geodesic {
            walk_geodesic(
                &curve,
                ellipsoid,
                Place { vertex, ..place },
                graph,
                &mut walk,
            )?;
        } else {
            walk.push(graph.insert_curve(&curve), vertex);
        }
    }
    Ok(walk)
}

/// The boundary of a zone: its rings, which have it to their left, or what they wind round.
pub(crate) fn bound_zone(
    ellipsoid: &Ellipsoid,
    graph: &BoundaryGraph,
    authalic: &Authalic,
    walk: &PolygonWalk,
    is_simple: bool,
) -> Result<Boundary, RegionError> {
    let loops = if is_simple {
        walk.rings.iter().map(|ring| ring.edges.clone()).collect()
    } else {
        loops_round_winding(ellipsoid, graph, walk).ok_or(RegionError::Tangled {
            edges: walk.rings.iter().map(|ring| ring.edges.len()).sum(),
        })?
    };
    let component = Component { loops, ring: 0 };
    direct(
        ellipsoid,
        graph,
        authalic,
        vec![component],
        Inside::LeftOfRing,
    )
}
