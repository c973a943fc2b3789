//! Where the mesh keeps the vertices of nodes and edges.

use crate::{
    boundary::arcs::Chain,
    boundary::boundary_graph::{BoundaryGraph, DirectedEdge},
    mesh::densify::DenseChain,
};

/// Where the vertices of the graph's nodes and edges are in the mesh.
pub(crate) struct VertexRuns {
    /// Per node one of its vertices.
    node: Vec<u32>,
    /// Per edge its first and its last vertex, from its smaller node to its greater.
    edge: Vec<(u32, u32)>,
}

impl VertexRuns {
    pub(crate) fn new(graph: &BoundaryGraph) -> Self {
        Self {
            node: vec![u32::MAX; graph.nodes.len()],
            edge: vec![(u32::MAX, u32::MAX); graph.edges.len()],
        }
    }

    /// Notes where a chain's vertices are, the first at `first_vertex`.
    pub(crate) fn add(
        &mut self,
        graph: &BoundaryGraph,
        chain: &Chain,
        dense: &DenseChain,
        first_vertex: u32,
    ) {
        let end = dense.vertices.len() as u32 - 1;
        let starts = dense
            .edge_starts
            .iter()
            .copied()
            .chain([end])
            .map(|start| first_vertex + start);
        let starts: Vec<u32> = starts.collect();
        for (&edge, run) in chain.edges.iter().zip(starts.windows(2)) {
            self.node[graph.start_node(edge) as usize] = run[0];
            self.node[graph.end_node(edge) as usize] = run[1];
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

    /// The vertices of a loop, one for each position.
    pub(crate) fn loop_vertices(&self, graph: &BoundaryGraph, edges: &[DirectedEdge]) -> Vec<u32> {
        let mut vertices = Vec::with_capacity(edges.len());
        for &edge in edges {
            let (from, to) = self.edge[edge.edge() as usize];
            vertices.push(self.node[graph.start_node(edge) as usize]);
            let inner = from.abs_diff(to) as usize - 1;
            vertices.extend(self.along(edge).skip(1).take(inner));
        }
        vertices
    }
}
