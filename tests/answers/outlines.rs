//! Outlines given by closures: circles of every size, in awkward parametrisations.

use std::{
    cell::Cell,
    f64::consts::{PI, TAU},
};

use globefill::{Ellipsoid, Outline, glam::DVec3};
use proptest::{prelude::*, test_runner::RngSeed};

use crate::spread_positions;

type Stretches = Vec<Box<dyn Fn(f64) -> DVec3>>;

/// Points of `ellipsoid` whose normal is `radius_rad` from `axis`, counter-clockwise, in three
/// stretches. `twist` changes how the parameter runs.
fn circle(ellipsoid: Ellipsoid, axis: DVec3, radius_rad: f64, twist: fn(f64) -> f64) -> Stretches {
    let (right, up) = axis.any_orthonormal_pair();
    let stretch = move |first: f64, last: f64| {
        let point = move |t: f64| {
            let (sin, cos) = (TAU * (first + (last - first) * twist(t))).sin_cos();
            let across = right * cos + up * sin;
            ellipsoid.surface_with_normal(axis * radius_rad.cos() + across * radius_rad.sin())
        };
        Box::new(point) as Box<dyn Fn(f64) -> DVec3>
    };
    vec![stretch(0.0, 0.2), stretch(0.2, 0.21), stretch(0.21, 1.0)]
}

const TWISTS: [fn(f64) -> f64; 3] = [
    |t| t,
    // As at the limb: infinitely fast at one end, at both.
    |t| t.sqrt(),
    |t| (0.5 * PI * t).sin().powi(2).sqrt().asin() * 2.0 / PI,
];

#[test]
fn circles_of_every_size_have_the_area_of_the_formula() {
    let moon = Ellipsoid::MOON;
    let mut worst = 0.0_f64;
    for (index, position) in spread_positions(12).enumerate() {
        let axis = match index {
            0 => DVec3::Z,
            1 => DVec3::NEG_Z,
            2 => DVec3::X,
            _ => moon.normal(position),
        };
        for radius_rad in [1e-6, 1e-3, 0.3, 0.5 * PI, 1.6, 2.5, PI - 1e-3, PI - 1e-6] {
            for twist in TWISTS {
                let outline = Outline::new(moon, circle(moon, axis, radius_rad, twist));
                let found = outline.measures();
                let smaller_rad = radius_rad.min(PI - radius_rad);
                let cap_m2 =
                    |radius_rad: f64| 2.0 * TAU * (moon.a_m * (0.5 * radius_rad).sin()).powi(2);
                let bound_m2 = 2e-11 * cap_m2(smaller_rad)
                    + 1e-15
                        * 2.0
                        * TAU
                        * moon.a_m.powi(2)
                        * if radius_rad > 1.6 { 1.0 } else { radius_rad };
                let error_m2 = (found.area_m2 - cap_m2(radius_rad)).abs();
                worst = worst.max(error_m2 / cap_m2(smaller_rad));
                assert!(
                    error_m2 < bound_m2,
                    "{axis} {radius_rad}: {error_m2} {bound_m2}"
                );
                let centroid = moon.normal(outline.centroid().unwrap());
                assert!(centroid.distance(axis) < 1e-9);
            }
        }
    }
    println!("circles: error of areas up to {worst:e} of the smaller side");
}

/// ∬ 1 and ∬ n over the points of an ellipsoid whose normals are within an angle of an axis: on the
/// sphere of normals a patch dω has the area a⁴b²/(a² cos²φ + b² sin²φ)² dω.
fn circle_measures(ellipsoid: Ellipsoid, axis: DVec3, radius_rad: f64) -> (f64, DVec3) {
    let (right, up) = axis.any_orthonormal_pair();
    let (a2, b2) = (ellipsoid.a_m.powi(2), ellipsoid.b_m.powi(2));
    let (rings, spokes) = (400, 128);
    let (mut area_m2, mut normals_m2) = (0.0, DVec3::ZERO);
    for ring in 0..=rings {
        let weight = match ring {
            0 => 1.0,
            k if k == rings => 1.0,
            k => 2.0 + 2.0 * f64::from(k % 2),
        };
        let (sin, cos) = (radius_rad * f64::from(ring) / f64::from(rings)).sin_cos();
        for spoke in 0..spokes {
            let turn = TAU * f64::from(spoke) / f64::from(spokes);
            let normal = axis * cos + (right * turn.cos() + up * turn.sin()) * sin;
            let ground = a2 * (1.0 - normal.z * normal.z) + b2 * normal.z * normal.z;
            let patch = weight * sin * a2 * a2 * b2 / (ground * ground);
            area_m2 += patch;
            normals_m2 += patch * normal;
        }
    }
    let scale = radius_rad / f64::from(3 * rings) * TAU / f64::from(spokes);
    (area_m2 * scale, normals_m2 * scale)
}

#[test]
fn circles_on_ellipsoids_agree_with_integrals_over_the_surface() {
    for (index, position) in spread_positions(9).enumerate() {
        let ellipsoid = [Ellipsoid::WGS84, Ellipsoid::MARS][index % 2];
        let axis = ellipsoid.normal(position);
        for radius_rad in [0.02, 1.0, 2.0, 3.0] {
            let twist = TWISTS[index % 3];
            let outline = Outline::new(ellipsoid, circle(ellipsoid, axis, radius_rad, twist));
            let (area_m2, normals_m2) = circle_measures(ellipsoid, axis, radius_rad);
            let found = outline.measures();
            assert!(
                (found.area_m2 / area_m2 - 1.0).abs() < 1e-10,
                "{position:?} {radius_rad}"
            );
            let error_m2 = found.vector_area_m2.distance(normals_m2);
            assert!(
                error_m2 < 1e-10 * area_m2,
                "{position:?} {radius_rad} {error_m2}"
            );
        }
    }
}

#[test]
fn caps_of_circles_are_the_circles() {
    for (index, position) in spread_positions(9).enumerate() {
        let moon = Ellipsoid::MOON;
        let axis = moon.normal(position);
        for radius_rad in [1e-6, 0.01, 1.0, 0.5 * PI, 2.0, 3.0] {
            let stretches = circle(moon, axis, radius_rad, TWISTS[index % 3]);
            let cap = Outline::new(moon, stretches).bounding_cap().unwrap();
            let excess_rad = cap.radius_rad - radius_rad;
            assert!(
                excess_rad >= -2e-9 && excess_rad < 1.1e-5 * radius_rad + 1e-9,
                "{radius_rad} {excess_rad:e}"
            );
        }
        // Nearer to everything than a milliradian.
        let stretches = circle(moon, axis, PI - 5e-4, TWISTS[0]);
        let cap = Outline::new(moon, stretches).bounding_cap().unwrap();
        assert_eq!(cap.radius_rad, PI);
    }
}

#[test]
fn annuli_and_holes_are_outlines_too() {
    let mars = Ellipsoid::MARS;
    let axis = mars.normal(globefill::LonLat::new(170.0, 80.0));
    // The hole is walked clockwise: left of a circle about the antipode.
    let hole = |radius_rad: f64| circle(mars, -axis, PI - radius_rad, TWISTS[1]);
    for (outer_rad, inner_rad) in [(0.3, 0.1), (2.8, 0.2), (3.0, 2.9), (0.3, 0.299)] {
        let mut stretches = hole(inner_rad);
        stretches.extend(circle(mars, axis, outer_rad, TWISTS[0]));
        let found = Outline::new(mars, stretches).measures();
        let (outer, inner) = (
            circle_measures(mars, axis, outer_rad),
            circle_measures(mars, axis, inner_rad),
        );
        let expected_m2 = outer.0 - inner.0;
        assert!(
            (found.area_m2 / expected_m2 - 1.0).abs() < 1e-9,
            "{outer_rad} {inner_rad}"
        );
        let error_m2 = found.vector_area_m2.distance(outer.1 - inner.1);
        assert!(error_m2 < 1e-9 * expected_m2);
    }
    let nothing = Outline::new(mars, Stretches::new());
    assert_eq!(nothing.measures(), Default::default());
    assert_eq!(nothing.bounding_cap(), None);
    // There and back again encloses nothing, and not everything.
    let there = circle(mars, axis, 0.3, TWISTS[0]);
    let back = circle(mars, axis, 0.3, TWISTS[0])
        .into_iter()
        .map(|stretch| Box::new(move |t: f64| stretch(1.0 - t)) as Box<dyn Fn(f64) -> DVec3>);
    let spike = Outline::new(mars, there.into_iter().chain(back).collect());
    assert!(spike.area_m2() < 1.0, "{:?}", spike.measures());
    assert_eq!(spike.centroid(), None);
}

#[test]
fn loops_of_one_stretch_cost_little_however_small() {
    let earth = Ellipsoid::WGS84;
    for (index, position) in spread_positions(20).enumerate() {
        let axis = earth.normal(position);
        let (right, up) = axis.any_orthonormal_pair();
        let radius_m = [0.01, 1.0, 100.0, 1e4, 1e6][index % 5];
        let calls = Cell::new(0);
        let ring = |t: f64| {
            calls.set(calls.get() + 1);
            let (sin, cos) = (TAU * t).sin_cos();
            let tilt = radius_m / earth.a_m;
            earth.surface_with_normal((axis + (right * cos + up * sin) * tilt).normalize())
        };
        let outline = Outline::new(earth, vec![ring]);
        let found = outline.measures();
        assert!(calls.get() < 2_500, "{radius_m} m: {} points", calls.get());
        let relative = found.error_m2 / found.area_m2;
        assert!(
            relative < 2e-11 + 4e-8 / radius_m,
            "{radius_m} m: {relative:e}"
        );
        let about_m2 = 0.5 * TAU * radius_m * radius_m;
        assert!(
            (found.area_m2 / about_m2 - 1.0).abs() < 0.05,
            "{found:?} {about_m2}"
        );
        calls.set(0);
        let cap = outline.bounding_cap().unwrap();
        assert!(calls.get() < 25_000, "{radius_m} m: {} points", calls.get());
        let cap_m = cap.radius_rad * earth.a_m;
        // The mean normal of tiny regions is uncertain, and with it the centre.
        let bound_m = 1.02 * radius_m + 0.02 / radius_m;
        assert!(
            cap_m > 0.98 * radius_m && cap_m < bound_m,
            "{cap_m} {radius_m}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    /// Circles cut into up to four stretches, each with a parametrisation of its own.
    #[test]
    fn errors_stay_below_what_is_said_of_them(
        axis in prop::array::uniform3(-1.0..1.0_f64),
        exponent in 0.0..6.0_f64,
        is_inside_out: bool,
        cuts in prop::collection::vec((0.01..0.99_f64, 0.3..3.0_f64), 1..5),
    ) {
        prop_assume!(DVec3::from(axis).length() > 0.1);
        let (moon, axis) = (Ellipsoid::MOON, DVec3::from(axis).normalize());
        let smaller_rad = 0.5 * PI * 10_f64.powf(-exponent);
        let radius_rad = if is_inside_out { PI - smaller_rad } else { smaller_rad };
        let (right, up) = axis.any_orthonormal_pair();
        let mut cuts = cuts;
        cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let ends = cuts.iter().skip(1).map(|cut| cut.0).chain([cuts[0].0 + 1.0]);
        let stretches = cuts.iter().zip(ends).map(|(&(first, power), last)| {
            move |t: f64| {
                let (sin, cos) = (TAU * (first + (last - first) * t.powf(power))).sin_cos();
                let across = (right * cos + up * sin) * radius_rad.sin();
                moon.surface_with_normal((axis * radius_rad.cos() + across).normalize())
            }
        });
        let found = Outline::new(moon, stretches.collect()).measures();
        let expected_m2 = 2.0 * TAU * (moon.a_m * (0.5 * radius_rad).sin()).powi(2);
        let vector_m2 = axis * (0.5 * TAU * (moon.a_m * radius_rad.sin()).powi(2));
        // A large area is itself only known to its rounding.
        let error_m2 = (found.area_m2 - expected_m2).abs() - 1e-15 * expected_m2;
        prop_assert!(error_m2 <= 0.5 * found.error_m2, "{error_m2} of {found:?}");
        let error_m2 = found.vector_area_m2.distance(vector_m2);
        prop_assert!(error_m2 <= 0.5 * found.error_m2, "{error_m2} of {found:?}");
    }
}
