//! Random poses, frame after frame.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, UVec2};
use globefill::{Ellipsoid, Extrusion, LonLat, View};

use crate::{
    common::{
        camera,
        figure::Figure,
        headless::{Gpu, gpu},
        surface::{Cast, DepthKind, Surface, Terrain},
        watch::{CountPainter, judge_counts},
        watcher::{Optics, Watcher},
    },
    gate::Gate,
};

/// Random numbers that are the same in every run (splitmix64).
struct Random(u64);

impl Random {
    /// A number from 0 to 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (mixed ^ (mixed >> 31)) as f64 / u64::MAX as f64
    }
}

/// A sensor of any kind in any pose, mostly looking somewhere down.
fn any_watcher(random: &mut Random, height_m: f64) -> Watcher {
    let mut next = || random.next();
    let at = LonLat::new(
        360.0 * next() - 180.0,
        (2.0 * next() - 1.0).asin().to_degrees(),
    );
    let off_rad = if next() < 0.8 {
        1.6 * next()
    } else {
        PI * next()
    };
    // From far away the ellipsoid is small: so are most of the fields of view.
    let seen_rad = (6.4e6 / (6.4e6 + height_m)).asin();
    let width_rad = seen_rad * (0.02 + 1.5 * next().powi(2));
    let off_rad = off_rad * seen_rad / (0.5 * PI);
    let optics = match (4.0 * next()) as u32 {
        0 => Optics::Annulus {
            inner_rad: 0.0,
            outer_rad: width_rad,
        },
        1 => Optics::Annulus {
            inner_rad: width_rad * 0.9 * next(),
            outer_rad: width_rad,
        },
        2 => Optics::Rectangle {
            right_rad: width_rad.min(1.5),
            up_rad: (width_rad * next()).clamp(0.001, 1.5),
        },
        _ => {
            let reach = width_rad.min(1.0).tan();
            let corner = |k: f64| (reach * (k * TAU).cos(), reach * (k * TAU).sin());
            let turn = next();
            Optics::Corners([0.0, 0.2, 0.45, 0.8].map(|k| corner(k + turn)).to_vec())
        }
    };
    let mut watcher = Watcher::new(at, height_m, off_rad, TAU * next(), optics);
    if next() < 0.3 {
        watcher.min_elevation_rad = Some(0.5 * next());
    }
    if next() < 0.5 {
        watcher.extrusion = Extrusion::Apex;
    }
    watcher
}

/// One renderer and one view; its only sensor takes pose after pose, and every frame must show it.
fn check_poses(gpu: &Gpu, poses: usize) {
    let figure = Figure::new(Ellipsoid::WGS84);
    let size_px = UVec2::new(64, 64);
    let directions = [
        DVec3::X,
        DVec3::NEG_X,
        DVec3::Y,
        DVec3::NEG_Y,
        DVec3::Z,
        DVec3::NEG_Z,
    ];
    let surfaces = directions.map(|normal| {
        let lat_deg = normal.z.asin().to_degrees();
        let mut pose = camera::Pose::nadir(normal.y.atan2(normal.x).to_degrees(), lat_deg, 2e7);
        // One block of the tiles, the whole globe or what overfills it.
        pose.fov_deg = if normal.x + normal.y > 0.0 {
            20.0
        } else {
            29.0
        };
        let cast = Cast::new(&figure, &pose, size_px, 1, Terrain::Bare);
        Surface::new(&cast, DepthKind::Reversed)
    });
    let mut random = Random(7);
    let first = any_watcher(&mut random, 1e6);
    let mut painter = CountPainter::new(gpu, &[first], &surfaces[0]);
    let mut view = View::default();
    let mut gate = Gate::new(gpu, size_px);
    let mut seen = 0;
    for height_m in [1e4, 3e4, 1e5, 5e5, 1e6, 3e6, 1e7, 3.6e7, 1e8, 3.8e8] {
        for k in 0..poses {
            let watcher = any_watcher(&mut random, height_m);
            let sensors = painter.renderer.sensors_mut();
            sensors
                .set_sensor(painter.ids[0], watcher.sensor())
                .expect("a sound sensor");
            // Mostly from its own side; sometimes from another, where the limb hides the rest.
            let facing = |surface: &&Surface| surface.lens.eye_m.dot(watcher.pose.apex_ecef_m);
            let nearest = surfaces
                .iter()
                .max_by(|a, b| facing(a).total_cmp(&facing(b)))
                .expect("six sides");
            let surface = if k % 5 == 0 {
                &surfaces[k % 6]
            } else {
                nearest
            };
            let (drawn, stats) = painter.draw(gpu, &mut view, surface);
            assert!(stats.upload_bytes <= 1024, "{stats:?}");
            let watchers = [watcher];
            let score = judge_counts(&watchers, surface, &drawn);
            seen += usize::from(score.covered > 0);
            gate.note(
                &format!("pose {k} from {height_m} m: {:?}", watchers[0]),
                &score,
            );
        }
    }
    println!("{seen} of {} frames show a footprint", gate.pictures);
    assert!(2 * seen > gate.pictures, "the poses hardly see anything");
    // What is far from its limb or its edge has none in the picture.
    gate.with_edge = gate.pictures;
    gate.finish();
}

#[test]
fn no_frame_misses_its_footprint() {
    let Some(gpu) = gpu() else { return };
    check_poses(gpu, 40);
}

#[test]
#[ignore = "the whole: 1 000 poses at 10 altitudes"]
fn no_frame_misses_its_footprint_in_ten_thousand() {
    let Some(gpu) = gpu() else { return };
    check_poses(gpu, 1000);
}
