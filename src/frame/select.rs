//! Selection: what of a mesh one view draws in one frame.

use std::ops::Range;

use crate::{
    fill_mesh::FillMesh,
    frame::code::PlaneSums,
    frame::edge_draws::{ArcEdges, EdgeDraws, EdgeWants},
    frame::edge_segments::EdgeSegments,
    frame::layers::PieceCode,
    frame::refine::Patch,
    frame::sight::Sight,
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

/// Contiguous triangles of pieces with one code.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CapRun {
    /// The first piece.
    pub piece: u32,
    pub triangles: Range<u32>,
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
        codes: &[Option<PieceCode>],
        layer_count: usize,
        sight: &Sight,
        wants: &EdgeWants<'_>,
    ) -> Self {
        let shown: Vec<Option<PieceCode>> = mesh
            .pieces
            .iter()
            .zip(codes)
            .map(|(piece, code)| code.filter(|_| !sight.beyond_horizon(&piece.bounds)))
            .collect();
        let mut selection = Self::default();
        selection.count_fills(mesh, codes, &shown);
        let arc_seen: Vec<bool> = mesh
            .arcs
            .iter()
            .map(|arc| !sight.outside_side_plane(&arc.bounds))
            .collect();
        let edges = ArcEdges::new(mesh, &shown, sight, wants);
        for (index, arc) in mesh.arcs.iter().enumerate() {
            let shown_on = |side: Option<u32>| side.and_then(|piece| shown[piece as usize]);
            let seen = arc_seen[index] || edges.any(index);
            if seen && shown_on(arc.left) != shown_on(arc.right) {
                selection.patch.refine_arc(mesh, index as u32, sight);
            }
        }
        selection.segments = EdgeSegments::new(&selection.patch, &edges, wants);
        selection.layers = (0..layer_count)
            .map(|layer| {
                let in_layer: Vec<u32> = std::iter::once(0)
                    .chain(shown.iter().map(|code| match code {
                        Some(code) if code.layer == layer => code.packed,
                        _ => 0,
                    }))
                    .collect();
                LayerDraws {
                    caps: cap_runs(mesh, &in_layer, sight),
                    walls: wall_runs(mesh, &in_layer, &arc_seen, &selection.patch),
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
    /// Adds to `sums` what the refined walls may add to any pixel, by plane.
    pub(crate) fn add_refined_sums(&self, mesh: &FillMesh, sums: &mut PlaneSums) {
        for run in &self.patches {
            let arc = &mesh.arcs[run.arc as usize];
            let [left, right] =
                [arc.left, arc.right].map(|side| code_of(&self.codes, side).to_le_bytes());
            let triangles = run.indices.len() as u64 / 3;
            for (plane, sum) in sums.iter_mut().enumerate() {
                *sum += triangles * u64::from(left[plane].abs_diff(right[plane]));
            }
        }
    }
}

fn code_of(codes: &[u32], side: Option<u32>) -> u32 {
    side.map_or(0, |piece| codes[piece as usize + 1])
}

fn cap_runs(mesh: &FillMesh, codes: &[u32], sight: &Sight) -> Vec<CapRun> {
    let mut runs: Vec<CapRun> = Vec::new();
    for (index, piece) in mesh.pieces.iter().enumerate() {
        if codes[index + 1] == 0 || sight.outside_side_plane(&piece.bounds) {
            continue;
        }
        let triangles = piece.first_triangle..piece.first_triangle + piece.triangle_count;
        match runs.last_mut() {
            Some(run)
                if run.triangles.end == triangles.start
                    && codes[run.piece as usize + 1] == codes[index + 1] =>
            {
                run.triangles.end = triangles.end;
            }
            _ => runs.push(CapRun {
                piece: index as u32,
                triangles,
            }),
        }
    }
    runs
}

fn wall_runs(mesh: &FillMesh, codes: &[u32], arc_seen: &[bool], patch: &Patch) -> Vec<Range<u32>> {
    slot_runs(mesh, patch, |index| {
        let arc = &mesh.arcs[index];
        arc_seen[index] && code_of(codes, arc.left) != code_of(codes, arc.right)
    })
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
mod tests {
    use std::collections::HashMap;

    use glam::{DMat3, DMat4, DVec3, DVec4, UVec2};

    use super::*;
    use crate::{
        Ellipsoid, FillStyle, LonLat, MeshOptions,
        countries::Dataset,
        frame::{
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
    fn boundary(mesh: &FillMesh, draws: &LayerDraws, patch: &Patch) -> Boundary {
        let mut boundary = Boundary::default();
        for run in &draws.caps {
            let weight = i64::from(draws.codes[run.piece as usize + 1]);
            for triangle in run.triangles.clone() {
                let corners = mesh.cap_triangles[triangle as usize]
                    .map(|vertex| mesh.vertices[vertex as usize]);
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
        let layering =
            Layering::assign(&styled, Counting::Winding, Mantissa::Single).expect("fits");
        let (mut culled, mut refined) = (0, 0);
        for (at, height_m, field_of_view_deg) in [
            (LonLat::new(10.0, 50.0), 2e7, 60.0),
            (LonLat::new(179.9, 66.0), 3e6, 60.0),
            (LonLat::new(0.0, -90.0), 1e6, 100.0),
            (LonLat::new(13.0, 48.5), 5e4, 60.0),
            (LonLat::new(6.8, 49.2), 9_010.0, 60.0),
        ] {
            let sight = looking_down(at, height_m, field_of_view_deg, mesh.sag_m);
            let layers = layering.layers.len();
            let selection = Selection::of(
                &mesh,
                &layering.codes[0],
                layers,
                &sight,
                &EdgeWants::default(),
            );
            culled += selection.fills_culled;
            refined += selection.patch.chords.len();
            for draws in &selection.layers {
                let open = boundary(&mesh, draws, &selection.patch).0;
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
            culled > 0 && refined > 0,
            "{culled} culled, {refined} refined"
        );
    }
}
