//! What asks for too much is refused by name, before it takes the time and the memory.

#![allow(missing_docs)]

use globefill::{
    EdgeKind, Excess, FillMesh, Inside, Limits, LonLat, MeshOptions, Polygon, Quantity, Region,
    RegionError, Repair, RepairKind, Zone,
};

/// Meshes with one limit set to `most`; answers what was exceeded, if anything was.
fn build(regions: &[Region], limits: Limits) -> Result<FillMesh, Excess> {
    let options = MeshOptions {
        limits,
        ..MeshOptions::default()
    };
    FillMesh::build(regions, &options).map_err(|error| match error {
        RegionError::Limit(excess) => excess,
        other => panic!("{other}"),
    })
}

fn refused(regions: &[Region], limits: Limits) -> Excess {
    build(regions, limits).unwrap_err()
}

fn square(west_deg: f64, south_deg: f64, side_deg: f64) -> Vec<LonLat> {
    [
        (0.0, 0.0),
        (side_deg, 0.0),
        (side_deg, side_deg),
        (0.0, side_deg),
    ]
    .map(|(x, y)| LonLat::new(west_deg + x, south_deg + y))
    .to_vec()
}

fn straight(polygons: Vec<Polygon>) -> Region {
    Region {
        polygons,
        edges: EdgeKind::Straight,
        ..Region::default()
    }
}

#[test]
fn vertices_are_counted_in_rings_and_corridors() {
    let shell = square(0.0, 0.0, 1.0);
    let holes = vec![square(0.2, 0.2, 0.1)];
    let mut region = straight(vec![Polygon { shell, holes }]);
    region.zones = vec![
        Zone::circle(LonLat::new(50.0, 0.0), 1e4),
        Zone::corridor(vec![LonLat::new(60.0, 0.0), LonLat::new(60.0, 1.0)], 1e3),
    ];
    let within = |vertices| Limits {
        vertices,
        ..Limits::default()
    };
    let excess = Excess {
        what: Quantity::Vertices,
        most: 10,
    };
    assert_eq!(refused(std::slice::from_ref(&region), within(10)), excess);
    assert_eq!(
        excess.to_string(),
        "more than 10 vertices, the limit that is set"
    );
    assert!(build(&[region], within(11)).is_ok());
}

#[test]
fn rings_and_zones_are_counted() {
    let mut region = straight(vec![Polygon {
        shell: square(0.0, 0.0, 1.0),
        holes: vec![square(0.2, 0.2, 0.1)],
    }]);
    region.zones = vec![Zone::circle(LonLat::new(50.0, 0.0), 1e4)];
    let within = |rings| Limits {
        rings,
        ..Limits::default()
    };
    let excess = Excess {
        what: Quantity::Rings,
        most: 2,
    };
    assert_eq!(refused(std::slice::from_ref(&region), within(2)), excess);
    assert!(build(&[region], within(3)).is_ok());
}

/// A ring that goes to and fro `teeth` times, from west to east or from south to north.
fn comb(teeth: u32, turned: bool) -> Vec<LonLat> {
    (0..=2 * teeth)
        .map(|k| {
            let (along, across) = (f64::from(k) / f64::from(2 * teeth), f64::from(k % 2) * 0.9);
            let (along, across) = (0.05 + 0.9 * along, 0.05 + across);
            if turned {
                LonLat::new(across, along)
            } else {
                LonLat::new(along, across)
            }
        })
        .collect()
}

#[test]
fn combs_across_each_other_are_refused_by_their_crossings() {
    // 1 600 teeth across 1 600: 10 million crossings from 6 400 vertices.
    let combs = |teeth| {
        [comb(teeth, false), comb(teeth, true)]
            .map(|shell| Polygon {
                shell,
                holes: Vec::new(),
            })
            .to_vec()
    };
    let limits = Limits {
        crossings: 100_000,
        ..Limits::default()
    };
    let excess = Excess {
        what: Quantity::Crossings,
        most: 100_000,
    };
    assert_eq!(refused(&[straight(combs(1_600))], limits), excess);
    let mesh = build(&[straight(combs(20))], limits).unwrap();
    assert_eq!(mesh.overlaps, [(0, 1)]);
}

#[test]
fn nested_squares_are_refused_by_their_overlaps() {
    let nested = |count: u32| -> Vec<Region> {
        let squares = (0..count).map(|k| {
            let inset_deg = f64::from(k) * 0.4 / f64::from(count);
            let shell = square(inset_deg, inset_deg, 1.0 - 2.0 * inset_deg);
            straight(vec![Polygon {
                shell,
                holes: Vec::new(),
            }])
        });
        squares.collect()
    };
    let limits = Limits {
        overlaps: 200,
        ..Limits::default()
    };
    let excess = Excess {
        what: Quantity::Overlaps,
        most: 200,
    };
    assert_eq!(refused(&nested(1_000), limits), excess);
    assert_eq!(build(&nested(20), limits).unwrap().overlaps.len(), 190);
}

#[test]
fn everything_but_a_triangle_a_thousand_times_is_refused_by_its_vertices() {
    // Each is filled with the 14 442 points that cover the globe: 14 million from 3 000 vertices.
    let all_but = |k: u32| Region {
        inside: Inside::LeftOfRing,
        ..straight(vec![Polygon {
            shell: square(f64::from(k) * 0.1, 0.0, 0.05)
                .into_iter()
                .rev()
                .collect(),
            holes: Vec::new(),
        }])
    };
    let limits = Limits {
        mesh_vertices: 50_000,
        ..Limits::default()
    };
    let excess = Excess {
        what: Quantity::MeshVertices,
        most: 50_000,
    };
    let regions: Vec<Region> = (0..1_000).map(all_but).collect();
    assert_eq!(refused(&regions, limits), excess);
    assert!(build(&regions[..2], limits).is_ok());
}

#[test]
fn a_millimetre_all_round_the_globe_is_refused_by_its_vertices() {
    let ring = [(0.0, 50.0), (120.0, 50.0), (-120.0, 50.0)].map(|(x, y)| LonLat::new(x, y));
    let region = [Region::ring(ring.to_vec(), EdgeKind::Rhumb)];
    for tolerance_m in [0.0, f64::NAN] {
        let limits = Limits {
            mesh_vertices: 20_000,
            ..Limits::default()
        };
        let options = MeshOptions {
            tolerance_m,
            limits,
            ..MeshOptions::default()
        };
        let excess = Excess {
            what: Quantity::MeshVertices,
            most: 20_000,
        };
        assert_eq!(
            FillMesh::build(&region, &options).unwrap_err(),
            RegionError::Limit(excess)
        );
    }
}

#[test]
fn edges_micrometres_beside_each_other_for_thousands_of_kilometres_count_as_crossings() {
    // Each pair crosses, at angles below 10⁻⁹.
    let lines = (0..30).map(|k| {
        let aside_deg = f64::from(k) * 3e-11;
        let ring = [
            (0.0, 10.0 + aside_deg),
            (70.0, 30.0 - aside_deg),
            (35.0, -60.0),
        ];
        let ring = ring.map(|(x, y)| LonLat::new(x, y));
        Region::ring(ring.to_vec(), EdgeKind::Geodesic)
    });
    let limits = Limits {
        crossings: 20,
        ..Limits::default()
    };
    let excess = Excess {
        what: Quantity::Crossings,
        most: 20,
    };
    assert_eq!(refused(&lines.collect::<Vec<_>>(), limits), excess);
}

#[test]
fn long_edges_that_cross_count_once_however_many_cells_they_lie_in() {
    // Every edge of a star {41/20} crosses all but those at its own ends once: 41 · 38 / 2.
    let star = (0..41).map(|k| {
        let (sin, cos) = (f64::from(k * 20) / 41.0 * std::f64::consts::TAU).sin_cos();
        LonLat::new(10.0 + 40.0 * cos, 3.0 + 40.0 * sin)
    });
    let region = [Region::ring(star.collect(), EdgeKind::Geodesic)];
    let limits = |crossings| Limits {
        crossings,
        ..Limits::default()
    };
    assert_eq!(refused(&region, limits(700)).what, Quantity::Crossings);
    // Parts end a lattice step off the line, and some cross once more there.
    assert!(build(&region, limits(1_000)).is_ok());
}

#[test]
fn edges_a_millimetre_apart_for_thousands_of_kilometres_are_no_overlap() {
    for kind in [EdgeKind::Geodesic, EdgeKind::Rhumb] {
        let triangle = |aside_deg: f64, third: f64| {
            let ring = [
                (0.0, 10.0 + aside_deg),
                (60.0, 30.0 + aside_deg),
                (30.0, third),
            ];
            Region::ring(ring.map(|(x, y)| LonLat::new(x, y)).to_vec(), kind)
        };
        let regions = [triangle(1e-8, 80.0), triangle(0.0, -60.0)];
        let mesh = FillMesh::build(&regions, &MeshOptions::default()).unwrap();
        assert_eq!(mesh.overlaps, [], "{kind:?}");
        let regions = [triangle(-1e-8, 80.0), triangle(0.0, -60.0)];
        let mesh = FillMesh::build(&regions, &MeshOptions::default()).unwrap();
        assert_eq!(mesh.overlaps, [(0, 1)], "{kind:?}");
    }
}

#[test]
fn rings_within_rings_by_the_ten_thousand_are_refused() {
    // Each has all that hold it between itself and the pole.
    let nested = |count: u32| {
        let hole = |k: u32| {
            let inset_deg = f64::from(k + 1) * 0.4 / f64::from(count);
            square(inset_deg, inset_deg, 1.0 - 2.0 * inset_deg)
        };
        straight(vec![Polygon {
            shell: square(0.0, 0.0, 1.0),
            holes: (0..count).map(hole).collect(),
        }])
    };
    let refused = FillMesh::build(&[nested(100_000)], &MeshOptions::default());
    assert!(matches!(refused, Err(RegionError::Tangled { .. })));
    let mesh = FillMesh::build(&[nested(1_000)], &MeshOptions::default()).unwrap();
    let idle = |repair: &&Repair| repair.kind == RepairKind::IdleHole;
    assert_eq!(mesh.repairs.iter().filter(idle).count(), 999);
}
