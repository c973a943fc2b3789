//! Shapes that break others: poles, the antimeridian, holes, crossings, and what is refused.

use globefill::{
    EdgeKind, Ellipsoid, FillMesh, Inside, LonLat, MeshOptions, Region, RepairKind,
    countries::Dataset,
};

use crate::law::{KINDS, build, fill_area_m2, kinds, region, smaller};

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
fn ellipsoids_that_positions_cannot_be_encoded_for_are_refused() {
    let square = smaller(
        EdgeKind::Geodesic,
        &[&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]],
    );
    for (a_m, b_m) in [
        (f64::NAN, 6e6),
        (6e6, 0.0),
        (-6e6, -6e6),
        (7e7, 7e7),
        (6e6, 5e6),
    ] {
        let options = MeshOptions {
            ellipsoid: Ellipsoid { a_m, b_m },
            ..MeshOptions::default()
        };
        let refused = FillMesh::build(std::slice::from_ref(&square), &options);
        assert!(matches!(
            refused,
            Err(globefill::RegionError::InvalidEllipsoid { .. })
        ));
    }
}

/// A file of one polygon many times over has quadratically many overlaps at every edge.
#[test]
fn copies_of_one_polygon_are_refused_before_they_exhaust_memory() {
    let ring: Vec<(f64, f64)> = (0..300)
        .map(|k| {
            let (sin, cos) = (f64::from(k) * 1.2).to_radians().sin_cos();
            (10.0 + 3.0 * cos, 45.0 + 2.0 * sin)
        })
        .collect();
    let copies = vec![smaller(EdgeKind::Straight, &[&ring]); 600];
    let refused = FillMesh::build(&copies, &MeshOptions::default());
    assert!(matches!(
        refused,
        Err(globefill::RegionError::Tangled { .. })
    ));
    assert!(FillMesh::build(&copies[..5], &MeshOptions::default()).is_ok());
}
