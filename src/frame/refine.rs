//! Per-frame refinement: boundary chords near the eye are replaced by finer ones on the true edge.
//!
//! A stored chord may lie metres beside the true edge, its end columns may stand too far away for
//! single precision, and its flat wall misses the edge where the end normals are skew. Near the eye
//! that shows. A *patch* takes the place of one chord's wall and has the same boundary, so that what
//! is drawn stays closed whatever the neighbours do: finer walls, and *ears* between chord and polyline
//! at top and bottom. Where an end column is cut in height, all chords that end there are refined and cut
//! it alike. (Slivers between a cut and a straight column would close it as well; but depth interpolated
//! over what has no width may be anything, and a pixel that falls into one would miss a face.)

use glam::DVec3;

use crate::{
    curve::CurveOn,
    fill_mesh::{Arc, FillMesh},
    frame::sight::Sight,
    gpu::fixed_point::{FixedVertex, encode},
};

/// Ends of walls and columns lie within this many times the distance at which they are seen, or at which
/// pixels would span `REACH_PIXEL_RAD` if that is less: single precision then displaces what is between by
/// less than 0.01 px.
const REACH: f64 = 150.0;
const REACH_PIXEL_RAD: f64 = 1e-3;
/// Halvings of one chord; 2⁻³² of the longest is below the vertex encoding.
const MAX_HALVINGS: u32 = 32;

/// How an index of a patch draws its vertex; the same in extrude.wgsl.
pub(crate) const BOTTOM: u32 = 0;
pub(crate) const TOP: u32 = 1;
const AS_IS: u32 = 2;

/// Triangles that replace the walls of refined chords of one mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Patch {
    /// Surface points of columns and cut points.
    pub vertices: Vec<FixedVertex>,
    /// Triangle list; 4 · vertex + how it is drawn.
    pub indices: Vec<u32>,
    /// The refined chords, in mesh order.
    pub chords: Vec<RefinedChord>,
    /// Vertices on the true edge, chord after chord, each from its first to its last.
    pub points: Vec<u32>,
}

/// One chord whose wall is left out, and the triangles in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RefinedChord {
    pub arc: u32,
    /// Boundary vertex where the chord starts.
    pub vertex: u32,
    pub first_index: u32,
    pub index_count: u32,
    pub first_point: u32,
    pub point_count: u32,
}

impl Patch {
    /// The surface points that stand for a refined chord, from its first vertex to its last.
    pub(crate) fn polyline(&self, chord: &RefinedChord) -> impl Iterator<Item = FixedVertex> {
        let first = chord.first_point as usize;
        self.points[first..first + chord.point_count as usize]
            .iter()
            .map(|&point| self.vertices[point as usize])
    }

    /// Refines what `sight` needs of the arc.
    pub(crate) fn refine_arc(&mut self, mesh: &FillMesh, arc_index: u32, sight: &Sight) {
        let arc = &mesh.arcs[arc_index as usize];
        let nearest_m = sight.distance_to_m(&arc.bounds);
        let longest_m = 2.1 * arc.bounds.radius_rad * mesh.ellipsoid.a_m;
        let limits = Limits::at(sight, nearest_m);
        let (middle_m, radius_m) = sight.sphere(&arc.bounds);
        let farthest_m = middle_m.length() + radius_m;
        let may_cut = column_reach_m(sight, farthest_m) > reach_at_m(sight, nearest_m);
        if !may_cut && !limits.exceeded_by(longest_m, mesh_deviation_m(mesh, arc)) {
            return;
        }
        let is_cut = |point_m: DVec3| cuts_m(point_m, sight).next().is_some();
        let mut a_is_cut = is_cut(mesh.vertices[arc.first_vertex as usize]);
        for vertex in arc.first_vertex..arc.first_vertex + arc.vertex_count - 1 {
            let a = mesh.vertices[vertex as usize];
            let b = mesh.vertices[vertex as usize + 1];
            let b_is_cut = is_cut(b);
            let limits = Limits::at(sight, sight.distance_to_wall_m(a, b));
            let deviation_m = f64::from(mesh.boundary[vertex as usize].deviation_m);
            if a_is_cut || b_is_cut || limits.exceeded_by(a.distance(b), deviation_m) {
                self.refine_chord(mesh, arc_index, vertex, sight);
            }
            a_is_cut = b_is_cut;
        }
    }

    fn refine_chord(&mut self, mesh: &FillMesh, arc: u32, vertex: u32, sight: &Sight) {
        let first_index = self.indices.len() as u32;
        let points_m = true_edge_points(mesh, vertex, sight);
        let columns: Vec<Column> = points_m
            .iter()
            .map(|&point_m| self.add_column(point_m, sight))
            .collect();
        for pair in columns.windows(2) {
            self.add_wall(&pair[0], &pair[1]);
        }
        self.add_ears(&columns);
        let first_point = self.points.len() as u32;
        self.points.extend(columns.iter().map(|column| column.base));
        self.chords.push(RefinedChord {
            arc,
            vertex,
            first_index,
            index_count: self.indices.len() as u32 - first_index,
            first_point,
            point_count: columns.len() as u32,
        });
    }

    /// A column from bottom to top, cut where it must be.
    fn add_column(&mut self, surface_m: DVec3, sight: &Sight) -> Column {
        let base = self.vertices.len() as u32;
        self.vertices.push(encode(surface_m));
        let normal = sight.ellipsoid.normal_at_surface(surface_m);
        let mut corners = vec![4 * base + BOTTOM];
        for cut_m in cuts_m(surface_m, sight) {
            corners.push(4 * self.vertices.len() as u32 + AS_IS);
            self.vertices.push(encode(surface_m + normal * cut_m));
        }
        corners.push(4 * base + TOP);
        Column { base, corners }
    }

    /// The wall between two columns, outward to the right of the walk from `a` to `b`.
    fn add_wall(&mut self, a: &Column, b: &Column) {
        let (mut i, mut j) = (0, 0);
        while i + 1 < a.corners.len() || j + 1 < b.corners.len() {
            let (low_a, low_b) = (a.corners[i], b.corners[j]);
            // Cut columns first: the diagonals then stay within the same range of heights.
            let climb_a = j + 1 == b.corners.len()
                || (i + 1 < a.corners.len() && a.left_above(i) >= b.left_above(j));
            if climb_a {
                i += 1;
                self.indices.extend([a.corners[i], low_a, low_b]);
            } else {
                j += 1;
                self.indices.extend([b.corners[j], low_a, low_b]);
            }
        }
    }

    /// Between the chord and the polyline: the caps keep the chord, the walls follow the polyline.
    fn add_ears(&mut self, columns: &[Column]) {
        let start = columns[0].base;
        for pair in columns[1..].windows(2) {
            let (near, far) = (pair[0].base, pair[1].base);
            self.indices
                .extend([start, near, far].map(|vertex| 4 * vertex + TOP));
            self.indices
                .extend([start, far, near].map(|vertex| 4 * vertex + BOTTOM));
        }
    }
}

/// Heights, metres, at which a column is cut: above and below the eye, where its ends stand too far away
/// from it, or far from the ellipsoid that they are raised from. They depend on the column and the eye
/// alone, so that all walls at a column cut it alike.
fn cuts_m(surface_m: DVec3, sight: &Sight) -> impl Iterator<Item = f64> {
    let distance_m = surface_m.distance(sight.eye_ecef_m);
    let bottom_m = sight.extrusion.bottom_at_m(distance_m);
    let top_m = sight.extrusion.top_at_m(distance_m);
    let reach_m = reach_at_m(sight, sight.distance_to_wall_m(surface_m, surface_m));
    let middle_m = sight.nearest_surface_height_m();
    // Within half the slack there is no surface.
    let inset_m = 0.5 * sight.extrusion.slack_m(distance_m);
    let ends_m = [
        (middle_m - reach_m, bottom_m, bottom_m + inset_m),
        (middle_m + reach_m, top_m, top_m - inset_m),
    ];
    ends_m
        .into_iter()
        .filter_map(move |(cut_m, end_m, near_end_m)| {
            if cut_m > bottom_m + 1.0 && cut_m < top_m - 1.0 {
                Some(cut_m)
            } else {
                (end_m.abs() > reach_m).then_some(near_end_m)
            }
        })
}

/// How far, metres, columns at a distance from the eye reach beyond the surface that is nearest to it, or
/// from the ellipsoid that they are raised from.
fn column_reach_m(sight: &Sight, distance_m: f64) -> f64 {
    let bottom_m = sight.extrusion.bottom_at_m(distance_m);
    let top_m = sight.extrusion.top_at_m(distance_m);
    let middle_m = sight.nearest_surface_height_m();
    let beyond_m = (top_m - middle_m).max(middle_m - bottom_m);
    beyond_m.max(top_m.abs()).max(bottom_m.abs())
}

/// A column's vertex and its corners from bottom to top, as indices of the patch.
struct Column {
    base: u32,
    corners: Vec<u32>,
}

impl Column {
    fn left_above(&self, corner: usize) -> usize {
        self.corners.len() - 1 - corner
    }
}

/// How far, metres, walls and columns may reach that are seen from a given distance.
fn reach_at_m(sight: &Sight, distance_m: f64) -> f64 {
    REACH * sight.pixel.distance_m(REACH_PIXEL_RAD, distance_m)
}

/// What a chord may be where it is seen from a given distance.
struct Limits {
    tolerance_m: f64,
    length_m: f64,
    /// Length times wall height, square metres.
    area_m2: f64,
    wall_m: f64,
    /// Whether columns must be cut.
    columns_reach_too_far: bool,
}

impl Limits {
    fn at(sight: &Sight, distance_m: f64) -> Self {
        let tolerance_m = sight.tolerance_m(distance_m);
        let top_m = sight.extrusion.top_at_m(distance_m);
        let bottom_m = sight.extrusion.bottom_at_m(distance_m);
        let ellipsoid = sight.ellipsoid;
        // e′²: flat walls with skew end normals miss the edge by e′²·cos²φ·(s/R)·H/8.
        let skew = (ellipsoid.a_m / ellipsoid.b_m).powi(2) - 1.0;
        Self {
            tolerance_m,
            length_m: reach_at_m(sight, distance_m),
            area_m2: 8.0 * ellipsoid.b_m * tolerance_m / skew.abs(),
            wall_m: top_m - bottom_m,
            columns_reach_too_far: column_reach_m(sight, distance_m)
                > reach_at_m(sight, distance_m),
        }
    }

    /// Whether a chord is too coarse whatever its columns do.
    fn too_coarse(&self, length_m: f64, deviation_m: f64) -> bool {
        deviation_m > self.tolerance_m
            || length_m > self.length_m
            || length_m * self.wall_m > self.area_m2
    }

    fn exceeded_by(&self, length_m: f64, deviation_m: f64) -> bool {
        self.columns_reach_too_far || self.too_coarse(length_m, deviation_m)
    }
}

/// Whether chords of at most this length and deviation, seen from `distance_m` or farther, do as they are.
pub(crate) fn needs_no_refinement(
    sight: &Sight,
    distance_m: f64,
    length_m: f64,
    deviation_m: f64,
) -> bool {
    !Limits::at(sight, distance_m).exceeded_by(length_m, deviation_m)
}

/// Points on the true edge, from the chord's first to its last, fine enough for `sight`.
fn true_edge_points(mesh: &FillMesh, vertex: u32, sight: &Sight) -> Vec<DVec3> {
    let vertex = vertex as usize;
    let (from, to) = (mesh.boundary[vertex], mesh.boundary[vertex + 1]);
    let end_t = if to.curve == from.curve { to.t } else { 1.0 };
    let curve = mesh.curves[from.curve as usize].on(&mesh.ellipsoid);
    let mut points_m = vec![mesh.vertices[vertex]];
    let start = (from.t, mesh.vertices[vertex]);
    halve(
        &curve,
        start,
        (end_t, mesh.vertices[vertex + 1]),
        sight,
        MAX_HALVINGS,
        &mut points_m,
    );
    points_m
}

/// Appends the points after `a` up to `b`; each is a curve parameter and its surface point.
fn halve(
    curve: &CurveOn,
    a: (f64, DVec3),
    b: (f64, DVec3),
    sight: &Sight,
    halvings: u32,
    points_m: &mut Vec<DVec3>,
) {
    let limits = Limits::at(sight, sight.distance_to_wall_m(a.1, b.1));
    let too_coarse =
        halvings > 0 && limits.too_coarse(a.1.distance(b.1), curve.deviation_bound_m(a.0, b.0));
    if !too_coarse {
        points_m.push(b.1);
        return;
    }
    let middle_t = 0.5 * (a.0 + b.0);
    let middle = (middle_t, curve.ecef(middle_t));
    halve(curve, a, middle, sight, halvings - 1, points_m);
    halve(curve, middle, b, sight, halvings - 1, points_m);
}

fn mesh_deviation_m(mesh: &FillMesh, arc: &Arc) -> f64 {
    let first = arc.first_vertex as usize;
    mesh.boundary[first..first + arc.vertex_count as usize]
        .iter()
        .fold(0.0, |most: f32, vertex| most.max(vertex.deviation_m))
        .into()
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod wall_tests;
