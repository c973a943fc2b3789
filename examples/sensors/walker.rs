//! A made-up constellation: a Walker delta shell, as element sets.

use std::f64::consts::TAU;

use globefill::Ellipsoid;
use serde_json::json;
use sgp4::Elements;

use crate::cli::Arguments;

/// Gravitational parameter of the Earth that SGP4 uses, m³/s² (WGS 72).
const MU_M3_S2: f64 = 3.986_008e14;
const SECONDS_PER_DAY: f64 = 86_400.0;

/// The shell that the command line asks for.
pub fn elements(arguments: &Arguments) -> Result<Vec<Elements>, String> {
    let count = arguments.made();
    let planes = arguments.planes.unwrap_or_else(|| planes_of(count));
    if !count.is_multiple_of(planes) {
        return Err(format!(
            "--planes: {count} satellites cannot be shared evenly by {planes} planes"
        ));
    }
    shell(count, planes, arguments.height, arguments.inclination)
}

/// The divisor of `count` nearest to its square root, as a ratio. A prime number gets a plane for
/// every satellite.
fn planes_of(count: usize) -> usize {
    let most_in_plane = count.isqrt();
    let in_plane = (1..=most_in_plane)
        .rev()
        .find(|in_plane| count.is_multiple_of(*in_plane));
    count / in_plane.unwrap_or(1)
}

/// Most phasings that are tried.
const MOST_PHASINGS: usize = 1_000;

/// The phasing f with which satellites pass each other at the greatest distance.
fn phasing_of(count: usize, planes: usize, inclination_rad: f64) -> usize {
    // By how much the satellite of another plane lags at the crossing if both started at the node,
    // and the part of a lag that is left where they are closest (Speckman, Lang and Boyce, An analysis
    // of the line of sight vector between two satellites in common altitude circular orbits, 1990).
    let (sin, cos) = inclination_rad.sin_cos();
    let crossings: Vec<(f64, f64)> = (1..planes)
        .map(|plane| {
            let node_rad = TAU * plane as f64 / planes as f64;
            let lag_rad = 2.0 * (cos * (0.5 * node_rad).sin()).atan2((0.5 * node_rad).cos());
            let cos_between = cos * cos + sin * sin * node_rad.cos();
            (lag_rad, (0.5 * (1.0 + cos_between)).max(0.0).sqrt())
        })
        .collect();
    let slot_rad = TAU * planes as f64 / count as f64;
    let nearest = |phasing: usize| {
        let step_rad = TAU * phasing as f64 / count as f64;
        let distances = (1..).zip(&crossings).map(|(plane, (lag_rad, left))| {
            let lag_rad = lag_rad + step_rad * f64::from(plane);
            let lag_rad = lag_rad - slot_rad * (lag_rad / slot_rad).round();
            (0.5 * lag_rad).sin().abs() * left
        });
        distances.fold(f64::INFINITY, f64::min)
    };
    (0..planes.min(MOST_PHASINGS))
        .max_by(|&a, &b| nearest(a).total_cmp(&nearest(b)))
        .unwrap_or(0)
}

/// Walker's i: t/p/f with `count` satellites in `planes` planes whose nodes are spread over 360°.
pub fn shell(
    count: usize,
    planes: usize,
    height_m: f64,
    inclination_deg: f64,
) -> Result<Vec<Elements>, String> {
    let radius_m = Ellipsoid::WGS84.a_m + height_m;
    let turns_per_day = SECONDS_PER_DAY / TAU * (MU_M3_S2 / radius_m.powi(3)).sqrt();
    let in_plane = count / planes;
    let phasing = phasing_of(count, planes, inclination_deg.to_radians()) as f64;
    let satellite = |index: usize| {
        let (plane, slot) = (index / in_plane, index % in_plane);
        let anomaly_turns = slot as f64 / in_plane as f64 + phasing * plane as f64 / count as f64;
        // An orbit mean-elements message, as catalogues give it out.
        serde_json::from_value(json!({
            "OBJECT_NAME": format!("SHELL {plane}-{slot}"),
            "OBJECT_ID": null,
            "EPOCH": "2026-01-01T00:00:00",
            "MEAN_MOTION": turns_per_day,
            "ECCENTRICITY": 0.0,
            "INCLINATION": inclination_deg,
            "RA_OF_ASC_NODE": 360.0 * plane as f64 / planes as f64,
            "ARG_OF_PERICENTER": 0.0,
            "MEAN_ANOMALY": 360.0 * anomaly_turns.fract(),
            "EPHEMERIS_TYPE": 0,
            "CLASSIFICATION_TYPE": "U",
            "NORAD_CAT_ID": index + 1,
            "ELEMENT_SET_NO": 1,
            "REV_AT_EPOCH": 0,
            "BSTAR": 0.0,
            "MEAN_MOTION_DOT": 0.0,
            "MEAN_MOTION_DDOT": 0.0,
        }))
        .map_err(|error| format!("the shell's element sets: {error}"))
    };
    (0..count).map(satellite).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constellation::Constellation;

    /// Against the satellites themselves, over the time in which each takes the place of the next.
    #[test]
    fn satellites_of_the_shell_keep_their_distance() {
        let (count, planes, inclination_deg) = (100, 10, 53.0_f64);
        let shell = shell(count, planes, 550e3, inclination_deg).unwrap();
        let constellation = Constellation::new(&shell, &Ellipsoid::WGS84).unwrap();
        let mut least_m = f64::INFINITY;
        for minutes in 0..10 {
            let poses = constellation.poses(f64::from(minutes));
            let apexes: Vec<_> = poses
                .iter()
                .flatten()
                .map(|pose| pose.apex_ecef_m)
                .collect();
            assert_eq!(apexes.len(), count);
            for (index, apex) in apexes.iter().enumerate() {
                for other in &apexes[..index] {
                    least_m = least_m.min(apex.distance(*other));
                }
            }
        }
        // With other phasings satellites meet, or pass within 70 … 500 km.
        assert!(least_m > 550e3, "{least_m}");
    }
}
