//! Areas and centroids of polygons: geographiclib's areas, boxes by formula.

use geographiclib_rs::{DirectGeodesic, Geodesic, PolygonArea, Winding};
use globefill::{EdgeKind, Ellipsoid, FillMesh, Inside, LonLat, MeshOptions, glam::DVec3};

use crate::{build, common::figure::Figure, region, spread};

/// A star of geodesics about a centre, counter-clockwise, on the lattice of the mesh.
fn star(centre: (f64, f64), radius_m: f64, corners: usize) -> Vec<(f64, f64)> {
    let geodesic = Geodesic::wgs84();
    let round = |x: f64| (x * 2f64.powi(36)).round() / 2f64.powi(36);
    let corner = |k: usize| {
        let azimuth_deg = -360.0 * k as f64 / corners as f64;
        let reach_m = radius_m * if k.is_multiple_of(2) { 1.0 } else { 0.6 };
        let (lat, lon): (f64, f64) = geodesic.direct(centre.1, centre.0, azimuth_deg, reach_m);
        (round(lon), round(lat))
    };
    (0..corners).map(corner).collect()
}

fn karney_area_m2(shell: &[(f64, f64)]) -> f64 {
    let geodesic = Geodesic::wgs84();
    let mut area = PolygonArea::new(&geodesic, Winding::CounterClockwise);
    for &(lon, lat) in shell {
        area.add_point(lat, lon);
    }
    area.compute(false).1
}

#[test]
fn geodesic_polygons_have_karneys_area() {
    let globe_m2 = 510_065_621_724_088.44;
    let mut worst = 0.0_f64;
    let centres = spread(6).map(|(x, y)| (360.0 * x - 180.0, 178.0 * y - 89.0));
    let special = [(0.0, 90.0), (10.0, -90.0), (180.0, 0.0), (77.0, 89.999)];
    for (index, centre) in centres.chain(special).enumerate() {
        for radius_m in [1e3, 1e5, 2e6, 8e6] {
            let shell = star(centre, radius_m, 8 + 2 * (index % 5));
            let expected_m2 = karney_area_m2(&shell);
            let backwards: Vec<_> = shell.iter().rev().copied().collect();
            let mesh = build(&[
                region(EdgeKind::Geodesic, Inside::LeftOfRing, &shell),
                region(EdgeKind::Geodesic, Inside::LeftOfRing, &backwards),
            ]);
            let [own, others] = [0, 1].map(|fill| mesh.measures(fill));
            // Karney's own areas are good to 0.1 m² a corner (J. Geod. 87, 2013, section 6).
            let bound_m2 = 1e-11 * expected_m2.min(globe_m2 - expected_m2) + 0.1;
            let error_m2 = (own.area_m2 - expected_m2).abs();
            if radius_m > 1e4 {
                worst = worst.max(error_m2 / expected_m2);
            }
            assert!(error_m2 < bound_m2, "{centre:?} {radius_m}: {error_m2} m²");
            assert!((others.area_m2 + expected_m2 - globe_m2).abs() < bound_m2 + 0.5);
            assert!(own.error_m2 < 1e-10 * expected_m2 + 2e-8 * radius_m);
            // What lies on either side has opposite mean normals.
            let sum_m2 = (own.vector_area_m2 + others.vector_area_m2).length();
            assert!(sum_m2 <= own.error_m2 + others.error_m2);
        }
    }
    println!("geodesic polygons: relative error of areas up to {worst:e}");
}

#[test]
fn small_polygons_have_the_area_of_flat_ones() {
    let centres = spread(12).map(|(x, y)| (360.0 * x - 180.0, 180.0 * y - 90.0));
    for centre in centres.chain([(0.0, 90.0), (10.0, -90.0), (180.0, 0.0)]) {
        for radius_m in [1.0, 10.0] {
            let shell = star(centre, radius_m, 8);
            let figure = Figure::new(Ellipsoid::WGS84);
            let corner = |k: usize| figure.ecef(LonLat::new(shell[k % 8].0, shell[k % 8].1), 0.0);
            let flat_m2: DVec3 = (0..8)
                .map(|k| 0.5 * (corner(k) - corner(0)).cross(corner(k + 1) - corner(0)))
                .sum();
            let mesh = build(&[region(EdgeKind::Geodesic, Inside::Smaller, &shell)]);
            let error_m2 = (mesh.area_m2(0) - flat_m2.length()).abs();
            // Positions are rounded to a nanometre: that times the length of the outline is lost.
            assert!(
                error_m2 < 2e-9 * 8.0 * radius_m,
                "{centre:?} {radius_m} {error_m2:e}"
            );
        }
    }
}

/// Area and ∬ n dA of a box along meridians and parallels, by quadrature over the latitude.
fn box_measures(
    ellipsoid: Ellipsoid,
    west: f64,
    east: f64,
    south: f64,
    north: f64,
) -> (f64, DVec3) {
    let figure = Figure::new(ellipsoid);
    let (a2, b2) = (figure.a_m.powi(2), figure.b_m.powi(2));
    let [west, east, low, high] = [west, east, south, north].map(f64::to_radians);
    // ∬ over a strip one radian wide of 1, cos φ and sin φ.
    let steps = 4000;
    let mut sums = DVec3::ZERO;
    for k in 0..=steps {
        let weight = match k {
            0 => 1.0,
            k if k == steps => 1.0,
            k => 2.0 + 2.0 * f64::from(k % 2),
        };
        let (sin, cos) = (low + (high - low) * f64::from(k) / f64::from(steps)).sin_cos();
        let strip = a2 * a2 * b2 * cos / (a2 * cos * cos + b2 * sin * sin).powi(2);
        sums += DVec3::new(1.0, cos, sin) * (weight * strip);
    }
    sums *= (high - low) / f64::from(3 * steps);
    let normals = DVec3::new(
        sums.y * (east.sin() - west.sin()),
        sums.y * (west.cos() - east.cos()),
        sums.z * (east - west),
    );
    (sums.x * (east - west), normals)
}

#[test]
fn boxes_have_the_area_and_centroid_of_the_formula() {
    let mut worst = (0.0_f64, 0.0_f64);
    for ellipsoid in [Ellipsoid::WGS84, Ellipsoid::MARS, Ellipsoid::MOON] {
        for [west, east, south, north] in [
            [10.0, 20.0, 40.0, 50.0],
            [170.0, 230.0, -20.0, 70.0],
            [-30.0, 0.0, 60.0, 90.0],
            [5.0, 5.000_976_562_5, -89.0, -88.875],
            [-180.0, 180.0, 60.0, 90.0],
            [-180.0, 180.0, -90.0, -89.984_375],
            [0.0, 150.0, -90.0, 90.0],
        ] {
            let corners = [(west, south), (east, south), (east, north), (west, north)];
            let options = MeshOptions {
                ellipsoid,
                ..MeshOptions::default()
            };
            let shell = region(EdgeKind::Straight, Inside::Smaller, &corners);
            let mesh = FillMesh::build(&[shell], &options).unwrap();
            let (area_m2, normals_m2) = box_measures(ellipsoid, west, east, south, north);
            let found = mesh.measures(0);
            let error = (found.area_m2 / area_m2 - 1.0).abs();
            let turn = (found.vector_area_m2 / area_m2 - normals_m2 / area_m2).length();
            worst = (worst.0.max(error), worst.1.max(turn));
            assert!(error < 2e-11, "{corners:?} {error:e}");
            assert!(turn < 2e-11, "{corners:?} {turn:e}");
            let centroid = ellipsoid.normal(mesh.centroid(0).unwrap());
            assert!(centroid.distance(normals_m2.normalize()) < 1e-9);
        }
    }
    println!(
        "boxes: relative error of areas {:e}, of mean normals {:e}",
        worst.0, worst.1
    );
}

#[test]
fn everything_and_nothing_are_told_apart() {
    let all = [
        (-180.0, -90.0),
        (180.0, -90.0),
        (180.0, 90.0),
        (-180.0, 90.0),
    ];
    let spike = [(0.0, 0.0), (10.0, 0.0), (10.0, 5.0), (10.0, 0.0)];
    let belt = [
        (-180.0, -10.0),
        (180.0, -10.0),
        (180.0, 10.0),
        (-180.0, 10.0),
    ];
    let mesh = build(&[
        region(EdgeKind::Straight, Inside::Smaller, &all),
        region(EdgeKind::Straight, Inside::Smaller, &spike),
        region(EdgeKind::Straight, Inside::LeftOfRing, &belt),
    ]);
    let globe = mesh.measures(0);
    assert!((globe.area_m2 - 510_065_621_724_088.44).abs() < 1.0);
    assert_eq!(mesh.centroid(0), None);
    let cap = mesh.bounding_cap(0).unwrap();
    assert_eq!(cap.radius_rad, std::f64::consts::PI);
    for nothing in [1, 3, u32::MAX] {
        assert_eq!(mesh.measures(nothing), Default::default());
        assert_eq!(mesh.centroid(nothing), None);
        assert_eq!(mesh.bounding_cap(nothing), None);
    }
    // A belt has no centroid; its cap is about the pole.
    assert_eq!(mesh.centroid(2), None);
    let cap = mesh.bounding_cap(2).unwrap();
    assert_eq!(cap.centre, LonLat::new(0.0, 90.0));
    assert!(
        (cap.radius_rad.to_degrees() - 100.0).abs() < 2e-3,
        "{cap:?}"
    );
}

#[test]
fn caps_hold_their_fill_and_little_more() {
    for (index, (x, y)) in spread(16).enumerate() {
        let centre = (360.0 * x - 180.0, 180.0 * y - 90.0);
        let shell = star(centre, [100.0, 1e5, 3e6, 9e6][index % 4], 10);
        let kind = [EdgeKind::Geodesic, EdgeKind::Rhumb, EdgeKind::Straight][index % 3];
        let inside = [Inside::Smaller, Inside::LeftOfRing][index / 8];
        // Over the poles stars of straight edges cross themselves, which is as good.
        let mesh = build(&[region(kind, inside, &shell)]);
        let Some(cap) = mesh.bounding_cap(0) else {
            panic!("{shell:?}");
        };
        let axis = mesh.ellipsoid.normal(cap.centre);
        let mut least_rad = 0.0_f64;
        for curve in &mesh.curves {
            let curve = curve.on(&mesh.ellipsoid);
            for k in 0..=500 {
                let normal = mesh
                    .ellipsoid
                    .normal_at_surface(curve.ecef(f64::from(k) / 500.0));
                let angle_rad = 2.0 * (0.5 * axis.distance(normal)).asin();
                least_rad = least_rad.max(angle_rad);
                assert!(angle_rad <= cap.radius_rad + 1e-15);
            }
        }
        // 500 samples of an arc miss its farthest point by 10⁻⁶ of it.
        let is_tight = cap.radius_rad <= least_rad * (1.0 + 2e-5) + 1e-12;
        assert!(
            is_tight || cap.radius_rad == std::f64::consts::PI,
            "{least_rad} {cap:?}"
        );
        for corner in shell {
            assert!(cap.contains(LonLat::new(corner.0, corner.1)));
        }
    }
}
