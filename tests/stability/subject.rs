//! A placed shape: its mesh, its judge, and what of it cameras look at.

use globefill::{EdgeKind, Ellipsoid, FillMesh, LonLat, MeshOptions, Region};

use crate::{
    common::oracle::Oracle,
    placement::{Placement, direction, lon_lat},
    shape::Shape,
};

pub struct Subject {
    pub name: String,
    pub placement: String,
    pub mesh: FillMesh,
    pub oracle: Oracle,
    pub foci: Foci,
}

/// What cameras look at.
#[derive(Clone, Copy, Debug)]
pub struct Foci {
    pub centre: LonLat,
    pub vertex: LonLat,
    /// A point of the true boundary amid an edge.
    pub edge: LonLat,
    /// Bearing of the boundary there.
    pub bearing_deg: f64,
    /// How far, metres, the shape reaches from its centre.
    pub radius_m: f64,
    /// How much higher, metres, cameras stand than they say.
    pub lift_m: f64,
}

impl Subject {
    pub fn placed(shape: &Shape, placement: &Placement, edges: EdgeKind) -> Self {
        let turn = placement.globe_from_shape(shape);
        let regions = shape.placed(turn, edges);
        let name = format!("{} ({edges:?})", shape.name);
        let mesh = mesh(&name, placement.name, &regions, shape.ellipsoid);
        let oracle = Oracle::new(&regions, shape.ellipsoid);
        let [start, next] = shape.first_edge();
        let foci = Foci::new(
            &oracle,
            lon_lat(turn * glam::DVec3::X),
            regions[0].polygons[0].shell[0],
            lon_lat(turn * (start + next).normalize()),
            shape.radius_rad() * shape.ellipsoid.a_m,
        );
        Self {
            name,
            placement: placement.name.to_owned(),
            mesh,
            oracle,
            foci,
        }
    }

    /// Regions that lie where they lie, seen from a place on the boundary nearest to `near`.
    pub fn fixed(
        name: &str,
        near: (&str, LonLat),
        regions: &[Region],
        centre: LonLat,
        radius_m: f64,
    ) -> Self {
        Self::judged_as(name, near, regions, regions, centre, radius_m)
    }

    /// The same, and the oracle is told of the regions in another way.
    pub fn judged_as(
        name: &str,
        near: (&str, LonLat),
        regions: &[Region],
        judged: &[Region],
        centre: LonLat,
        radius_m: f64,
    ) -> Self {
        let (placement, near) = near;
        let oracle = Oracle::new(judged, Ellipsoid::WGS84);
        let vertex = nearest_vertex(judged, near);
        let foci = Foci::new(&oracle, centre, vertex, near, radius_m);
        Self {
            name: name.to_owned(),
            placement: placement.to_owned(),
            mesh: mesh(name, placement, regions, Ellipsoid::WGS84),
            oracle,
            foci,
        }
    }
}

fn mesh(name: &str, placement: &str, regions: &[Region], ellipsoid: Ellipsoid) -> FillMesh {
    let options = MeshOptions {
        ellipsoid,
        ..MeshOptions::default()
    };
    FillMesh::build(regions, &options)
        .unwrap_or_else(|error| panic!("{name}, {placement}: {error}"))
}

fn nearest_vertex(regions: &[Region], near: LonLat) -> LonLat {
    let towards = direction(near);
    let polygons = regions.iter().flat_map(|region| &region.polygons);
    let vertices = polygons.flat_map(|polygon| polygon.holes.iter().chain([&polygon.shell]));
    *vertices
        .flatten()
        .min_by(|a, b| {
            let [a, b] = [a, b].map(|v| direction(**v).distance(towards));
            a.total_cmp(&b)
        })
        .expect("regions have vertices")
}

impl Foci {
    fn new(
        oracle: &Oracle,
        centre: LonLat,
        vertex: LonLat,
        near_edge: LonLat,
        radius_m: f64,
    ) -> Self {
        let figure = &oracle.figure;
        let near_m = figure.ecef(near_edge, 0.0);
        let edges = (0..oracle.region_count()).flat_map(|region| oracle.boundary(region));
        let mut sorted: Vec<_> = edges
            .map(|edge| ((edge.middle_m - near_m).length() - edge.radius_m, edge))
            .collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        // An edge is nowhere nearer than the sphere that holds it.
        let mut nearest = (f64::INFINITY, 0.0, sorted[0].1);
        for (least_m, edge) in sorted {
            if least_m > nearest.0 {
                break;
            }
            let (distance_m, t) = edge.nearest(figure, near_m);
            if distance_m < nearest.0 {
                nearest = (distance_m, t, edge);
            }
        }
        let (_, t, edge) = nearest;
        let at = |t: f64| figure.ecef(edge.point(figure, t.clamp(0.0, 1.0)), 0.0);
        let focus = edge.point(figure, t);
        let along_m = at(t + 1e-4) - at(t - 1e-4);
        let (sin_lon, cos_lon) = focus.lon_deg.to_radians().sin_cos();
        let east = glam::DVec3::new(-sin_lon, cos_lon, 0.0);
        let north = direction(focus).cross(east);
        Self {
            centre,
            vertex,
            edge: focus,
            bearing_deg: along_m.dot(east).atan2(along_m.dot(north)).to_degrees(),
            radius_m,
            lift_m: 0.0,
        }
    }
}
