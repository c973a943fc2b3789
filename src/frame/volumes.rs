//! Closed volumes, one a fill: what the stencil technique counts fill by fill.

use std::{collections::HashMap, ops::Range};

use crate::{
    fill_mesh::FillMesh,
    frame::select::{LayerDraws, PatchRun, slot},
};

/// The faces of one fill's volume. Shared walls are stored for the fill on their left; seen from the
/// fill on their right they face the other way.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Volume {
    /// A piece of the fill, for its code.
    pub piece: u32,
    pub caps: Vec<Range<u32>>,
    pub left_of: Walls,
    pub right_of: Walls,
}

/// Walls, as boundary slots and as patch indices.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Walls {
    pub slots: Vec<Range<u32>>,
    pub patches: Vec<Range<u32>>,
}

/// The volumes of the fills that a mesh has in a layer.
pub(crate) fn volumes(mesh: &FillMesh, draws: &LayerDraws) -> Vec<Volume> {
    let mut builder = Builder {
        mesh,
        codes: &draws.codes,
        index_of_fill: HashMap::new(),
        volumes: Vec::new(),
    };
    for run in &draws.caps {
        if let Some(piece) = run.piece {
            builder.volume(piece).caps.push(run.triangles.clone());
        }
    }
    for slots in &draws.walls {
        builder.add_walls(slots);
    }
    for run in &draws.patches {
        builder.add_patch(run);
    }
    builder.volumes
}

struct Builder<'a> {
    mesh: &'a FillMesh,
    codes: &'a [u32],
    index_of_fill: HashMap<u32, usize>,
    volumes: Vec<Volume>,
}

impl Builder<'_> {
    fn volume(&mut self, piece: u32) -> &mut Volume {
        let fill = self.mesh.pieces[piece as usize].fill;
        let index = *self.index_of_fill.entry(fill).or_insert_with(|| {
            self.volumes.push(Volume {
                piece,
                ..Default::default()
            });
            self.volumes.len() - 1
        });
        &mut self.volumes[index]
    }

    /// Splits a run of slots into arcs and gives each to the fills beside it.
    fn add_walls(&mut self, slots: &Range<u32>) {
        let arcs = &self.mesh.arcs;
        // Slots grow with the arcs: the first one that ends behind the run's start.
        let (mut index, mut behind) = (0, arcs.len());
        while index < behind {
            let middle = (index + behind) / 2;
            let arc = &arcs[middle];
            if slot(middle as u32, arc.first_vertex + arc.vertex_count) <= slots.start {
                index = middle + 1;
            } else {
                behind = middle;
            }
        }
        while index < arcs.len() {
            let arc = &arcs[index];
            let first = slot(index as u32, arc.first_vertex);
            let part = first.max(slots.start)..(first + arc.vertex_count).min(slots.end);
            if part.start >= slots.end {
                break;
            }
            let (left, right) = self.sides(index as u32);
            if let Some(piece) = left {
                self.volume(piece).left_of.slots.push(part.clone());
            }
            if let Some(piece) = right {
                self.volume(piece).right_of.slots.push(part);
            }
            index += 1;
        }
    }

    fn add_patch(&mut self, run: &PatchRun) {
        let (left, right) = self.sides(run.arc);
        if let Some(piece) = left {
            self.volume(piece).left_of.patches.push(run.indices.clone());
        }
        if let Some(piece) = right {
            self.volume(piece)
                .right_of
                .patches
                .push(run.indices.clone());
        }
    }

    /// The pieces beside an arc that are drawn in this layer.
    fn sides(&self, arc: u32) -> (Option<u32>, Option<u32>) {
        let arc = &self.mesh.arcs[arc as usize];
        let drawn = |side: Option<u32>| side.filter(|&piece| self.codes[piece as usize + 1] != 0);
        (drawn(arc.left), drawn(arc.right))
    }
}
