//! Where the mesh keeps the vertices of edges.

use crate::{
    boundary::arcs::Chain,
    boundary::boundary_graph::{BoundaryGraph, DirectedEdge},
    mesh::densify::DenseChain,
};

/// Where the vertices of the graph's edges are in the mesh.
pub(crate) struct VertexRuns {
    /// Per edge its first and its last vertex, from its smaller node to its greater.
    edge: Vec<(u32, u32)>,
}

impl VertexRuns {
    pub(crate) fn new(graph: &BoundaryGraph) -> Self {
        Self {
            edge: vec![(u32::MAX, u32::MAX); graph.edges.len()],
        }
    }

    /// Notes where a chain's vertices are, the first at `first_vertex`.
    pub(crate) fn add(&mut self, chain: &Chain, dense: &DenseChain, first_vertex: u32) {
        let end = dense.vertices.len() as u32 - 1;
        let starts = dense
            .edge_starts
            .iter()
            .copied()
            .chain([end])
            .map(|start| first_vertex + start);
        let starts: Vec<u32> = starts.collect();
        for (&edge, run) in chain.edges.iter().zip(starts.windows(2)) {
            self.edge[edge.edge() as usize] = if edge.is_forward() {
                (run[0], run[1])
            } else {
                (run[1], run[0])
            };
        }
    }

    /// The vertices of an edge as it is walked.
    pub(crate) fn along(&self, edge: DirectedEdge) -> impl Iterator<Item = u32> + use<> {
        let (from, to) = self.edge[edge.edge() as usize];
        let (from, to) = if edge.is_forward() {
            (from, to)
        } else {
            (to, from)
        };
        let step = move |k: u32| if from <= to { from + k } else { from - k };
        (0..=from.abs_diff(to)).map(step)
    }

    /// The vertices of a loop, one for each position: at nodes that of the arc that goes on from there.
    pub(crate) fn loop_vertices(&self, edges: &[DirectedEdge]) -> Vec<u32> {
        let but_last = |&edge: &DirectedEdge| {
            let (from, to) = self.edge[edge.edge() as usize];
            self.along(edge).take(from.abs_diff(to) as usize)
        };
        edges.iter().flat_map(but_last).collect()
    }
}
