//! Rings that touch, cross or retrace themselves → simple loops.

use rustc_hash::FxHashMap;

use crate::{
    boundary::boundary_graph::{BoundaryGraph, DirectedEdge},
    boundary::noding::PolygonWalk,
    ellipsoid::Ellipsoid,
    repair::{Place, Repair, RepairKind},
};

/// A connected part of a polygon's boundary, directed so that one and the same side (inside or
/// outside, still to be found out) lies to the left of all of it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Component {
    /// Closed, none visits a node twice; they may touch each other at nodes.
    pub(crate) loops: Vec<Vec<DirectedEdge>>,
    /// The first ring that has an edge in it; 0 is the shell.
    pub(crate) ring: usize,
}

impl Component {
    pub(crate) fn is_hole(&self) -> bool {
        self.ring > 0
    }

    pub(crate) fn edges(&self) -> impl Iterator<Item = DirectedEdge> + Clone {
        self.loops.iter().flatten().copied()
    }

    pub(crate) fn reverse(&mut self) {
        for edges in &mut self.loops {
            edges.reverse();
            edges.iter_mut().for_each(|edge| *edge = edge.reversed());
        }
    }
}

/// The boundary of a noded polygon by the even-odd rule.
///
/// An edge walked an even number of times bounds nothing and is dropped. Round every node the
/// remaining edges bound sectors that lie inside and outside in turn, which directs all edges that
/// hang together; of the two ways to do so that is taken in which most edges keep the direction of
/// their ring.
pub(crate) fn even_odd_components(
    ellipsoid: &Ellipsoid,
    graph: &BoundaryGraph,
    polygon: &PolygonWalk,
    repairs: &mut Vec<Repair>,
) -> Vec<Component> {
    let uses = odd_uses(polygon, repairs);
    let stars = Stars::new(ellipsoid, graph, uses.iter().map(|&(edge, _)| edge));
    report_pinches(graph, polygon, &stars, repairs);
    let mut directed: FxHashMap<u32, DirectedEdge> = FxHashMap::default();
    let mut components = Vec::new();
    for &(start, _) in &uses {
        if directed.contains_key(&start.edge()) {
            continue;
        }
        let edges = stars.direct_from(graph, start, &mut directed);
        components.push(edges);
    }
    let ring_of: FxHashMap<u32, (DirectedEdge, usize)> = uses
        .iter()
        .map(|&(edge, ring)| (edge.edge(), (edge, ring)))
        .collect();
    components
        .into_iter()
        .map(|mut edges| {
            let agreeing = edges
                .iter()
                .filter(|edge| ring_of[&edge.edge()].0 == **edge)
                .count();
            if 2 * agreeing < edges.len() {
                edges.iter_mut().for_each(|edge| *edge = edge.reversed());
            }
            let rings = edges.iter().map(|edge| ring_of[&edge.edge()].1);
            Component {
                ring: rings.min().unwrap_or(0),
                loops: stars.loops(graph, &edges),
            }
        })
        .collect()
}

/// Edges walked an odd number of times, in the direction they are mostly walked, with their ring.
fn odd_uses(polygon: &PolygonWalk, repairs: &mut Vec<Repair>) -> Vec<(DirectedEdge, usize)> {
    let mut counts: FxHashMap<u32, (u32, i32)> = FxHashMap::default();
    for edge in polygon.rings.iter().flat_map(|ring| &ring.edges) {
        let count = counts.entry(edge.edge()).or_default();
        count.0 += 1;
        count.1 += if edge.is_forward() { 1 } else { -1 };
    }
    let mut uses = Vec::new();
    for (ring, walk) in polygon.rings.iter().enumerate() {
        let mut in_seam = false;
        for (edge, &vertex) in walk.edges.iter().zip(&walk.vertices) {
            // Each edge is dealt with where it is walked first.
            let Some((count, sum)) = counts.remove(&edge.edge()) else {
                continue;
            };
            if count % 2 == 1 {
                uses.push((DirectedEdge::new(edge.edge(), sum > 0), ring));
            } else if !in_seam {
                let place = Place {
                    ring,
                    vertex: vertex as usize,
                    ..polygon.place
                };
                repairs.push(Repair {
                    place,
                    kind: RepairKind::Seam,
                });
            }
            in_seam = count % 2 == 0;
        }
    }
    uses
}

/// Nodes where more than two edges remain, and which no crossing made, are pinches of the input.
fn report_pinches(
    graph: &BoundaryGraph,
    polygon: &PolygonWalk,
    stars: &Stars,
    repairs: &mut Vec<Repair>,
) {
    let mut visited: FxHashMap<u32, ()> = FxHashMap::default();
    for (ring, walk) in polygon.rings.iter().enumerate() {
        let mut last_vertex = u32::MAX;
        for (&edge, &vertex) in walk.edges.iter().zip(&walk.vertices) {
            let node = graph.start_node(edge);
            // Later parts of a split edge start at nodes that are no vertices of this ring.
            let is_vertex = std::mem::replace(&mut last_vertex, vertex) != vertex;
            if is_vertex && stars.edges_at(node).len() > 2 && visited.insert(node, ()).is_none() {
                let place = Place {
                    ring,
                    vertex: vertex as usize,
                    ..polygon.place
                };
                repairs.push(Repair {
                    place,
                    kind: RepairKind::Pinch,
                });
            }
        }
    }
}

/// For every node the edges that start there, counter-clockwise.
pub(crate) struct Stars {
    edges_at: FxHashMap<u32, Vec<DirectedEdge>>,
}

impl Stars {
    pub(crate) fn new(
        ellipsoid: &Ellipsoid,
        graph: &BoundaryGraph,
        edges: impl Iterator<Item = DirectedEdge>,
    ) -> Self {
        let mut edges_at: FxHashMap<u32, Vec<DirectedEdge>> = FxHashMap::default();
        for edge in edges {
            for outgoing in [edge, edge.reversed()] {
                edges_at
                    .entry(graph.start_node(outgoing))
                    .or_default()
                    .push(outgoing);
            }
        }
        for edges in edges_at.values_mut().filter(|edges| edges.len() > 2) {
            crate::boundary::headings::sort_counter_clockwise(ellipsoid, graph, edges);
        }
        Self { edges_at }
    }

    pub(crate) fn edges_at(&self, node: u32) -> &[DirectedEdge] {
        self.edges_at.get(&node).map_or(&[], Vec::as_slice)
    }

    /// Directs all edges connected with `start`: round each node they lead out and in in turn.
    fn direct_from(
        &self,
        graph: &BoundaryGraph,
        start: DirectedEdge,
        directed: &mut FxHashMap<u32, DirectedEdge>,
    ) -> Vec<DirectedEdge> {
        let mut connected = vec![start];
        directed.insert(start.edge(), start);
        let mut next = 0;
        while let Some(&edge) = connected.get(next) {
            next += 1;
            for outgoing in [edge, edge.reversed()] {
                let star = self.edges_at(graph.start_node(outgoing));
                let Some(own) = star.iter().position(|&other| other == outgoing) else {
                    continue;
                };
                for (index, &other) in star.iter().enumerate() {
                    if directed.contains_key(&other.edge()) {
                        continue;
                    }
                    // Same parity: the same role, in or out.
                    let alike = (index + own).is_multiple_of(2);
                    let is_out = alike == (outgoing == edge);
                    let other = if is_out { other } else { other.reversed() };
                    directed.insert(other.edge(), other);
                    connected.push(other);
                }
            }
        }
        connected
    }

    /// The directed edges as simple loops that keep to their sectors.
    pub(crate) fn loops(
        &self,
        graph: &BoundaryGraph,
        edges: &[DirectedEdge],
    ) -> Vec<Vec<DirectedEdge>> {
        let directions: FxHashMap<u32, DirectedEdge> =
            edges.iter().map(|&edge| (edge.edge(), edge)).collect();
        let mut walked: FxHashMap<u32, ()> = FxHashMap::default();
        let mut loops = Vec::new();
        for &start in edges {
            let mut path: Vec<DirectedEdge> = Vec::new();
            let mut index_of_node: FxHashMap<u32, usize> = FxHashMap::default();
            let mut edge = start;
            while walked.insert(edge.edge(), ()).is_none() {
                index_of_node.insert(graph.start_node(edge), path.len());
                path.push(edge);
                let node = graph.end_node(edge);
                if let Some(&first) = index_of_node.get(&node) {
                    for passed in &path[first..] {
                        index_of_node.remove(&graph.start_node(*passed));
                    }
                    loops.push(path.split_off(first));
                }
                edge = self.next(node, edge, &directions);
            }
        }
        loops
    }

    /// The edge that leaves `node` along the sector that `arriving` ends: its clockwise neighbour.
    fn next(
        &self,
        node: u32,
        arriving: DirectedEdge,
        directions: &FxHashMap<u32, DirectedEdge>,
    ) -> DirectedEdge {
        let star = self.edges_at(node);
        let own = star
            .iter()
            .position(|&edge| edge == arriving.reversed())
            .unwrap_or(0);
        (1..=star.len())
            .map(|back| star[(own + star.len() - back) % star.len()])
            .find(|edge| directions.get(&edge.edge()) == Some(edge))
            .unwrap_or(arriving)
    }
}
