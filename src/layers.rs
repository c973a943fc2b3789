//! Layers: which pieces may be counted together, and in which order they are resolved.
//!
//! Codes of disjoint pieces can be summed in one target; overlapping ones need targets of their own.
//! Layers are resolved bottom to top, so of two overlapping pieces the one with the greater z-order
//! gets the higher layer: the host's blending then composes them in order.

use crate::{
    code::{Code, Mantissa},
    error::RendererError,
    fill_mesh::{Bounds, FillMesh},
    options::{CountTechnique, FillStyle},
};

/// Most layers: each takes a target of the view's size.
pub(crate) const MAX_LAYERS: usize = 16;

/// A mesh and how its fills look.
#[derive(Clone, Copy)]
pub(crate) struct Styled<'a> {
    pub mesh: &'a FillMesh,
    pub styles: &'a [FillStyle],
}

/// Names a fill among several meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FillOf {
    pub mesh: usize,
    pub fill: u32,
}

/// Mutually disjoint pieces that are counted together.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layer {
    /// Ids are positions in this list, plus one.
    pub fills: Vec<FillOf>,
    pub code: Code,
    /// Upper bound of |partial sum| with everything drawn that is stored.
    pub largest_sum: u64,
}

/// Layer and packed code of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PieceCode {
    pub layer: usize,
    pub packed: u32,
}

/// The layers of everything visible.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layering {
    pub technique: CountTechnique,
    pub layers: Vec<Layer>,
    /// By mesh and piece; `None` where the fill is hidden or fully transparent.
    pub codes: Vec<Vec<Option<PieceCode>>>,
}

impl Layering {
    /// Assigns layers and codes. Winding falls back to the stencil where head-room is not proven.
    pub(crate) fn assign(
        meshes: &[Styled<'_>],
        wanted: CountTechnique,
        mantissa: Mantissa,
    ) -> Result<Self, RendererError> {
        let pieces = visible_pieces(meshes);
        let layer_of = stack(meshes, &pieces);
        let layer_count = layer_of.iter().map(|layer| layer + 1).max().unwrap_or(0);
        if layer_count > MAX_LAYERS {
            return Err(RendererError::TooManyLayers {
                needed: layer_count,
                most: MAX_LAYERS,
            });
        }
        let members = members(&pieces, &layer_of, layer_count);
        let triangles = triangles_by_id(meshes, &pieces, &layer_of, &members);
        let summed: Option<Vec<Code>> = match wanted {
            CountTechnique::Winding => triangles
                .iter()
                .map(|by_id| Code::fitting(by_id, mantissa))
                .collect(),
            CountTechnique::Stencil => None,
        };
        let (technique, codes) = match summed {
            Some(codes) => (CountTechnique::Winding, codes),
            None => (CountTechnique::Stencil, unsummed(&members)?),
        };
        let layers: Vec<Layer> = members
            .into_iter()
            .zip(codes)
            .zip(&triangles)
            .map(|((fills, code), by_id)| Layer {
                fills,
                largest_sum: code.largest_sum(by_id),
                code,
            })
            .collect();
        let codes = piece_codes(meshes, &pieces, &layer_of, &layers);
        Ok(Self {
            technique,
            layers,
            codes,
        })
    }
}

/// A piece that is drawn, in drawing order.
struct Visible<'a> {
    of: FillOf,
    piece: usize,
    bounds: &'a Bounds,
}

fn visible_pieces<'a>(meshes: &[Styled<'a>]) -> Vec<Visible<'a>> {
    let mut visible = Vec::new();
    for (mesh, styled) in meshes.iter().enumerate() {
        for (piece, stored) in styled.mesh.pieces.iter().enumerate() {
            let style = &styled.styles[stored.fill as usize];
            if style.visible && style.color[3] > 0.0 {
                visible.push(Visible {
                    of: FillOf {
                        mesh,
                        fill: stored.fill,
                    },
                    piece,
                    bounds: &stored.bounds,
                });
            }
        }
    }
    visible.sort_by_key(|piece| meshes[piece.of.mesh].styles[piece.of.fill as usize].z_index);
    visible
}

/// The lowest layer above everything below that a piece may overlap.
fn stack(meshes: &[Styled<'_>], pieces: &[Visible<'_>]) -> Vec<usize> {
    let mut overlaps: Vec<Vec<Vec<u32>>> = meshes
        .iter()
        .map(|styled| vec![Vec::new(); styled.mesh.pieces.len()])
        .collect();
    for (lists, styled) in overlaps.iter_mut().zip(meshes) {
        for &(a, b) in &styled.mesh.overlaps {
            lists[a as usize].push(b);
            lists[b as usize].push(a);
        }
    }
    let mut layer_by_piece: Vec<Vec<Option<usize>>> = meshes
        .iter()
        .map(|styled| vec![None; styled.mesh.pieces.len()])
        .collect();
    let mut layers = Vec::with_capacity(pieces.len());
    for (index, piece) in pieces.iter().enumerate() {
        let within = overlaps[piece.of.mesh][piece.piece]
            .iter()
            .filter_map(|&other| layer_by_piece[piece.of.mesh][other as usize]);
        // Nothing is known of pieces of other meshes but where they lie.
        let across = pieces[..index]
            .iter()
            .zip(&layers)
            .filter(|(below, _)| {
                below.of.mesh != piece.of.mesh && below.bounds.intersects(piece.bounds)
            })
            .map(|(_, &layer): (_, &usize)| layer);
        let layer = within.chain(across).max().map_or(0, |below| below + 1);
        layer_by_piece[piece.of.mesh][piece.piece] = Some(layer);
        layers.push(layer);
    }
    layers
}

/// The fills of each layer, in drawing order.
fn members(pieces: &[Visible<'_>], layer_of: &[usize], layer_count: usize) -> Vec<Vec<FillOf>> {
    let mut members: Vec<Vec<FillOf>> = vec![Vec::new(); layer_count];
    for (piece, &layer) in pieces.iter().zip(layer_of) {
        // Pieces of a fill follow each other.
        if members[layer].last() != Some(&piece.of) {
            members[layer].push(piece.of);
        }
    }
    members
}

/// How many triangles are drawn with the code of each id of each layer, caps and walls.
fn triangles_by_id(
    meshes: &[Styled<'_>],
    pieces: &[Visible<'_>],
    layer_of: &[usize],
    members: &[Vec<FillOf>],
) -> Vec<Vec<u64>> {
    let mut by_piece: Vec<Vec<u64>> = meshes
        .iter()
        .map(|styled| wall_triangles(styled.mesh))
        .collect();
    for (by_piece, styled) in by_piece.iter_mut().zip(meshes) {
        for (count, piece) in by_piece.iter_mut().zip(&styled.mesh.pieces) {
            *count += 2 * u64::from(piece.triangle_count);
        }
    }
    let mut by_id: Vec<Vec<u64>> = members.iter().map(|fills| vec![0; fills.len()]).collect();
    for_each_id(pieces, layer_of, |piece, layer, index| {
        by_id[layer][index] += by_piece[piece.of.mesh][piece.piece];
    });
    by_id
}

fn wall_triangles(mesh: &FillMesh) -> Vec<u64> {
    let mut by_piece = vec![0; mesh.pieces.len()];
    for arc in &mesh.arcs {
        for piece in [arc.left, arc.right].into_iter().flatten() {
            by_piece[piece as usize] += 2 * u64::from(arc.vertex_count - 1);
        }
    }
    by_piece
}

/// Visits every piece with its layer and the position of its fill there.
fn for_each_id(
    pieces: &[Visible<'_>],
    layer_of: &[usize],
    mut visit: impl FnMut(&Visible<'_>, usize, usize),
) {
    let mut last: [Option<(FillOf, usize)>; MAX_LAYERS] = [None; MAX_LAYERS];
    for (piece, &layer) in pieces.iter().zip(layer_of) {
        let index = match last[layer] {
            Some((fill, index)) if fill == piece.of => index,
            Some((_, index)) => index + 1,
            None => 0,
        };
        last[layer] = Some((piece.of, index));
        visit(piece, layer, index);
    }
}

fn unsummed(members: &[Vec<FillOf>]) -> Result<Vec<Code>, RendererError> {
    members
        .iter()
        .map(|fills| {
            Code::unsummed(fills.len() as u32)
                .ok_or(RendererError::TooManyFills { fills: fills.len() })
        })
        .collect()
}

fn piece_codes(
    meshes: &[Styled<'_>],
    pieces: &[Visible<'_>],
    layer_of: &[usize],
    layers: &[Layer],
) -> Vec<Vec<Option<PieceCode>>> {
    let mut codes: Vec<Vec<Option<PieceCode>>> = meshes
        .iter()
        .map(|styled| vec![None; styled.mesh.pieces.len()])
        .collect();
    for_each_id(pieces, layer_of, |piece, layer, index| {
        codes[piece.of.mesh][piece.piece] = Some(PieceCode {
            layer,
            packed: layers[layer].code.packed(index as u32 + 1),
        });
    });
    codes
}
