//! Shapes everywhere on the globe, and rings made by chance.

use proptest::{prelude::*, test_runner::RngSeed};

use globefill::{
    EdgeKind, Ellipsoid, FillMesh, Inside, LonLat, MeshOptions, Polygon, Region, glam::DVec3,
};

use crate::law::{
    KINDS, check_arcs, check_bounds, check_laws, check_pieces_are_closed, fill_area_m2,
};

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
                zones: Vec::new(),
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
        let region = Region { polygons: vec![polygon], edges: KINDS[kind], inside, zones: Vec::new() };
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
            zones: Vec::new(),
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
