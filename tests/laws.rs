//! Laws that every mesh keeps, on real countries and on shapes that break others.

use std::collections::HashMap;

use geographiclib_rs::{Geodesic, PolygonArea, Winding};
use globefill::{
    Curve, EdgeKind, Ellipsoid, FillMesh, Inside, LonLat, MeshOptions, Polygon, Region, RepairKind,
    countries::{Country, Dataset},
    glam::DVec3,
};
use proptest::{prelude::*, test_runner::RngSeed};

fn build(regions: &[Region]) -> FillMesh {
    let mesh = FillMesh::build(regions, &MeshOptions::default()).unwrap();
    check_laws(&mesh);
    mesh
}

fn region(edges: EdgeKind, inside: Inside, rings: &[&[(f64, f64)]]) -> Region {
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
    }
}

fn smaller(edges: EdgeKind, rings: &[&[(f64, f64)]]) -> Region {
    region(edges, Inside::Smaller, rings)
}

/// Equal positions are one point.
fn key(position: DVec3) -> [u64; 3] {
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
fn check_laws(mesh: &FillMesh) {
    check_arcs(mesh);
    check_pieces_are_closed(mesh);
    check_bounds(mesh);
    check_deviation(mesh);
    for &(a, b) in &mesh.overlaps {
        assert!(a < b && (b as usize) < mesh.pieces.len());
    }
}

fn check_arcs(mesh: &FillMesh) {
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
fn check_pieces_are_closed(mesh: &FillMesh) {
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

fn check_bounds(mesh: &FillMesh) {
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
fn cap_area_m2(mesh: &FillMesh, piece: usize) -> f64 {
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

fn countries(dataset: Dataset) -> (Vec<Country>, FillMesh) {
    let countries = dataset.countries();
    let regions: Vec<Region> = countries
        .iter()
        .map(|country| country.region.clone())
        .collect();
    let mesh = build(&regions);
    (countries, mesh)
}

/// Area of a region, m², with edges cut fine enough that geodesics are as good.
fn region_area_m2(region: &Region) -> f64 {
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

fn fill_area_m2(mesh: &FillMesh, fill: usize) -> f64 {
    let fill = &mesh.fills[fill];
    let first = fill.first_piece as usize;
    (first..first + fill.piece_count as usize)
        .map(|piece| cap_area_m2(mesh, piece))
        .sum()
}

fn check_country_areas(countries: &[Country], mesh: &FillMesh) {
    for (index, country) in countries.iter().enumerate() {
        let expected_m2 = region_area_m2(&country.region);
        let found_m2 = fill_area_m2(mesh, index);
        let perimeter_m: f64 = country
            .region
            .polygons
            .iter()
            .flat_map(|polygon| std::iter::once(&polygon.shell).chain(&polygon.holes))
            .flat_map(|ring| ring.windows(2))
            .map(|pair| {
                Ellipsoid::WGS84
                    .ecef(pair[0], 0.0)
                    .distance(Ellipsoid::WGS84.ecef(pair[1], 0.0))
            })
            .sum();
        // No chord lies further beside its true edge than the tolerance.
        let bound_m2 = 5.0 * perimeter_m + 1e-6 * expected_m2;
        let error_m2 = (found_m2 - expected_m2).abs();
        assert!(
            error_m2 < bound_m2,
            "{}: {found_m2} for {expected_m2} m²",
            country.name
        );
    }
}

fn kinds(mesh: &FillMesh) -> Vec<RepairKind> {
    mesh.repairs.iter().map(|repair| repair.kind).collect()
}

#[test]
fn countries_at_110m_are_closed_and_have_their_areas() {
    let (countries, mesh) = countries(Dataset::Countries110m);
    check_country_areas(&countries, &mesh);
    // Natural Earth's Sudan turns back on itself across its borders with Ethiopia and South Sudan.
    let name = |piece: u32| countries[mesh.pieces[piece as usize].fill as usize].name;
    let among = ["Sudan", "S. Sudan", "Ethiopia"];
    for &(a, b) in &mesh.overlaps {
        assert!(
            among.contains(&name(a)) && among.contains(&name(b)),
            "{} {}",
            name(a),
            name(b)
        );
    }
    let repaired = |kind: RepairKind| -> Vec<&str> {
        let found = mesh.repairs.iter().filter(|repair| repair.kind == kind);
        found
            .map(|repair| countries[repair.place.region].name)
            .collect()
    };
    assert_eq!(repaired(RepairKind::Crossing), ["Sudan"]);
    assert!(repaired(RepairKind::Seam).contains(&"Antarctica"));
}

#[test]
fn countries_at_50m_are_closed_disjoint_and_have_their_areas() {
    let (countries, mesh) = countries(Dataset::Countries50m);
    check_country_areas(&countries, &mesh);
    assert_eq!(mesh.overlaps, []);
    // The border is stored once: as many arcs have two sides as the atlas has borders and more.
    let named = |name: &str| {
        countries
            .iter()
            .position(|country| country.name == name)
            .unwrap()
    };
    let fill_of = |piece: Option<u32>| piece.map(|piece| mesh.pieces[piece as usize].fill as usize);
    let pair = [named("France"), named("Germany")];
    let common: Vec<_> = mesh
        .arcs
        .iter()
        .filter(|arc| {
            let sides = [fill_of(arc.left), fill_of(arc.right)];
            pair.iter().all(|&fill| sides.contains(&Some(fill)))
        })
        .collect();
    assert_eq!(common.len(), 1);
    let first = common[0].first_vertex as usize;
    let run = &mesh.vertices[first..first + common[0].vertex_count as usize];
    let border_m: f64 = run.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    assert!((300e3..450e3).contains(&border_m), "{border_m}");
    let mut seen: HashMap<([u64; 3], [u64; 3]), u32> = HashMap::new();
    for arc in &mesh.arcs {
        let first = arc.first_vertex as usize;
        for pair in mesh.vertices[first..first + arc.vertex_count as usize].windows(2) {
            let (a, b) = (key(pair[0]), key(pair[1]));
            let count = seen.entry((a.min(b), a.max(b))).or_default();
            *count += 1;
            assert_eq!(*count, 1, "a chord is stored once");
        }
    }
}

#[test]
fn states_of_the_us_are_closed_and_have_their_areas() {
    let (states, mesh) = countries(Dataset::UsStates);
    check_country_areas(&states, &mesh);
    assert_eq!(mesh.overlaps, []);
}

#[test]
fn antarctica_keeps_no_artificial_edge() {
    for dataset in [Dataset::Countries110m, Dataset::Countries50m] {
        let mesh = build(&[dataset.country("ATA").unwrap().region]);
        for (vertex, position) in mesh.boundary.iter().zip(&mesh.vertices) {
            let lat_deg = mesh.ellipsoid.geodetic(*position).0.lat_deg;
            // At 50m Natural Earth leaves out a disc of 120 m round the pole: that is an edge.
            let at_disc = (lat_deg + 89.998_925_8).abs() < 1e-6;
            assert!(lat_deg > -86.0 || at_disc, "{vertex:?} at {lat_deg}");
        }
        let south = mesh
            .pieces
            .iter()
            .filter(|piece| piece.bounds.axis.z < -0.9 && piece.bounds.radius_rad > 0.3);
        assert_eq!(south.count(), 1);
    }
}

#[test]
fn the_canadian_border_is_the_parallel() {
    let ring = [(-100.0, 45.0), (-97.0, 45.0), (-97.0, 49.0), (-100.0, 49.0)];
    let mesh = build(&[smaller(EdgeKind::Straight, &[&ring])]);
    let mut lowest_deg = 90.0_f64;
    for (index, vertex) in mesh.boundary.iter().enumerate() {
        let next = mesh
            .boundary
            .get(index + 1)
            .filter(|next| next.curve == vertex.curve);
        let curve = mesh.curves[vertex.curve as usize].on(&mesh.ellipsoid);
        let position = mesh.ellipsoid.geodetic(mesh.vertices[index]).0;
        if position.lat_deg > 48.9999 {
            assert!((position.lat_deg - 49.0).abs() < 1e-9);
            let middle = curve.lon_lat(0.5 * (vertex.t + next.map_or(1.0, |next| next.t)));
            if next.is_some() && curve.curve().from.lat_deg == curve.curve().to.lat_deg {
                lowest_deg = lowest_deg.min(middle.lat_deg);
            }
        }
    }
    assert_eq!(lowest_deg, 49.0);
}

const KINDS: [EdgeKind; 3] = [EdgeKind::Geodesic, EdgeKind::Rhumb, EdgeKind::Straight];

/// Σ of the pieces' areas over the globe's, and the mesh.
fn share_of_globe(region: Region) -> (f64, FillMesh) {
    let mesh = build(&[region]);
    let globe_m2 = 510_065_621_724_088.44;
    (fill_area_m2(&mesh, 0) / globe_m2, mesh)
}

fn assert_share(region: Region, expected: f64) -> FillMesh {
    let (share, mesh) = share_of_globe(region);
    // Signed Karney areas are known up to whole globes.
    let error = (share - expected + 0.5).rem_euclid(1.0) - 0.5;
    assert!(error.abs() < 2e-7, "{share} for {expected}");
    mesh
}

#[test]
fn octants_and_their_rests() {
    let octant = [(20.0, 0.0), (110.0, 0.0), (110.0, 90.0), (20.0, 90.0)];
    let reversed: Vec<_> = octant.iter().rev().copied().collect();
    for kind in KINDS {
        for ring in [&octant[..], &reversed] {
            assert_share(smaller(kind, &[ring]), 0.125);
        }
        assert_share(region(kind, Inside::LeftOfRing, &[&octant]), 0.125);
        assert_share(region(kind, Inside::LeftOfRing, &[&reversed]), 0.875);
        let south = [(20.0, 0.0), (20.0, -90.0), (110.0, -90.0), (110.0, 0.0)];
        assert_share(smaller(kind, &[&south]), 0.125);
        // A quarter from pole to pole, and across the antimeridian.
        let lune = [
            (135.0, 0.0),
            (135.0, -90.0),
            (-135.0, -90.0),
            (-135.0, 0.0),
            (-135.0, 90.0),
            (135.0, 90.0),
        ];
        assert_share(smaller(kind, &[&lune]), 0.25);
    }
}

#[test]
fn rings_round_a_pole() {
    // sin φ on the authalic sphere: the share north of 60° by the closed formula.
    let north_of_60 = 0.067_473_34;
    let parallel = [(-180.0, 60.0), (-60.0, 60.0), (60.0, 60.0)];
    let cap = build(&[smaller(EdgeKind::Straight, &[&parallel])]);
    let share = fill_area_m2(&cap, 0) / 510_065_621_724_088.44;
    assert!((share - north_of_60).abs() < 1e-7, "{share}");
    // The same cap written as a box, and as one edge all the way round.
    let box_ = [(-180.0, 60.0), (180.0, 60.0), (180.0, 90.0), (-180.0, 90.0)];
    let boxed = assert_share(smaller(EdgeKind::Straight, &[&box_]), share);
    assert!(kinds(&boxed).contains(&RepairKind::Seam));
    let rest = region(
        EdgeKind::Straight,
        Inside::LeftOfRing,
        &[&[(60.0, 60.0), (-60.0, 60.0), (-180.0, 60.0)]],
    );
    assert_share(rest, 1.0 - share);
    // A geodesic over the pole is an ordinary edge.
    let over = [(0.0, 70.0), (180.0, 70.0), (-90.0, 60.0)];
    let mesh = build(&[smaller(EdgeKind::Geodesic, &[&over])]);
    assert!(
        mesh.vertices
            .iter()
            .any(|vertex| vertex.truncate().length() == 0.0)
    );
}

#[test]
fn the_whole_globe_and_the_globe_with_a_hole() {
    let world = [
        (-180.0, -90.0),
        (180.0, -90.0),
        (180.0, 90.0),
        (-180.0, 90.0),
    ];
    let mesh = build(&[smaller(EdgeKind::Straight, &[&world])]);
    assert_eq!((mesh.arcs.len(), mesh.pieces.len()), (0, 1));
    assert!(mesh.cap_triangles.len() > 1000);
    let octant = [(20.0, 0.0), (110.0, 0.0), (110.0, 90.0), (20.0, 90.0)];
    assert_share(smaller(EdgeKind::Straight, &[&world, &octant]), 0.875);
    // A line there and back bounds nothing.
    let spike = [(0.0, 0.0), (10.0, 0.0), (20.0, 0.0), (10.0, 0.0)];
    let nothing = build(&[smaller(EdgeKind::Straight, &[&spike])]);
    assert_eq!((nothing.pieces.len(), nothing.fills[0].piece_count), (0, 0));
    assert!(kinds(&nothing).contains(&RepairKind::Seam));
}

#[test]
fn holes_are_holes_whatever_their_winding() {
    let shell = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
    let hole = [(2.0, 2.0), (4.0, 2.0), (4.0, 4.0), (2.0, 4.0)];
    let reversed: Vec<_> = hole.iter().rev().copied().collect();
    for kind in KINDS {
        let (whole, _) = share_of_globe(smaller(kind, &[&shell]));
        let (gone, _) = share_of_globe(smaller(kind, &[&hole]));
        for hole in [&hole[..], &reversed] {
            assert_share(smaller(kind, &[&shell, hole]), whole - gone);
        }
        // Outside the shell, or in another hole, a hole removes nothing.
        let outside = [(20.0, 2.0), (24.0, 2.0), (24.0, 4.0), (20.0, 4.0)];
        let mesh = assert_share(smaller(kind, &[&shell, &outside]), whole);
        assert!(kinds(&mesh).contains(&RepairKind::IdleHole));
        let nested = [(2.5, 2.5), (3.0, 2.5), (3.0, 3.0)];
        assert_share(smaller(kind, &[&shell, &hole, &nested]), whole - gone);
        assert_share(smaller(kind, &[&shell, &nested, &hole]), whole - gone);
        // A hole that touches the shell from within is one still.
        let touching = [(0.0, 0.0), (4.0, 2.0), (2.0, 4.0)];
        let (bite, _) = share_of_globe(smaller(kind, &[&touching]));
        let mesh = assert_share(smaller(kind, &[&shell, &touching]), whole - bite);
        assert!(kinds(&mesh).contains(&RepairKind::Pinch));
    }
}

#[test]
fn neighbours_fill_a_hole_without_overlap() {
    let shell = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
    let hole = [(2.0, 2.0), (4.0, 2.0), (4.0, 4.0), (2.0, 4.0)];
    for kind in KINDS {
        let mesh = build(&[smaller(kind, &[&shell, &hole]), smaller(kind, &[&hole])]);
        assert_eq!((mesh.arcs.len(), mesh.overlaps.len()), (2, 0));
        let mesh = build(&[smaller(kind, &[&shell]), smaller(kind, &[&hole])]);
        assert_eq!((mesh.arcs.len(), &mesh.overlaps[..]), (2, &[(0, 1)][..]));
        // The same region twice: each has walls of its own.
        let mesh = build(&[
            smaller(kind, &[&hole]),
            smaller(kind, &[&hole]),
            smaller(kind, &[&shell]),
        ]);
        assert_eq!(mesh.overlaps, [(0, 1), (0, 2), (1, 2)]);
        assert_eq!(mesh.arcs.len(), 3);
    }
    // Lesotho is cut out of South Africa.
    let regions = ["ZAF", "LSO"].map(|code| Dataset::Countries50m.country(code).unwrap().region);
    let mesh = build(&regions);
    assert_eq!(mesh.overlaps, []);
    let lesotho = mesh.fills[1].first_piece;
    assert!(
        mesh.arcs
            .iter()
            .filter(|arc| [arc.left, arc.right].contains(&Some(lesotho)))
            .all(|arc| arc.left.is_some() && arc.right.is_some())
    );
}

#[test]
fn crossing_neighbours_are_listed_and_touching_ones_are_not() {
    let left = [(0.0, 0.0), (5.0, 0.0), (5.0, 10.0), (0.0, 10.0)];
    for kind in KINDS {
        let right = [(5.0, 0.0), (9.0, 0.0), (9.0, 10.0), (5.0, 10.0)];
        assert_eq!(
            build(&[smaller(kind, &[&left]), smaller(kind, &[&right])]).overlaps,
            []
        );
        let corner = [(5.0, 10.0), (9.0, 10.0), (9.0, 20.0)];
        assert_eq!(
            build(&[smaller(kind, &[&left]), smaller(kind, &[&corner])]).overlaps,
            []
        );
        let across = [(4.0, 2.0), (9.0, 2.0), (9.0, 8.0)];
        assert_eq!(
            build(&[smaller(kind, &[&left]), smaller(kind, &[&across])]).overlaps,
            [(0, 1)]
        );
        // They share an edge, but lie on the same side of it.
        let within = [(0.0, 0.0), (5.0, 0.0), (2.0, 3.0)];
        assert_eq!(
            build(&[smaller(kind, &[&left]), smaller(kind, &[&within])]).overlaps,
            [(0, 1)]
        );
    }
    // The neighbour has a vertex more on the common border: it becomes the border's.
    let right = [(5.0, 0.0), (9.0, 0.0), (9.0, 10.0), (5.0, 10.0), (5.0, 3.0)];
    let mesh = build(&[
        smaller(EdgeKind::Straight, &[&left]),
        smaller(EdgeKind::Straight, &[&right]),
    ]);
    assert_eq!((mesh.overlaps.len(), mesh.arcs.len()), (0, 3));
}

#[test]
fn crossing_rings_are_filled_by_the_even_odd_rule() {
    let bow_tie = [(0.0, -5.0), (10.0, 5.0), (10.0, -5.0), (0.0, 5.0)];
    for kind in KINDS {
        let mesh = build(&[smaller(kind, &[&bow_tie])]);
        assert_eq!(kinds(&mesh), [RepairKind::Unclosed, RepairKind::Crossing]);
        let halves = [
            [(0.0, -5.0), (5.0, 0.0), (0.0, 5.0)],
            [(10.0, -5.0), (5.0, 0.0), (10.0, 5.0)],
        ];
        let share: f64 = halves
            .iter()
            .map(|half| share_of_globe(smaller(kind, &[half])).0)
            .sum();
        assert!((fill_area_m2(&mesh, 0) / 510_065_621_724_088.44 - share).abs() < 1e-8);

        // The middle of a pentagram is outside.
        let star: Vec<_> = (0..5)
            .map(|k| (f64::from(2 * k) * 72.0).to_radians().sin_cos())
            .map(|(sin, cos)| (170.0 + 15.0 * sin, 10.0 * cos))
            .collect();
        let mesh = build(&[smaller(kind, &[&star])]);
        let crossings = kinds(&mesh)
            .into_iter()
            .filter(|&kind| kind == RepairKind::Crossing)
            .count();
        assert_eq!(crossings, 5);
        let center = mesh.ellipsoid.ecef(LonLat::new(170.0, 0.0), 0.0);
        let near = mesh
            .vertices
            .iter()
            .map(|vertex| vertex.distance(center))
            .fold(f64::INFINITY, f64::min);
        assert!(near > 300e3, "{near}");
    }
}

#[test]
fn spikes_pinches_and_keyholes() {
    let with_spike = [
        (0.0, 0.0),
        (10.0, 0.0),
        (10.0, 5.0),
        (20.0, 5.0),
        (10.0, 5.0),
        (10.0, 10.0),
        (0.0, 10.0),
    ];
    let square = [
        (0.0, 0.0),
        (10.0, 0.0),
        (10.0, 5.0),
        (10.0, 10.0),
        (0.0, 10.0),
    ];
    let keyhole = [
        (0.0, 0.0),
        (10.0, 0.0),
        (10.0, 10.0),
        (0.0, 10.0),
        (0.0, 0.0),
        (2.0, 2.0),
        (2.0, 4.0),
        (4.0, 4.0),
        (4.0, 2.0),
        (2.0, 2.0),
    ];
    let hole = [(2.0, 2.0), (4.0, 2.0), (4.0, 4.0), (2.0, 4.0)];
    let pinch = [
        (0.0, 0.0),
        (5.0, 5.0),
        (10.0, 0.0),
        (10.0, 10.0),
        (5.0, 5.0),
        (0.0, 10.0),
    ];
    let halves = [
        [(0.0, 0.0), (5.0, 5.0), (0.0, 10.0)],
        [(5.0, 5.0), (10.0, 0.0), (10.0, 10.0)],
    ];
    for kind in KINDS {
        let (whole, _) = share_of_globe(smaller(kind, &[&square]));
        let mesh = assert_share(smaller(kind, &[&with_spike]), whole);
        assert!(kinds(&mesh).contains(&RepairKind::Seam));
        let (gone, _) = share_of_globe(smaller(kind, &[&hole]));
        let (plain, _) = share_of_globe(smaller(
            kind,
            &[&[square[0], square[1], square[3], square[4]]],
        ));
        assert_share(smaller(kind, &[&keyhole]), plain - gone);
        let share: f64 = halves
            .iter()
            .map(|half| share_of_globe(smaller(kind, &[half])).0)
            .sum();
        let mesh = assert_share(smaller(kind, &[&pinch]), share);
        assert_eq!(
            mesh.repairs
                .iter()
                .filter(|repair| repair.kind == RepairKind::Pinch)
                .count(),
            1
        );
    }
    let korea = Dataset::Countries110m.country("PRK").unwrap().region;
    assert!(!build(&[korea]).pieces.is_empty());
}

#[test]
fn errors_name_the_place() {
    let good = smaller(
        EdgeKind::Geodesic,
        &[&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)]],
    );
    let hole = |ring: &[(f64, f64)]| {
        let mut region = good.clone();
        region.polygons.push(region.polygons[0].clone());
        region.polygons[1].holes.push(
            ring.iter()
                .map(|&(lon, lat)| LonLat::new(lon, lat))
                .collect(),
        );
        FillMesh::build(&[good.clone(), region], &MeshOptions::default())
            .unwrap_err()
            .to_string()
    };
    let place = "feature 1, polygon 1, ring 1, vertex";
    for (ring, expected) in [
        (
            &[][..],
            format!("{place} 0: the ring has 0 distinct vertices, a ring needs three"),
        ),
        (
            &[(1.0, 1.0), (2.0, 2.0)],
            format!("{place} 0: the ring has 2 distinct vertices, a ring needs three"),
        ),
        (
            &[(1.0, 1.0), (2.0, 91.0)],
            format!("{place} 1: (2, 91) is not a longitude and latitude in degrees"),
        ),
        (
            &[(f64::NAN, 1.0)],
            format!("{place} 0: (NaN, 1) is not a longitude and latitude in degrees"),
        ),
        (
            &[(1.0, 1.0), (0.0, 1.0), (179.9, -1.0)],
            format!("{place} 1: the edge to the next vertex joins nearly antipodal points"),
        ),
    ] {
        assert_eq!(hole(ring), expected);
    }
    let empty = FillMesh::build(&[Region::default()], &MeshOptions::default()).unwrap();
    assert_eq!((empty.fills.len(), empty.pieces.len()), (1, 0));
}

#[test]
fn shapes_keep_their_laws_wherever_they_lie() {
    // A star with a hole, turned to many places, among them the poles and the antimeridian.
    let star = |scale: f64| {
        (0..9).map(move |k| {
            let (sin, cos) = (f64::from(k) * 40.0).to_radians().sin_cos();
            let reach = scale * if k % 2 == 0 { 0.3 } else { 0.12 };
            DVec3::new(1.0, reach * cos, reach * sin).normalize()
        })
    };
    let mut first_area_m2 = None;
    for step in 0..60_u32 {
        let turn = globefill::glam::DQuat::from_rotation_z(f64::from(step) * 0.7)
            * globefill::glam::DQuat::from_rotation_y(
                f64::from(step % 8) * std::f64::consts::FRAC_PI_8,
            )
            * globefill::glam::DQuat::from_rotation_x(f64::from(step) * 1.3);
        let options = MeshOptions {
            ellipsoid: Ellipsoid::MOON,
            ..MeshOptions::default()
        };
        let ring = |scale: f64| -> Vec<LonLat> {
            star(scale)
                .map(|point| Ellipsoid::MOON.geodetic(turn * point * 1_737_400.0).0)
                .collect()
        };
        let polygon = Polygon {
            shell: ring(1.0),
            holes: vec![ring(0.3)],
        };
        for edges in KINDS {
            let region = Region {
                polygons: vec![polygon.clone()],
                edges,
                inside: Inside::Smaller,
            };
            let mesh = FillMesh::build(&[region], &options).unwrap();
            check_laws(&mesh);
            assert_eq!(mesh.pieces.len(), 1);
            if edges == EdgeKind::Geodesic {
                let area_m2 = fill_area_m2(&mesh, 0);
                let expected_m2 = *first_area_m2.get_or_insert(area_m2);
                assert!(
                    (area_m2 / expected_m2 - 1.0).abs() < 1e-6,
                    "{area_m2} {expected_m2}"
                );
            }
        }
    }
}

/// How often a piece's triangles cover a direction, signed: 1 inside, 0 outside.
fn covering(mesh: &FillMesh, piece: usize, direction: DVec3) -> i32 {
    let piece = &mesh.pieces[piece];
    let first = piece.first_triangle as usize;
    let triangles = &mesh.cap_triangles[first..first + piece.triangle_count as usize];
    let covered = triangles.iter().map(|corners| {
        let [a, b, c] = corners.map(|corner| mesh.vertices[corner as usize]);
        let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| p.cross(q).dot(direction) > 0.0);
        match sides {
            [true, true, true] if (a + b + c).dot(direction) > 0.0 => 1,
            [false, false, false] if (a + b + c).dot(direction) > 0.0 => -1,
            _ => 0,
        }
    });
    covered.sum()
}

/// Directions spread evenly over the sphere, none on a round meridian or parallel.
fn directions(count: u32) -> impl Iterator<Item = DVec3> {
    (0..count).map(move |k| {
        let z = 1.0 - (2.0 * f64::from(k) + 1.017) / f64::from(count);
        let (sin, cos) = (0.123_4 + f64::from(k) * 2.399_963_229_728_653).sin_cos();
        DVec3::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 250, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    /// Rings on a coarse grid touch, cross and retrace themselves, run through poles and round them.
    #[test]
    fn hostile_rings_keep_the_laws(
        kind in 0_usize..3,
        left in any::<bool>(),
        rings in prop::collection::vec(prop::collection::vec((-6_i32..=6, -3_i32..=3), 3..9), 1..4),
        shrink in prop::sample::select(vec![1.0, 0.1, 1e-4]),
    ) {
        let place = |&(x, y): &(i32, i32)| LonLat::new(150.0 + shrink * 30.0 * f64::from(x), shrink * 30.0 * f64::from(y));
        let mut rings = rings.iter().map(|ring| ring.iter().map(place).collect::<Vec<_>>());
        let polygon = Polygon { shell: rings.next().unwrap(), holes: rings.collect() };
        let inside = if left { Inside::LeftOfRing } else { Inside::Smaller };
        let region = Region { polygons: vec![polygon], edges: KINDS[kind], inside };
        if let Ok(mesh) = FillMesh::build(&[region], &MeshOptions::default()) {
            check_arcs(&mesh);
            check_pieces_are_closed(&mesh);
            check_bounds(&mesh);
            for direction in directions(50) {
                for piece in 0..mesh.pieces.len() {
                    let times = covering(&mesh, piece, direction);
                    prop_assert!((0..=1).contains(&times), "{times} times at {direction}");
                }
            }
        }
    }

    /// Whatever two pieces both cover is listed.
    #[test]
    fn overlaps_are_all_listed(
        kinds in (0_usize..3, 0_usize..3),
        rings in prop::array::uniform4(prop::collection::vec((-6_i32..=6, -3_i32..=3), 3..6)),
    ) {
        let place = |&(x, y): &(i32, i32)| LonLat::new(150.0 + 10.0 * f64::from(x), 30.0 + 20.0 * f64::from(y));
        let polygon = |ring: &Vec<(i32, i32)>| Polygon { shell: ring.iter().map(place).collect(), holes: vec![] };
        let region = |rings: &[Vec<(i32, i32)>], kind: usize| Region {
            polygons: rings.iter().map(polygon).collect(),
            edges: KINDS[kind],
            inside: Inside::Smaller,
        };
        let regions = [region(&rings[..2], kinds.0), region(&rings[2..], kinds.1)];
        if let Ok(mesh) = FillMesh::build(&regions, &MeshOptions::default()) {
            check_pieces_are_closed(&mesh);
            for direction in directions(500) {
                let covering: Vec<u32> = (0..mesh.pieces.len() as u32)
                    .filter(|&piece| covering(&mesh, piece as usize, direction) != 0)
                    .collect();
                for (index, &a) in covering.iter().enumerate() {
                    for &b in &covering[index + 1..] {
                        prop_assert!(mesh.overlaps.contains(&(a, b)), "{a} and {b} at {direction}");
                    }
                }
            }
        }
    }
}
