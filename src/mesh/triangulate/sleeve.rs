//! Walks along edges of a triangulation that stay close to a straight line.

use glam::DVec3;
use spade::{
    Intersection, LineIntersectionIterator, Triangulation,
    handles::{FixedDirectedEdgeHandle, FixedVertexHandle},
};

use super::constrained::Cdt;

/// A walk from `from` to `to`: the edge itself where there is one, else the pieces of it between
/// vertices on the line, else the shortest walk on the edges of the triangles that the line crosses.
///
/// `None` if the walk breaks off, which a sound triangulation rules out.
pub(super) fn walk(
    cdt: &Cdt,
    points: &[DVec3],
    from: FixedVertexHandle,
    to: FixedVertexHandle,
) -> Option<Vec<FixedDirectedEdgeHandle>> {
    if let Some(edge) = cdt.get_edge_from_neighbors(from, to) {
        return Some(vec![edge.fix()]);
    }
    let mut vertices = vec![from];
    let mut sleeve = Sleeve::new(points, from);
    for intersection in LineIntersectionIterator::new_from_handles(cdt, from, to) {
        let reached = match intersection {
            // The line's end is on the edge's left: the edge runs from the line's left to its right.
            Intersection::EdgeIntersection(edge) => {
                sleeve.cross(edge.from().fix(), edge.to().fix());
                continue;
            }
            Intersection::VertexIntersection(vertex) => vertex.fix(),
            Intersection::EdgeOverlap(edge) => edge.to().fix(),
        };
        if vertices.last() != Some(&reached) {
            vertices.extend(sleeve.shortest_to(reached));
            sleeve = Sleeve::new(points, reached);
        }
    }
    if vertices.last() != Some(&to) {
        return None;
    }
    let edge =
        |pair: &[FixedVertexHandle]| Some(cdt.get_edge_from_neighbors(pair[0], pair[1])?.fix());
    vertices.windows(2).map(edge).collect()
}

/// The triangles crossed by a line that leaves a vertex, with the shortest walks to their corners.
struct Sleeve<'a> {
    points: &'a [DVec3],
    nodes: Vec<Node>,
    /// The ends of the edge crossed last, as indices of nodes; both the start before the first.
    left: usize,
    right: usize,
}

#[derive(Clone, Copy)]
struct Node {
    vertex: FixedVertexHandle,
    length: f64,
    before: usize,
}

impl<'a> Sleeve<'a> {
    fn new(points: &'a [DVec3], start: FixedVertexHandle) -> Self {
        let node = Node {
            vertex: start,
            length: 0.0,
            before: 0,
        };
        Self {
            points,
            nodes: vec![node],
            left: 0,
            right: 0,
        }
    }

    /// Goes on over the edge from `left` to `right`, which shares an end with the one before.
    fn cross(&mut self, left: FixedVertexHandle, right: FixedVertexHandle) {
        let (old_left, old_right) = (self.left, self.right);
        if self.nodes[old_left].vertex != left {
            self.left = self.reach(left, [old_left, old_right]);
        }
        if self.nodes[old_right].vertex != right {
            self.right = self.reach(right, [self.left, old_right]);
        }
    }

    /// Adds a corner that has edges to two known ones.
    fn reach(&mut self, vertex: FixedVertexHandle, known: [usize; 2]) -> usize {
        let through = known.map(|before| Node {
            vertex,
            length: self.nodes[before].length + self.distance(self.nodes[before].vertex, vertex),
            before,
        });
        let shorter = if through[0].length <= through[1].length {
            through[0]
        } else {
            through[1]
        };
        self.nodes.push(shorter);
        self.nodes.len() - 1
    }

    fn distance(&self, a: FixedVertexHandle, b: FixedVertexHandle) -> f64 {
        self.points[a.index()].distance(self.points[b.index()])
    }

    /// The vertices of the shortest walk to the vertex where the line ends, without the start.
    fn shortest_to(mut self, end: FixedVertexHandle) -> Vec<FixedVertexHandle> {
        let mut at = self.reach(end, [self.left, self.right]);
        let mut vertices = Vec::new();
        while at != 0 {
            vertices.push(self.nodes[at].vertex);
            at = self.nodes[at].before;
        }
        vertices.reverse();
        vertices
    }
}
