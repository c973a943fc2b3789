//! What the count passes cost.

use crate::view::MeshView;

/// What the count passes of one mesh cost.
#[derive(Default)]
pub(crate) struct Cost {
    pub draws: u32,
    pub vertices: u64,
}

impl Cost {
    fn add(&mut self, vertices: usize, times: u64) {
        self.draws += times as u32;
        self.vertices += vertices as u64 * times;
    }
}

/// Counts what `Recorder` records.
pub(crate) fn cost(view: &MeshView) -> Cost {
    let mut cost = Cost::default();
    if view.volumes.is_empty() {
        for draws in &view.selection.layers {
            for run in &draws.caps {
                cost.draws += 1;
                cost.vertices += (3 * run.triangles.len() * run.instances().len()) as u64;
            }
            draws
                .walls
                .iter()
                .for_each(|slots| cost.add(2 * slots.len(), 1));
            draws
                .patches
                .iter()
                .for_each(|run| cost.add(run.indices.len(), 1));
        }
    }
    // Count, cover and reject draw the same.
    for volume in view.volumes.iter().flatten() {
        for triangles in &volume.caps {
            cost.add(3 * triangles.len(), 6);
        }
        for walls in [&volume.left_of, &volume.right_of] {
            walls
                .slots
                .iter()
                .for_each(|slots| cost.add(2 * slots.len(), 3));
            walls
                .patches
                .iter()
                .for_each(|indices| cost.add(indices.len(), 3));
        }
    }
    cost
}
