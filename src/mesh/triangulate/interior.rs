//! Interior vertices: as many as the sag limit asks for.

use glam::{DVec2, DVec3};
use spade::{PositionInTriangulation, Triangulation, handles::FixedVertexHandle};

use super::{
    chart::Chart,
    constrained::{Constrained, Face, position},
    lattice::LATTICE,
    sag,
};

/// Lattice points nearer than this to a corner of their triangle are left out, radians (0.9°, half
/// the lattice's spacing).
const CLEARANCE_RAD: f64 = 0.0157;
/// Rounds of splitting. Each halves what is too long; 2° to 180° needs seven.
const ROUNDS: usize = 40;
/// Interior vertices after which nothing more is split. The whole globe needs 14 442; loops that
/// need more have chords longer than 2°, or wind around all of it many times.
const INTERIOR_MAX: usize = 40_000;

/// Adds vertices until no filled triangle sags too deep: lattice points in the wide parts first, then
/// the middles of sides that are too long. The boundary is never split.
pub(super) fn refine(constrained: &mut Constrained) {
    let deep = deep_faces(constrained);
    if !deep.contains(&true) {
        return;
    }
    for (point, near) in lattice_points(constrained, &deep) {
        constrained.insert(constrained.chart.project(point), point, near);
    }
    for _ in 0..ROUNDS {
        if constrained.interior_count() > INTERIOR_MAX || !split_long_sides(constrained) {
            break;
        }
    }
    debug_assert!(constrained.is_wound());
}

/// Per face, whether it is filled and sags too deep.
fn deep_faces(constrained: &Constrained) -> Vec<bool> {
    let mut deep = vec![false; constrained.cdt.num_all_faces()];
    let outer = constrained.cdt.outer_face().fix();
    deep[outer.index()] = constrained.winding_of_pole != 0;
    for face in constrained.cdt.fixed_inner_faces() {
        deep[face.index()] = is_deep(constrained, face);
    }
    deep
}

fn is_deep(constrained: &Constrained, face: Face) -> bool {
    if constrained.winding(face) == 0 {
        return false;
    }
    sag::deeper(sag::limit(), constrained.corners(face)) > sag::limit()
}

/// The lattice points in deep faces, away from their corners, each with one of these.
fn lattice_points(constrained: &Constrained, deep: &[bool]) -> Vec<(DVec3, FixedVertexHandle)> {
    let centre = constrained.chart.centre();
    let pole_is_inside = constrained.winding_of_pole != 0;
    let boundary = constrained.points.iter().map(|p| p.dot(centre));
    let lowest = if pole_is_inside {
        -1.0
    } else {
        boundary.fold(1.0, f64::min)
    };
    let clear =
        |point: DVec3, corner: DVec3| corner.distance_squared(point) > CLEARANCE_RAD.powi(2);
    let mut found = Vec::new();
    for &point in LATTICE.points.iter().filter(|p| p.dot(centre) > lowest) {
        // The pole, a lattice point where it is inside, is a vertex already.
        if pole_is_inside && !clear(point, -centre) {
            continue;
        }
        let position = position(constrained.chart.project(point));
        match constrained.cdt.locate(position) {
            PositionInTriangulation::OnFace(face) => {
                let corners = constrained.corners(face);
                if deep[face.index()] && corners.into_iter().all(|c| clear(point, c)) {
                    let corner = constrained.cdt.face(face).vertices()[0];
                    found.push((point, corner.fix()));
                }
            }
            PositionInTriangulation::OutsideOfConvexHull(edge) if pole_is_inside => {
                let ends = constrained.cdt.directed_edge(edge).vertices();
                if ends
                    .iter()
                    .all(|v| clear(point, constrained.points[v.index()]))
                {
                    found.push((point, ends[0].fix()));
                }
            }
            _ => {}
        }
    }
    found
}

/// Splits the longest side of every deep face; whether there was any to split.
fn split_long_sides(constrained: &mut Constrained) -> bool {
    let faces = constrained.cdt.fixed_inner_faces();
    let deep = faces.filter(|&face| is_deep(constrained, face));
    let mut sides: Vec<_> = deep
        .filter_map(|face| longest_side(constrained, face))
        .collect();
    sides.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    sides.dedup_by_key(|side| side.1);
    for &(_, [from, to]) in &sides {
        // Splitting a longer side may have removed this one.
        let [from, to] = [from, to].map(FixedVertexHandle::from_index);
        if constrained.cdt.get_edge_from_neighbors(from, to).is_some() {
            let plane = middle(constrained, [from, to]);
            constrained.insert(plane, constrained.chart.unproject(plane), from);
        }
    }
    !sides.is_empty()
}

/// Squared length and vertices, in ascending order, of a face's longest side, unless that is boundary.
///
/// It never is where no chord is longer than 2° of arc; and where one is, splitting the other sides
/// would not end.
fn longest_side(constrained: &Constrained, face: Face) -> Option<(f64, [usize; 2])> {
    let edges = constrained.cdt.face(face).adjacent_edges();
    let sides = edges.map(|edge| {
        let mut ends = edge.vertices().map(|v| v.index());
        ends.sort_unstable();
        let [a, b] = ends.map(|v| constrained.points[v]);
        (a.distance_squared(b), ends, edge.is_constraint_edge())
    });
    let longest = sides.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
    longest.and_then(|(length, ends, boundary)| (!boundary).then_some((length, ends)))
}

/// The point of the straight edge in the chart that is equally far, on the sphere, from both ends.
fn middle(constrained: &Constrained, ends: [FixedVertexHandle; 2]) -> DVec2 {
    let [a, b] = ends.map(|end| {
        let position = constrained.cdt.vertex(end).position();
        DVec2::new(position.x, position.y)
    });
    // The chord between images p, q is |p − q| √(scale(p) scale(q)).
    let [near_a, near_b] = [a, b].map(|p| Chart::scale(p).sqrt());
    (a * near_a + b * near_b) / (near_a + near_b)
}
