//! Exact answers about zones: what contains a point, areas and extents.

use std::f64::consts::PI;

use globefill::{Ellipsoid, FillMesh, Locator, LonLat, MeshOptions, Zone};

use crate::{
    common::zone_oracle::ZoneOracle,
    subjects::{at, subjects},
};

#[test]
fn the_locator_knows_the_true_curves() {
    for subject in subjects() {
        let locator = Locator::new(&subject.mesh(5.0));
        let oracle = ZoneOracle::new(&subject.zone, Ellipsoid::WGS84);
        let mut judged = [0, 0];
        let mut ask = |position: LonLat| {
            let outside_m = oracle.outside_m(position);
            if outside_m.abs() > 1e-4 {
                let inside = outside_m < 0.0;
                judged[usize::from(inside)] += 1;
                assert_eq!(
                    locator.contains(0, position),
                    inside,
                    "{}: {position:?}, {outside_m} m",
                    subject.name
                );
            }
        };
        for k in 0..300 {
            let k = f64::from(k);
            // Near the boundary, then anywhere.
            let far_m = 10_f64.powf(k % 8.0 - 3.0);
            ask(oracle.go(subject.on_boundary, 137.5 * k, far_m));
            let lat_deg = ((k + 0.5) / 150.0 - 1.0).asin().to_degrees();
            ask(at((137.5 * k).rem_euclid(360.0) - 180.0, lat_deg));
        }
        assert!(
            judged[0] > 20 && judged[1] > 20,
            "{}: {judged:?}",
            subject.name
        );
    }
}

#[test]
fn circles_measure_what_they_should() {
    let sphere = Ellipsoid::sphere(6_371_000.0);
    let options = MeshOptions {
        ellipsoid: sphere,
        ..MeshOptions::default()
    };
    for (lon_deg, lat_deg) in [(10.0, 50.0), (179.0, -3.0), (-60.0, 89.0), (0.0, -90.0)] {
        for radius_m in [100.0, 1e5, 5e6, 1.5e7] {
            let centre = at(lon_deg, lat_deg);
            let zone = Zone::circle(centre, radius_m);
            let mesh = FillMesh::build(&[zone.into()], &options).expect("a sound circle");
            let angle_rad = radius_m / sphere.a_m;
            let expected_m2 = 4.0 * PI * (sphere.a_m * (0.5 * angle_rad).sin()).powi(2);
            let off = (mesh.area_m2(0) / expected_m2 - 1.0).abs();
            assert!(off < 1e-8, "{centre:?} {radius_m}: {off}");
            let centroid = mesh.centroid(0).expect("it has one");
            let apart_rad = sphere.normal(centroid).angle_between(sphere.normal(centre));
            assert!(
                apart_rad * sphere.a_m < 0.01,
                "{centre:?} {radius_m}: {apart_rad}"
            );
            let cap = mesh.bounding_cap(0).expect("it has one");
            assert!((cap.radius_rad / angle_rad - 1.0).abs() < 1e-4);
        }
    }
}
