//! Shapes that have broken triangulators before, each at many places.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3};

use super::*;

#[test]
fn discs_from_a_metre_to_all_but_a_metre() {
    let radii_rad = [
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
    ];
    for (row, radius_rad) in radii_rad.into_iter().enumerate() {
        for (column, corners) in [3, 4, 17, 300].into_iter().enumerate() {
            // Every radius meets most turns, and every number of corners all.
            for_one(row + column, &[circle(radius_rad, corners)], |case| {
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
        for_all(
            &[circle(outer, 300), reversed(circle(inner, 300))],
            |case| {
                let caps = case.check();
                assert!(
                    (area_sr(&case, &caps) / (TAU * (inner.cos() - outer.cos())) - 1.0).abs()
                        < 0.05
                );
            },
        );
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
fn horns_that_end_opposite_the_middle() {
    for gap in [0.01, 1e-6, 1e-9, 1e-16] {
        let bulb = |half: f64| (1..150).map(move |k| polar(0.05, half + f64::from(k) * PI / 150.0));
        let tip = |half: f64| [polar(PI - gap, half)];
        let corners: Vec<_> = bulb(0.0)
            .chain(tip(PI))
            .chain(bulb(PI))
            .chain(tip(0.0))
            .collect();
        for_all(&[densified(&corners)], |case| {
            case.check();
            // An edge through the projection point would leave the inside ambiguous.
            let outline = Outline::new(
                case.ellipsoid,
                &case.vertices,
                &case.loops,
                case.inside_sr(),
            );
            let (centre, radius_rad) = outline.bounding_cap();
            let pole = -outline.chart(centre, radius_rad).0.centre();
            assert!(outline.points.iter().all(|p| p.distance(pole) > 0.3));
        });
    }
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
fn holes_all_over_the_globe() {
    // No place for the pole is farther than 3° from a hole.
    let hole = reversed(circle(0.02, 40));
    let shape: Vec<_> = directions(700).map(|to| moved(&hole, to)).collect();
    let hole = TAU * (1.0 - 0.02_f64.cos());
    for_all(&shape, |case| {
        let share = area_sr(&case, &case.check()) / (4.0 * PI - 700.0 * hole);
        assert!((share - 1.0).abs() < 0.01, "{share}");
    });
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
fn loops_of_a_hundred_thousand_vertices() {
    let coast = |k: u32| {
        let azimuth = f64::from(k) * TAU / 1e5;
        polar(
            0.8 + 0.3 * (azimuth * 9.0).sin() + 0.002 * (f64::from(k) * 7.31).sin(),
            azimuth,
        )
    };
    let case = Case::new(
        Ellipsoid::WGS84,
        turns()[4],
        &[(0..100_000).map(coast).collect()],
    );
    let caps = case.check();
    assert!(caps.interior.len() < 10_000, "{}", caps.interior.len());
    // Chords of 20°, against the contract: the sag cannot be held, everything else must.
    let spikes = |k: u32| {
        polar(
            0.6 + 0.2 * (f64::from(k) * 7.31).sin(),
            f64::from(k) * TAU / 1e5,
        )
    };
    let case = Case::new(
        Ellipsoid::WGS84,
        turns()[4],
        &[(0..100_000).map(spikes).collect()],
    );
    let caps = case.check_laws();
    assert!(caps.interior.len() < 100_000, "{}", caps.interior.len());
}
