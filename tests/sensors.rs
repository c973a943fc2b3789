//! Footprints drawn, judged pixel by pixel by lines of sight in f64. The pictures are small so that
//! `cargo test` stays short. The whole:
//! `cargo test --release --test sensors -- --ignored --nocapture`

mod common;

use std::f64::consts::{PI, TAU};

use common::{
    camera,
    figure::Figure,
    headless::{Gpu, gpu},
    surface::{Cast, DepthKind, Surface, Terrain},
    watch::{CountPainter, CountScore, judge_counts},
    watcher::{Optics, Watcher},
};
use glam::{DVec3, UVec2};
use globefill::{Ellipsoid, Extrusion, LonLat, View};

const SMALL: UVec2 = UVec2::new(144, 81);
const LARGE: UVec2 = UVec2::new(320, 180);
const EXTRUSIONS: [Extrusion; 2] = [Extrusion::Normal, Extrusion::Apex];
const PLATEAU: Terrain = Terrain::Plateau { height_m: 4000.0 };

/// Judges every picture before it fails, so that one run shows them all.
struct Gate<'a> {
    gpu: &'a Gpu,
    size_px: UVec2,
    /// Whether every picture is drawn with both depth conventions, not with one or the other.
    both: bool,
    pictures: usize,
    /// Those of which only a part is covered.
    with_edge: usize,
    worst_px: f64,
    failed: Vec<String>,
}

impl<'a> Gate<'a> {
    fn new(gpu: &'a Gpu, size_px: UVec2) -> Self {
        Self {
            gpu,
            size_px,
            both: false,
            pictures: 0,
            with_edge: 0,
            worst_px: 0.0,
            failed: Vec::new(),
        }
    }

    /// Draws and judges a view; answers the covered pixels.
    fn check(
        &mut self,
        name: &str,
        watchers: &[Watcher],
        pose: camera::Pose,
        terrain: Terrain,
    ) -> usize {
        let cast = Cast::new(&watchers[0].figure, &pose, self.size_px, 1, terrain);
        let kinds = [DepthKind::Reversed, DepthKind::Standard];
        let first = self.pictures % 2;
        let kinds = if self.both {
            &kinds[..]
        } else {
            &kinds[first..=first]
        };
        let mut covered = 0;
        for &depth in kinds {
            let surface = Surface::new(&cast, depth);
            let mut painter = CountPainter::new(self.gpu, watchers, &surface);
            let (drawn, _) = painter.draw(self.gpu, &mut View::default(), &surface);
            let score = judge_counts(watchers, &surface, &drawn);
            self.note(&format!("{name} {terrain:?} {depth:?}"), &score);
            covered = score.covered;
        }
        covered
    }

    fn note(&mut self, name: &str, score: &CountScore) {
        self.pictures += 1;
        self.with_edge += usize::from(score.covered > 0 && score.covered < score.surface);
        self.worst_px = self.worst_px.max(score.worst_px);
        if score.differing > 0 {
            println!("{name}: {score}");
        }
        if score.wrong > 0 {
            self.failed.push(format!("{name}: {score}"));
        }
    }

    fn finish(self) {
        println!(
            "{} pictures, {} with an edge, worst {:.4} px",
            self.pictures, self.with_edge, self.worst_px
        );
        // A picture without an edge shows little.
        assert!(3 * self.with_edge > self.pictures, "{}", self.with_edge);
        let failed = self.failed;
        assert!(
            failed.is_empty(),
            "{} failed:\n{}",
            failed.len(),
            failed.join("\n")
        );
    }
}

/// A sensor with a covered place and an uncovered one; its edge is looked at between the two.
struct Subject {
    name: String,
    watcher: Watcher,
    inside: LonLat,
    outside: LonLat,
}

/// Where the subjects are.
const AT: LonLat = LonLat::new(23.0, 41.0);

/// One sensor of each kind at each height, and such as see to the limb or a least elevation.
fn subjects() -> Vec<Subject> {
    let mut subjects = Vec::new();
    for height_m in [1e4, 5.5e5, 3.6e7] {
        let scale = if height_m > 1e7 { 0.2 } else { 1.0 };
        let kinds = [
            (
                "cone",
                Optics::Annulus {
                    inner_rad: 0.0,
                    outer_rad: 0.4 * scale,
                },
            ),
            (
                "rectangle",
                Optics::Rectangle {
                    right_rad: 0.5 * scale,
                    up_rad: 0.2 * scale,
                },
            ),
            (
                "corners",
                Optics::Corners(
                    [(0.4, -0.3), (0.1, 0.5), (-0.4, -0.2)]
                        .map(|(right, up)| (right * scale, up * scale))
                        .to_vec(),
                ),
            ),
        ];
        let east = |angle_deg: f64| LonLat::new(AT.lon_deg + angle_deg, AT.lat_deg);
        let far = east(90_f64.min(height_m / 1e4));
        for (kind, optics) in kinds {
            subjects.push(Subject {
                name: format!("{kind} from {height_m:.0} m"),
                watcher: Watcher::new(AT, height_m, 0.1 * scale, 1.0, optics),
                inside: AT,
                outside: far,
            });
        }
        let all = |inner_rad| Optics::Annulus {
            inner_rad,
            outer_rad: 2.0,
        };
        for least_deg in [None, Some(1.0), Some(10.0)] {
            let mut watcher = Watcher::new(AT, height_m, 0.3, 1.0, all(0.0));
            watcher.min_elevation_rad = least_deg.map(f64::to_radians);
            subjects.push(Subject {
                name: format!("elevation {least_deg:?} from {height_m:.0} m"),
                watcher,
                inside: AT,
                outside: east(150.0),
            });
        }
        // The inner edge, from the covered outside in.
        subjects.push(Subject {
            name: format!("inner cone from {height_m:.0} m"),
            watcher: Watcher::new(AT, height_m, 0.02, 1.0, all(0.3 * scale)),
            inside: east(if height_m > 1e7 {
                60.0
            } else {
                0.00001 * height_m
            }),
            outside: AT,
        });
    }
    subjects
}

fn check_edges(gate: &mut Gate<'_>, heights_m: &[f64], terrains: &[Terrain]) {
    for subject in subjects() {
        for extrusion in EXTRUSIONS {
            for &terrain in terrains {
                let mut watcher = subject.watcher.clone();
                watcher.extrusion = extrusion;
                let ground_m = |normal| terrain.height_m(normal);
                let edge = watcher.edge_between(subject.inside, subject.outside, ground_m);
                let ground_m = ground_m(watcher.figure.normal(edge));
                for &height_m in heights_m {
                    let mut over =
                        camera::Pose::nadir(edge.lon_deg, edge.lat_deg, ground_m + height_m);
                    // The Moon's view is a telescope's.
                    over.fov_deg = if height_m > 1e8 { 1.5 } else { 60.0 };
                    // The edge runs about north.
                    let oblique = over.turned(10.0, -25.0);
                    let poses = if height_m > 1e6 {
                        vec![over]
                    } else {
                        vec![over, oblique]
                    };
                    for pose in poses {
                        let name = format!(
                            "{}, {extrusion:?}, seen from {height_m} m at {}",
                            subject.name, pose.pitch_deg
                        );
                        gate.check(&name, std::slice::from_ref(&watcher), pose, terrain);
                    }
                }
            }
        }
    }
}

#[test]
fn edges_are_sharp_from_one_metre_to_the_moon() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu, SMALL);
    check_edges(&mut gate, &[1.0, 1e4, 2e7], &[Terrain::Bare, PLATEAU]);
    gate.finish();
}

#[test]
#[ignore = "the whole; minutes"]
fn edges_are_sharp_at_every_height() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu, LARGE);
    gate.both = true;
    let heights_m = [1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6, 2e7, 4e8];
    check_edges(
        &mut gate,
        &heights_m,
        &[Terrain::Bare, PLATEAU, Terrain::Rough],
    );
    gate.finish();
}

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

#[test]
fn other_bodies_are_seen_as_sharply() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu, SMALL);
    for ellipsoid in [Ellipsoid::MOON, Ellipsoid::MARS] {
        let smaller = |subject: &Subject| !subject.name.starts_with("inner");
        for subject in subjects().into_iter().filter(smaller) {
            for extrusion in EXTRUSIONS {
                let mut watcher = subject.watcher.clone().moved_to(ellipsoid);
                watcher.extrusion = extrusion;
                let ground_m = |normal| PLATEAU.height_m(normal);
                let far = LonLat::new(AT.lon_deg + 150.0, AT.lat_deg);
                let edge = watcher.edge_between(subject.inside, far, ground_m);
                for height_m in [10.0, 1e5] {
                    let over = camera::Pose::nadir(edge.lon_deg, edge.lat_deg, 4000.0 + height_m);
                    let name = format!("{} over {ellipsoid:?} from {height_m} m", subject.name);
                    gate.check(&name, std::slice::from_ref(&watcher), over, PLATEAU);
                }
            }
        }
    }
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
