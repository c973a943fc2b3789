//! Coarser meshes of the same pieces and arcs, for eyes far away.

use std::collections::HashMap;

use rayon::prelude::*;

use crate::{
    fill_mesh::{Arc, BoundaryVertex, FillMesh, Piece},
    limits::{Excess, Limits},
    mesh::simplify::{KeptVertices, Simplifier},
};

/// From one level of detail to the next chords may lie so many times farther beside the true edges.
const STEP: f64 = 4.0;
/// Chords of the coarsest level may lie so far beside the true edges, in equatorial radii: 64 km on Earth,
/// a quarter of a pixel from 1.6·10⁸ m.
const COARSEST: f64 = 0.01;
/// Meshes of fewer boundary vertices cost next to nothing whatever is left of them.
const WORTHWHILE: usize = 256;
/// A level is kept if it has at most this share of the boundary vertices of the one before.
const SHARE: f64 = 0.6;

/// The levels of detail beyond the mesh itself, each coarser than the one before.
pub(crate) fn coarser(
    mesh: &FillMesh,
    inside_sr: &[f64],
    tolerance_m: f64,
    limits: &Limits,
) -> Result<Vec<FillMesh>, Excess> {
    let mut levels: Vec<FillMesh> = Vec::new();
    if mesh.boundary.len() < WORTHWHILE {
        return Ok(levels);
    }
    let loops = piece_loops(mesh);
    let mut origins: Vec<u32> = (0..mesh.boundary.len() as u32).collect();
    let [least_m, coarsest_m] = [1e-6, COARSEST].map(|share| share * mesh.ellipsoid.a_m);
    let first_m = tolerance_m.max(least_m) * STEP;
    let mut tolerances_m =
        std::iter::successors(Some(first_m), |tolerance_m| Some(tolerance_m * STEP))
            .take_while(|&tolerance_m| tolerance_m <= coarsest_m);
    loop {
        let finer = levels.last().unwrap_or(mesh);
        if finer.boundary.len() < WORTHWHILE {
            return Ok(levels);
        }
        let simplifier = Simplifier::new(finer, mesh, &origins);
        let most = SHARE * finer.boundary.len() as f64;
        let few = |kept: &Vec<KeptVertices>| {
            kept.iter().map(|kept| kept.vertices.len()).sum::<usize>() as f64 <= most
        };
        let Some(kept) = tolerances_m
            .by_ref()
            .map(|tolerance_m| simplifier.kept(tolerance_m))
            .find(few)
        else {
            return Ok(levels);
        };
        let mut level = simplified(finer, &kept);
        let loops_of = |piece: usize| loop_vertices(&level.arcs, &loops[piece]);
        let loops_of: Vec<_> = (0..loops.len()).into_par_iter().map(loops_of).collect();
        level.add_caps(|piece| loops_of[piece].clone(), inside_sr, limits)?;
        let vertices = kept.iter().flat_map(|kept| &kept.vertices);
        origins = vertices.map(|&vertex| origins[vertex as usize]).collect();
        levels.push(level);
    }
}

/// A mesh without caps of the vertices that are kept of each arc.
fn simplified(finer: &FillMesh, kept: &[KeptVertices]) -> FillMesh {
    let mut level = FillMesh {
        ellipsoid: finer.ellipsoid,
        fills: finer.fills.clone(),
        pieces: finer.pieces.iter().map(without_triangles).collect(),
        ..FillMesh::default()
    };
    for (arc, kept) in finer.arcs.iter().zip(kept) {
        level.arcs.push(Arc {
            first_vertex: level.vertices.len() as u32,
            vertex_count: kept.vertices.len() as u32,
            ..arc.clone()
        });
        let positions = kept.vertices.iter();
        level
            .vertices
            .extend(positions.map(|&vertex| finer.vertices[vertex as usize]));
        let deviations = kept.deviations_m.iter().copied().chain([0.0]);
        level
            .boundary
            .extend(deviations.map(|deviation_m| BoundaryVertex {
                deviation_m,
                ..BoundaryVertex::default()
            }));
    }
    level.sag_m = level.ellipsoid.chord_sag_m(level.longest_chord_m());
    level.bound_arcs();
    level
}

fn without_triangles(piece: &Piece) -> Piece {
    Piece {
        fill: piece.fill,
        ..Piece::default()
    }
}

impl FillMesh {
    /// Length, metres, of the longest boundary chord.
    pub(crate) fn longest_chord_m(&self) -> f64 {
        let longest = |arc: &Arc| {
            let first = arc.first_vertex as usize;
            let chords = self.vertices[first..first + arc.vertex_count as usize].windows(2);
            chords.fold(0.0, |longest: f64, ends| {
                longest.max(ends[0].distance(ends[1]))
            })
        };
        self.arcs
            .par_iter()
            .with_min_len(64)
            .map(longest)
            .reduce(|| 0.0, f64::max)
    }
}

/// An arc as a piece walks it, which lies to its left.
#[derive(Clone, Copy, Debug, PartialEq)]
struct DirectedArc {
    arc: u32,
    forward: bool,
}

/// The arcs around each piece, linked to loops. Where loops touch any linking will do: all have the same
/// edges.
fn piece_loops(mesh: &FillMesh) -> Vec<Vec<Vec<DirectedArc>>> {
    let mut around: Vec<Vec<DirectedArc>> = vec![Vec::new(); mesh.pieces.len()];
    for (arc, stored) in (0..).zip(&mesh.arcs) {
        for (side, forward) in [(stored.left, true), (stored.right, false)] {
            if let Some(piece) = side {
                around[piece as usize].push(DirectedArc { arc, forward });
            }
        }
    }
    around.par_iter().map(|arcs| linked(mesh, arcs)).collect()
}

fn linked(mesh: &FillMesh, arcs: &[DirectedArc]) -> Vec<Vec<DirectedArc>> {
    let end = |arc: DirectedArc, is_start: bool| {
        let stored = &mesh.arcs[arc.arc as usize];
        let vertex = if arc.forward == is_start {
            stored.first_vertex
        } else {
            stored.first_vertex + stored.vertex_count - 1
        };
        mesh.vertices[vertex as usize].to_array().map(f64::to_bits)
    };
    let mut leaving: HashMap<[u64; 3], Vec<DirectedArc>> = HashMap::new();
    for &arc in arcs.iter().rev() {
        leaving.entry(end(arc, true)).or_default().push(arc);
    }
    let mut loops = Vec::new();
    for &arc in arcs {
        let mut walked = Vec::new();
        let mut node = end(arc, true);
        while let Some(next) = leaving.get_mut(&node).and_then(Vec::pop) {
            node = end(next, false);
            walked.push(next);
        }
        if !walked.is_empty() {
            loops.push(walked);
        }
    }
    loops
}

/// The vertices of loops, one for each position.
fn loop_vertices(arcs: &[Arc], loops: &[Vec<DirectedArc>]) -> Vec<Vec<u32>> {
    let vertices = |walked: &DirectedArc| {
        let arc = &arcs[walked.arc as usize];
        let (first, last) = (arc.first_vertex, arc.first_vertex + arc.vertex_count - 1);
        let forward = walked.forward;
        // All but the last of the walk.
        (0..last - first).map(move |step| if forward { first + step } else { last - step })
    };
    loops
        .iter()
        .map(|walked| walked.iter().flat_map(vertices).collect())
        .collect()
}

#[cfg(all(test, feature = "countries"))]
mod tests;
