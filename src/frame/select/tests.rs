//! Laws of what is selected.

use std::collections::HashMap;

use glam::{DMat3, DMat4, DVec3, DVec4, UVec2};

use super::*;
use crate::{
    Ellipsoid, FillStyle, LonLat, MeshOptions,
    countries::Dataset,
    frame::{
        beyond::longest_edge_rad,
        code::Mantissa,
        layers::{Counting, Layering, Styled},
        refine::{BOTTOM, TOP},
    },
    options::{Camera, Frame, HeightRange, RendererOptions},
};

fn mesh() -> FillMesh {
    let countries = Dataset::Countries110m.countries();
    let regions: Vec<_> = countries
        .into_iter()
        .map(|country| country.region)
        .collect();
    FillMesh::build(&regions, &MeshOptions::default()).expect("embedded data is sound")
}

fn looking_down(at: LonLat, height_m: f64, field_of_view_deg: f64, sag_m: f64) -> Sight {
    let ellipsoid = Ellipsoid::WGS84;
    let up = ellipsoid.normal(at);
    let right = up.any_orthonormal_vector();
    let scale = 1.0 / (0.5 * field_of_view_deg).to_radians().tan();
    let clip_from_view = DMat4::from_cols(
        DVec4::new(scale, 0.0, 0.0, 0.0),
        DVec4::new(0.0, scale, 0.0, 0.0),
        DVec4::new(0.0, 0.0, 0.0, -1.0),
        DVec4::new(0.0, 0.0, 0.1 * height_m, 0.0),
    );
    let camera = Camera {
        eye_ecef_m: ellipsoid.ecef(at, height_m),
        view_from_ecef: DMat3::from_cols(right, up.cross(right), up).transpose(),
        clip_from_view,
    };
    let frame = Frame {
        terrain: HeightRange {
            min_m: -500.0,
            max_m: 9_000.0,
        },
        pixel_error: 0.0,
        ..Frame::new(camera, UVec2::splat(720))
    };
    Sight::new(ellipsoid, sag_m, &frame, &RendererOptions::default()).expect("valid")
}

/// A corner of a drawn triangle: its surface point, bit for bit, and how it is drawn.
type Corner = ([u64; 3], u32);

fn corner(point_m: DVec3, drawn: u32) -> Corner {
    (point_m.to_array().map(f64::to_bits), drawn)
}

#[derive(Default)]
struct Boundary(HashMap<(Corner, Corner), i64>);

impl Boundary {
    fn add(&mut self, triangle: [Corner; 3], weight: i64) {
        for side in 0..3 {
            let (from, to) = (triangle[side], triangle[(side + 1) % 3]);
            // Where volumes have no height walls have none.
            if from == to {
                continue;
            }
            if from < to {
                *self.0.entry((from, to)).or_default() += weight;
            } else {
                *self.0.entry((to, from)).or_default() -= weight;
            }
        }
    }
}

/// The signed boundary of what a layer draws. A patch has the boundary of the wall it replaces
/// (tested in refine.rs), so that wall stands for it.
fn boundary(mesh: &FillMesh, draws: &LayerDraws, patch: &Patch, sight: &Sight) -> Boundary {
    let corner = |point_m: DVec3, drawn: u32| {
        let is_flat = sight
            .beyond
            .is_some_and(|beyond| beyond.holds_point(point_m));
        corner(point_m, if is_flat { BOTTOM } else { drawn })
    };
    let mut boundary = Boundary::default();
    let chunks = draws.caps.iter().flat_map(|run| run.chunks(mesh));
    for chunk in chunks {
        let weight = i64::from(draws.codes[chunk.piece as usize + 1]);
        for triangle in chunk.first_triangle..chunk.first_triangle + chunk.triangle_count {
            let corners =
                mesh.cap_triangles[triangle as usize].map(|vertex| mesh.vertices[vertex as usize]);
            boundary.add(corners.map(|point_m| corner(point_m, TOP)), weight);
            boundary.add(corners.map(|point_m| corner(point_m, BOTTOM)), -weight);
        }
    }
    let mut wall = |arc: &crate::fill_mesh::Arc, vertex: u32| {
        let weight = i64::from(code_of(&draws.codes, arc.left))
            - i64::from(code_of(&draws.codes, arc.right));
        let [a, b] = [vertex, vertex + 1].map(|vertex| mesh.vertices[vertex as usize]);
        let (a, b) = (
            (corner(a, TOP), corner(a, BOTTOM)),
            (corner(b, TOP), corner(b, BOTTOM)),
        );
        boundary.add([a.0, a.1, b.0], weight);
        boundary.add([a.1, b.1, b.0], weight);
    };
    for (index, arc) in (0..).zip(&mesh.arcs) {
        let ends = arc.first_vertex..arc.first_vertex + arc.vertex_count - 1;
        for vertex in ends {
            let slots = slot(index, vertex)..slot(index, vertex + 1) + 1;
            // A wall drawn twice would count twice.
            for run in &draws.walls {
                if run.start <= slots.start && slots.end <= run.end {
                    wall(arc, vertex);
                }
            }
        }
    }
    for chord in &patch.chords {
        if draws
            .patches
            .iter()
            .any(|run| run.indices.contains(&chord.first_index))
        {
            wall(&mesh.arcs[chord.arc as usize], chord.vertex);
        }
    }
    boundary
}

/// How many triangles of shown pieces are left out since their volumes have no height there.
fn left_flat(mesh: &FillMesh, draws: &LayerDraws, sight: &Sight) -> usize {
    let drawn: usize = draws.caps.iter().map(|run| run.triangles.len()).sum();
    let unseen = mesh.cap_chunks.iter().filter(|chunk| {
        draws.codes[chunk.piece as usize + 1] != 0 && sight.is_flat_over(&chunk.bounds)
    });
    let left: usize = unseen.map(|chunk| chunk.triangle_count as usize).sum();
    assert!(drawn + left <= mesh.cap_triangles.len());
    left
}

/// The law: after culling, layering and refinement the signed boundary of everything drawn is
/// zero, but for edges outside a side plane of the frustum, which no pixel sees.
#[test]
fn what_is_drawn_is_closed() {
    let mesh = mesh();
    let mut styles = vec![FillStyle::default(); mesh.fills.len()];
    for style in styles.iter_mut().step_by(5) {
        style.visible = false;
    }
    let styled = [Styled {
        mesh: &mesh,
        styles: &styles,
    }];
    let layering = Layering::assign(&styled, Counting::Winding, Mantissa::Single).expect("fits");
    let (mut culled, mut refined, mut flat) = (0, 0, 0);
    for (at, height_m, field_of_view_deg) in [
        (LonLat::new(10.0, 50.0), 2e7, 60.0),
        (LonLat::new(179.9, 66.0), 3e6, 60.0),
        (LonLat::new(0.0, -90.0), 1e6, 100.0),
        (LonLat::new(13.0, 48.5), 5e4, 60.0),
        (LonLat::new(6.8, 49.2), 9_010.0, 60.0),
    ] {
        let sight = looking_down(at, height_m, field_of_view_deg, mesh.sag_m)
            .flat_beyond(longest_edge_rad(&mesh));
        let selection = Selection::of(&mesh, layering.coded(0), &sight, &EdgeWants::default());
        culled += selection.fills_culled;
        flat += selection
            .layers
            .iter()
            .map(|draws| left_flat(&mesh, draws, &sight))
            .sum::<usize>();
        refined += selection.patch.chords.len();
        for draws in &selection.layers {
            let open = boundary(&mesh, draws, &selection.patch, &sight).0;
            for ((from, to), sum) in open {
                let ends = [from, to].map(|(bits, drawn)| {
                    let point_m = DVec3::from_array(bits.map(f64::from_bits));
                    let distance_m = point_m.distance(sight.eye_ecef_m);
                    let height_m = if drawn == TOP {
                        sight.extrusion.top_at_m(distance_m)
                    } else {
                        sight.extrusion.bottom_at_m(distance_m)
                    };
                    let normal = sight.ellipsoid.normal_at_surface(point_m);
                    point_m + normal * height_m - sight.eye_ecef_m
                });
                let unseen = sight
                    .side_planes
                    .iter()
                    .any(|plane| ends.iter().all(|end| plane.dot(end.extend(1.0)) < 0.0));
                assert!(sum == 0 || unseen, "{sum} from {height_m} m over {at:?}");
            }
        }
    }
    assert!(
        culled > 0 && refined > 0 && flat > 5_000,
        "{culled} culled, {refined} refined, {flat} left out as flat"
    );
}
