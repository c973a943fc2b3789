//! Nodes and edges of all rings, each stored once.

use std::collections::hash_map::Entry;

use rustc_hash::FxHashMap;

use crate::{
    boundary::lattice::{LatticePoint, steps, wrap},
    curve::{Curve, CurveKind},
    geodetic::LonLat,
};

/// The vertices and edges of all regions, each stored once, whoever uses them.
#[derive(Debug, Default)]
pub(crate) struct BoundaryGraph {
    /// Where the nodes are: canonical names.
    pub(crate) nodes: Vec<LatticePoint>,
    /// Undirected edges, walked from `from` to `to` with `from < to`.
    pub(crate) edges: Vec<Edge>,
    node_of_point: FxHashMap<LatticePoint, u32>,
    /// By its ends, smaller node first, the first edge between them.
    edge_of_ends: FxHashMap<u64, u32>,
    /// Further edges between ends that have one already: of another kind, or the other way round.
    further: FxHashMap<Edge, u32>,
}

/// An edge between two different nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Edge {
    pub(crate) from: u32,
    pub(crate) to: u32,
    /// Where it starts and, unwrapped, ends on the lon/lat plane. At a pole the longitude is the
    /// meridian that the edge arrives on, which the node does not know.
    pub(crate) start: LatticePoint,
    pub(crate) end: LatticePoint,
    pub(crate) kind: CurveKind,
}

impl Edge {
    pub(crate) fn reversed(self) -> Self {
        let turn = wrap(self.end.lon) - self.end.lon;
        Self {
            from: self.to,
            to: self.from,
            start: LatticePoint::new(self.end.lon + turn, self.end.lat),
            end: LatticePoint::new(self.start.lon + turn, self.start.lat),
            kind: self.kind,
        }
    }

    /// Whether the edge is also an edge of `kind` between its ends.
    pub(crate) fn is_also(&self, kind: CurveKind) -> bool {
        self.kind == kind || self.kind == plainest_kind(kind, self.start, self.end)
    }

    /// Signed difference in longitude, lattice steps.
    pub(crate) fn turn(&self) -> i64 {
        self.end.lon - self.start.lon
    }

    pub(crate) fn curve(&self) -> Curve {
        let mut from = self.start.lon_lat();
        let mut to = LatticePoint::new(wrap(self.end.lon), self.end.lat).lon_lat();
        if self.kind == CurveKind::Geodesic {
            (from, to) = (from.canonical(), to.canonical());
        }
        Curve {
            kind: self.kind,
            from,
            to,
            turn_deg: LatticePoint::new(self.turn(), 0).lon_lat().lon_deg,
        }
    }
}

/// An edge of a [`BoundaryGraph`] with the direction in which it is walked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct DirectedEdge(u32);

impl DirectedEdge {
    pub(crate) fn new(edge: u32, forward: bool) -> Self {
        Self(edge << 1 | u32::from(!forward))
    }

    pub(crate) fn edge(self) -> u32 {
        self.0 >> 1
    }

    /// A number for tables over directed edges: below twice the number of edges.
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }

    pub(crate) fn is_forward(self) -> bool {
        self.0 & 1 == 0
    }

    pub(crate) fn reversed(self) -> Self {
        Self(self.0 ^ 1)
    }
}

impl BoundaryGraph {
    pub(crate) fn with_capacity(vertices: usize) -> Self {
        Self {
            nodes: Vec::with_capacity(vertices),
            edges: Vec::with_capacity(vertices),
            node_of_point: FxHashMap::with_capacity_and_hasher(vertices, Default::default()),
            edge_of_ends: FxHashMap::with_capacity_and_hasher(vertices, Default::default()),
            further: FxHashMap::default(),
        }
    }

    /// The graph once nothing more is inserted: without the tables by which to find things.
    pub(crate) fn finished(self) -> Self {
        Self {
            nodes: self.nodes,
            edges: self.edges,
            ..Self::default()
        }
    }

    /// The node at a point, made if it is new.
    pub(crate) fn node(&mut self, point: LatticePoint) -> u32 {
        let point = point.canonical();
        match self.node_of_point.entry(point) {
            Entry::Occupied(found) => *found.get(),
            Entry::Vacant(vacant) => {
                let id = self.nodes.len() as u32;
                self.nodes.push(point);
                *vacant.insert(id)
            }
        }
    }

    /// The edge along a curve between lattice points; none if it has no length.
    pub(crate) fn insert_curve(&mut self, curve: &Curve) -> Option<DirectedEdge> {
        let ends = [curve.from, curve.to].map(|end| self.node(LatticePoint::exactly(end)));
        self.insert_curve_between(curve, ends)
    }

    /// [`Self::insert_curve`] for who knows the nodes at its ends.
    pub(crate) fn insert_curve_between(
        &mut self,
        curve: &Curve,
        ends: [u32; 2],
    ) -> Option<DirectedEdge> {
        let start = LatticePoint::exactly(curve.from);
        let mut end = LatticePoint::exactly(curve.to);
        // Curves to a pole without a turn of their own get their meridian in `insert_between`.
        if !follows_meridian_to_pole(curve.kind) || !(start.is_pole() || end.is_pole()) {
            end.lon = start.lon + steps(curve.turn_deg);
        }
        self.insert_between(curve.kind, start, end, ends)
    }

    /// The edge from `start` to `end`, unwrapped points of the lon/lat plane; none if it has no length.
    pub(crate) fn insert(
        &mut self,
        kind: impl Into<CurveKind>,
        start: LatticePoint,
        end: LatticePoint,
    ) -> Option<DirectedEdge> {
        let ends = [start, end].map(|end| self.node(end));
        self.insert_between(kind.into(), start, end, ends)
    }

    fn insert_between(
        &mut self,
        kind: CurveKind,
        mut start: LatticePoint,
        mut end: LatticePoint,
        [from, to]: [u32; 2],
    ) -> Option<DirectedEdge> {
        if from == to {
            return None;
        }
        if follows_meridian_to_pole(kind) {
            if start.is_pole() {
                start.lon = end.lon;
            } else if end.is_pole() {
                end.lon = start.lon;
            }
        }
        let turn = wrap(start.lon) - start.lon;
        start.lon += turn;
        end.lon += turn;
        let kind = plainest_kind(kind, start, end);
        let directed = Edge {
            from,
            to,
            start,
            end,
            kind,
        };
        let forward = from < to;
        let edge = if forward {
            directed
        } else {
            directed.reversed()
        };
        let id = self.id_of(edge);
        if id as usize == self.edges.len() {
            self.edges.push(edge);
        }
        Some(DirectedEdge::new(id, forward))
    }

    /// The number of an edge; the next free one if it is new.
    fn id_of(&mut self, edge: Edge) -> u32 {
        let next = self.edges.len() as u32;
        let ends = u64::from(edge.from) << 32 | u64::from(edge.to);
        let first = *self.edge_of_ends.entry(ends).or_insert(next);
        if first == next || self.edges[first as usize] == edge {
            return first;
        }
        *self.further.entry(edge).or_insert(next)
    }

    /// The edge as it is walked.
    pub(crate) fn walk(&self, directed: DirectedEdge) -> Edge {
        let edge = self.edges[directed.edge() as usize];
        if directed.is_forward() {
            edge
        } else {
            edge.reversed()
        }
    }

    pub(crate) fn start_node(&self, directed: DirectedEdge) -> u32 {
        let edge = &self.edges[directed.edge() as usize];
        if directed.is_forward() {
            edge.from
        } else {
            edge.to
        }
    }

    pub(crate) fn end_node(&self, directed: DirectedEdge) -> u32 {
        self.start_node(directed.reversed())
    }

    pub(crate) fn position(&self, node: u32) -> LonLat {
        self.nodes[node as usize].lon_lat()
    }
}

/// Geodesics and rhumbs reach a pole on the meridian of their other end.
fn follows_meridian_to_pole(kind: CurveKind) -> bool {
    matches!(kind, CurveKind::Geodesic | CurveKind::Rhumb)
}

/// Meridians, the equator and, for rhumbs, all parallels are straight on the lon/lat plane too: as
/// straight edges they are met exactly, and found by neighbours of another kind.
fn plainest_kind(kind: CurveKind, start: LatticePoint, end: LatticePoint) -> CurveKind {
    let on_meridian = start.lon == end.lon;
    let on_parallel = start.lat == end.lat;
    match kind {
        CurveKind::Geodesic if on_meridian || on_parallel && start.lat == 0 => CurveKind::Straight,
        CurveKind::Rhumb if on_meridian || on_parallel => CurveKind::Straight,
        kind => kind,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::region::EdgeKind;

    fn insert(graph: &mut BoundaryGraph, a: (f64, f64), b: (f64, f64)) -> DirectedEdge {
        let [a, b] = [a, b].map(|(lon, lat)| LonLat::new(lon, lat));
        graph
            .insert_curve(&Curve::between(EdgeKind::Straight, a, b))
            .unwrap()
    }

    #[test]
    fn neighbours_find_their_common_edge() {
        let mut graph = BoundaryGraph::default();
        for (a, b) in [
            ((1.0, 2.0), (3.0, 4.0)),
            ((180.0, 10.0), (-170.0, 20.0)),
            ((-180.0, 10.0), (190.0, 20.0)),
            ((170.0, 1.0), (180.0, 1.0)),
            ((0.0, 1.0), (180.0, 1.0)),
            ((50.0, 90.0), (40.0, 80.0)),
        ] {
            let there = insert(&mut graph, a, b);
            let back = insert(&mut graph, b, a);
            assert_eq!(there, back.reversed());
            assert_eq!(graph.walk(there), graph.walk(back).reversed());
            assert_eq!(
                graph.walk(there).curve().reversed(),
                graph.walk(back).curve()
            );
        }
        assert_eq!(graph.edges.len(), 5);
        // Half a turn east is another edge than half a turn west.
        let west = graph.insert_curve(&Curve::between(
            EdgeKind::Straight,
            LonLat::new(180.0, 1.0),
            LonLat::new(0.0, 1.0),
        ));
        let east = graph.insert_curve(&Curve::between(
            EdgeKind::Straight,
            LonLat::new(-180.0, 1.0),
            LonLat::new(0.0, 1.0),
        ));
        assert_ne!(west.unwrap().edge(), east.unwrap().edge());
    }
}
