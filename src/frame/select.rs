//! Selection: what of a mesh one view draws in one frame.

use std::ops::Range;

use crate::{
    fill_mesh::{Arc, CapChunk, FillMesh, Piece},
    frame::beyond::Beyond,
    frame::code::PlaneSums,
    frame::edge_draws::{ArcEdges, EdgeDraws, EdgeWants},
    frame::edge_segments::EdgeSegments,
    frame::layer_set::LayerSet,
    frame::layers::{Coded, PieceCode},
    frame::refine::Patch,
    frame::sight::Sight,
    options::CountTechnique,
};

/// What is drawn of one mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Selection {
    pub layers: Vec<LayerDraws>,
    /// Finer walls in the place of chords near the eye.
    pub patch: Patch,
    /// The pieces of refined chords whose edges are wanted.
    pub segments: EdgeSegments,
    pub fills_drawn: u32,
    pub fills_culled: u32,
}

/// Draws of one mesh in one layer.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct LayerDraws {
    /// By piece plus one: packed winding code; 0 for what is not in this layer, hidden or culled.
    pub codes: Vec<u32>,
    pub caps: Vec<CapRun>,
    /// Boundary slots of wall strips.
    pub walls: Vec<Range<u32>>,
    pub patches: Vec<PatchRun>,
    pub edges: EdgeDraws,
}

/// Contiguous triangles.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CapRun {
    /// The first piece, if all have one code.
    pub piece: Option<u32>,
    pub triangles: Range<u32>,
    /// Whether the top caps are drawn, too: not where all surface lies behind them, since only faces
    /// behind the surface count.
    pub tops: bool,
}

impl CapRun {
    /// Top and bottom caps drawn, as instances of extrude.wgsl.
    pub(crate) fn instances(&self) -> Range<u32> {
        let first = 2 * self.piece.unwrap_or(0);
        first + u32::from(!self.tops)..first + 2
    }

    /// What it is made of.
    pub(crate) fn chunks<'a>(&self, mesh: &'a FillMesh) -> &'a [CapChunk] {
        let before = |triangle| {
            let chunks = &mesh.cap_chunks;
            chunks.partition_point(|chunk| chunk.first_triangle < triangle)
        };
        &mesh.cap_chunks[before(self.triangles.start)..before(self.triangles.end)]
    }
}

/// Contiguous indices of a patch that belong to one arc.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PatchRun {
    pub arc: u32,
    pub indices: Range<u32>,
}

/// Slot of a boundary vertex on the GPU: one slot separates an arc from the next.
pub(crate) fn slot(arc: u32, vertex: u32) -> u32 {
    vertex + arc
}

impl Selection {
    /// Culls, refines and lists what to draw.
    pub(crate) fn of(
        mesh: &FillMesh,
        coded: Coded<'_>,
        sight: &Sight,
        wants: &EdgeWants<'_>,
    ) -> Self {
        let codes = coded.codes;
        let least_cos_squared = sight.least_cos_squared();
        // Strokes show pieces that are too small to be seen themselves.
        let is_missed = |piece: &Piece| {
            !wants.slots.is_empty() || !sight.is_within_budget(&piece.bounds, least_cos_squared)
        };
        let is_shown = |piece: &Piece| !sight.beyond_horizon(&piece.bounds) && is_missed(piece);
        let shown: Vec<Option<PieceCode>> = mesh
            .pieces
            .iter()
            .zip(codes)
            .map(|(piece, code)| code.filter(|_| is_shown(piece)))
            .collect();
        let mut selection = Self::default();
        selection.count_fills(mesh, codes, &shown);
        let arc_seen: Vec<bool> = mesh
            .arcs
            .iter()
            .map(|arc| !sight.outside_side_plane(&arc.bounds))
            .collect();
        let edges = ArcEdges::new(mesh, &shown, sight, wants);
        // Coarser levels are drawn where they do as they are, and know no true edges.
        let refinable = if mesh.curves.is_empty() {
            &[]
        } else {
            &mesh.arcs[..]
        };
        for (index, arc) in refinable.iter().enumerate() {
            let shown_on = |side: Option<u32>| side.and_then(|piece| shown[piece as usize]);
            let seen = arc_seen[index] || edges.any(index);
            if seen && shown_on(arc.left) != shown_on(arc.right) {
                selection.patch.refine_arc(mesh, index as u32, sight);
            }
        }
        selection.segments = EdgeSegments::new(&selection.patch, &edges, wants);
        // The stencil counts fill by fill.
        let mixing = coded.technique == CountTechnique::Winding;
        selection.layers = (0..coded.layers)
            .map(|layer| {
                let in_layer: Vec<u32> = std::iter::once(0)
                    .chain(shown.iter().map(|code| match code {
                        Some(code) if code.layer == layer => code.packed,
                        _ => 0,
                    }))
                    .collect();
                LayerDraws {
                    caps: cap_runs(mesh, &in_layer, sight, mixing),
                    walls: wall_runs(mesh, &in_layer, &arc_seen, &selection.patch, sight),
                    patches: patch_runs(mesh, &in_layer, &arc_seen, &selection.patch),
                    edges: EdgeDraws {
                        chords: slot_runs(mesh, &selection.patch, |arc| {
                            edges.wanted(layer, arc) && !edges.flat(arc)
                        }),
                        flat: slot_runs(mesh, &selection.patch, |arc| {
                            edges.wanted(layer, arc) && edges.flat(arc)
                        }),
                        segments: selection
                            .segments
                            .runs(&selection.patch, |arc| edges.wanted(layer, arc)),
                    },
                    codes: in_layer,
                }
            })
            .collect();
        selection
    }

    /// Adds the layers in which anything is drawn.
    pub(crate) fn add_shown(&self, shown: &mut LayerSet) {
        let layers = self.layers.iter().enumerate();
        layers
            .filter(|(_, draws)| !draws.is_empty())
            .for_each(|(layer, _)| shown.insert(layer));
    }

    fn count_fills(
        &mut self,
        mesh: &FillMesh,
        codes: &[Option<PieceCode>],
        shown: &[Option<PieceCode>],
    ) {
        for fill in &mesh.fills {
            let pieces = fill.first_piece as usize..(fill.first_piece + fill.piece_count) as usize;
            let any =
                |codes: &[Option<PieceCode>]| codes[pieces.clone()].iter().any(Option::is_some);
            if any(shown) {
                self.fills_drawn += 1;
            } else if any(codes) {
                self.fills_culled += 1;
            }
        }
    }
}

impl LayerDraws {
    /// Whether nothing is drawn.
    fn is_empty(&self) -> bool {
        let volumes = self.caps.is_empty() && self.walls.is_empty() && self.patches.is_empty();
        volumes && self.edges.is_empty()
    }

    /// Upper bounds, by plane, of |partial sum| at any pixel: all that is drawn of `mesh` added up.
    pub(crate) fn add_sums(&self, mesh: &FillMesh, sums: &mut PlaneSums) {
        let mut add = |triangles: usize, code: [u32; 4]| {
            for (sum, digit) in sums.iter_mut().zip(code) {
                *sum += triangles as u64 * u64::from(digit);
            }
        };
        for run in &self.caps {
            for chunk in run.chunks(mesh) {
                let code = self.codes[chunk.piece as usize + 1].to_le_bytes();
                let triangles = chunk.triangle_count as usize * run.instances().len();
                add(triangles, code.map(u32::from));
            }
        }
        let weight = |arc: &Arc| {
            let [left, right] =
                [arc.left, arc.right].map(|side| code_of(&self.codes, side).to_le_bytes());
            std::array::from_fn(|plane| left[plane].abs_diff(right[plane]).into())
        };
        if !self.walls.is_empty() {
            for arc in &mesh.arcs {
                add(2 * (arc.vertex_count as usize - 1), weight(arc));
            }
        }
        for run in &self.patches {
            add(run.indices.len() / 3, weight(&mesh.arcs[run.arc as usize]));
        }
    }
}

fn code_of(codes: &[u32], side: Option<u32>) -> u32 {
    side.map_or(0, |piece| codes[piece as usize + 1])
}

fn cap_runs(mesh: &FillMesh, codes: &[u32], sight: &Sight, mixing: bool) -> Vec<CapRun> {
    let mut runs: Vec<CapRun> = Vec::new();
    let code_of = |piece: u32| codes[piece as usize + 1];
    for chunk in &mesh.cap_chunks {
        let unseen =
            || sight.outside_side_plane(&chunk.bounds) || sight.is_flat_over(&chunk.bounds);
        if code_of(chunk.piece) == 0 || unseen() {
            continue;
        }
        let triangles = chunk.first_triangle..chunk.first_triangle + chunk.triangle_count;
        let tops = !sight.tops_hide_surface(&chunk.bounds);
        if let Some(run) = runs.last_mut()
            && (run.triangles.end, run.tops) == (triangles.start, tops)
        {
            let alike = run.piece.map(code_of) == Some(code_of(chunk.piece));
            if alike || mixing {
                run.piece = run.piece.filter(|_| alike);
                run.triangles.end = triangles.end;
                continue;
            }
        }
        runs.push(CapRun {
            piece: Some(chunk.piece),
            triangles,
            tops,
        });
    }
    runs
}

fn wall_runs(
    mesh: &FillMesh,
    codes: &[u32],
    arc_seen: &[bool],
    patch: &Patch,
    sight: &Sight,
) -> Vec<Range<u32>> {
    let runs = slot_runs(mesh, patch, |index| {
        let arc = &mesh.arcs[index];
        let weighs = code_of(codes, arc.left) != code_of(codes, arc.right);
        arc_seen[index] && weighs && !sight.is_flat_over(&arc.bounds)
    });
    match sight.beyond {
        Some(beyond) => without_flat(mesh, runs, &beyond),
        None => runs,
    }
}

/// As many chords without height are worth another draw.
const LEAST_FLAT: u32 = 32;

/// What is left of runs of slots without the longer stretches where walls have no height.
fn without_flat(mesh: &FillMesh, runs: Vec<Range<u32>>, beyond: &Beyond) -> Vec<Range<u32>> {
    let mut left = Vec::with_capacity(runs.len());
    let mut arcs = (0..).zip(&mesh.arcs).peekable();
    for run in runs {
        let mut start = run.start;
        let end_of = |index: u32, arc: &Arc| slot(index, arc.first_vertex) + arc.vertex_count;
        while arcs
            .next_if(|(index, arc)| end_of(*index, arc) <= run.start)
            .is_some()
        {}
        let mut within = arcs.clone();
        while let Some((index, arc)) =
            within.next_if(|(index, arc)| slot(*index, arc.first_vertex) < run.end)
        {
            if !beyond.holds_some(&arc.bounds) {
                continue;
            }
            let first = slot(index, arc.first_vertex).max(run.start);
            let end = end_of(index, arc).min(run.end);
            let mut flat_from = first;
            for at in first..=end {
                let is_flat = at < end && beyond.holds_point(mesh.vertices[(at - index) as usize]);
                if is_flat {
                    continue;
                }
                if at - flat_from > LEAST_FLAT {
                    // Not where only the way from one flat stretch to the next is left.
                    if flat_from > first || start + 2 != first {
                        left.push(start..flat_from + 1);
                    }
                    start = at - 1;
                }
                flat_from = at + 1;
            }
        }
        left.push(start..run.end);
    }
    left.retain(|run| run.len() > 1);
    left
}

/// The slots of the arcs that are drawn, without their refined chords.
fn slot_runs(mesh: &FillMesh, patch: &Patch, drawn: impl Fn(usize) -> bool) -> Vec<Range<u32>> {
    let mut runs: Vec<Range<u32>> = Vec::new();
    let mut refined = patch.chords.iter().peekable();
    for (index, arc) in (0..).zip(&mesh.arcs) {
        let mut start = arc.first_vertex;
        let end = arc.first_vertex + arc.vertex_count;
        let drawn = drawn(index as usize);
        while let Some(chord) = refined.next_if(|chord| chord.arc == index) {
            if drawn {
                let slots = slot(index, start)..slot(index, chord.vertex + 1);
                add_wall_run(&mut runs, slots, start == arc.first_vertex);
            }
            start = chord.vertex + 1;
        }
        if drawn {
            let slots = slot(index, start)..slot(index, end);
            add_wall_run(&mut runs, slots, start == arc.first_vertex);
        }
    }
    runs
}

/// Joins an arc's run to that of the arc before, over the break; drops one without a chord.
fn add_wall_run(runs: &mut Vec<Range<u32>>, slots: Range<u32>, starts_arc: bool) {
    if slots.len() < 2 {
        return;
    }
    match runs.last_mut() {
        Some(last) if starts_arc && last.end + 1 == slots.start => last.end = slots.end,
        _ => runs.push(slots),
    }
}

fn patch_runs(mesh: &FillMesh, codes: &[u32], arc_seen: &[bool], patch: &Patch) -> Vec<PatchRun> {
    let mut runs: Vec<PatchRun> = Vec::new();
    for chord in &patch.chords {
        let arc = &mesh.arcs[chord.arc as usize];
        // Arcs out of sight are refined for the edges within their reach alone.
        let weighs = code_of(codes, arc.left) != code_of(codes, arc.right);
        if !weighs || !arc_seen[chord.arc as usize] {
            continue;
        }
        let indices = chord.first_index..chord.first_index + chord.index_count;
        match runs.last_mut() {
            Some(run) if run.arc == chord.arc && run.indices.end == indices.start => {
                run.indices.end = indices.end;
            }
            _ => runs.push(PatchRun {
                arc: chord.arc,
                indices,
            }),
        }
    }
    runs
}

#[cfg(all(test, feature = "countries"))]
mod tests;
