//! From noded polygons to boundaries with an inside.

use rayon::prelude::*;
use rustc_hash::FxHashSet;

use crate::{
    boundary::authalic::Authalic,
    boundary::boundary_graph::{BoundaryGraph, DirectedEdge},
    boundary::inside::{Boundary, direct},
    boundary::noding::PolygonWalk,
    boundary::rings::RingWalk,
    boundary::simple_loops::{Component, even_odd_components},
    boundary::zones::bound_zone,
    ellipsoid::Ellipsoid,
    error::RegionError,
    geodetic::LonLat,
    region::{EdgeKind, Region},
    repair::{Place, Repair, RepairKind},
};

/// A polygon's boundary, if it has an inside, and what was repaired.
type Bounded = (Option<Boundary>, Vec<Repair>);

/// The boundary of every polygon, inside to the left; none for polygons without inside.
pub(crate) fn bound_polygons(
    regions: &[Region],
    ellipsoid: &Ellipsoid,
    graph: &BoundaryGraph,
    polygons: &[PolygonWalk],
    repairs: &mut Vec<Repair>,
) -> Result<Vec<Option<Boundary>>, RegionError> {
    let authalic = Authalic::new(*ellipsoid);
    let tangled = tangled_rings(graph, polygons);
    let bounded: Result<Vec<Bounded>, RegionError> = polygons
        .par_iter()
        .zip(tangled)
        .map(|(walk, tangled)| {
            if walk.is_zone {
                let boundary = bound_zone(ellipsoid, graph, &authalic, walk, tangled.is_empty())?;
                return Ok((Some(boundary), Vec::new()));
            }
            let region = &regions[walk.place.region];
            let mut repairs = Vec::new();
            let mut components = rings_as_components(walk, &tangled);
            if !tangled.is_empty() {
                let walk = only_rings(walk, &tangled);
                components.extend(even_odd_components(ellipsoid, graph, &walk, &mut repairs));
                components.sort_by_key(|component| component.ring);
            }
            let shell_is_left = components.iter().any(|component| !component.is_hole());
            let shell = &region.polygons[walk.place.polygon].shell;
            let is_globe =
                !shell_is_left && region.edges == EdgeKind::Straight && spans_globe(shell);
            let boundary = (shell_is_left || is_globe)
                .then(|| direct(ellipsoid, graph, &authalic, components, region.inside))
                .transpose()?;
            for &ring in boundary.iter().flat_map(|boundary| &boundary.idle_holes) {
                repairs.push(Repair {
                    place: Place { ring, ..walk.place },
                    kind: RepairKind::IdleHole,
                });
            }
            Ok((boundary, repairs))
        })
        .collect();
    let bounded = bounded?.into_iter().map(|(boundary, found)| {
        repairs.extend(found);
        boundary
    });
    Ok(bounded.collect())
}

/// For every polygon the rings that visit a node twice or share one with another ring of it, ascending.
/// Nearly all have none, and need no decomposition.
fn tangled_rings(graph: &BoundaryGraph, polygons: &[PolygonWalk]) -> Vec<Vec<usize>> {
    let mut last_visit = vec![u32::MAX; graph.nodes.len()];
    // One edge there and back visits no node twice.
    let is_ring = |ring: &RingWalk| match ring.edges[..] {
        [] => false,
        [there, back] => there.edge() != back.edge(),
        _ => true,
    };
    let tangled_of = |(visit, walk): (u32, &PolygonWalk)| {
        let mut shared: FxHashSet<u32> = FxHashSet::default();
        for &edge in walk.rings.iter().flat_map(|ring| &ring.edges) {
            let node = graph.start_node(edge);
            if std::mem::replace(&mut last_visit[node as usize], visit) == visit {
                shared.insert(node);
            }
        }
        let shares = |edge: &DirectedEdge| shared.contains(&graph.start_node(*edge));
        let is_tangled =
            |ring: &RingWalk| !is_ring(ring) || !shared.is_empty() && ring.edges.iter().any(shares);
        let rings = walk.rings.iter().enumerate();
        rings
            .filter(|(_, ring)| is_tangled(ring))
            .map(|(index, _)| index)
            .collect()
    };
    (0..).zip(polygons).map(tangled_of).collect()
}

/// The other rings, each a component of its own.
fn rings_as_components(walk: &PolygonWalk, tangled: &[usize]) -> Vec<Component> {
    let component = |(index, ring): (usize, &RingWalk)| Component {
        loops: vec![ring.edges.clone()],
        ring: index,
    };
    let rings = walk.rings.iter().enumerate();
    rings
        .filter(|(index, _)| tangled.binary_search(index).is_err())
        .map(component)
        .collect()
}

/// A polygon in which all other rings are empty, so that these keep their numbers.
fn only_rings(walk: &PolygonWalk, kept: &[usize]) -> PolygonWalk {
    let mut rings = vec![RingWalk::default(); walk.rings.len()];
    for &ring in kept {
        rings[ring] = walk.rings[ring].clone();
    }
    PolygonWalk { rings, ..*walk }
}

/// Whether a ring whose edges cancel was written round more than half of the lon/lat plane: such is
/// the box from −180° to 180° and −90° to 90°, whose sides coincide on the globe.
fn spans_globe(ring: &[LonLat]) -> bool {
    let mut area = 0.0;
    for (index, a) in ring.iter().enumerate() {
        let b = ring[(index + 1) % ring.len()];
        let mean_sin = 0.5 * (a.lat_deg.to_radians().sin() + b.lat_deg.to_radians().sin());
        area += (b.lon_deg - a.lon_deg).to_radians() * mean_sin;
    }
    area.abs() > std::f64::consts::TAU
}
