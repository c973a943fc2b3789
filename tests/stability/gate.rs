//! The gate: every cell is drawn, judged and printed; then none may have failed.

use std::{
    sync::atomic::{AtomicUsize, Ordering},
    time::Instant,
};

use glam::UVec2;

use crate::{
    common::{
        headless::Gpu,
        score::{expected_ids, judge},
        surface::{Cast, Surface},
    },
    shot::Shot,
    stage::{Stage, TECHNIQUES},
    subject::Subject,
};

const SIZE_PX: UVec2 = UVec2::new(320, 180);

/// Cells of all tests of this process.
static ALL_CELLS: AtomicUsize = AtomicUsize::new(0);

pub struct Gate<'a> {
    name: &'static str,
    stage: Stage<'a>,
    started: Instant,
    subjects: usize,
    cells: usize,
    /// Cells with a boundary in view.
    divided: usize,
    /// Cells where the stencil had to count for want of head-room.
    counted_by_stencil: usize,
    failed: Vec<String>,
}

impl<'a> Gate<'a> {
    pub fn new(name: &'static str, gpu: &'a Gpu) -> Self {
        Self {
            name,
            stage: Stage::new(gpu),
            started: Instant::now(),
            subjects: 0,
            cells: 0,
            divided: 0,
            counted_by_stencil: 0,
            failed: Vec::new(),
        }
    }

    /// Judges all cells of a subject.
    pub fn check(&mut self, subject: &Subject, shots: &[Shot]) {
        self.subjects += 1;
        self.stage.clear();
        for shot in shots {
            self.check_shot(subject, shot);
        }
    }

    fn check_shot(&mut self, subject: &Subject, shot: &Shot) {
        let figure = &subject.oracle.figure;
        let pose = shot.pose(figure, &subject.foci);
        let cast = Cast::new(figure, &pose, SIZE_PX, 1, shot.terrain);
        let surface = Surface::new(&cast, shot.depth);
        let expected = expected_ids(&subject.oracle, &surface);
        let pictures = [0, 1].map(|technique| self.stage.draw(subject, &surface, technique));
        let disagreeing = (0..surface.pixel_count())
            .filter(|&pixel| pictures[0].ids[pixel] != pictures[1].ids[pixel])
            .count();
        for (picture, technique) in pictures.iter().zip(TECHNIQUES) {
            let score = judge(&subject.oracle, &surface, &expected, &picture.ids, 0.0);
            let wrong = score.wrong + score.sky;
            let cell = format!(
                "{} | {} | {} | {technique:?} | {wrong} | {disagreeing} | {}",
                subject.name,
                subject.placement,
                shot.name(),
                score.surface
            );
            println!("{cell}");
            assert!(score.surface > 0, "{cell}: only sky");
            self.cells += 1;
            let plain = expected
                .iter()
                .zip(&surface.points_m)
                .filter(|(_, seen)| seen.is_some());
            let mut ids = plain.map(|(id, _)| id);
            let first = ids.next();
            self.divided += usize::from(ids.any(|id| Some(id) != first));
            self.counted_by_stencil += usize::from(picture.stats.technique != technique);
            if wrong + disagreeing > 0 {
                self.failed
                    .push(format!("{cell}: {score}; {:?}", score.examples));
            }
        }
    }

    pub fn finish(self) {
        assert!(self.cells > 0);
        let Self {
            name,
            subjects,
            cells,
            divided,
            counted_by_stencil,
            failed,
            ..
        } = self;
        let all = ALL_CELLS.fetch_add(cells, Ordering::Relaxed) + cells;
        println!(
            "total of {name}: {cells} cells of {subjects} placed shapes, {divided} with a boundary in view, {} failed, \
             {counted_by_stencil} without head-room for winding, {:.0} s; {all} cells so far",
            failed.len(),
            self.started.elapsed().as_secs_f64()
        );
        assert!(
            failed.is_empty(),
            "{name}: {} of {cells} cells failed:\n{}",
            failed.len(),
            failed.join("\n")
        );
    }
}
