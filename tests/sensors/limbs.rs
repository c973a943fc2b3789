//! Lines of sight that graze: low ground behind the limb, beams at low elevations, mountains.

use globefill::{Extrusion, LonLat};

use crate::{
    AT, EXTRUSIONS, LARGE, PLATEAU, SMALL,
    common::{
        camera,
        headless::gpu,
        surface::Terrain,
        watcher::{Optics, Watcher},
    },
    gate::Gate,
};

/// Level ground behind the limb, where a metre of height is seen kilometres farther.
fn check_limb_over(gate: &mut Gate<'_>, heights_m: &[f64], eyes_m: &[f64]) {
    for apex_m in [1e4, 5.5e5] {
        for &height_m in heights_m {
            let optics = Optics::Annulus {
                inner_rad: 0.0,
                outer_rad: 2.0,
            };
            let mut watcher = Watcher::new(AT, apex_m, 0.3, 1.0, optics);
            watcher.extrusion = Extrusion::Apex;
            let terrain = Terrain::Plateau { height_m };
            let far = LonLat::new(AT.lon_deg + 150.0, AT.lat_deg);
            let edge = watcher.edge_between(AT, far, |normal| terrain.height_m(normal));
            for &eye_m in eyes_m {
                let over = camera::Pose::nadir(edge.lon_deg, edge.lat_deg, height_m + eye_m);
                let name = format!("{height_m} m behind the limb of {apex_m} m, from {eye_m} m");
                gate.check(&name, std::slice::from_ref(&watcher), over, terrain);
            }
        }
    }
}

#[test]
fn ground_behind_the_limb_is_seen_as_far_as_it_is_high() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu, LARGE);
    check_limb_over(&mut gate, &[-400.0, -1.0, 1.0, 5.0, 20.0], &[2.0, 1e3, 1e5]);
    check_limb_over(&mut gate, &[-400.0, 20.0, 100.0], &[1e6]);
    check_limb_over(&mut gate, &[-400.0, 100.0, 1000.0], &[2e7]);
    gate.finish();
}

/// Ground that rises by less than a millionth of the distance, or by decimetres, is hard to tell from
/// the ellipsoid: there the limb may be off by a quarter of a pixel, as the documentation says.
#[test]
fn the_limb_over_low_ground_is_within_a_quarter_of_a_pixel() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu, LARGE);
    check_limb_over(&mut gate, &[0.1], &[2.0, 1e3, 1e6]);
    check_limb_over(&mut gate, &[1.0, 5.0], &[1e6, 2e7]);
    gate.failed.clear();
    assert!(gate.worst_px <= 0.25, "{}", gate.worst_px);
    gate.finish();
}

/// Lines of sight that graze: a beam that meets the ground at a low elevation, looked at where it ends.
fn check_grazing(gate: &mut Gate<'_>, heights_m: &[f64]) {
    for (apex_m, beam_rad) in [(1e4, 0.02), (5.5e5, 0.02), (3.6e7, 0.002)] {
        for elevation_deg in [1.0, 3.0] {
            // Off-nadir angle of a line of sight that arrives at this elevation on a sphere.
            let radius_m = 6.371e6;
            let sine = radius_m / (radius_m + apex_m) * f64::to_radians(elevation_deg).cos();
            let off_rad = sine.asin();
            let ahead_deg = 90.0 - elevation_deg - off_rad.to_degrees();
            let optics = Optics::Annulus {
                inner_rad: 0.0,
                outer_rad: beam_rad,
            };
            for extrusion in EXTRUSIONS {
                for terrain in [Terrain::Bare, PLATEAU, Terrain::Rough] {
                    let mut watcher = Watcher::new(AT, apex_m, off_rad, 0.0, optics.clone());
                    watcher.extrusion = extrusion;
                    let target = LonLat::new(AT.lon_deg, AT.lat_deg + ahead_deg);
                    let target = if target.lat_deg > 90.0 {
                        LonLat::new(AT.lon_deg + 180.0, 180.0 - target.lat_deg)
                    } else {
                        target
                    };
                    for &height_m in heights_m {
                        let ground_m = terrain.height_m(watcher.figure.normal(target));
                        let pose = camera::Pose::nadir(
                            target.lon_deg,
                            target.lat_deg,
                            ground_m + height_m,
                        );
                        let name = format!(
                            "beam from {apex_m} m at {elevation_deg}°, {extrusion:?}, seen from {height_m} m"
                        );
                        gate.check(&name, std::slice::from_ref(&watcher), pose, terrain);
                    }
                }
            }
        }
    }
}

#[test]
fn grazing_beams_end_where_they_should() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu, SMALL);
    check_grazing(&mut gate, &[3e4, 1e6]);
    gate.finish();
}

#[test]
#[ignore = "the whole; minutes"]
fn grazing_beams_end_where_they_should_at_every_height() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu, LARGE);
    gate.both = true;
    check_grazing(&mut gate, &[1.0, 100.0, 1e4, 3e4, 1e5, 1e6, 2e7]);
    gate.finish();
}

#[test]
fn an_apex_among_mountains_sees_those_above_and_below_it() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu, LARGE);
    let optics = Optics::Rectangle {
        right_rad: 0.6,
        up_rad: 0.3,
    };
    for (apex_m, off_rad) in [(6000.0, 1.45), (5000.0, 1.7), (8500.0, 1.2)] {
        let mut watcher = Watcher::new(AT, apex_m, off_rad, 0.0, optics.clone());
        watcher.extrusion = Extrusion::Apex;
        for height_m in [12_000.0, 1e5, 4e5] {
            let ahead = camera::Pose::nadir(AT.lon_deg, AT.lat_deg + height_m / 2e6, height_m);
            let watchers = std::slice::from_ref(&watcher);
            let covered = gate.check(
                &format!("apex at {apex_m} m"),
                watchers,
                ahead,
                Terrain::Rough,
            );
            assert!(covered > 0, "nothing seen from {apex_m} m");
        }
    }
    gate.finish();
}
