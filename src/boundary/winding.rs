//! What a ring that crosses itself winds round: the rule of zones.

use rustc_hash::FxHashMap;

use crate::{
    boundary::boundary_graph::{BoundaryGraph, DirectedEdge},
    boundary::noding::PolygonWalk,
    boundary::simple_loops::Stars,
    ellipsoid::Ellipsoid,
};

/// How often each edge is walked forward more than backward, where that is not 0.
type Uses = FxHashMap<u32, i32>;
/// For each edge the winding number to its left, walked forward, up to a common constant.
type Windings = FxHashMap<u32, i32>;

/// Loops round what noded rings wind round at least once, which lies to their left.
///
/// Crossing an edge from right to left adds to the winding number what the edge is walked more often
/// forward than backward; so from one edge the numbers of all that hang together with it follow. The
/// least is that of the outside. None if the rings do not hang together, or if the numbers contradict
/// each other: then the noding missed a crossing, because edges lie too close to tell.
pub(crate) fn loops_round_winding(
    ellipsoid: &Ellipsoid,
    graph: &BoundaryGraph,
    walk: &PolygonWalk,
) -> Option<Vec<Vec<DirectedEdge>>> {
    let edges = || walk.rings.iter().flat_map(|ring| &ring.edges).copied();
    let mut uses = Uses::default();
    for edge in edges() {
        *uses.entry(edge.edge()).or_default() += if edge.is_forward() { 1 } else { -1 };
    }
    uses.retain(|_, uses| *uses != 0);
    // In the order of the walk, so that the same input gives the same loops.
    let mut walked: Vec<DirectedEdge> = Vec::with_capacity(uses.len());
    let mut seen = FxHashMap::default();
    for edge in edges().filter(|edge| uses.contains_key(&edge.edge())) {
        if seen.insert(edge.edge(), ()).is_none() {
            walked.push(DirectedEdge::new(edge.edge(), true));
        }
    }
    let stars = Stars::new(ellipsoid, graph, walked.iter().copied());
    let windings = windings(graph, &stars, &uses, *walked.first()?)?;
    if windings.len() < walked.len() {
        return None;
    }
    let sides = |edge: &DirectedEdge| {
        let left = windings[&edge.edge()];
        (left, left - uses[&edge.edge()])
    };
    let outside = walked.iter().map(sides).map(|(l, r)| l.min(r)).min()?;
    let kept: Vec<DirectedEdge> = walked
        .iter()
        .filter_map(|edge| match sides(edge) {
            (left, right) if left == outside && right > outside => Some(edge.reversed()),
            (left, right) if left > outside && right == outside => Some(*edge),
            _ => None,
        })
        .collect();
    is_balanced(graph, &kept).then(|| stars.loops(graph, &kept))
}

/// Winding numbers from that to the left of `first`, set to 0; none if they contradict each other.
fn windings(
    graph: &BoundaryGraph,
    stars: &Stars,
    uses: &Uses,
    first: DirectedEdge,
) -> Option<Windings> {
    let mut windings = Windings::default();
    windings.insert(first.edge(), 0);
    let mut reached = vec![first];
    let mut next = 0;
    while let Some(&edge) = reached.get(next) {
        next += 1;
        for outgoing in [edge, edge.reversed()] {
            let star = stars.edges_at(graph.start_node(outgoing));
            let own = star.iter().position(|&other| other == outgoing)?;
            let mut left = windings[&edge.edge()];
            if !outgoing.is_forward() {
                left -= uses[&edge.edge()];
            }
            // Counter-clockwise, what lies to the left of one lies to the right of the next.
            for step in 1..star.len() {
                let other = star[(own + step) % star.len()];
                let uses = uses[&other.edge()];
                let left_of_forward = if other.is_forward() {
                    left + uses
                } else {
                    left
                };
                left = if other.is_forward() {
                    left + uses
                } else {
                    left - uses
                };
                match windings.insert(other.edge(), left_of_forward) {
                    None => reached.push(other),
                    Some(before) if before != left_of_forward => return None,
                    Some(_) => {}
                }
            }
        }
    }
    Some(windings)
}

/// Whether as many edges arrive at every node as leave it.
fn is_balanced(graph: &BoundaryGraph, edges: &[DirectedEdge]) -> bool {
    let mut excess: FxHashMap<u32, i32> = FxHashMap::default();
    for &edge in edges {
        *excess.entry(graph.start_node(edge)).or_default() += 1;
        *excess.entry(graph.end_node(edge)).or_default() -= 1;
    }
    excess.values().all(|&excess| excess == 0)
}
