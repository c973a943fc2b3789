//! What the extruder finds in the tables, read as it reads them.

use super::*;
use crate::{countries::Dataset, fill_mesh::MeshOptions};

/// `arc_of` of extrude.wgsl.
fn arc_of(arc_at: &[u32], slot: u32) -> (u32, bool) {
    let block = slot as usize / BLOCK * (BLOCK / 4 + 1);
    let within = slot as usize % BLOCK;
    let own = arc_at[block + 1 + within / 4] >> (8 * (within % 4));
    let is_break = own as u8 & BREAK != 0;
    (arc_at[block] + u32::from(own as u8 & !BREAK), is_break)
}

fn countries() -> FillMesh {
    let regions: Vec<_> = Dataset::Countries110m
        .countries()
        .into_iter()
        .map(|country| country.region)
        .collect();
    FillMesh::build(&regions, &MeshOptions::default()).expect("they are sound")
}

#[test]
fn every_corner_of_a_cap_knows_its_piece() {
    let mesh = countries();
    let mut interiors_seen = 0;
    for level in std::iter::once(&mesh).chain(&mesh.coarser) {
        let interiors = level.interiors();
        interiors_seen += interiors.len();
        let (arcs, arc_at) = (
            arc_records(level, &interiors),
            arc_at_slots(level, &interiors),
        );
        let corners = cap_indices(level);
        for (index, piece) in (1..).zip(&level.pieces) {
            let first = piece.first_triangle as usize;
            let of_piece = &corners[first..first + piece.triangle_count as usize];
            for corner in of_piece.iter().flatten() {
                let (arc, is_break) = arc_of(&arc_at, corner >> 1);
                let sides = arcs[arc as usize];
                let found = if corner & 1 == 1 {
                    sides.right
                } else {
                    sides.left
                };
                assert!(!is_break && found == index, "{found} instead of {index}");
            }
        }
    }
    assert!(interiors_seen > 100, "{interiors_seen}");
}

#[test]
fn slots_know_their_arcs_and_breaks() {
    let mesh = countries();
    let arc_at = arc_at_slots(&mesh, &mesh.interiors());
    for (index, arc) in (0..).zip(&mesh.arcs) {
        let first = slot(index, arc.first_vertex);
        for slot in first..first + arc.vertex_count {
            assert_eq!(arc_of(&arc_at, slot), (index, false));
        }
        assert_eq!(arc_of(&arc_at, first + arc.vertex_count), (index, true));
    }
}
