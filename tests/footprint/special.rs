//! What footprints look like where that is known.

use std::f64::consts::{FRAC_PI_2, PI};

use globefill::{
    Ellipsoid, FieldOfView, Footprint, FootprintBound,
    FootprintBound::{InnerCone, Limb, MinElevation, OuterCone, Side},
    LonLat, Pose, Sensor, SensorError,
    glam::DVec3,
};

const SPHERE: Ellipsoid = Ellipsoid::sphere(6_371_000.0);

/// At 700 km above the sphere, tilted from nadir towards the north.
fn sensor(tilt_deg: f64, field_of_view: FieldOfView) -> Sensor {
    over(&SPHERE, 700_000.0, tilt_deg, field_of_view)
}

fn over(ellipsoid: &Ellipsoid, height_m: f64, tilt_deg: f64, field_of_view: FieldOfView) -> Sensor {
    let apex_m = ellipsoid.ecef(LonLat::new(12.0, 0.0), height_m);
    let nadir = Pose::nadir(ellipsoid, apex_m);
    let (sin, cos) = tilt_deg.to_radians().sin_cos();
    let pose = Pose {
        boresight: nadir.boresight * cos + nadir.up * sin,
        up: nadir.up * cos - nadir.boresight * sin,
        ..nadir
    };
    Sensor::new(pose, field_of_view)
}

fn conic(half_angle_deg: f64) -> FieldOfView {
    FieldOfView::conic(half_angle_deg.to_radians()).unwrap()
}

fn annular(inner_deg: f64, outer_deg: f64) -> FieldOfView {
    FieldOfView::annular(inner_deg.to_radians(), outer_deg.to_radians()).unwrap()
}

fn rectangular(right_deg: f64, up_deg: f64) -> FieldOfView {
    FieldOfView::rectangular(right_deg.to_radians(), up_deg.to_radians()).unwrap()
}

/// What bounds each edge of each loop, from the least in each loop on.
fn bounds(footprint: &Footprint) -> Vec<Vec<FootprintBound>> {
    let rank = |bound: &FootprintBound| match bound {
        OuterCone => 0,
        InnerCone => 1,
        Side(side) => 2 + side,
        Limb => 100,
        MinElevation => 101,
    };
    let mut loops: Vec<Vec<_>> = footprint
        .loops
        .iter()
        .map(|closed| {
            let mut bounds: Vec<_> = closed.edges.iter().map(|edge| edge.bound()).collect();
            let least = (0..bounds.len()).min_by_key(|&k| rank(&bounds[k]));
            bounds.rotate_left(least.unwrap());
            bounds
        })
        .collect();
    loops.sort_by_key(|bounds| rank(&bounds[0]));
    loops
}

#[track_caller]
fn assert_bounds(sensor: &Sensor, expected: &[&[FootprintBound]]) {
    let footprint = sensor.footprint(&SPHERE).unwrap();
    assert_eq!(bounds(&footprint), expected);
    assert_eq!(footprint.is_empty(), expected.is_empty());
}

/// The limb of the sphere lies 64.3° from nadir.
#[test]
fn footprints_have_the_edges_they_must_have() {
    assert_bounds(&sensor(0.0, conic(30.0)), &[&[OuterCone]]);
    assert_bounds(&sensor(0.0, conic(70.0)), &[&[Limb]]);
    assert_bounds(&sensor(0.0, conic(180.0)), &[&[Limb]]);
    assert_bounds(&sensor(180.0, conic(110.0)), &[]);
    assert_bounds(&sensor(100.0, conic(30.0)), &[]);
    assert_bounds(&sensor(180.0, conic(150.0)), &[&[OuterCone], &[Limb]]);
    assert_bounds(&sensor(60.0, conic(20.0)), &[&[OuterCone, Limb]]);
    assert_bounds(
        &sensor(0.0, annular(20.0, 40.0)),
        &[&[OuterCone], &[InnerCone]],
    );
    assert_bounds(&sensor(0.0, annular(20.0, 80.0)), &[&[InnerCone], &[Limb]]);
    assert_bounds(&sensor(0.0, annular(65.0, 80.0)), &[]);
    assert_bounds(
        &sensor(64.0, annular(5.0, 20.0)),
        &[&[OuterCone, Limb, InnerCone, Limb]],
    );
    assert_bounds(
        &sensor(55.0, annular(5.0, 20.0)),
        &[&[OuterCone, Limb], &[InnerCone]],
    );
    let sides = [Side(0), Side(1), Side(2), Side(3)];
    assert_bounds(&sensor(0.0, rectangular(20.0, 10.0)), &[&sides]);
    // A fan from limb to limb: all corners miss.
    assert_bounds(
        &sensor(0.0, rectangular(80.0, 2.0)),
        &[&[Side(0), Limb, Side(2), Limb]],
    );
    // The lower side alone cuts the disc.
    assert_bounds(&sensor(80.0, rectangular(80.0, 20.0)), &[&[Side(2), Limb]]);
    assert_bounds(&sensor(80.0, rectangular(80.0, 10.0)), &[]);
}

#[test]
fn flattening_makes_a_ring_into_two_moons() {
    let ellipsoid = Ellipsoid {
        a_m: 6.4e6,
        b_m: 6.272e6,
    };
    let limb_deg = |footprint: &Footprint, sensor: &Sensor, t: f64| {
        let line_m = footprint.loops[0].edges[0].ecef_m(t) - sensor.pose.apex_ecef_m;
        line_m.angle_between(sensor.pose.boresight).to_degrees()
    };
    let all = over(&ellipsoid, 2e6, 0.0, conic(180.0));
    let cap = all.footprint(&ellipsoid).unwrap();
    let angles_deg: Vec<_> = (0..64)
        .map(|step| limb_deg(&cap, &all, f64::from(step) / 64.0))
        .collect();
    let [least, most] = [
        angles_deg.iter().copied().fold(f64::INFINITY, f64::min),
        angles_deg.iter().copied().fold(0.0, f64::max),
    ];
    assert!(most - least > 0.3);
    let between = 0.5 * (least + most);
    let moons = over(&ellipsoid, 2e6, 0.0, annular(between, 120.0));
    let moons = bounds(&moons.footprint(&ellipsoid).unwrap());
    assert_eq!(moons, [[InnerCone, Limb], [InnerCone, Limb]]);
    let disc = over(&ellipsoid, 2e6, 0.0, conic(between));
    let disc = bounds(&disc.footprint(&ellipsoid).unwrap());
    assert_eq!(disc, [[OuterCone, Limb, OuterCone, Limb]]);
}

/// Angle at the centre of the sphere between the nadir point and a point of an edge, radians.
fn reach_rad(sensor: &Sensor, t: f64) -> f64 {
    let footprint = sensor.footprint(&SPHERE).unwrap();
    let point_m = footprint.loops[0].edges[0].ecef_m(t);
    let apex_m = sensor.pose.apex_ecef_m;
    apex_m.cross(point_m).length().atan2(apex_m.dot(point_m))
}

#[test]
fn on_a_sphere_reaches_are_known() {
    let distance = 1.0 + 700_000.0 / SPHERE.a_m;
    for t in [0.0, 0.3, 0.9] {
        let off_rad = 40_f64.to_radians();
        let expected = (distance * off_rad.sin()).asin() - off_rad;
        assert!((reach_rad(&sensor(0.0, conic(40.0)), t) - expected).abs() < 1e-14);
        let expected = (1.0 / distance).acos();
        assert!((reach_rad(&sensor(0.0, conic(180.0)), t) - expected).abs() < 1e-14);
        for elevation_deg in [1e-6, 5.0, 60.0, 89.999] {
            let mut sensor = sensor(0.0, conic(180.0));
            let elevation_rad = f64::to_radians(elevation_deg);
            sensor.min_elevation_rad = Some(elevation_rad);
            let expected = (elevation_rad.cos() / distance).acos() - elevation_rad;
            assert!(
                (reach_rad(&sensor, t) - expected).abs() < 1e-14,
                "{elevation_deg}"
            );
        }
    }
}

#[test]
fn least_elevations_from_below_the_limb_to_the_zenith() {
    let with = |elevation_rad| {
        let mut sensor = sensor(0.0, conic(180.0));
        sensor.min_elevation_rad = Some(elevation_rad);
        sensor
    };
    for nothing in [-FRAC_PI_2, -0.3, 0.0] {
        assert_bounds(&with(nothing), &[&[Limb]]);
    }
    assert_bounds(&with(0.1), &[&[MinElevation]]);
    assert_bounds(&with(FRAC_PI_2), &[]);
    let tiny = with(FRAC_PI_2 - 1e-7).footprint(&Ellipsoid::WGS84).unwrap();
    let middle_m = Ellipsoid::WGS84.ecef(LonLat::new(12.0, 0.0), 0.0);
    for t in [0.1, 0.6] {
        let reach_m = (tiny.loops[0].edges[0].ecef_m(t) - middle_m).length();
        assert!((0.05..0.08).contains(&reach_m), "{reach_m}");
    }
}

/// Seen from the apex, right is east: sides are counted from the upper.
#[test]
fn sides_are_where_they_say() {
    let footprint = sensor(0.0, rectangular(10.0, 5.0))
        .footprint(&SPHERE)
        .unwrap();
    for edge in &footprint.loops[0].edges {
        let middle = edge.lon_lat(0.5);
        let (east, north) = (middle.lon_deg - 12.0, middle.lat_deg);
        let expected = match edge.bound() {
            Side(0) => north > 0.5,
            Side(1) => east < -1.0,
            Side(2) => north < -0.5,
            Side(3) => east > 1.0,
            _ => false,
        };
        assert!(expected, "{:?} {middle:?}", edge.bound());
    }
}

#[test]
fn the_loop_round_a_hole_is_clockwise() {
    let footprint = sensor(0.0, annular(20.0, 40.0)).footprint(&SPHERE).unwrap();
    for closed in &footprint.loops {
        let edge = &closed.edges[0];
        let turn = edge.ecef_m(0.0).cross(edge.ecef_m(0.25));
        let up = footprint.sensor().pose.apex_ecef_m;
        assert_eq!(turn.dot(up) > 0.0, edge.bound() == OuterCone);
    }
    assert!(footprint.contains(LonLat::new(12.0, 3.5)));
    assert!(!footprint.contains(LonLat::new(12.0, 0.0)));
    assert!(!footprint.contains(LonLat::new(192.0, 0.0)));
}

#[test]
fn sensors_that_cannot_be_have_no_footprint() {
    let mut buried = sensor(0.0, conic(30.0));
    buried.pose.apex_ecef_m *= 0.9;
    assert_eq!(
        buried.footprint(&SPHERE).err(),
        Some(SensorError::ApexBelowSurface)
    );
    // Whatever comes of numbers that are none, it comes.
    let nowhere = Ellipsoid::sphere(f64::NAN);
    let _ = sensor(0.0, rectangular(10.0, 5.0)).footprint(&nowhere);
}

/// Corners of a square all but on a line, and fields of view of every width down to nothing.
#[test]
fn needles_and_pin_pricks_are_closed() {
    for narrow_rad in [1e-3, 1e-6, 1e-9, 1e-12, 1e-15] {
        let views = [
            FieldOfView::rectangular(1.5, narrow_rad),
            FieldOfView::rectangular(narrow_rad, 1.5),
            FieldOfView::rectangular(narrow_rad, narrow_rad),
            FieldOfView::conic(narrow_rad),
            FieldOfView::conic(PI - narrow_rad),
            FieldOfView::annular(0.5, 0.5 + narrow_rad),
        ];
        for view in views.into_iter().flatten() {
            for tilt_deg in [0.0, 40.0, 64.278, 90.0] {
                let sensor = sensor(tilt_deg, view.clone());
                let footprint = sensor.footprint(&SPHERE).unwrap();
                for closed in &footprint.loops {
                    let end = closed.edges.last().unwrap().ecef_m(1.0);
                    assert_eq!(closed.edges[0].ecef_m(0.0), end);
                    let points = closed.edges.iter().map(|edge| edge.ecef_m(0.5));
                    assert!(points.into_iter().all(DVec3::is_finite));
                }
            }
        }
    }
}
