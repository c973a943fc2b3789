//! Curves end where they should and keep their promises between.

use proptest::{prelude::*, test_runner::RngSeed};

use super::*;
use crate::region::EdgeKind;

const KINDS: [EdgeKind; 3] = [EdgeKind::Geodesic, EdgeKind::Rhumb, EdgeKind::Straight];

fn straight(from: (f64, f64), to: (f64, f64)) -> Curve {
    let [from, to] = [from, to].map(|(lon, lat)| LonLat::new(lon, lat));
    Curve::between(EdgeKind::Straight, from, to)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn swapping_the_ends_reverses_the_curve(
        kind in 0_usize..3,
        from in (-540.0..540.0_f64, -90.0..90.0_f64),
        to in (-540.0..540.0_f64, -90.0..90.0_f64),
    ) {
        let (from, to) = (LonLat::new(from.0, from.1), LonLat::new(to.0, to.1));
        let curve = Curve::between(KINDS[kind], from, to);
        prop_assert_eq!(curve.reversed(), Curve::between(KINDS[kind], to, from));
        prop_assert_eq!(curve.from, from.canonical());
        prop_assert!(curve.turn_deg.abs() <= 180.0);
    }

    #[test]
    fn rhumbs_keep_their_azimuth(
        from in (-180.0..180.0_f64, -85.0..85.0_f64),
        turn_deg in -170.0..170.0_f64,
        to_lat_deg in -85.0..85.0_f64,
    ) {
        let to = LonLat::new(from.0 + turn_deg, to_lat_deg);
        let curve = Curve::between(EdgeKind::Rhumb, LonLat::new(from.0, from.1), to);
        let on = curve.on(&Ellipsoid::WGS84);
        let tangent_of_azimuth = |t: f64| {
            let step = (on.ecef(t + 1e-5) - on.ecef(t - 1e-5)).normalize();
            let (sin, cos) = on.lon_lat(t).lon_deg.to_radians().sin_cos();
            let east = DVec3::new(-sin, cos, 0.0);
            let north = Ellipsoid::WGS84.normal_at_surface(on.ecef(t)).cross(east);
            step.dot(east).atan2(step.dot(north))
        };
        let azimuth = tangent_of_azimuth(0.1);
        for t in [0.3, 0.5, 0.9] {
            let turn = tangent_of_azimuth(t) - azimuth;
            prop_assert!(turn.sin().abs() < 1e-4 && turn.cos() > 0.0, "{curve:?} {turn}");
        }
    }
}

#[test]
fn ends_are_the_vertices_bit_for_bit() {
    let vertex = LonLat::new(-179.999_999_9, -16.067_132_663_642_447);
    let expected = Ellipsoid::WGS84.ecef(vertex.canonical(), 0.0);
    for kind in KINDS {
        for other in [LonLat::new(179.3, -16.5), LonLat::new(-178.0, 3.0)] {
            let turned = LonLat::new(vertex.lon_deg + 0.0, vertex.lat_deg);
            assert_eq!(
                Curve::between(kind, turned, other)
                    .on(&Ellipsoid::WGS84)
                    .ecef(0.0),
                expected
            );
            assert_eq!(
                Curve::between(kind, other, turned)
                    .on(&Ellipsoid::WGS84)
                    .ecef(1.0),
                expected
            );
        }
    }
    assert_eq!(
        LonLat::new(12.0, 90.0).canonical(),
        straight((12.0, 90.0), (12.0, 80.0)).from.canonical()
    );
}

#[test]
fn straight_edges_take_the_shorter_way_or_the_whole_parallel() {
    assert_eq!(straight((170.0, 1.0), (-170.0, 2.0)).turn_deg, 20.0);
    assert_eq!(straight((170.0, 1.0), (190.0, 2.0)).turn_deg, 20.0);
    assert_eq!(straight((-180.0, 1.0), (180.0, 1.0)).turn_deg, 360.0);
    assert_eq!(straight((180.0, 1.0), (-180.0, 1.0)).turn_deg, -360.0);
    assert_eq!(straight((-180.0, 1.0), (0.0, 1.0)).turn_deg, 180.0);
    assert_eq!(straight((180.0, 1.0), (0.0, 1.0)).turn_deg, -180.0);
    assert_eq!(straight((-90.0, 1.0), (90.0, 1.0)).turn_deg, 180.0);
    let middle = straight((-180.0, 60.0), (180.0, 60.0))
        .on(&Ellipsoid::WGS84)
        .lon_lat(0.25);
    assert_eq!(
        (middle.lon_deg.rem_euclid(360.0), middle.lat_deg),
        (270.0, 60.0)
    );
}

#[test]
fn curves_reach_the_poles() {
    let to_pole = straight((10.0, 80.0), (50.0, 90.0)).on(&Ellipsoid::WGS84);
    assert_eq!(to_pole.lon_lat(0.5), LonLat::new(30.0, 85.0));
    assert_eq!(
        to_pole.ecef(1.0),
        DVec3::new(0.0, 0.0, Ellipsoid::WGS84.b_m)
    );
    let rhumb = Curve::between(
        EdgeKind::Rhumb,
        LonLat::new(10.0, 80.0),
        LonLat::new(50.0, 90.0),
    );
    assert_eq!(
        rhumb.on(&Ellipsoid::WGS84).lon_lat(0.5),
        LonLat::new(10.0, 85.0)
    );
    let over = Curve::between(
        EdgeKind::Geodesic,
        LonLat::new(10.0, 80.0),
        LonLat::new(190.0, 80.0),
    );
    assert!(over.on(&Ellipsoid::WGS84).ecef(0.5).truncate().length() < 1e-6);
}
