//! Wrong pixels, counted against the oracle: 0 is the only pass.
//!
//! The pictures are small so that `cargo test` stays short. The full-size run:
//! `cargo test --release --test accuracy -- --ignored --nocapture`

mod common;

use std::time::Instant;

use common::{
    camera::Pose,
    draw::IdPainter,
    figure::Figure,
    headless::{Gpu, gpu},
    oracle::Oracle,
    pair_mesh::Pair,
    score::{Score, judge},
    surface::{DepthKind, Surface, Terrain},
};
use glam::UVec2;
use globefill::{CountTechnique, EdgeKind, Ellipsoid, FillMesh, LonLat, Region, View};

const SMALL: UVec2 = UVec2::new(320, 180);
const FULL: UVec2 = UVec2::new(1280, 720);
const TECHNIQUES: [CountTechnique; 2] = [CountTechnique::Winding, CountTechnique::Stencil];
const DEPTHS: [DepthKind; 2] = [DepthKind::Reversed, DepthKind::Standard];

/// Regions, their mesh and their judge.
struct Subject {
    name: String,
    mesh: FillMesh,
    oracle: Oracle,
}

impl Subject {
    fn new(name: &str, regions: &[Region], mesh: FillMesh) -> Self {
        Self {
            name: name.to_owned(),
            mesh,
            oracle: Oracle::new(regions, Ellipsoid::WGS84),
        }
    }

    fn pair(name: &str, pair: Pair) -> Self {
        Self::new(name, &pair.regions(), pair.mesh())
    }
}

/// What a picture is drawn under.
#[derive(Clone, Copy)]
struct Setting {
    pose: Pose,
    terrain: Terrain,
    depth: DepthKind,
    samples: u32,
    count: CountTechnique,
}

/// Draws and judges one picture; prints a line of figures.
fn check(gpu: &Gpu, subject: &Subject, setting: Setting, size_px: UVec2) -> Score {
    let start = Instant::now();
    let Setting {
        pose,
        terrain,
        depth,
        samples,
        count,
    } = setting;
    let figure = subject.oracle.figure;
    let surface = Surface::new(&figure, &pose, size_px, samples, terrain, depth);
    let cast_s = start.elapsed().as_secs_f64();
    let mut painter = IdPainter::new(gpu, subject.mesh.clone(), &surface, count);
    let picture = painter.draw(gpu, &mut View::default(), &surface, 0.0);
    let drawn_s = start.elapsed().as_secs_f64();
    assert_eq!(
        picture.stats.technique, count,
        "{}: head-room",
        subject.name
    );
    let score = judge(&subject.oracle, &surface, &picture.ids, 0.0);
    println!(
        "{:<34} {:>9} m pitch {:>3} {terrain:?} {depth:?} {count:?} ×{samples}: covered {} of {}, \
         differing {}, wrong {} (stray {}, limb {}, sky {}), worst {:.4} px; \
         {} refined, {} vertices; {cast_s:.1} + {:.1} + {:.1} s",
        subject.name,
        pose.height_m,
        pose.pitch_deg,
        score.covered,
        score.surface,
        score.differing,
        score.wrong,
        score.stray,
        score.wrong_at_limb,
        score.sky,
        score.worst_px,
        picture.stats.refined_chords,
        picture.stats.vertices,
        drawn_s - cast_s,
        start.elapsed().as_secs_f64() - drawn_s,
    );
    if !score.is_clean() {
        println!("    x, y, drawn, expected, px: {:?}", score.examples);
    }
    score
}

/// Judges every case before it fails, so that one run shows them all.
#[derive(Default)]
struct Tally {
    pictures: usize,
    failed: Vec<String>,
}

impl Tally {
    fn check(&mut self, gpu: &Gpu, subject: &Subject, setting: Setting, size_px: UVec2) {
        let score = check(gpu, subject, setting, size_px);
        self.pictures += 1;
        assert!(score.surface > 0, "{}: only sky", subject.name);
        if !score.is_clean() {
            self.failed.push(format!("{}: {score:?}", subject.name));
        }
    }

    fn finish(self) {
        assert!(self.pictures > 0);
        assert!(
            self.failed.is_empty(),
            "{} of {} pictures have wrong pixels:\n{}",
            self.failed.len(),
            self.pictures,
            self.failed.join("\n")
        );
    }
}

/// Height of the eye above the terrain at a place.
fn above(terrain: Terrain, at: LonLat, height_m: f64) -> f64 {
    let figure = Figure::new(Ellipsoid::WGS84);
    terrain.height_m(figure.normal(at)) + height_m
}

/// Nadir over the middle of one 100 km edge: where a chord, a skew wall and single precision show.
fn over_the_middle_of_an_edge(size_px: UVec2, techniques: &[CountTechnique], depths: &[DepthKind]) {
    let Some(gpu) = gpu() else { return };
    let mut tally = Tally::default();
    let terrains = [
        Terrain::Bare,
        Terrain::Plateau { height_m: 4000.0 },
        Terrain::Rough,
    ];
    for kind in [EdgeKind::Straight, EdgeKind::Rhumb, EdgeKind::Geodesic] {
        let pair = Pair::about(kind, 11.0, 47.0, 65.0, 0.9);
        let subject = Subject::pair(&format!("{kind:?} edge of 100 km"), pair);
        // The middle of the true edge, by the oracle.
        let edge = subject.oracle.boundary(0).next().expect("a triangle");
        let middle = edge.point(&subject.oracle.figure, 0.5);
        for terrain in terrains {
            for height_m in [1.0, 10.0, 100.0, 10_000.0] {
                for &depth in depths {
                    for &count in techniques {
                        let height_m = above(terrain, middle, height_m);
                        let pose = Pose::nadir(middle.lon_deg, middle.lat_deg, height_m);
                        let setting = Setting {
                            pose,
                            terrain,
                            depth,
                            samples: 1,
                            count,
                        };
                        tally.check(gpu, &subject, setting, size_px);
                    }
                }
            }
        }
    }
    tally.finish();
}

#[test]
fn nothing_is_wrong_over_the_middle_of_an_edge() {
    over_the_middle_of_an_edge(SMALL, &TECHNIQUES, &DEPTHS);
}

#[test]
#[ignore = "full size; see the head of this file"]
fn nothing_is_wrong_over_the_middle_of_an_edge_at_full_size() {
    over_the_middle_of_an_edge(FULL, &TECHNIQUES, &DEPTHS);
}
