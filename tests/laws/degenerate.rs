//! Degeneracies that fuzzing found, one test each.

use globefill::{
    EdgeKind, Ellipsoid, FillMesh, Inside, Locator, LonLat, MeshOptions, Region, RegionError,
};

use crate::law::{KINDS, build, region, smaller};

#[test]
fn ellipsoids_whose_products_of_lengths_vanish_are_refused() {
    let ring = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)];
    let region = [smaller(EdgeKind::Straight, &[&ring])];
    let on = |radius_m: f64| {
        let ellipsoid = Ellipsoid::sphere(radius_m);
        FillMesh::build(
            &region,
            &MeshOptions {
                ellipsoid,
                ..Default::default()
            },
        )
    };
    for radius_m in [f64::MIN_POSITIVE, 1e-200, 1e-3, 0.999] {
        let error = on(radius_m).unwrap_err();
        assert_eq!(
            error,
            RegionError::InvalidEllipsoid {
                a_m: radius_m,
                b_m: radius_m
            }
        );
    }
    assert!(on(1.0).is_ok());
}

/// A triangle whose third vertex lies off the middle of the long side by a share of that side.
fn sliver(start: LonLat, side_deg: f64, share: f64) -> [LonLat; 3] {
    let at = |along: f64, aside: f64| {
        let (x, y) = (side_deg * (along - aside), side_deg * (along + aside));
        LonLat::new(start.lon_deg + x, start.lat_deg + y)
    };
    [at(0.0, 0.0), at(1.0, 0.0), at(0.5, share)]
}

#[test]
fn slivers_below_a_square_millimetre_are_not_turned_inside_out() {
    for kind in KINDS {
        for (index, side_deg) in [2e-9, 1e-8, 1e-7, 1e-6, 1e-5].into_iter().enumerate() {
            for share in [0.3, 0.1, 0.03, -0.03, -0.1, -0.3] {
                let start = LonLat::new(179.999_999_995, [-30.0, 61.0, 5.0][index % 3]);
                let ring = sliver(start, side_deg, share);
                // Narrower than the lattice is not a triangle.
                if side_deg * share.abs() < 5e-10 {
                    continue;
                }
                let mesh = build(&[Region::ring(ring.to_vec(), kind)]);
                let locator = Locator::new(&mesh);
                let at = |weights: [f64; 3]| {
                    let sum = |of: fn(&LonLat) -> f64| -> f64 {
                        ring.iter()
                            .map(of)
                            .zip(weights)
                            .map(|(x, weight)| x * weight)
                            .sum()
                    };
                    LonLat::new(sum(|v| v.lon_deg), sum(|v| v.lat_deg))
                };
                let third = 1.0 / 3.0;
                assert!(
                    locator.contains(0, at([third; 3])),
                    "{kind:?} {side_deg} {share}"
                );
                assert!(
                    !locator.contains(0, at([-1.0, 1.0, 1.0])),
                    "{kind:?} {side_deg} {share}"
                );
                assert!(!locator.contains(0, LonLat::new(20.0, 10.0)));
                assert!(!locator.contains(0, LonLat::new(0.0, 90.0)));
                assert!(mesh.area_m2(0) < 1e3);
            }
        }
    }
}

#[test]
fn straight_triangles_of_half_a_square_step_of_the_lattice_do_not_fill_the_globe() {
    // Neighbours in Fibonacci's sequence: thousands of kilometres long, and no wider than an atom.
    let mut numbers = (1_u64, 1_u64);
    while numbers.1 < 1 << 40 {
        numbers = (numbers.1, numbers.0 + numbers.1);
    }
    let (small, middle, large) = (numbers.1 - numbers.0, numbers.0, numbers.1);
    let deg = |steps: u64| steps as f64 / (1_u64 << 36) as f64;
    for k in 0..40 {
        let (west_deg, south_deg) = (f64::from(k) * 7.0 - 170.0, f64::from(k % 20) * 3.0 - 40.0);
        let at = |x, y| LonLat::new(west_deg + deg(x), south_deg + deg(y));
        let [a, b, c] = [at(0, 0), at(middle, small), at(large, middle)];
        for ring in [[a, b, c], [c, b, a]] {
            let mesh = build(&[Region::ring(ring.to_vec(), EdgeKind::Straight)]);
            let locator = Locator::new(&mesh);
            for elsewhere in [(0.0, 90.0), (0.0, -90.0), (175.0, 1.0)] {
                let elsewhere = LonLat::new(elsewhere.0, elsewhere.1);
                assert!(!locator.contains(0, elsewhere), "{k} {elsewhere:?}");
            }
        }
    }
}

/// How often triangles cover a surface point, seen from the centre, signed.
fn covering(mesh: &FillMesh, position: LonLat) -> i32 {
    let point = mesh.ellipsoid.ecef(position, 0.0);
    let covers = |corners: &[u32; 3]| {
        let corners = corners.map(|corner| mesh.vertices[corner as usize]);
        if corners.iter().any(|corner| corner.dot(point) <= 0.0) {
            return 0;
        }
        let [a, b, c] = corners.map(|corner| corner - point);
        match [(a, b), (b, c), (c, a)].map(|(p, q)| p.cross(q).dot(point) > 0.0) {
            [true, true, true] => 1,
            [false, false, false] => -1,
            _ => 0,
        }
    };
    mesh.cap_triangles.iter().map(covers).sum()
}

/// The region to the left of a ring, which holds all but a sliver.
fn check_all_but(ring: &[(f64, f64)], kind: EdgeKind) {
    let region = region(kind, Inside::LeftOfRing, &[ring]);
    let mesh = build(&[region]);
    let locator = Locator::new(&mesh);
    for elsewhere in [(20.3, 10.1), (-100.7, 80.2), (3.1, -70.3), (179.1, 0.7)] {
        let elsewhere = LonLat::new(elsewhere.0, elsewhere.1);
        assert!(locator.contains(0, elsewhere));
        assert_eq!(covering(&mesh, elsewhere), 1, "{elsewhere:?}");
    }
    assert!(mesh.area_m2(0) > 5.1e14);
}

#[test]
fn everything_but_a_sliver_is_drawn() {
    for kind in KINDS {
        // 1.4 mm long and a hundredth of that wide; then 3 km and 8 m.
        check_all_but(&[(-8e-9, -8e-9), (5e-9, -8e-9), (4.9e-9, -8.11e-9)], kind);
        check_all_but(&[(8.0, 50.0), (8.02, 50.02), (8.0201, 50.02)], kind);
    }
}

#[test]
fn everything_but_a_sliver_whose_sides_are_one_chord_is_drawn() {
    let sliver = [(-8e-5, -90.0), (-8e-5, -89.999_96), (3e-5, -90.0)];
    check_all_but(&sliver, EdgeKind::Straight);
}

#[test]
fn slivers_at_a_pole_are_not_turned_inside_out() {
    for pole_deg in [-90.0, 90.0] {
        for west_deg in [-0.4, 90.3, 179.6] {
            let beside = pole_deg - 1e-9_f64.copysign(pole_deg);
            let ring = [
                (west_deg, beside),
                (west_deg + 0.8, beside),
                (0.0, pole_deg),
            ];
            for kind in [EdgeKind::Geodesic, EdgeKind::Rhumb] {
                let mesh = FillMesh::build(&[smaller(kind, &[&ring])], &MeshOptions::default());
                let locator = Locator::new(&mesh.unwrap());
                for elsewhere in [
                    (west_deg + 0.3, 0.99 * pole_deg),
                    (20.0, 0.0),
                    (-20.0, -pole_deg),
                ] {
                    let elsewhere = LonLat::new(elsewhere.0, elsewhere.1);
                    assert!(!locator.contains(0, elsewhere), "{kind:?} {elsewhere:?}");
                }
            }
        }
    }
}

#[test]
fn a_lune_from_pole_to_pole_is_filled_however_far_chords_may_stray() {
    let ring = [(20.0, 90.0), (20.0, -90.0), (120.0, 90.0)];
    for kind in [EdgeKind::Rhumb, EdgeKind::Straight] {
        for tolerance_m in [1e7, f64::INFINITY] {
            let options = MeshOptions {
                tolerance_m,
                ..MeshOptions::default()
            };
            let mesh = FillMesh::build(&[smaller(kind, &[&ring])], &options).unwrap();
            for (lon_deg, expected) in [(15.0, 0), (25.0, 1), (56.7, 1), (115.0, 1), (125.0, 0)] {
                // Straight edges go over from one meridian to the other.
                let at = match kind {
                    EdgeKind::Rhumb => LonLat::new(lon_deg, 40.7),
                    _ => LonLat::new(lon_deg, 89.0),
                };
                assert_eq!(
                    covering(&mesh, at),
                    expected,
                    "{kind:?} {tolerance_m} {at:?}"
                );
            }
        }
    }
}

#[test]
fn slivers_of_rhumbs_a_few_micrometres_wide_are_beside_others_what_they_are_alone() {
    // Where two of its sides cross, a third passes within rounding.
    let sliver = [
        (-90.000_099_999_912_69, 30.000_499_999_985_447),
        (-90.000_100_000_014_56, 30.000_500_000_072_76),
        (-89.999_300_000_014_56, 30.000_700_000_072_758),
        (-90.000_100_000_014_56, 30.000_499_999_956_343),
        (-89.999_3, 30.000_7),
    ];
    let beside = [
        (-90.000_099_999_912_69, 30.000_499_999_985_447),
        (-89.999_3, 30.000_7),
        (-89.999_300_000_014_56, 30.000_700_000_072_758),
        (-90.000_1, 30.000_5),
        (-90.000_8, 29.999_2),
        (-89.999_300_000_014_56, 30.000_700_000_072_758),
    ];
    let [beside, sliver] = [&beside[..], &sliver[..]].map(|ring| smaller(EdgeKind::Rhumb, &[ring]));
    let options = MeshOptions {
        ellipsoid: Ellipsoid::MARS,
        ..MeshOptions::default()
    };
    for regions in [vec![sliver.clone()], vec![beside, sliver]] {
        let mesh = FillMesh::build(&regions, &options).unwrap();
        let fill = regions.len() as u32 - 1;
        assert!(mesh.area_m2(fill) < 1e-3);
        let locator = Locator::new(&mesh);
        for elsewhere in [(-89.999_96, 30.000_06), (10.0, 20.0), (0.0, 90.0)] {
            assert!(!locator.contains(fill, LonLat::new(elsewhere.0, elsewhere.1)));
        }
    }
}
