//! Footprints: measured against closed formulas on a sphere and against counting points.

use std::f64::consts::{PI, TAU};

use globefill::{Ellipsoid, FieldOfView, LonLat, Pose, Sensor};

fn nadir(ellipsoid: &Ellipsoid, at: LonLat, height_m: f64, field_of_view: FieldOfView) -> Sensor {
    Sensor::new(
        Pose::nadir(ellipsoid, ellipsoid.ecef(at, height_m)),
        field_of_view,
    )
}

/// Angle about the centre of a sphere at which a line of sight meets it.
fn reach_rad(radius_m: f64, height_m: f64, off_rad: f64) -> f64 {
    let sine = (radius_m + height_m) / radius_m * off_rad.sin();
    if sine >= 1.0 {
        (radius_m / (radius_m + height_m)).acos()
    } else {
        sine.asin() - off_rad
    }
}

#[test]
fn cones_over_a_sphere_see_caps_and_belts() {
    let sphere = Ellipsoid::sphere(6_371_000.0);
    let cap_m2 = |reach_rad: f64| 4.0 * PI * (6_371_000.0 * (0.5 * reach_rad).sin()).powi(2);
    for height_m in [1e4, 5.5e5, 3.6e7, 4e8] {
        for (inner, outer) in [(0.0, 0.05), (0.0, 1.5), (0.02, 0.1), (0.1, 1.0), (0.0, 3.0)] {
            let field_of_view = FieldOfView::annular(inner, outer).expect("sound angles");
            let at = LonLat::new(-77.0, 83.0);
            let sensor = nadir(&sphere, at, height_m, field_of_view);
            let footprint = sensor.footprint(&sphere).expect("a sound sensor");
            let limb_rad = (6_371_000.0 / (6_371_000.0 + height_m)).asin();
            let reach = |off_rad: f64| reach_rad(6_371_000.0, height_m, off_rad.min(0.5 * PI));
            let expected_m2 = if inner >= limb_rad {
                0.0
            } else {
                cap_m2(reach(outer)) - cap_m2(reach(inner))
            };
            let measures = footprint.measures();
            let off = (measures.area_m2 - expected_m2).abs();
            let known_m2 = 1e-8 * expected_m2 + 2.0 * measures.error_m2 + 1e-3;
            assert!(
                off <= known_m2,
                "{height_m} {inner} {outer}: off by {off} of {expected_m2}"
            );
            let Some(cap) = footprint.bounding_cap() else {
                assert_eq!(expected_m2, 0.0);
                continue;
            };
            let centroid = footprint.centroid().expect("it is not empty");
            let apart = sphere.normal(centroid).angle_between(sphere.normal(at));
            assert!(apart < 1e-7, "{apart}");
            assert!((cap.radius_rad / reach(outer) - 1.0).abs() < 1e-4);
        }
    }
}

#[test]
fn area_and_extent_agree_with_points_that_are_covered() {
    let ellipsoid = Ellipsoid::WGS84;
    let square = FieldOfView::rectangular(0.9, 0.5).expect("sound angles");
    let at = LonLat::new(170.0, -78.0);
    let mut sensor = nadir(&ellipsoid, at, 1.5e6, square);
    sensor.pose.boresight += 0.6 * sensor.pose.up;
    sensor.min_elevation_rad = Some(0.1);
    let footprint = sensor.footprint(&ellipsoid).expect("a sound sensor");
    let cap = footprint.bounding_cap().expect("it sees something");
    let axis = ellipsoid.normal(cap.centre);
    let (right, ahead) = axis.any_orthonormal_pair();
    // A spiral of normals evenly spread over the cap; each stands for area by the curvature there.
    let count = 400_000;
    let cap_area = TAU * (1.0 - cap.radius_rad.cos());
    let mut covered_m2 = 0.0;
    for k in 0..count {
        let z = 1.0 - (1.0 - cap.radius_rad.cos()) * (k as f64 + 0.5) / count as f64;
        let (sin, cos) = (2.399_963_229_728_653 * k as f64).sin_cos();
        let normal = axis * z + (right * cos + ahead * sin) * (1.0 - z * z).sqrt();
        let position = LonLat::new(
            normal.y.atan2(normal.x).to_degrees(),
            normal.z.asin().to_degrees(),
        );
        if footprint.contains(position) {
            let (a, b) = (ellipsoid.a_m, ellipsoid.b_m);
            let support = (a * normal.x).hypot(a * normal.y).hypot(b * normal.z);
            // 1 / Gaussian curvature at this normal: a⁴b² / support⁴.
            covered_m2 += cap_area / count as f64 * (a * a * b).powi(2) / support.powi(4);
        }
    }
    let measured_m2 = footprint.area_m2();
    let off = (covered_m2 / measured_m2 - 1.0).abs();
    assert!(off < 2e-4, "{covered_m2} {measured_m2}: {off}");
    let along: f64 = footprint
        .loops
        .iter()
        .flat_map(|each| &each.edges)
        .flat_map(|edge| (0..=100).map(|k| edge.lon_lat(f64::from(k) / 100.0)))
        .map(|position| ellipsoid.normal(position).angle_between(axis))
        .fold(0.0, f64::max);
    assert!(along <= cap.radius_rad && along > 0.999 * cap.radius_rad);
}

#[test]
fn nothing_seen_is_nothing_measured() {
    let ellipsoid = Ellipsoid::WGS84;
    let cone = FieldOfView::conic(0.1).expect("a sound angle");
    let mut sensor = nadir(&ellipsoid, LonLat::new(3.0, 4.0), 5e5, cone);
    sensor.pose.boresight = -sensor.pose.boresight;
    let footprint = sensor.footprint(&ellipsoid).expect("a sound sensor");
    assert!(footprint.is_empty());
    assert_eq!(footprint.area_m2(), 0.0);
    assert_eq!(footprint.centroid(), None);
    assert!(footprint.bounding_cap().is_none());
}
