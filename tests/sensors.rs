//! Footprints drawn, judged pixel by pixel by lines of sight in f64. The whole:
//! `cargo test --release --test sensors -- --ignored --nocapture`

mod common;

use common::{
    camera,
    headless::{Gpu, gpu},
    surface::{Cast, DepthKind, Surface, Terrain},
    watch::{CountPainter, judge_counts},
    watcher::{Optics, Watcher},
};
use glam::UVec2;
use globefill::{Extrusion, LonLat, View};

const SMALL: UVec2 = UVec2::new(320, 180);
const EXTRUSIONS: [Extrusion; 2] = [Extrusion::Normal, Extrusion::Apex];
const PLATEAU: Terrain = Terrain::Plateau { height_m: 4000.0 };

/// Draws and judges; says what failed.
fn check(
    gpu: &Gpu,
    name: &str,
    watchers: &[Watcher],
    pose: camera::Pose,
    terrain: Terrain,
) -> Option<String> {
    let cast = Cast::new(&watchers[0].figure, &pose, SMALL, 1, terrain);
    let mut failed = None;
    for depth in [DepthKind::Reversed, DepthKind::Standard] {
        let surface = Surface::new(&cast, depth);
        let mut painter = CountPainter::new(gpu, watchers, &surface);
        let (drawn, _) = painter.draw(gpu, &mut View::default(), &surface);
        let score = judge_counts(watchers, &surface, &drawn);
        let verdict = format!("{name} {terrain:?} {depth:?}: {score}");
        println!("{verdict}");
        if score.wrong > 0 {
            failed = Some(verdict);
        }
    }
    failed
}

/// One sensor of each kind at each height, with an uncovered place to walk to from the covered middle.
fn subjects() -> Vec<(String, Watcher, LonLat)> {
    let at = LonLat::new(23.0, 41.0);
    let kinds = [
        (
            "cone",
            Optics::Annulus {
                inner_rad: 0.0,
                outer_rad: 0.4,
            },
        ),
        (
            "rectangle",
            Optics::Rectangle {
                right_rad: 0.5,
                up_rad: 0.2,
            },
        ),
        (
            "corners",
            Optics::Corners(vec![(0.4, -0.3), (0.1, 0.5), (-0.4, -0.2)]),
        ),
    ];
    let mut subjects = Vec::new();
    for (kind, optics) in kinds {
        for height_m in [1e4, 5.5e5, 3.6e7] {
            let scale = if height_m > 1e7 { 0.2 } else { 1.0 };
            let optics = match &optics {
                &Optics::Annulus { outer_rad, .. } => Optics::Annulus {
                    inner_rad: 0.0,
                    outer_rad: outer_rad * scale,
                },
                &Optics::Rectangle { right_rad, up_rad } => Optics::Rectangle {
                    right_rad: right_rad * scale,
                    up_rad: up_rad * scale,
                },
                Optics::Corners(corners) => Optics::Corners(
                    corners
                        .iter()
                        .map(|&(x, y)| (x * scale, y * scale))
                        .collect(),
                ),
            };
            let watcher = Watcher::new(at, height_m, 0.1 * scale, 1.0, optics);
            let outside = LonLat::new(at.lon_deg + 90_f64.min(height_m / 1e4), at.lat_deg);
            subjects.push((format!("{kind} from {height_m:.0} m"), watcher, outside));
        }
    }
    subjects
}

fn check_edges(gpu: &Gpu, heights_m: &[f64], terrains: &[Terrain]) {
    let mut failed = Vec::new();
    for (name, watcher, outside) in subjects() {
        for extrusion in EXTRUSIONS {
            for &terrain in terrains {
                if terrain == Terrain::Rough && watcher.pose.apex_ecef_m.length() < 6.4e6 {
                    continue;
                }
                let mut watcher = watcher.clone();
                watcher.extrusion = extrusion;
                let inside = watcher.figure.geodetic(watcher.pose.apex_ecef_m).0;
                let edge = watcher.edge_between(inside, outside, |normal| terrain.height_m(normal));
                let ground_m = terrain.height_m(watcher.figure.normal(edge));
                for &height_m in heights_m {
                    let over = camera::Pose::nadir(edge.lon_deg, edge.lat_deg, ground_m + height_m);
                    // The edge runs about north.
                    let poses = [over, over.turned(10.0, -25.0)];
                    for pose in poses {
                        if height_m > 1e6 && pose.pitch_deg > -90.0 {
                            continue;
                        }
                        let name = format!(
                            "{name}, {extrusion:?}, seen from {height_m} m at {}",
                            pose.pitch_deg
                        );
                        failed.extend(check(
                            gpu,
                            &name,
                            std::slice::from_ref(&watcher),
                            pose,
                            terrain,
                        ));
                    }
                }
            }
        }
    }
    assert!(
        failed.is_empty(),
        "{} failed:\n{}",
        failed.len(),
        failed.join("\n")
    );
}

#[test]
fn edges_are_sharp_from_one_metre_to_the_moon() {
    let Some(gpu) = gpu() else { return };
    check_edges(gpu, &[1.0, 1e4, 2e7], &[Terrain::Bare, PLATEAU]);
}

#[test]
#[ignore = "the whole; minutes"]
fn edges_are_sharp_at_every_height() {
    let Some(gpu) = gpu() else { return };
    let heights_m = [1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6, 2e7, 4e8];
    check_edges(gpu, &heights_m, &[Terrain::Bare, PLATEAU, Terrain::Rough]);
}
