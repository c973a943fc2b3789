//! The fills of each layer in the order of their ids: those with most triangles first, as sums of small ids
//! leave more head-room.

use super::{FillOf, MAX_LAYERS, Styled, Visible};
use crate::fill_mesh::FillMesh;

/// The fills of each layer and what their ids depend on, by layer.
pub(super) struct Members {
    /// By id, less one.
    pub fills: Vec<Vec<FillOf>>,
    /// How many triangles are drawn with the code of each id, caps and walls.
    pub triangles: Vec<Vec<u64>>,
    /// By rank, the place in the drawing order.
    pub ids: Vec<Vec<u32>>,
}

impl Members {
    pub(super) fn new(
        meshes: &[Styled<'_>],
        pieces: &[Visible<'_>],
        layer_of: &[usize],
        layer_count: usize,
    ) -> Self {
        let drawn = drawn_fills(pieces, layer_of, layer_count);
        let counts = triangles_by_rank(meshes, pieces, layer_of, &drawn);
        let ranks: Vec<Vec<u32>> = counts.iter().map(|counts| most_first(counts)).collect();
        Self {
            fills: by_id(&ranks, &drawn),
            triangles: by_id(&ranks, &counts),
            ids: ranks.iter().map(|ranks| ids_by_rank(ranks)).collect(),
        }
    }
}

/// The ranks of the greatest counts first; of equal ones, the one drawn first.
fn most_first(counts: &[u64]) -> Vec<u32> {
    let mut ranks: Vec<u32> = (0..counts.len() as u32).collect();
    ranks.sort_by_key(|&rank| std::cmp::Reverse(counts[rank as usize]));
    ranks
}

fn ids_by_rank(ranks: &[u32]) -> Vec<u32> {
    let mut ids = vec![0; ranks.len()];
    for (id, &rank) in (1..).zip(ranks) {
        ids[rank as usize] = id;
    }
    ids
}

/// What is known by rank, by id less one.
fn by_id<T: Copy>(ranks: &[Vec<u32>], by_rank: &[Vec<T>]) -> Vec<Vec<T>> {
    let layers = ranks.iter().zip(by_rank);
    let sorted = layers.map(|(ranks, by_rank)| {
        let of_id = |&rank: &u32| by_rank[rank as usize];
        ranks.iter().map(of_id).collect()
    });
    sorted.collect()
}

/// The fills of each layer, in drawing order.
fn drawn_fills(pieces: &[Visible<'_>], layer_of: &[usize], layer_count: usize) -> Vec<Vec<FillOf>> {
    let mut drawn: Vec<Vec<FillOf>> = vec![Vec::new(); layer_count];
    for (piece, &layer) in pieces.iter().zip(layer_of) {
        // Pieces of a fill follow each other.
        if drawn[layer].last() != Some(&piece.of) {
            drawn[layer].push(piece.of);
        }
    }
    drawn
}

fn triangles_by_rank(
    meshes: &[Styled<'_>],
    pieces: &[Visible<'_>],
    layer_of: &[usize],
    drawn: &[Vec<FillOf>],
) -> Vec<Vec<u64>> {
    let mut by_piece: Vec<Vec<u64>> = meshes
        .iter()
        .map(|styled| wall_triangles(styled.mesh))
        .collect();
    for (by_piece, styled) in by_piece.iter_mut().zip(meshes) {
        for (index, count) in by_piece.iter_mut().enumerate() {
            *count += 2 * most_cap_triangles(styled.mesh, index);
        }
    }
    let mut by_rank: Vec<Vec<u64>> = drawn.iter().map(|fills| vec![0; fills.len()]).collect();
    for_each_rank(pieces, layer_of, |piece, layer, rank| {
        by_rank[layer][rank] += by_piece[piece.of.mesh][piece.piece];
    });
    by_rank
}

/// The triangles of a piece at the level of detail that has most of them.
fn most_cap_triangles(mesh: &FillMesh, piece: usize) -> u64 {
    let levels = std::iter::once(mesh).chain(&mesh.coarser);
    let most = levels.map(|level| level.pieces[piece].triangle_count).max();
    most.unwrap_or(0).into()
}

/// Two for each chord; coarser levels have fewer.
fn wall_triangles(mesh: &FillMesh) -> Vec<u64> {
    let mut by_piece = vec![0; mesh.pieces.len()];
    for arc in &mesh.arcs {
        for piece in [arc.left, arc.right].into_iter().flatten() {
            by_piece[piece as usize] += 2 * u64::from(arc.vertex_count - 1);
        }
    }
    by_piece
}

/// Visits every piece with its layer and the rank of its fill there.
pub(super) fn for_each_rank(
    pieces: &[Visible<'_>],
    layer_of: &[usize],
    mut visit: impl FnMut(&Visible<'_>, usize, usize),
) {
    let mut last: [Option<(FillOf, usize)>; MAX_LAYERS] = [None; MAX_LAYERS];
    for (piece, &layer) in pieces.iter().zip(layer_of) {
        let rank = match last[layer] {
            Some((fill, rank)) if fill == piece.of => rank,
            Some((_, rank)) => rank + 1,
            None => 0,
        };
        last[layer] = Some((piece.of, rank));
        visit(piece, layer, rank);
    }
}
