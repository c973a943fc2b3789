//! Zones keep the laws of every mesh, alone and beside others.

use globefill::{Ellipsoid, FillMesh, LonLat, MeshOptions, Region, Zone, glam::DVec3};

use crate::law::{build, check_laws, fill_area_m2};

fn at(lon_deg: f64, lat_deg: f64) -> LonLat {
    LonLat::new(lon_deg, lat_deg)
}

const GLOBE_M2: f64 = 510_065_621_724_088.44;

/// The closed formula on a sphere: 2πR²·(1 − cos(r/R)).
#[test]
fn circles_have_their_areas() {
    let sphere = Ellipsoid::sphere(6.4e6);
    let options = MeshOptions {
        ellipsoid: sphere,
        tolerance_m: 0.01,
        ..MeshOptions::default()
    };
    for centre in [
        at(0.0, 0.0),
        at(180.0, 60.0),
        at(33.0, 90.0),
        at(-70.0, -89.99),
    ] {
        for radius_m in [0.1, 1e3, 1e5, 3e6, 1.2e7, 1.95e7] {
            let mesh = FillMesh::build(&[Zone::circle(centre, radius_m).into()], &options).unwrap();
            check_laws(&mesh);
            let half = 0.5 * radius_m / 6.4e6;
            let expected_m2 = 4.0 * std::f64::consts::PI * (6.4e6 * half.sin()).powi(2);
            let globe_m2 = 4.0 * std::f64::consts::PI * 6.4e6_f64.powi(2);
            let error_m2 = fill_area_m2(&mesh, 0) - expected_m2;
            let error_m2 = (error_m2 + 0.5 * globe_m2).rem_euclid(globe_m2) - 0.5 * globe_m2;
            // Chords lie up to the tolerance beside the circle; Karney's areas are known to 0.1 m².
            let band_m2 = 2.0 * std::f64::consts::PI * 6.4e6 * (2.0 * half).sin() * 0.01 + 0.2;
            assert!(
                error_m2.abs() <= band_m2,
                "{centre:?} {radius_m}: {error_m2} of {expected_m2}"
            );
        }
    }
}

#[test]
fn zones_share_borders_and_overlap_like_countries() {
    let centre = at(179.0, 70.0);
    let alone = |zone: Zone| Region::from(zone);
    // Pieces of one pie: all borders are shared, nothing overlaps.
    let parts = [
        alone(Zone::circle(centre, 2e5)),
        alone(Zone::annulus(centre, 2e5, 5e5)),
        alone(Zone::sector(centre, 5e5, 9e5, 90.0, 270.0)),
        alone(Zone::sector(centre, 5e5, 9e5, 270.0, 90.0)),
    ];
    let mesh = build(&parts);
    assert_eq!(mesh.overlaps, []);
    assert!(mesh.arcs.iter().filter(|arc| arc.right.is_some()).count() >= 4);
    let whole = build(&[alone(Zone::circle(centre, 9e5))]);
    let sum_m2: f64 = (0..4).map(|fill| fill_area_m2(&mesh, fill)).sum();
    let error = sum_m2 / fill_area_m2(&whole, 0) - 1.0;
    assert!(error.abs() < 1e-5, "{error}");
    // Two circles that cross, one inside, one beside.
    let others = [
        alone(Zone::circle(at(0.0, 0.0), 3e5)),
        alone(Zone::circle(at(4.0, 0.0), 3e5)),
        alone(Zone::circle(at(0.1, 0.2), 1e5)),
        alone(Zone::circle(at(30.0, 0.0), 3e5)),
        alone(Zone::corridor(vec![at(25.0, -5.0), at(33.0, 4.0)], 1e4)),
    ];
    assert_eq!(build(&others).overlaps, [(0, 1), (0, 2), (3, 4)]);
    // Equal zones are one boundary twice.
    let twice = [
        alone(Zone::circle(centre, 2e5)),
        alone(Zone::circle(centre, 2e5)),
    ];
    assert_eq!(build(&twice).overlaps, [(0, 1)]);
}

#[test]
fn a_zone_is_what_its_definition_says_wherever_it_lies() {
    let parts = |centre: LonLat| {
        [
            Zone::annulus(centre, 3e6, 1.6e7),
            Zone::sector(centre, 1e6, 1.8e7, 350.0, 180.0),
            Zone::sector(centre, 0.0, 5e5, 0.0, 359.9),
            Zone::corridor(
                vec![centre, at(centre.lon_deg + 50.0, 0.0), at(0.0, 70.0)],
                1e6,
            ),
            Zone::corridor(
                vec![centre, at(centre.lon_deg + 170.0, centre.lat_deg * 0.9)],
                100.0,
            ),
        ]
    };
    for lon_deg in [-180.0, -77.0, 0.0, 179.999_999] {
        for lat_deg in [-90.0, -66.0, 0.0, 1e-9, 45.0, 89.999_999_99, 90.0] {
            for zone in parts(at(lon_deg, lat_deg)) {
                let options = MeshOptions::default();
                let mesh = FillMesh::build(&[zone.clone().into()], &options);
                let mesh = mesh.unwrap_or_else(|error| panic!("{zone:?}: {error}"));
                check_laws(&mesh);
                assert_eq!((mesh.pieces.len(), mesh.repairs.len()), (1, 0), "{zone:?}");
            }
        }
    }
}

#[test]
fn annuli_have_their_areas_on_the_ellipsoid() {
    // Azimuthal slices of Karney's m₁₂, integrated: ∫∫ m₁₂ dr dα.
    let geodesic = geographiclib_rs::Geodesic::wgs84();
    let centre = at(10.0, 40.0);
    let (min_m, max_m) = (1e6, 1.2e7);
    let mut expected_m2 = 0.0;
    let (azimuths, ranges) = (64, 400);
    for a in 0..azimuths {
        for r in 0..ranges {
            let distance_m = min_m + (max_m - min_m) * (f64::from(r) + 0.5) / f64::from(ranges);
            let azimuth_deg = 360.0 * f64::from(a) / f64::from(azimuths);
            let reduced_m = geodesic
                ._gen_direct(
                    centre.lat_deg,
                    centre.lon_deg,
                    azimuth_deg,
                    false,
                    distance_m,
                    geographiclib_rs::geodesic_capability::REDUCEDLENGTH,
                )
                .5;
            expected_m2 += reduced_m * (max_m - min_m) / f64::from(ranges) * std::f64::consts::TAU
                / f64::from(azimuths);
        }
    }
    let mesh = build(&[Zone::annulus(centre, min_m, max_m).into()]);
    let error = fill_area_m2(&mesh, 0) / expected_m2 - 1.0;
    assert!(error.abs() < 2e-6, "{error}");
    assert!(expected_m2 < GLOBE_M2 && mesh.vertices.iter().all(|v: &DVec3| v.is_finite()));
}
