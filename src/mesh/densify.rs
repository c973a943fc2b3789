//! Points on the true edges, so many that the chords between them stay close.

use glam::DVec3;

use crate::{
    boundary::arcs::Chain,
    boundary::boundary_graph::BoundaryGraph,
    curve::{Curve, CurveOn},
    ellipsoid::Ellipsoid,
    fill_mesh::BoundaryVertex,
    mesh::vertex_room::VertexRoom,
};

/// Longest chord, in equatorial radii: 2° of arc, which sags 970 m on Earth.
pub(crate) const MAX_CHORD: f64 = 2.0 / 180.0 * std::f64::consts::PI;
/// Tighter tolerances are not met: they would only fill the memory.
const MIN_TOLERANCE_M: f64 = 1e-3;
/// A curve is halved at most this often: then its pieces are metres long whatever the tolerance.
const MAX_DEPTH: u32 = 24;

/// So many vertices are made before room is taken for them.
const BATCH: usize = 1024;

/// The vertices of an arc.
#[derive(Clone, Debug, Default)]
pub(crate) struct DenseChain {
    pub(crate) vertices: Vec<DVec3>,
    /// One per vertex; indices into `curves`.
    pub(crate) boundary: Vec<BoundaryVertex>,
    /// One per edge of the chain.
    pub(crate) curves: Vec<Curve>,
    /// Per edge of the chain the index of its first vertex.
    pub(crate) edge_starts: Vec<u32>,
    /// Length of the longest chord, metres.
    pub(crate) longest_chord_m: f64,
}

/// Puts points on a chain's true edges until no chord lies more than `tolerance_m` beside its edge, or
/// until there is no `room`: then the answer means nothing.
pub(crate) fn densify(
    ellipsoid: &Ellipsoid,
    graph: &BoundaryGraph,
    node_ecef_m: &[DVec3],
    chain: &Chain,
    tolerance_m: f64,
    room: &VertexRoom,
) -> DenseChain {
    let tolerance_m = tolerance_m.max(MIN_TOLERANCE_M);
    let mut dense = DenseChain::default();
    let ecef_m = |node: u32| node_ecef_m[node as usize];
    for &edge in &chain.edges {
        dense.edge_starts.push(dense.vertices.len() as u32);
        let curve = graph.walk(edge).curve();
        let (start, end) = (ecef_m(graph.start_node(edge)), ecef_m(graph.end_node(edge)));
        dense.curves.push(curve);
        dense.add_edge(&curve.on_between(ellipsoid, start, end), tolerance_m, room);
        if room.is_full() {
            return DenseChain::default();
        }
    }
    room.take(dense.vertices.len() % BATCH);
    if let (Some(&last), Some(edge)) = (dense.boundary.last(), chain.edges.last()) {
        dense.vertices.push(ecef_m(graph.end_node(*edge)));
        dense.boundary.push(BoundaryVertex {
            deviation_m: 0.0,
            t: 1.0,
            ..last
        });
    }
    dense
}

impl DenseChain {
    /// Adds the vertices of the latest curve except its end.
    fn add_edge(&mut self, curve: &CurveOn, tolerance_m: f64, room: &VertexRoom) {
        let index = self.curves.len() as u32 - 1;
        let max_chord_m = MAX_CHORD * curve.ellipsoid().a_m;
        // Intervals still to be drawn, the first on top.
        let mut open = vec![(0.0, 1.0, 0)];
        while let Some((t0, t1, depth)) = open.pop() {
            let start = curve.ecef(t0);
            let chord_m = start.distance(curve.ecef(t1));
            let deviation_m = if chord_m > max_chord_m {
                f64::INFINITY
            } else {
                curve.deviation_bound_m(t0, t1)
            };
            // Deviations that cannot be bounded are infinite.
            let strays = deviation_m > tolerance_m || deviation_m.is_infinite();
            if strays && depth < MAX_DEPTH {
                let middle = 0.5 * (t0 + t1);
                open.push((middle, t1, depth + 1));
                open.push((t0, middle, depth + 1));
                continue;
            }
            self.vertices.push(start);
            if self.vertices.len().is_multiple_of(BATCH) {
                room.take(BATCH);
                if room.is_full() {
                    return;
                }
            }
            self.boundary.push(BoundaryVertex {
                curve: index,
                // Rounded up, so that it stays a bound.
                deviation_m: (deviation_m as f32).next_up(),
                t: t0,
            });
            self.longest_chord_m = self.longest_chord_m.max(chord_m);
        }
    }
}
