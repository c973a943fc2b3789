//! Degeneracies that fuzzing found, one test each.

use globefill::{EdgeKind, Ellipsoid, FillMesh, Locator, LonLat, MeshOptions, Region, RegionError};

use crate::law::{KINDS, build, smaller};

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
fn a_vertex_within_rounding_of_a_long_straight_edge_does_not_fill_the_globe() {
    for k in 1..40 {
        let (a, b) = (
            LonLat::new(-3.0, 7.0),
            LonLat::new(70.0 + f64::from(k), 33.3),
        );
        let share = f64::from(k) / 41.0;
        let on_edge = LonLat::new(
            a.lon_deg + share * (b.lon_deg - a.lon_deg),
            a.lat_deg + share * (b.lat_deg - a.lat_deg),
        );
        for ring in [vec![a, b, on_edge], vec![on_edge, b, a]] {
            let mesh = build(&[Region::ring(ring, EdgeKind::Straight)]);
            let locator = Locator::new(&mesh);
            for elsewhere in [
                LonLat::new(0.0, 90.0),
                LonLat::new(0.0, -90.0),
                LonLat::new(-100.0, 1.0),
            ] {
                assert!(!locator.contains(0, elsewhere), "{k}");
            }
        }
    }
}
