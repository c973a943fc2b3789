//! Which boundaries a meridian crosses on its way from a point to the north pole.

use crate::{
    boundary_graph::{BoundaryGraph, DirectedEdge},
    edge_grid::LatticeBox,
    ellipsoid::Ellipsoid,
    lattice::{LatticePoint, TURN, wrap},
    meeting::passes_north_of,
};

/// Labelled edges sorted into columns of longitude.
pub(crate) struct MeridianIndex<'a> {
    ellipsoid: &'a Ellipsoid,
    graph: &'a BoundaryGraph,
    columns: Vec<Vec<(u32, u32)>>,
    /// Meridians on which edges reach the north pole, with the edges' labels.
    polar: Vec<(i64, u32)>,
}

impl<'a> MeridianIndex<'a> {
    pub(crate) fn new(
        ellipsoid: &'a Ellipsoid,
        graph: &'a BoundaryGraph,
        edges: impl Iterator<Item = (DirectedEdge, u32)> + Clone,
    ) -> Self {
        let (count, total_turn) = edges
            .clone()
            .fold((0_i64, 0_i64), |(count, turn), (edge, _)| {
                // In 1/2²⁰ of a turn: the sum of many turns must not overflow.
                (count + 1, turn + (graph.walk(edge).turn().abs() >> 16))
            });
        // As many columns as keep the entries below about four an edge.
        let mean_turn = (total_turn / count.max(1)).max(1) << 16;
        let columns = (count / 4).min(3 * TURN / mean_turn).clamp(1, 4096);
        let mut index = Self {
            ellipsoid,
            graph,
            columns: vec![Vec::new(); columns as usize],
            polar: Vec::new(),
        };
        for (edge, label) in edges {
            index.insert(edge, label);
        }
        index
    }

    fn column(&self, lon: i64) -> i64 {
        let columns = self.columns.len() as i64;
        (lon + TURN / 2)
            .div_euclid(TURN / columns + 1)
            .rem_euclid(columns)
    }

    fn insert(&mut self, directed: DirectedEdge, label: u32) {
        let edge = self.graph.walk(directed);
        let edge_box = LatticeBox::around(&edge);
        let columns = self.columns.len() as i64;
        let (first, last) = (self.column(edge_box.west), self.column(wrap(edge_box.east)));
        let last = if last < first || edge_box.east - edge_box.west > TURN / 2 && last == first {
            last + columns
        } else {
            last
        };
        for column in first..=last.min(first + columns - 1) {
            self.columns[(column % columns) as usize].push((directed.edge(), label));
        }
        for end in [edge.start, edge.end] {
            if end.is_pole() && end.lat > 0 {
                self.polar.push((wrap(end.lon), label));
            }
        }
    }

    /// Labels of the boundaries that separate `point` (not a pole) from the neighbourhood of the
    /// north pole just beyond the meridian of 180°, sorted: those crossed an odd number of times
    /// on the way along the meridian and round the pole. `on_node` is called with the label of
    /// every edge that ends at the point itself: what is said about those is void.
    pub(crate) fn separating(&self, point: LatticePoint, mut on_node: impl FnMut(u32)) -> Vec<u32> {
        let mut crossed = Vec::new();
        for &(edge, label) in &self.columns[self.column(point.lon) as usize] {
            let edge = &self.graph.edges[edge as usize];
            if self.graph.nodes[edge.from as usize] == point
                || self.graph.nodes[edge.to as usize] == point
            {
                on_node(label);
            } else if passes_north_of(self.ellipsoid, edge, point) {
                crossed.push(label);
            }
        }
        // Round the pole eastward to 180° every edge that ends there in between is crossed.
        crossed.extend(
            self.polar
                .iter()
                .filter(|&&(lon, _)| point.lon < lon)
                .map(|&(_, label)| label),
        );
        crossed.sort_unstable();
        odd_ones(&crossed)
    }
}

/// Of sorted labels those that occur an odd number of times.
fn odd_ones(sorted: &[u32]) -> Vec<u32> {
    let runs = sorted.chunk_by(|a, b| a == b);
    runs.filter(|run| run.len() % 2 == 1)
        .map(|run| run[0])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{curve::Curve, geodetic::LonLat, region::EdgeKind};

    #[test]
    fn boxes_and_polar_rings_separate() {
        for kind in [EdgeKind::Straight, EdgeKind::Rhumb, EdgeKind::Geodesic] {
            let mut graph = BoundaryGraph::default();
            let rings: [&[(f64, f64)]; 3] = [
                &[(170.0, 0.0), (-170.0, 0.0), (-170.0, 20.0), (170.0, 20.0)],
                &[(0.0, 70.0), (120.0, 70.0), (-120.0, 70.0)],
                &[(10.0, 60.0), (50.0, 60.0), (50.0, 90.0), (10.0, 90.0)],
            ];
            let mut edges = Vec::new();
            for (label, ring) in rings.iter().enumerate() {
                for k in 0..ring.len() {
                    let [a, b] = [ring[k], ring[(k + 1) % ring.len()]]
                        .map(|(lon, lat)| LonLat::new(lon, lat));
                    edges.extend(
                        graph
                            .insert_curve(&Curve::between(kind, a, b))
                            .map(|edge| (edge, label as u32)),
                    );
                }
            }
            let index = MeridianIndex::new(&Ellipsoid::WGS84, &graph, edges.iter().copied());
            let separating = |lon, lat| {
                let point = LatticePoint::nearest(LonLat::new(lon, lat)).canonical();
                index.separating(point, |_| panic!("not on a node"))
            };
            assert_eq!(separating(180.0, 10.0), [0, 1]);
            assert_eq!(separating(-171.0, 1.0), [0, 1]);
            assert_eq!(separating(-171.0, -1.0), [1]);
            assert_eq!(separating(0.5, 85.0), [0; 0]);
            assert_eq!(separating(30.0, 69.0), [1, 2]);
            assert_eq!(separating(30.0, 88.0), [2]);
        }
    }
}
