//! Laws that hold for every cap, tested on shapes at many places, and on random ones.

use std::{collections::HashMap, f64::consts::PI, f64::consts::TAU};

use glam::{DQuat, DVec3};
use proptest::prelude::*;

use super::{Caps, sag, triangulate};
use crate::Ellipsoid;

const ELLIPSOIDS: [Ellipsoid; 3] = [
    Ellipsoid::WGS84,
    Ellipsoid::MOON,
    Ellipsoid { a_m: 1.0, b_m: 1.2 },
];

/// Turns that bring the test shapes' middle, +x, over a pole, the antimeridian and elsewhere.
fn turns() -> Vec<DQuat> {
    vec![
        DQuat::IDENTITY,
        DQuat::from_rotation_y(-PI / 2.0),
        DQuat::from_rotation_y(PI / 2.0),
        DQuat::from_rotation_z(PI),
        DQuat::from_axis_angle(DVec3::new(0.36, 0.48, -0.8), 1.234),
    ]
}

/// The unit vector at a distance from +x, counter-clockwise from +y seen from outside.
fn polar(distance_rad: f64, azimuth_rad: f64) -> DVec3 {
    let (sin, cos) = distance_rad.sin_cos();
    let (east, north) = (azimuth_rad.cos(), azimuth_rad.sin());
    DVec3::new(cos, sin * east, sin * north)
}

/// A closed loop through `corners` with chords of at most 2°.
fn densified(corners: &[DVec3]) -> Vec<DVec3> {
    let mut points = Vec::new();
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let parts = (a.angle_between(b) / 2f64.to_radians()).ceil().max(1.0);
        let step = |k: f64| a.slerp(b, k / parts).normalize();
        points.extend((0..parts as u32).map(|k| if k == 0 { a } else { step(f64::from(k)) }));
    }
    points
}

fn circle(radius_rad: f64, corners: u32) -> Vec<DVec3> {
    let azimuth = |k| f64::from(k) * TAU / f64::from(corners);
    densified(
        &(0..corners)
            .map(|k| polar(radius_rad, azimuth(k)))
            .collect::<Vec<_>>(),
    )
}

fn reversed(mut points: Vec<DVec3>) -> Vec<DVec3> {
    points.reverse();
    points
}

fn moved(points: &[DVec3], to: DVec3) -> Vec<DVec3> {
    let turn = DQuat::from_rotation_arc(DVec3::X, to);
    points.iter().map(|&p| turn * p).collect()
}

/// Loops on the unit sphere turned and laid on an ellipsoid, behind other vertices.
struct Case {
    ellipsoid: Ellipsoid,
    vertices: Vec<DVec3>,
    loops: Vec<Vec<u32>>,
}

impl Case {
    fn new(ellipsoid: Ellipsoid, turn: DQuat, shape: &[Vec<DVec3>]) -> Self {
        let mut vertices = vec![ellipsoid.radii_m() * DVec3::Z; 7];
        let mut loops = Vec::new();
        for points in shape {
            let first = vertices.len() as u32;
            vertices.extend(
                points
                    .iter()
                    .map(|&p| (turn * p).normalize() * ellipsoid.radii_m()),
            );
            loops.push((first..vertices.len() as u32).collect());
        }
        Self {
            ellipsoid,
            vertices,
            loops,
        }
    }

    fn caps(&self) -> Caps {
        triangulate(self.ellipsoid, &self.vertices, &self.loops)
    }

    /// Everything that must hold for any input: the signed boundary, the area, the reported sag.
    fn check_laws(&self) -> Caps {
        let caps = self.caps();
        self.check_boundary(&caps);
        self.check_area(&caps);
        let all = self.all_unit(&caps);
        let measured = caps
            .triangles
            .iter()
            .map(|&t| sampled_sag(t.map(|i| all[i as usize])));
        let measured = measured.fold(0.0, f64::max) * self.ellipsoid.a_m.max(self.ellipsoid.b_m);
        assert!(measured <= caps.sag_m, "{measured} {}", caps.sag_m);
        caps
    }

    /// As `check_laws`, for a proper shape: every triangle within the sag limit.
    fn check(&self) -> Caps {
        let caps = self.check_laws();
        let limit_m = sag::metres(self.ellipsoid, sag::limit());
        assert!(caps.sag_m <= limit_m, "{} of {limit_m}", caps.sag_m);
        caps
    }

    fn check_boundary(&self, caps: &Caps) {
        let mut all = self.vertices.clone();
        all.extend(&caps.interior);
        let mut sums: HashMap<[[u64; 3]; 2], i64> = HashMap::new();
        let mut add = |a: u32, b: u32, sign: i64| {
            let bits = |i: u32| all[i as usize].to_array().map(|x| (x + 0.0).to_bits());
            let (a, b) = (bits(a), bits(b));
            if a < b {
                *sums.entry([a, b]).or_default() += sign;
            } else if b < a {
                *sums.entry([b, a]).or_default() -= sign;
            }
        };
        for &[a, b, c] in &caps.triangles {
            add(a, b, 1);
            add(b, c, 1);
            add(c, a, 1);
        }
        for ring in &self.loops {
            for (k, &b) in ring.iter().enumerate() {
                add(ring[(k + ring.len() - 1) % ring.len()], b, -1);
            }
        }
        let open = sums.values().filter(|&&sum| sum != 0).count();
        assert_eq!(open, 0, "open edges");
    }

    fn all_unit(&self, caps: &Caps) -> Vec<DVec3> {
        let all = self.vertices.iter().chain(&caps.interior);
        all.map(|&p| (p / self.ellipsoid.radii_m()).normalize())
            .collect()
    }

    fn check_area(&self, caps: &Caps) {
        let all = self.all_unit(caps);
        let filled: f64 = caps
            .triangles
            .iter()
            .map(|&t| excess(t.map(|i| all[i as usize])))
            .sum();
        let ends = |ring: &Vec<u32>| {
            let previous = ring.iter().cycle().skip(ring.len().saturating_sub(1));
            let edges = previous
                .zip(ring)
                .map(|(&a, &b)| [all[a as usize], all[b as usize]]);
            edges.collect::<Vec<_>>()
        };
        let edges: Vec<_> = self.loops.iter().flat_map(ends).collect();
        let Some(&[reference, _]) = edges.first() else {
            return;
        };
        let enclosed: f64 = edges.iter().map(|&[a, b]| excess([reference, a, b])).sum();
        let turns = ((filled - enclosed) / (4.0 * PI)).round();
        let error = filled - enclosed - 4.0 * PI * turns;
        let rounding = 1e-15 * (caps.triangles.len() as f64).sqrt() * filled.abs().min(1.0);
        assert!(
            error.abs() <= 1e-9 * filled.abs() + rounding,
            "{error} of {filled}"
        );
    }
}

/// Signed area of a triangle on the unit sphere.
fn excess([a, b, c]: [DVec3; 3]) -> f64 {
    let volume = a.dot((b - a).cross(c - a));
    2.0 * volume.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}

/// The depth of the deepest of many points of a flat triangle.
fn sampled_sag([a, b, c]: [DVec3; 3]) -> f64 {
    const N: u32 = 8;
    let mut deepest = 0.0_f64;
    for i in 0..=N {
        for j in 0..=N - i {
            let weights = [i, j, N - i - j].map(|k| f64::from(k) / f64::from(N));
            let point = a * weights[0] + b * weights[1] + c * weights[2];
            deepest = deepest.max(1.0 - point.length());
        }
    }
    // A corner's own rounding is no sag.
    deepest - 1e-15
}

fn for_all(shape: &[Vec<DVec3>], check: impl Fn(Case)) {
    for ellipsoid in ELLIPSOIDS {
        for turn in turns() {
            check(Case::new(ellipsoid, turn, shape));
        }
    }
}

fn area_sr(case: &Case, caps: &Caps) -> f64 {
    let all = case.all_unit(caps);
    caps.triangles
        .iter()
        .map(|&t| excess(t.map(|i| all[i as usize])))
        .sum()
}

#[test]
fn discs_from_a_metre_to_all_but_a_metre() {
    for radius_rad in [
        1.6e-7,
        1e-5,
        1e-3,
        0.02,
        0.0203,
        0.1,
        1.0,
        1.57,
        1.58,
        2.0,
        2.9,
        3.1,
        PI - 1e-3,
        PI - 1e-5,
        PI - 1.6e-7,
    ] {
        for corners in [3, 4, 17, 64, 300] {
            for_all(&[circle(radius_rad, corners)], |case| {
                let caps = case.check();
                let area = area_sr(&case, &caps);
                // Inscribed polygons lose, and their complements gain, less than this.
                let disc = TAU * (1.0 - radius_rad.cos());
                assert!(
                    (area - disc).abs() < 0.9 * disc.min(4.0 * PI - disc) + 1e-8,
                    "{area} {disc}"
                );
            });
        }
    }
}

#[test]
fn annuli_and_belts() {
    for (inner, outer) in [
        (1e-6, 2e-6),
        (0.01, 0.02),
        (0.3, 0.31),
        (0.2, 2.8),
        (1.55, 1.59),
        (3.0, 3.1),
    ] {
        for_all(&[circle(outer, 100), reversed(circle(inner, 37))], |case| {
            let caps = case.check();
            assert!(
                (area_sr(&case, &caps) / (TAU * (inner.cos() - outer.cos())) - 1.0).abs() < 0.05
            );
        });
    }
}

#[test]
fn stars_combs_and_spirals() {
    let star = |radius: f64, points: u32| {
        let corner = |k: u32| {
            polar(
                radius * [1.0, 0.2][k as usize % 2],
                f64::from(k) * PI / f64::from(points),
            )
        };
        densified(&(0..2 * points).map(corner).collect::<Vec<_>>())
    };
    let comb = |size: f64| {
        let at = |x: f64, y: f64| DVec3::new(1.0, size * x, size * y).normalize();
        let mut corners = vec![at(-1.0, -1.0), at(1.0, -1.0)];
        for tooth in (0..20).rev() {
            let x = -1.0 + f64::from(tooth) / 10.0;
            corners.extend([
                at(x + 0.1, 1.0),
                at(x + 0.06, 1.0),
                at(x + 0.05, -0.9),
                at(x + 0.04, 1.0),
            ]);
        }
        densified(&corners)
    };
    let spiral = |size: f64| {
        let arm = |start: f64| {
            (0..400).map(move |k| polar(size * (start + f64::from(k) / 400.0), f64::from(k) * 0.1))
        };
        let out: Vec<_> = arm(0.04).collect();
        let back: Vec<_> = reversed(arm(0.0).collect());
        reversed(densified(&[back, out].concat()))
    };
    for size in [1e-6, 0.01, 0.5, 1.5, 2.9] {
        for_all(&[star(size, 7)], |case| drop(case.check()));
        for_all(&[star(size, 100)], |case| drop(case.check()));
        for_all(&[comb(size)], |case| drop(case.check()));
        for_all(&[spiral(size)], |case| drop(case.check_laws()));
    }
}

#[test]
fn pinches_and_touching_holes() {
    for size in [1e-6, 0.01, 0.4] {
        let eight = [
            polar(0.0, 0.0),
            polar(size, -0.4),
            polar(size, 0.4),
            polar(0.0, 0.0),
            polar(size, PI - 0.4),
            polar(size, PI + 0.4),
        ];
        for_all(&[densified(&eight)], |case| drop(case.check()));
        let shell = [
            polar(size, 0.0),
            polar(size, 1.5),
            polar(size, 3.0),
            polar(size, 4.5),
        ];
        let hole = [
            polar(size, 0.0),
            polar(0.3 * size, 5.0),
            polar(0.3 * size, 1.0),
        ];
        for_all(&[densified(&shell), densified(&hole)], |case| {
            drop(case.check())
        });
        let far = [polar(size, 0.0), polar(size, 3.0), polar(0.3 * size, 1.0)];
        for_all(&[densified(&shell), densified(&far)], |case| {
            drop(case.check_laws())
        });
    }
}

#[test]
fn bow_ties_and_hexagrams_are_signed_chains() {
    for size in [1e-6, 0.01, 0.4] {
        let at = |x: f64, y: f64| DVec3::new(1.0, size * x, size * y).normalize();
        let tie = [at(-1.0, -1.0), at(1.0, 1.0), at(1.0, -1.0), at(-1.0, 0.7)];
        for_all(&[densified(&tie)], |case| drop(case.check_laws()));
        let star: Vec<_> = (0..11)
            .map(|k| polar(size, f64::from(k) * 4.0 * TAU / 11.0))
            .collect();
        for_all(&[densified(&star)], |case| drop(case.check_laws()));
    }
}

#[test]
fn chords_that_cross_by_metres_stay_within_the_sag_limit() {
    // A long thin gulf whose sides are 30 km long and cross by 5 m.
    let deviation = 5.0 / 6_371_000.0;
    let at = |x: f64, y: f64| DVec3::new(1.0, x, y).normalize();
    let shell = densified(&[at(-0.5, -0.5), at(0.5, -0.5), at(0.5, 0.5), at(-0.5, 0.5)]);
    let hole = [
        at(0.0, 0.0),
        at(0.02, 3.0 * deviation),
        at(0.04, 0.0),
        at(0.041, 4.0 * deviation),
        at(0.02, 2.0 * deviation),
        at(0.001, -deviation),
    ];
    for_all(&[shell, densified(&hole)], |case| drop(case.check()));
}

#[test]
fn a_thousand_holes() {
    let mut shape = vec![circle(1.2, 500)];
    for k in 0..1000 {
        let (row, column) = (k / 40, k % 40);
        let to = DVec3::new(
            1.0,
            0.05 * f64::from(column - 20),
            0.05 * f64::from(row - 12),
        )
        .normalize();
        shape.push(moved(&reversed(circle(0.008, 5 + k as u32 % 7)), to));
    }
    for_all(&shape, |case| drop(case.check()));
    // The same without the shell: the globe with a thousand holes.
    for_all(&shape[1..], |case| drop(case.check()));
}

#[test]
fn the_whole_globe() {
    for ellipsoid in ELLIPSOIDS {
        let case = Case::new(ellipsoid, DQuat::IDENTITY, &[]);
        let caps = case.check();
        assert!((area_sr(&case, &caps) - 4.0 * PI).abs() < 1e-11);
    }
}

#[test]
fn degenerate_loops_do_no_harm() {
    let (a, b, c) = (polar(0.01, 0.0), polar(0.02, 1.0), polar(0.015, 2.0));
    let line: Vec<_> = (0..50).map(|k| polar(f64::from(k) * 0.001, 0.0)).collect();
    let there_and_back = [line.clone(), reversed(line.clone())].concat();
    let shapes: [Vec<Vec<DVec3>>; 12] = [
        vec![vec![]],
        vec![vec![a]],
        vec![vec![a, b]],
        vec![vec![a, b], vec![c]],
        vec![vec![a, a, a, a]],
        vec![vec![a, b, a, b]],
        vec![vec![a, a, b, b, c, c]],
        vec![vec![a, b, c, b]],
        vec![line],
        vec![there_and_back],
        vec![vec![a, b, c], vec![a, b, c]],
        vec![vec![a, b, c], vec![c, b, a]],
    ];
    for shape in &shapes {
        for_all(shape, |case| drop(case.check_laws()));
    }
    // The same at a tenth of a millimetre, where positions are multiples of 10⁻⁹ m.
    let tiny: Vec<_> = (0..40).map(|k| polar(1e-11, f64::from(k))).collect();
    for_all(&[tiny], |case| case.check_boundary(&case.caps()));
}

#[test]
fn a_loop_of_a_hundred_thousand_vertices() {
    let coast = |k: u32| {
        polar(
            0.6 + 0.2 * (f64::from(k) * 7.31).sin() + 0.1 * (f64::from(k) * 0.013).sin(),
            f64::from(k) * TAU / 1e5,
        )
    };
    let case = Case::new(
        Ellipsoid::WGS84,
        turns()[4],
        &[(0..100_000).map(coast).collect()],
    );
    case.check();
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn random_stars(
        size in prop_oneof![Just(1e-6), Just(0.01), 0.02..3.0],
        radii in prop::collection::vec(0.05..1.0, 3..120),
        turn in (-1.0..1.0, -1.0..1.0, -1.0..1.0, 0.0..TAU),
    ) {
        let corner = |(k, r): (usize, &f64)| polar(size * r, k as f64 * TAU / radii.len() as f64);
        let corners: Vec<_> = radii.iter().enumerate().map(corner).collect();
        let axis = DVec3::new(turn.0, turn.1, turn.2).try_normalize().unwrap_or(DVec3::X);
        let case = Case::new(Ellipsoid::WGS84, DQuat::from_axis_angle(axis, turn.3), &[densified(&corners)]);
        case.check();
    }

    #[test]
    fn random_scribbles(
        size in prop_oneof![Just(1e-9), Just(1e-4), 0.01..3.0],
        corners in prop::collection::vec((0..12u8, 0..12u8), 0..60),
        split in 0..60usize,
    ) {
        // A coarse grid makes duplicates, collinear runs, crossings and pinches frequent.
        let at = |&(x, y): &(u8, u8)| polar(size * f64::from(x) / 12.0, f64::from(y) * TAU / 12.0);
        let corners: Vec<_> = corners.iter().map(at).collect();
        let (one, two) = corners.split_at(split.min(corners.len()));
        let case = Case::new(Ellipsoid::WGS84, turns()[4], &[densified(one), densified(two)]);
        let caps = case.caps();
        case.check_boundary(&caps);
    }
}
