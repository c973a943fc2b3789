//! Layers: which pieces may be counted together, and in which order they are resolved.
//!
//! Codes of disjoint pieces can be summed in one target; overlapping ones need targets of their own.
//! Layers are resolved bottom to top, so of two overlapping pieces the one with the greater z-order
//! gets the higher layer: the host's blending then composes them in order. Unordered fills are mixed in one
//! layer above all others, however many overlap.

mod members;
#[cfg(test)]
mod tests;

use rustc_hash::FxHashMap;

use crate::{
    error::RendererError,
    fill_mesh::{Bounds, FillMesh},
    frame::code::{Code, Mantissa},
    frame::mixture::Mixture,
    options::CountTechnique,
    style::{Blend, FillStyle},
};
use members::{Members, for_each_rank};

/// Most layers: each takes a target of the view's size.
pub(crate) const MAX_LAYERS: usize = 16;

/// How many times the sums of what is stored fit where room is spared for refined walls.
const SPARE: u64 = 2;

/// How fills are to be counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Counting {
    /// By sums, in as few planes as hold those of what is stored, if there are so few.
    Winding,
    /// By sums, with room to spare for those of refined walls, if it can be had.
    SpareWinding,
    /// Fill by fill.
    Stencil,
}

impl Counting {
    /// What to try, one after the other, while sums have no room.
    pub(crate) const ALL: [Self; 3] = [Self::Winding, Self::SpareWinding, Self::Stencil];
}

/// A mesh and how its fills look.
#[derive(Clone, Copy)]
pub(crate) struct Styled<'a> {
    pub mesh: &'a FillMesh,
    pub styles: &'a [FillStyle],
}

/// Names a fill among several meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct FillOf {
    pub mesh: usize,
    pub fill: u32,
}

/// Mutually disjoint pieces that are counted together.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layer {
    /// Ids are positions in this list, plus one. Those with most triangles come first: sums of small ids
    /// leave more head-room.
    pub fills: Vec<FillOf>,
    pub code: Code,
}

/// Layer and packed code of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PieceCode {
    pub layer: usize,
    pub packed: u32,
}

/// The pieces of a mesh as they are counted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coded<'a> {
    /// By piece; none where nothing is drawn of it.
    pub codes: &'a [Option<PieceCode>],
    /// How many layers there are.
    pub layers: usize,
    pub technique: CountTechnique,
}

/// The layers of everything visible.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layering {
    pub technique: CountTechnique,
    pub layers: Vec<Layer>,
    /// The unordered fills, if there are any: the layer behind the last of `layers`.
    pub mixture: Option<Mixture>,
    /// By mesh and piece; `None` where nothing of the fill is drawn.
    pub codes: Vec<Vec<Option<PieceCode>>>,
}

impl Layering {
    /// Assigns layers and codes. Whether sums have head-room is asked of what each frame draws.
    pub(crate) fn assign(
        meshes: &[Styled<'_>],
        wanted: Counting,
        mantissa: Mantissa,
    ) -> Result<Self, RendererError> {
        let unordered = |piece: &Visible<'_>| style_of(meshes, piece).blend == Blend::Unordered;
        let (mixed, pieces): (Vec<_>, Vec<_>) =
            visible_pieces(meshes).into_iter().partition(unordered);
        let layer_of = stack(meshes, &pieces);
        let layer_count = layer_of.iter().map(|layer| layer + 1).max().unwrap_or(0);
        if layer_count > MAX_LAYERS {
            return Err(RendererError::TooManyLayers {
                needed: layer_count,
                most: MAX_LAYERS,
            });
        }
        let Members {
            fills,
            triangles,
            ids,
        } = Members::new(meshes, &pieces, &layer_of, layer_count);
        let fitting = |times: u64| -> Option<Vec<Code>> {
            let code = |by_id: &Vec<u64>| {
                Code::fitting(by_id, mantissa, times).or_else(|| Code::sparest(by_id))
            };
            triangles.iter().map(code).collect()
        };
        let summed = match wanted {
            Counting::Winding => fitting(1),
            Counting::SpareWinding => fitting(SPARE),
            Counting::Stencil => None,
        };
        let (technique, codes) = match summed {
            Some(codes) => (CountTechnique::Winding, codes),
            None => (CountTechnique::Stencil, unsummed(&fills)?),
        };
        let layers: Vec<Layer> = fills
            .into_iter()
            .zip(codes)
            .map(|(fills, code)| Layer { fills, code })
            .collect();
        let mut codes = piece_codes(meshes, &pieces, &layer_of, &ids, &layers);
        let mixture = mix(meshes, &mixed, technique, layers.len(), &mut codes);
        Ok(Self {
            technique,
            layers,
            mixture,
            codes,
        })
    }

    /// The pieces of a mesh.
    pub(crate) fn coded(&self, mesh: usize) -> Coded<'_> {
        Coded {
            codes: &self.codes[mesh],
            layers: self.count(),
            technique: self.technique,
        }
    }

    /// How many layers are counted, that of the mixture included.
    pub(crate) fn count(&self) -> usize {
        self.layers.len() + usize::from(self.mixture.is_some())
    }
}

/// A piece that is drawn, in drawing order.
struct Visible<'a> {
    of: FillOf,
    piece: usize,
    bounds: &'a Bounds,
}

fn style_of<'a>(meshes: &[Styled<'a>], piece: &Visible<'_>) -> &'a FillStyle {
    &meshes[piece.of.mesh].styles[piece.of.fill as usize]
}

fn visible_pieces<'a>(meshes: &[Styled<'a>]) -> Vec<Visible<'a>> {
    let mut visible = Vec::new();
    for (mesh, styled) in meshes.iter().enumerate() {
        for (piece, stored) in styled.mesh.pieces.iter().enumerate() {
            let style = &styled.styles[stored.fill as usize];
            if style.shows() {
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
    visible.sort_by_key(|piece| style_of(meshes, piece).z_index);
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

fn unsummed(layers: &[Vec<FillOf>]) -> Result<Vec<Code>, RendererError> {
    layers
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
    ids: &[Vec<u32>],
    layers: &[Layer],
) -> Vec<Vec<Option<PieceCode>>> {
    let mut codes: Vec<Vec<Option<PieceCode>>> = meshes
        .iter()
        .map(|styled| vec![None; styled.mesh.pieces.len()])
        .collect();
    for_each_rank(pieces, layer_of, |piece, layer, rank| {
        codes[piece.of.mesh][piece.piece] = Some(PieceCode {
            layer,
            packed: layers[layer].code.packed(ids[layer][rank]),
        });
    });
    codes
}

/// Gives unordered pieces codes: one for all of a colour, or one a fill where the stencil counts.
fn mix(
    meshes: &[Styled<'_>],
    pieces: &[Visible<'_>],
    technique: CountTechnique,
    layer: usize,
    codes: &mut [Vec<Option<PieceCode>>],
) -> Option<Mixture> {
    let mut mixture = Mixture::default();
    let mut code_of: FxHashMap<(Option<FillOf>, [u64; 4]), u32> = FxHashMap::default();
    for piece in pieces {
        let depths = Mixture::depths_of(style_of(meshes, piece));
        let alone = (technique == CountTechnique::Stencil).then_some(piece.of);
        let code = code_of.entry((alone, depths.map(f64::to_bits)));
        let packed = *code.or_insert_with(|| {
            mixture.depths.push(depths);
            mixture.depths.len() as u32
        });
        codes[piece.of.mesh][piece.piece] = Some(PieceCode { layer, packed });
    }
    (!pieces.is_empty()).then_some(mixture)
}
