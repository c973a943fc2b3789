//! Pictures drawn with both techniques and judged against the oracle.

use std::time::Instant;

use glam::UVec2;
use globefill::{CountTechnique, EdgeKind, Ellipsoid, FillMesh, LonLat, View};

use crate::common::{
    camera::Pose,
    draw::IdPainter,
    figure::Figure,
    headless::Gpu,
    oracle::Oracle,
    pair_mesh::Pair,
    score::{expected_ids, judge},
    surface::{Cast, DepthKind, Surface, Terrain},
};

pub const SIZE: UVec2 = UVec2::new(320, 180);
pub const TECHNIQUES: [CountTechnique; 2] = [CountTechnique::Winding, CountTechnique::Stencil];
pub const PLATEAU: Terrain = Terrain::Plateau { height_m: 4000.0 };

/// Two fills with a common edge of about 100 km, and their judge.
pub struct Subject {
    pub mesh: FillMesh,
    pub oracle: Oracle,
}

impl Subject {
    pub fn pair() -> Self {
        let pair = Pair::about(EdgeKind::Straight, 11.0, 47.0, 65.0, 0.9);
        Self {
            mesh: pair.mesh(),
            oracle: Oracle::new(&pair.regions(), Ellipsoid::WGS84),
        }
    }

    /// Somewhere on the common edge.
    pub fn on_edge(&self, t: f64) -> LonLat {
        let edge = self.oracle.boundary(0).next().expect("a triangle");
        edge.point(&self.oracle.figure, t)
    }

    /// Straight down from `height_m` above the terrain over the middle of the common edge.
    pub fn pose(&self, terrain: Terrain, height_m: f64) -> Pose {
        let at = self.on_edge(0.5);
        let ground_m = terrain.height_m(figure().normal(at));
        Pose::nadir(at.lon_deg, at.lat_deg, ground_m + height_m)
    }
}

pub fn figure() -> Figure {
    Figure::new(Ellipsoid::WGS84)
}

pub fn cast(pose: &Pose, terrain: Terrain) -> Cast {
    Cast::new(&figure(), pose, SIZE, 1, terrain)
}

/// Judges every picture before it fails, so that one run shows them all.
pub struct Gate<'a> {
    pub gpu: &'a Gpu,
    pictures: usize,
    with_edge: usize,
    failed: Vec<String>,
}

impl<'a> Gate<'a> {
    pub fn new(gpu: &'a Gpu) -> Self {
        Self {
            gpu,
            pictures: 0,
            with_edge: 0,
            failed: Vec::new(),
        }
    }

    /// Draws and judges a view with each kind of depth.
    pub fn check(&mut self, subject: &Subject, pose: Pose, terrain: Terrain, kinds: &[DepthKind]) {
        let cast = cast(&pose, terrain);
        for &kind in kinds {
            let name = format!(
                "from {:.2} m, heading {}, pitch {}, fov {}, parallel {:?}, {terrain:?}, {kind:?}",
                pose.height_m, pose.heading_deg, pose.pitch_deg, pose.fov_deg, pose.parallel_m
            );
            self.judge(&name, subject, &Surface::new(&cast, kind));
        }
    }

    /// Draws and judges a surface; both techniques must agree pixel for pixel.
    pub fn judge(&mut self, name: &str, subject: &Subject, surface: &Surface) {
        let expected = expected_ids(&subject.oracle, surface);
        let pictures = TECHNIQUES.map(|count| {
            let start = Instant::now();
            let mut painter = IdPainter::new(self.gpu, subject.mesh.clone(), surface, count);
            let picture = painter.draw(self.gpu, &mut View::default(), surface, 0.0);
            let ms = start.elapsed().as_millis();
            assert_eq!(picture.stats.technique, count, "{name}: no head-room");
            let score = judge(&subject.oracle, surface, &expected, &picture.ids, 0.0);
            println!("{name}, {count:?}: {score}; {ms} ms");
            assert!(score.surface > 0, "{name}: only sky");
            self.pictures += 1;
            if !score.is_clean() {
                let examples = &score.examples;
                self.failed
                    .push(format!("{name}, {count:?}: {score}; {examples:?}"));
            }
            picture.ids
        });
        let mut seen = expected;
        seen.sort_unstable();
        seen.dedup();
        self.with_edge += 2 * usize::from(seen.len() > 1);
        let disagreeing = (0..surface.pixel_count())
            .filter(|&pixel| pictures[0][pixel] != pictures[1][pixel])
            .count();
        if disagreeing > 0 {
            self.failed
                .push(format!("{name}: techniques disagree at {disagreeing}"));
        }
    }

    pub fn finish(self) {
        println!(
            "{} pictures, {} with an edge",
            self.pictures, self.with_edge
        );
        // A picture without an edge shows little.
        assert!(2 * self.with_edge > self.pictures);
        assert!(
            self.failed.is_empty(),
            "{} failures in {} pictures:\n{}",
            self.failed.len(),
            self.pictures,
            self.failed.join("\n")
        );
    }
}
