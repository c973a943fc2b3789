//! Arcs: runs of boundary with the same pieces on either side, each found once.

use crate::{
    boundary::boundary_graph::{BoundaryGraph, DirectedEdge},
    boundary::inside::Boundary,
};

/// No piece.
const NOBODY: u32 = u32::MAX;

/// Which pieces lie beside each edge.
pub(crate) struct EdgeSides {
    /// Per directed edge (as numbered) the piece to its left.
    left: Vec<u32>,
    /// Further pieces to the left of a directed edge: they overlap the first.
    further: Vec<(DirectedEdge, u32)>,
    /// Per node the number of edges that bound a piece, counted to 255.
    degree: Vec<u8>,
}

impl EdgeSides {
    pub(crate) fn new(graph: &BoundaryGraph, pieces: &[Boundary]) -> Self {
        let mut sides = Self {
            left: vec![NOBODY; 2 * graph.edges.len()],
            further: Vec::new(),
            degree: vec![0; graph.nodes.len()],
        };
        for (piece, boundary) in pieces.iter().enumerate() {
            for &edge in boundary.loops.iter().flatten() {
                sides.add(graph, edge, piece as u32);
            }
        }
        sides
    }

    fn add(&mut self, graph: &BoundaryGraph, edge: DirectedEdge, piece: u32) {
        if self.is_bare(edge.edge()) {
            for node in [graph.start_node(edge), graph.end_node(edge)] {
                let degree = &mut self.degree[node as usize];
                *degree = degree.saturating_add(1);
            }
        }
        let left = &mut self.left[edge.index()];
        if *left == NOBODY {
            *left = piece;
        } else {
            self.further.push((edge, piece));
        }
    }

    /// Whether no piece lies beside the edge.
    pub(crate) fn is_bare(&self, edge: u32) -> bool {
        let forward = DirectedEdge::new(edge, true);
        self.left_of(forward).is_none() && self.left_of(forward.reversed()).is_none()
    }

    /// The piece to the left of an edge, the first if there are several.
    pub(crate) fn left_of(&self, edge: DirectedEdge) -> Option<u32> {
        Some(self.left[edge.index()]).filter(|&piece| piece != NOBODY)
    }

    /// Pieces to the left of an edge that has another one there already.
    pub(crate) fn further(&self) -> &[(DirectedEdge, u32)] {
        &self.further
    }

    /// How many edges that bound pieces meet at a node, up to 255.
    pub(crate) fn degree(&self, node: u32) -> u8 {
        self.degree[node as usize]
    }
}

/// A run of edges with the same pieces on either side.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Chain {
    pub(crate) edges: Vec<DirectedEdge>,
    pub(crate) left: u32,
    pub(crate) right: Option<u32>,
    /// Whether another chain runs along the same edges: where pieces overlap, each further one gets
    /// a chain of its own.
    pub(crate) is_copy: bool,
}

/// Longer chains are cut, so that arcs far away from the eye can be told from near ones.
const MAX_CHAIN_EDGES: usize = 2048;

/// Every side of every piece in exactly one chain; common borders in one for both.
pub(crate) fn chains(graph: &BoundaryGraph, sides: &EdgeSides, pieces: &[Boundary]) -> Vec<Chain> {
    let mut chains = Vec::new();
    for (piece, boundary) in pieces.iter().enumerate() {
        for edges in &boundary.loops {
            add_chains_of_loop(graph, sides, piece as u32, edges, &mut chains);
        }
    }
    chains
}

fn add_chains_of_loop(
    graph: &BoundaryGraph,
    sides: &EdgeSides,
    piece: u32,
    edges: &[DirectedEdge],
    chains: &mut Vec<Chain>,
) {
    // What lies beside an edge: whether this piece is the first there, and who is opposite.
    let beside = |edge: DirectedEdge| {
        let is_first = sides.left_of(edge) == Some(piece);
        (
            is_first,
            sides.left_of(edge.reversed()).filter(|_| is_first),
        )
    };
    let starts_chain = |index: usize| {
        let (edge, last) = (edges[index], edges[(index + edges.len() - 1) % edges.len()]);
        sides.degree(graph.start_node(edge)) != 2 || beside(edge) != beside(last)
    };
    let first = (0..edges.len())
        .find(|&index| starts_chain(index))
        .unwrap_or(0);
    let mut open: Option<Chain> = None;
    for step in 0..edges.len() {
        let index = (first + step) % edges.len();
        let edge = edges[index];
        let full = |chain: &Chain| chain.edges.len() >= MAX_CHAIN_EDGES;
        if step == 0 || starts_chain(index) || open.as_ref().is_some_and(full) {
            chains.extend(open.take());
            let (is_first, right) = beside(edge);
            // The piece with the smaller number stores the border for both.
            if right.is_none_or(|right| piece < right) {
                let edges = Vec::new();
                open = Some(Chain {
                    edges,
                    left: piece,
                    right,
                    is_copy: !is_first,
                });
            }
        }
        if let Some(chain) = &mut open {
            chain.edges.push(edge);
        }
    }
    chains.extend(open);
}
