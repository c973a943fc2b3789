//! Layers: which pieces may be counted together, and in which order they are resolved.
//!
//! Codes of disjoint pieces can be summed in one target; overlapping ones need targets of their own.
//! Layers are resolved bottom to top, so of two overlapping pieces the one with the greater z-order
//! gets the higher layer: the host's blending then composes them in order.

use crate::{
    error::RendererError,
    fill_mesh::{Bounds, FillMesh},
    frame::code::{Code, Mantissa, PlaneSums},
    options::CountTechnique,
    style::FillStyle,
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
    /// Upper bounds of |partial sum|, by plane, with everything drawn that is stored.
    pub largest_sums: PlaneSums,
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
    /// By mesh and piece; `None` where nothing of the fill is drawn.
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
                largest_sums: code.largest_sums(by_id),
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

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::fill_mesh::{Fill, Piece};

    /// Fills of one piece with two triangles each, around a common axis.
    fn mesh(fills: u32, overlaps: &[(u32, u32)]) -> FillMesh {
        FillMesh {
            fills: (0..fills)
                .map(|fill| Fill {
                    first_piece: fill,
                    piece_count: 1,
                })
                .collect(),
            pieces: (0..fills)
                .map(|fill| Piece {
                    fill,
                    first_triangle: 2 * fill,
                    triangle_count: 2,
                    bounds: Bounds {
                        axis: DVec3::X,
                        radius_rad: 0.1,
                    },
                })
                .collect(),
            overlaps: overlaps.to_vec(),
            ..Default::default()
        }
    }

    fn layers_of(meshes: &[Styled<'_>]) -> Vec<Vec<Option<usize>>> {
        let layering =
            Layering::assign(meshes, CountTechnique::Winding, Mantissa::Single).expect("fits");
        layering
            .codes
            .iter()
            .map(|codes| {
                codes
                    .iter()
                    .map(|code| code.map(|code| code.layer))
                    .collect()
            })
            .collect()
    }

    #[test]
    fn disjoint_fills_share_a_layer_with_distinct_codes() {
        let mesh = mesh(300, &[]);
        let styles = vec![FillStyle::default(); 300];
        let meshes = [Styled {
            mesh: &mesh,
            styles: &styles,
        }];
        let layering =
            Layering::assign(&meshes, CountTechnique::Winding, Mantissa::Single).expect("fits");
        assert_eq!(layering.layers.len(), 1);
        let packed: std::collections::HashSet<u32> = layering.codes[0]
            .iter()
            .map(|code| code.expect("shown").packed)
            .collect();
        assert_eq!(packed.len(), 300);
    }

    #[test]
    fn of_two_overlapping_fills_the_greater_z_index_lies_above() {
        let mesh = mesh(3, &[(0, 1), (1, 2)]);
        let mut styles = vec![FillStyle::default(); 3];
        let in_order = layers_of(&[Styled {
            mesh: &mesh,
            styles: &styles,
        }]);
        assert_eq!(in_order, [[Some(0), Some(1), Some(2)]]);
        styles[0].z_index = 5;
        let raised = layers_of(&[Styled {
            mesh: &mesh,
            styles: &styles,
        }]);
        assert_eq!(raised, [[Some(1), Some(0), Some(1)]]);
    }

    #[test]
    fn meshes_that_may_meet_are_layered_and_hidden_fills_take_none() {
        let (below, above) = (mesh(2, &[]), mesh(1, &[]));
        let shown = vec![FillStyle::default(); 2];
        let both = [
            Styled {
                mesh: &below,
                styles: &shown,
            },
            Styled {
                mesh: &above,
                styles: &shown[..1],
            },
        ];
        assert_eq!(layers_of(&both), [vec![Some(0), Some(0)], vec![Some(1)]]);
        let hidden = vec![
            FillStyle {
                visible: false,
                ..FillStyle::default()
            };
            2
        ];
        let one = [
            Styled {
                mesh: &below,
                styles: &hidden,
            },
            Styled {
                mesh: &above,
                styles: &shown[..1],
            },
        ];
        assert_eq!(layers_of(&one), [vec![None, None], vec![Some(0)]]);
    }

    #[test]
    fn without_head_room_the_stencil_counts() {
        let mesh = mesh(300, &[]);
        let styles = vec![FillStyle::default(); 300];
        let meshes = [Styled {
            mesh: &mesh,
            styles: &styles,
        }];
        let layering =
            Layering::assign(&meshes, CountTechnique::Winding, Mantissa::Half).expect("stencil");
        assert_eq!(layering.technique, CountTechnique::Stencil);
    }

    #[test]
    fn too_many_overlaps_are_refused() {
        let pairs: Vec<_> = (0..20)
            .flat_map(|a| (a + 1..20).map(move |b| (a, b)))
            .collect();
        let mesh = mesh(20, &pairs);
        let styles = vec![FillStyle::default(); 20];
        let meshes = [Styled {
            mesh: &mesh,
            styles: &styles,
        }];
        let refused = Layering::assign(&meshes, CountTechnique::Winding, Mantissa::Single);
        let expected = RendererError::TooManyLayers {
            needed: 20,
            most: MAX_LAYERS,
        };
        assert_eq!(refused, Err(expected));
    }
}
