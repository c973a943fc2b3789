//! Random loops, proper and improper.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};
use proptest::{prelude::*, test_runner::RngSeed};

use super::*;

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

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
        case.check_laws();
    }
}

#[test]
fn a_scribble_of_six_millimetres() {
    // Clockwise on the whole: the globe without it. The pole once moved into one of its faces, where
    // the rounding of positions is as large as the gaps.
    // Pairs of hexadecimal digits: twelfths of the size, twelfths of a turn.
    const CORNERS: &[u8] = b"1100112772312000008391704b59424a0061310036008200\
        4100433081142a70116016614214144279000066810037";
    let at = |pair: &[u8]| {
        let [x, y] = [pair[0], pair[1]].map(|c| f64::from(char::from(c).to_digit(16).unwrap()));
        polar(1e-9 * x / 12.0, y * TAU / 12.0)
    };
    let corners: Vec<_> = CORNERS.chunks(2).map(at).collect();
    Case::new(
        Ellipsoid::WGS84,
        turns()[4],
        &[Vec::new(), densified(&corners)],
    )
    .check_laws();
}
