//! The rectangles that hold fills.

use geographiclib_rs::{DirectGeodesic, Geodesic, GeodesicLine, InverseGeodesic};
use globefill::{
    EdgeKind, Ellipsoid, Extents, FillMesh, Inside, LonLat, MeshOptions, Region, Zone,
    countries::Dataset,
};

use crate::{build, countries_50m, region};

/// Half a lattice step of vertices, and rounding.
const VERTEX_DEG: f64 = 1e-11;
const BULGE_DEG: f64 = 1e-9;

fn extents_of(region: Region) -> Extents {
    build(&[region]).extents(0).unwrap()
}

#[track_caller]
fn assert_near(found: Extents, expected: [f64; 4], error_deg: f64) {
    let Extents {
        west_deg,
        south_deg,
        east_deg,
        north_deg,
    } = found;
    assert!(
        found.is_valid() && (-180.0..180.0).contains(&west_deg),
        "{found:?}"
    );
    assert!(
        east_deg > west_deg && east_deg <= west_deg + 360.0,
        "{found:?}"
    );
    let sides = [west_deg, south_deg, east_deg, north_deg];
    for (side, expected_deg) in sides.iter().zip(expected) {
        assert!(
            (side - expected_deg).abs() <= error_deg,
            "{found:?} is not {expected:?}"
        );
    }
}

/// The least and greatest of numbers.
fn range(numbers: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let wider = |(low, high): (f64, f64), number: f64| (low.min(number), high.max(number));
    numbers.into_iter().fold(none, wider)
}

/// Points of a country's straight edges, as its rings are written.
fn samples(region: &Region) -> impl Iterator<Item = LonLat> {
    let polygons = region.polygons.iter();
    let rings = polygons.flat_map(|polygon| std::iter::once(&polygon.shell).chain(&polygon.holes));
    let edges = rings.flat_map(|ring| ring.windows(2));
    edges.flat_map(|edge| {
        (0..=16).map(|step| {
            let t = f64::from(step) / 16.0;
            let between = |from: f64, to: f64| from + t * (to - from);
            LonLat::new(
                between(edge[0].lon_deg, edge[1].lon_deg),
                between(edge[0].lat_deg, edge[1].lat_deg),
            )
        })
    })
}

/// Checks a country against its samples, whose longitudes are counted from a meridian it is far from.
fn check_country(name: &str, from_lon_deg: f64) -> Extents {
    let index = Dataset::Countries50m.countries();
    let fill = index
        .iter()
        .position(|country| country.is_called(name))
        .unwrap();
    let (regions, mesh) = countries_50m();
    let east_of = |at: LonLat| from_lon_deg + (at.lon_deg - from_lon_deg).rem_euclid(360.0);
    let (west_deg, east_deg) = range(samples(&regions[fill]).map(east_of));
    let (south_deg, north_deg) = range(samples(&regions[fill]).map(|at| at.lat_deg));
    let found = mesh.extents(fill as u32).unwrap();
    let turn_deg = if west_deg >= 180.0 { 360.0 } else { 0.0 };
    let expected = [
        west_deg - turn_deg,
        south_deg,
        east_deg - turn_deg,
        north_deg,
    ];
    assert_near(found, expected, VERTEX_DEG);
    assert!(
        samples(&regions[fill])
            .filter(|at| !holds(found, *at))
            .count()
            == 0
    );
    found
}

/// Whether extents, a lattice step wider, hold a point.
fn holds(extents: Extents, at: LonLat) -> bool {
    let wider = Extents {
        west_deg: extents.west_deg - VERTEX_DEG,
        south_deg: (extents.south_deg - VERTEX_DEG).max(-90.0),
        east_deg: extents.east_deg + VERTEX_DEG,
        north_deg: (extents.north_deg + VERTEX_DEG).min(90.0),
    };
    if extents.width_deg() == 360.0 {
        return (wider.south_deg..=wider.north_deg).contains(&at.lat_deg);
    }
    wider.contains(at)
}

#[test]
fn countries_across_the_antimeridian_are_narrow() {
    let russia = check_country("RUS", 0.0);
    assert!((19.0..28.0).contains(&russia.west_deg) && (190.0..191.0).contains(&russia.east_deg));
    let fiji = check_country("FJI", 0.0);
    assert!(
        fiji.width_deg() < 8.0 && fiji.contains(LonLat::new(180.0, -16.5)),
        "{fiji:?}"
    );
    let usa = check_country("USA", 0.0);
    assert!(
        (172.0..173.0).contains(&usa.west_deg) && usa.east_deg > 290.0,
        "{usa:?}"
    );
    check_country("NZL", 0.0);
    check_country("KIR", 0.0);
    check_country("FRA", 120.0);
    check_country("ZAF", -120.0);
    check_country("CHN", -120.0);
}

#[test]
fn antarctica_has_all_longitudes() {
    for (dataset, has_pole) in [
        (Dataset::Countries110m, true),
        (Dataset::Countries50m, false),
    ] {
        let region = dataset.country("ATA").unwrap().region;
        let (south_deg, north_deg) = range(samples(&region).map(|at| at.lat_deg));
        // At 1:50 million the ring is closed along a parallel 120 m from the pole, and so it is drawn.
        assert_eq!(south_deg == -90.0, has_pole);
        let found = extents_of(region);
        assert_near(found, [-180.0, south_deg, 180.0, north_deg], VERTEX_DEG);
        assert_eq!(found.width_deg(), 360.0);
    }
}

#[test]
fn every_country_holds_its_boundary() {
    let (regions, mesh) = countries_50m();
    for (fill, region) in (0..).zip(regions) {
        let found = mesh.extents(fill).unwrap();
        assert!(found.is_valid());
        for at in samples(region) {
            assert!(holds(found, at), "{fill} {found:?} {at:?}");
        }
    }
}

/// Points of geodesics between the corners, by Karney's series, far denser than 10⁻⁹° of latitude
/// asks for at an extreme.
fn geodesic_samples(ellipsoid: &Ellipsoid, shell: &[(f64, f64)]) -> Vec<(f64, f64)> {
    const STEPS: u32 = 400_000;
    let geodesic = Geodesic::new(ellipsoid.a_m, ellipsoid.flattening());
    let ends = shell.iter().zip(shell.iter().cycle().skip(1));
    ends.flat_map(|(from, to)| {
        let (length_m, azimuth_deg, ..): (f64, f64, f64, f64) =
            geodesic.inverse(from.1, from.0, to.1, to.0);
        let line = GeodesicLine::new(&geodesic, from.1, from.0, azimuth_deg, None, None, None);
        (0..=STEPS).map(move |step| {
            use geographiclib_rs::geodesic_capability as capability;
            let along_m = length_m * f64::from(step) / f64::from(STEPS);
            let mask = capability::LATITUDE | capability::LONGITUDE;
            let (_, lat_deg, lon_deg, ..) = line._gen_position(false, along_m, mask);
            (lon_deg, lat_deg)
        })
    })
    .collect()
}

#[test]
fn geodesics_bulge() {
    let prolate = Ellipsoid {
        a_m: 6.0e6,
        b_m: 6.1e6,
    };
    for ellipsoid in [Ellipsoid::WGS84, Ellipsoid::MOON, prolate] {
        for shell in [
            [(-40.0, 50.0), (0.0, 20.0), (40.0, 50.0)],
            [(-40.0, -50.0), (40.0, -50.0), (0.0, -20.0)],
            [(-3.0, 10.0), (70.0, 12.0), (20.0, 30.0)],
            [(-85.0, 80.0), (0.0, 70.0), (85.0, 80.0)],
            [(-60.0, 0.5), (40.0, 1.5), (100.0, -1.0)],
        ] {
            let options = MeshOptions {
                ellipsoid,
                ..Default::default()
            };
            let region = region(EdgeKind::Geodesic, Inside::Smaller, &shell);
            let found = FillMesh::build(&[region], &options)
                .unwrap()
                .extents(0)
                .unwrap();
            let samples = geodesic_samples(&ellipsoid, &shell);
            let (west_deg, east_deg) = range(samples.iter().map(|at| at.0));
            let (south_deg, north_deg) = range(samples.iter().map(|at| at.1));
            assert_near(found, [west_deg, south_deg, east_deg, north_deg], BULGE_DEG);
        }
    }
    // On a sphere the middle of a symmetric edge has tan φ = tan 50° / cos 40°.
    let options = MeshOptions {
        ellipsoid: Ellipsoid::MOON,
        ..Default::default()
    };
    let shell = [(-40.0, 50.0), (0.0, 20.0), (40.0, 50.0)];
    let triangle = region(EdgeKind::Geodesic, Inside::Smaller, &shell);
    let found = FillMesh::build(&[triangle], &options)
        .unwrap()
        .extents(0)
        .unwrap();
    let (rise, spread) = (50_f64.to_radians().tan(), 40_f64.to_radians().cos());
    let north_deg = (rise / spread).atan().to_degrees();
    assert_near(found, [-40.0, 20.0, 40.0, north_deg], BULGE_DEG);
}

#[test]
fn circles_reach_north_and_south_of_their_centres() {
    let earth = Ellipsoid::WGS84;
    let geodesic = Geodesic::new(earth.a_m, earth.flattening());
    let go = |centre: LonLat, azimuth_deg: f64, radius_m: f64| -> (f64, f64) {
        let (lat_deg, lon_deg): (f64, f64) =
            geodesic.direct(centre.lat_deg, centre.lon_deg, azimuth_deg, radius_m);
        (lon_deg, lat_deg)
    };
    for (lon_deg, lat_deg, radius_m) in [
        (10.0, 45.0, 300e3),
        (179.5, -20.0, 900e3),
        (-120.0, 62.0, 3_000e3),
        (0.0, 0.0, 9_000e3),
        (33.0, -1.0, 20.0),
    ] {
        let centre = LonLat::new(lon_deg, lat_deg);
        let found = extents_of(Zone::circle(centre, radius_m).into());
        // West and east by search among many azimuths.
        let turns = (0..720_000).map(|step| go(centre, f64::from(step) / 2_000.0, radius_m));
        let offsets = turns.map(|at| (at.0 - lon_deg + 180.0).rem_euclid(360.0) - 180.0);
        let (west_deg, east_deg) = range(offsets);
        let turn_deg = if lon_deg + west_deg < -180.0 {
            360.0
        } else {
            0.0
        };
        let (south_deg, north_deg) = (go(centre, 180.0, radius_m).1, go(centre, 0.0, radius_m).1);
        let lon_deg = lon_deg + turn_deg;
        let expected = [lon_deg + west_deg, south_deg, lon_deg + east_deg, north_deg];
        // Corners of zones are rounded to 1.1 µm, on longitudes' extremes too.
        assert_near(found, expected, BULGE_DEG);
    }
}

#[test]
fn corridors_bulge_with_their_lines() {
    let earth = Ellipsoid::WGS84;
    let line = [(-30.0, 40.0), (30.0, 40.0)];
    let points = line.map(|(lon, lat)| LonLat::new(lon, lat)).to_vec();
    let found = extents_of(Zone::corridor(points, 400e3).into());
    let geodesic = Geodesic::new(earth.a_m, earth.flattening());
    let (_, vertex_deg) = range(geodesic_samples(&earth, &line).iter().map(|at| at.1));
    let (north_deg, _): (f64, f64) = geodesic.direct(vertex_deg, 0.0, 0.0, 200e3);
    assert!(
        (found.north_deg - north_deg).abs() < BULGE_DEG,
        "{found:?} {north_deg}"
    );
}

#[test]
fn poles_inside_are_held_with_all_longitudes() {
    let earth = Ellipsoid::WGS84;
    let geodesic = Geodesic::new(earth.a_m, earth.flattening());
    for (pole_deg, azimuth_deg) in [(90.0, 180.0), (-90.0, 0.0)] {
        for offset_deg in [0.0, 2.0] {
            let centre = LonLat::new(70.0, pole_deg * (1.0 - offset_deg / 90.0));
            let found = extents_of(Zone::circle(centre, 1_000e3).into());
            let (far_deg, _): (f64, f64) =
                geodesic.direct(centre.lat_deg, centre.lon_deg, azimuth_deg, 1_000e3);
            let expected = match pole_deg > 0.0 {
                true => [-180.0, far_deg, 180.0, 90.0],
                false => [-180.0, -90.0, 180.0, far_deg],
            };
            assert_near(found, expected, BULGE_DEG);
        }
    }
    // All but a circle.
    let hole = region(
        EdgeKind::Straight,
        Inside::LeftOfRing,
        &[(10.0, 10.0), (10.0, 20.0), (20.0, 20.0), (20.0, 10.0)],
    );
    assert_eq!(extents_of(hole), Extents::GLOBE);
    // A belt round the globe: all longitudes, no pole.
    let centre = LonLat::new(0.0, 90.0);
    let found = extents_of(Zone::annulus(centre, 3_000e3, 9_000e3).into());
    let lat_deg = |radius_m: f64| -> f64 {
        let (lat_deg, _): (f64, f64) = geodesic.direct(90.0, 0.0, 180.0, radius_m);
        lat_deg
    };
    let expected = [-180.0, lat_deg(9_000e3), 180.0, lat_deg(3_000e3)];
    assert_near(found, expected, BULGE_DEG);
}

#[test]
fn poles_on_the_boundary_leave_longitudes_out() {
    // A lune between two meridians, and the rest of the globe.
    let mut lune = [(-90.0, -90.0), (30.0, -90.0), (30.0, 90.0), (-90.0, 90.0)];
    let east = region(EdgeKind::Straight, Inside::Smaller, &lune);
    assert_near(extents_of(east), [-90.0, -90.0, 30.0, 90.0], VERTEX_DEG);
    lune.reverse();
    let west = region(EdgeKind::Straight, Inside::LeftOfRing, &lune);
    assert_near(extents_of(west), [30.0, -90.0, 270.0, 90.0], VERTEX_DEG);
    for kind in [EdgeKind::Geodesic, EdgeKind::Rhumb, EdgeKind::Straight] {
        // A sector from the pole, and one with its corner at the other.
        let sector = [(150.0, 60.0), (200.0, 60.0), (170.0, 90.0)];
        let found = extents_of(region(kind, Inside::Smaller, &sector));
        assert_eq!((found.west_deg, found.east_deg), (150.0, 200.0), "{kind:?}");
        assert_eq!(found.north_deg, 90.0);
        assert!((found.south_deg - 60.0).abs() < VERTEX_DEG);
    }
    // A circle that touches the pole, which it does at right angles to the centre's meridian; one
    // that misses it, and one that goes beyond.
    let earth = Ellipsoid::WGS84;
    let geodesic = Geodesic::new(earth.a_m, earth.flattening());
    let radius_m: f64 = geodesic.inverse(80.0, 20.0, 90.0, 20.0);
    let circle = |radius_m: f64| Zone::circle(LonLat::new(20.0, 80.0), radius_m);
    let (south_deg, _): (f64, f64) = geodesic.direct(80.0, 20.0, 180.0, radius_m);
    let touching = extents_of(circle(radius_m).into());
    assert_near(touching, [-70.0, south_deg, 110.0, 90.0], BULGE_DEG);
    let missing = extents_of(circle(radius_m - 1.0).into());
    assert!(missing.north_deg < 90.0 && (179.0..180.0).contains(&missing.width_deg()));
    let beyond = extents_of(circle(radius_m + 1.0).into());
    assert!(beyond.north_deg == 90.0 && beyond.width_deg() == 360.0);
    // A geodesic over the pole.
    let over = region(
        EdgeKind::Geodesic,
        Inside::Smaller,
        &[(0.0, 50.0), (90.0, 50.0), (180.0, 50.0)],
    );
    assert_near(extents_of(over), [0.0, 50.0, 180.0, 90.0], VERTEX_DEG);
}

#[test]
fn everything_and_nothing() {
    let everything = region(
        EdgeKind::Straight,
        Inside::Smaller,
        &[
            (-180.0, -90.0),
            (180.0, -90.0),
            (180.0, 90.0),
            (-180.0, 90.0),
        ],
    );
    let nothing = Region::default();
    let mesh = build(&[everything, nothing]);
    assert_eq!(mesh.extents(0), Some(Extents::GLOBE));
    assert_eq!(mesh.extents(1), None);
    assert_eq!(mesh.extents(2), None);
    assert_eq!(FillMesh::default().extents(0), None);
}
