//! Layers of small meshes, and of the countries.

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
    let layering = Layering::assign(meshes, Counting::Winding, Mantissa::Single).expect("fits");
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
    let layering = Layering::assign(&meshes, Counting::Winding, Mantissa::Single).expect("fits");
    assert_eq!(layering.layers.len(), 1);
    let packed: std::collections::HashSet<u32> = layering.codes[0]
        .iter()
        .map(|code| code.expect("shown").packed)
        .collect();
    assert_eq!(packed.len(), 300);
}

#[cfg(feature = "countries")]
#[test]
fn countries_take_two_planes() {
    use crate::{MeshOptions, countries::Dataset};
    for dataset in [Dataset::Countries110m, Dataset::Countries50m] {
        let countries = dataset.countries().into_iter();
        let regions: Vec<_> = countries.map(|country| country.region).collect();
        let mesh = FillMesh::build(&regions, &MeshOptions::default()).expect("sound");
        let styles = vec![FillStyle::default(); mesh.fills.len()];
        let meshes = [Styled {
            mesh: &mesh,
            styles: &styles,
        }];
        let layering =
            Layering::assign(&meshes, Counting::Winding, Mantissa::Single).expect("fits");
        assert_eq!(layering.layers.len(), 1);
        assert_eq!(layering.layers[0].code.planes, 2);
    }
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

/// What is drawn may have room where all that is stored has none: frames are asked.
#[test]
fn where_not_all_has_head_room_sums_are_as_small_as_can_be() {
    let mesh = mesh(300, &[]);
    let styles = vec![FillStyle::default(); 300];
    let meshes = [Styled {
        mesh: &mesh,
        styles: &styles,
    }];
    let assign = |counting| Layering::assign(&meshes, counting, Mantissa::Half).expect("fits");
    let layering = assign(Counting::Winding);
    assert_eq!(layering.technique, CountTechnique::Winding);
    let code = layering.layers[0].code;
    assert_eq!((code.digits, code.base, code.check_bits), (3, 7, 2));
    assert_eq!(assign(Counting::Stencil).technique, CountTechnique::Stencil);
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
    let refused = Layering::assign(&meshes, Counting::Winding, Mantissa::Single);
    let expected = RendererError::TooManyLayers {
        needed: 20,
        most: MAX_LAYERS,
    };
    assert_eq!(refused, Err(expected));
}
