//! The laws: closed boundaries, areas, bounds and deviations; and how to build what they judge.

use std::collections::HashMap;

use geographiclib_rs::{Geodesic, PolygonArea, Winding};
use globefill::{
    Curve, EdgeKind, Ellipsoid, FillMesh, Inside, LonLat, MeshOptions, Polygon, Region, RepairKind,
    countries::{Country, Dataset},
    glam::DVec3,
};

pub fn build(regions: &[Region]) -> FillMesh {
    let mesh = FillMesh::build(regions, &MeshOptions::default()).unwrap();
    check_laws(&mesh);
    mesh
}

pub fn region(edges: EdgeKind, inside: Inside, rings: &[&[(f64, f64)]]) -> Region {
    let mut rings = rings.iter().map(|ring| {
        ring.iter()
            .map(|&(lon, lat)| LonLat::new(lon, lat))
            .collect()
    });
    let shell = rings.next().unwrap();
    let polygon = Polygon {
        shell,
        holes: rings.collect(),
    };
    Region {
        polygons: vec![polygon],
        edges,
        inside,
        zones: Vec::new(),
    }
}

pub fn smaller(edges: EdgeKind, rings: &[&[(f64, f64)]]) -> Region {
    region(edges, Inside::Smaller, rings)
}

/// Equal positions are one point.
pub fn key(position: DVec3) -> [u64; 3] {
    position.to_array().map(|x| (x + 0.0).to_bits())
}

type Chain = HashMap<([u64; 3], [u64; 3]), i32>;

/// Adds a directed edge to a signed chain: walked back, it counts −1.
fn walk(chain: &mut Chain, from: DVec3, to: DVec3, times: i32) {
    let (from, to) = (key(from), key(to));
    if from < to {
        *chain.entry((from, to)).or_default() += times;
    } else if to < from {
        *chain.entry((to, from)).or_default() -= times;
    }
}

/// All structural laws of a mesh.
pub fn check_laws(mesh: &FillMesh) {
    check_arcs(mesh);
    check_pieces_are_closed(mesh);
    check_bounds(mesh);
    check_deviation(mesh);
    for &(a, b) in &mesh.overlaps {
        assert!(a < b && (b as usize) < mesh.pieces.len());
    }
}

pub fn check_arcs(mesh: &FillMesh) {
    let mut next_vertex = 0;
    for arc in &mesh.arcs {
        assert_eq!(arc.first_vertex, next_vertex);
        assert!(arc.vertex_count >= 2);
        assert!(arc.left.is_some() || arc.right.is_some());
        assert_ne!(arc.left, arc.right);
        next_vertex += arc.vertex_count;
        let vertices = &mesh.boundary[arc.first_vertex as usize..next_vertex as usize];
        let (last, others) = vertices.split_last().unwrap();
        assert_eq!((last.t, last.deviation_m), (1.0, 0.0));
        assert_eq!(last.curve, others.last().unwrap().curve);
        for pair in vertices.windows(2) {
            if pair[0].curve == pair[1].curve {
                assert!(pair[0].t < pair[1].t);
            } else {
                assert_eq!((pair[1].curve, pair[1].t), (pair[0].curve + 1, 0.0));
            }
        }
    }
    assert_eq!(next_vertex as usize, mesh.boundary.len());
    for (vertex, position) in mesh.boundary.iter().zip(&mesh.vertices) {
        let curve: &Curve = &mesh.curves[vertex.curve as usize];
        let expected = curve.on(&mesh.ellipsoid).ecef(vertex.t);
        assert!(
            expected.distance(*position) < 2e-8 * mesh.ellipsoid.a_m / 6e6,
            "{curve:?}"
        );
    }
    for &position in &mesh.vertices {
        let scaled = position / mesh.ellipsoid.radii_m();
        assert!(
            (scaled.length() - 1.0).abs() < 1e-14,
            "{position} is not on the ellipsoid"
        );
    }
}

/// The signed boundary of a piece's triangles is its arcs, bit for bit.
pub fn check_pieces_are_closed(mesh: &FillMesh) {
    let mut chains: Vec<Chain> = vec![Chain::new(); mesh.pieces.len()];
    for arc in &mesh.arcs {
        let first = arc.first_vertex as usize;
        let vertices = &mesh.vertices[first..first + arc.vertex_count as usize];
        for pair in vertices.windows(2) {
            for (side, times) in [(arc.left, -1), (arc.right, 1)] {
                if let Some(piece) = side {
                    walk(&mut chains[piece as usize], pair[0], pair[1], times);
                }
            }
        }
    }
    for (piece, chain) in mesh.pieces.iter().zip(&mut chains) {
        let first = piece.first_triangle as usize;
        for corners in &mesh.cap_triangles[first..first + piece.triangle_count as usize] {
            let [a, b, c] = corners.map(|corner| mesh.vertices[corner as usize]);
            walk(chain, a, b, 1);
            walk(chain, b, c, 1);
            walk(chain, c, a, 1);
        }
        let open = chain.values().filter(|&&times| times != 0).count();
        assert_eq!(open, 0, "open edges of a piece of fill {}", piece.fill);
    }
    let pieces: u32 = mesh.fills.iter().map(|fill| fill.piece_count).sum();
    assert_eq!(pieces as usize, mesh.pieces.len());
    for (index, fill) in mesh.fills.iter().enumerate() {
        let first = fill.first_piece as usize;
        for piece in &mesh.pieces[first..first + fill.piece_count as usize] {
            assert_eq!(piece.fill as usize, index);
        }
    }
}

pub fn check_bounds(mesh: &FillMesh) {
    let inside = |bounds: &globefill::fill_mesh::Bounds, position: DVec3| {
        let unit = (position / mesh.ellipsoid.radii_m()).normalize();
        2.0 * (0.5 * unit.distance(bounds.axis)).min(1.0).asin() <= bounds.radius_rad
    };
    for arc in &mesh.arcs {
        for index in arc.first_vertex..arc.first_vertex + arc.vertex_count {
            let vertex = mesh.boundary[index as usize];
            let on = mesh.curves[vertex.curve as usize].on(&mesh.ellipsoid);
            let last = index + 1 == arc.first_vertex + arc.vertex_count;
            let next = mesh.boundary.get(index as usize + 1);
            let end = next
                .filter(|next| !last && next.curve == vertex.curve)
                .map_or(1.0, |next| next.t);
            for share in [0.0, 0.3, 0.6] {
                let point = on.ecef(vertex.t + share * (end - vertex.t));
                assert!(inside(&arc.bounds, point));
                for piece in [arc.left, arc.right].into_iter().flatten() {
                    assert!(inside(&mesh.pieces[piece as usize].bounds, point));
                }
            }
        }
    }
    for piece in &mesh.pieces {
        let first = piece.first_triangle as usize;
        for corners in &mesh.cap_triangles[first..first + piece.triangle_count as usize] {
            let corners = corners.map(|corner| mesh.vertices[corner as usize]);
            let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            assert!(
                corners
                    .iter()
                    .chain([&middle])
                    .all(|&corner| inside(&piece.bounds, corner))
            );
        }
    }
}

/// The drawn edge lies no further from the true one than it says, and than was asked for.
fn check_deviation(mesh: &FillMesh) {
    for (index, vertex) in mesh.boundary.iter().enumerate() {
        assert!(vertex.deviation_m <= 5.001, "{vertex:?}");
        let Some(next) = mesh.boundary.get(index + 1).filter(|_| vertex.t < 1.0) else {
            continue;
        };
        let end_t = if next.curve == vertex.curve {
            next.t
        } else {
            1.0
        };
        let on = mesh.curves[vertex.curve as usize].on(&mesh.ellipsoid);
        let (start, end) = (on.ecef(vertex.t), on.ecef(end_t));
        let up = mesh.ellipsoid.normal_at_surface(0.5 * (start + end));
        let across = (end - start).cross(up).normalize();
        let middle = on.ecef(0.5 * (vertex.t + end_t));
        assert!(((middle - start).dot(across)).abs() <= f64::from(vertex.deviation_m) + 1e-6);
        assert!(start.distance(end) < 223_000.0 * mesh.ellipsoid.a_m / 6_378_137.0);
        assert!(mesh.ellipsoid.geodetic(0.5 * (start + end)).1 >= -mesh.sag_m);
    }
}

/// Σ of signed triangle areas, m², on the authalic sphere through the ellipsoid.
pub fn cap_area_m2(mesh: &FillMesh, piece: usize) -> f64 {
    let piece = &mesh.pieces[piece];
    let first = piece.first_triangle as usize;
    let geodesic = Geodesic::new(mesh.ellipsoid.a_m, mesh.ellipsoid.flattening());
    let mut area_m2 = 0.0;
    for corners in &mesh.cap_triangles[first..first + piece.triangle_count as usize] {
        let corners =
            corners.map(|corner| mesh.ellipsoid.geodetic(mesh.vertices[corner as usize]).0);
        area_m2 += left_area_m2(&geodesic, &corners);
    }
    area_m2
}

/// Karney's signed area to the left of a geodesic ring.
fn left_area_m2(geodesic: &Geodesic, ring: &[LonLat]) -> f64 {
    let mut area = PolygonArea::new(geodesic, Winding::CounterClockwise);
    for vertex in ring {
        area.add_point(vertex.lat_deg, vertex.lon_deg);
    }
    area.compute(true).1
}

pub fn countries(dataset: Dataset) -> (Vec<Country>, FillMesh) {
    let countries = dataset.countries();
    let regions: Vec<Region> = countries
        .iter()
        .map(|country| country.region.clone())
        .collect();
    let mesh = build(&regions);
    (countries, mesh)
}

/// Area of a region, m², with edges cut fine enough that geodesics are as good.
pub fn region_area_m2(region: &Region) -> f64 {
    let geodesic = Geodesic::new(Ellipsoid::WGS84.a_m, Ellipsoid::WGS84.flattening());
    let ring_area_m2 = |ring: &[LonLat]| {
        let mut fine = Vec::new();
        for (index, &from) in ring.iter().enumerate() {
            let curve = Curve::between(region.edges, from, ring[(index + 1) % ring.len()]);
            let on = curve.on(&Ellipsoid::WGS84);
            let parts = if from.lat_deg.abs() > 80.0 { 300 } else { 30 };
            fine.extend((0..parts).map(|k| on.lon_lat(f64::from(k) / f64::from(parts))));
        }
        left_area_m2(&geodesic, &fine).abs()
    };
    let polygon_area_m2 = |polygon: &Polygon| {
        let holes: f64 = polygon.holes.iter().map(|hole| ring_area_m2(hole)).sum();
        ring_area_m2(&polygon.shell) - holes
    };
    region.polygons.iter().map(polygon_area_m2).sum()
}

pub fn fill_area_m2(mesh: &FillMesh, fill: usize) -> f64 {
    let fill = &mesh.fills[fill];
    let first = fill.first_piece as usize;
    (first..first + fill.piece_count as usize)
        .map(|piece| cap_area_m2(mesh, piece))
        .sum()
}

pub fn kinds(mesh: &FillMesh) -> Vec<RepairKind> {
    mesh.repairs.iter().map(|repair| repair.kind).collect()
}

pub const KINDS: [EdgeKind; 3] = [EdgeKind::Geodesic, EdgeKind::Rhumb, EdgeKind::Straight];
