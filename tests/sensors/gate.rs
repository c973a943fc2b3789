//! Pictures drawn and judged.

use glam::UVec2;
use globefill::View;

use crate::common::{
    camera,
    headless::Gpu,
    surface::{Cast, DepthKind, Surface, Terrain},
    watch::{CountPainter, CountScore, judge_counts},
    watcher::Watcher,
};

/// Judges every picture before it fails, so that one run shows them all.
pub struct Gate<'a> {
    gpu: &'a Gpu,
    size_px: UVec2,
    /// Whether every picture is drawn with both depth conventions, not with one or the other.
    pub both: bool,
    pub pictures: usize,
    /// Those of which only a part is covered.
    pub with_edge: usize,
    pub worst_px: f64,
    pub failed: Vec<String>,
}

impl<'a> Gate<'a> {
    pub fn new(gpu: &'a Gpu, size_px: UVec2) -> Self {
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
    pub fn check(
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

    pub fn note(&mut self, name: &str, score: &CountScore) {
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

    pub fn finish(self) {
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
