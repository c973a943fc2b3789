//! Which boundaries a meridian crosses on its way from a point to the north pole.

use crate::{
    boundary::boundary_graph::{BoundaryGraph, DirectedEdge},
    boundary::edge_grid::LatticeBox,
    boundary::lattice::{LatticePoint, TURN, wrap},
    boundary::meeting::passes_north_of,
    ellipsoid::Ellipsoid,
};

/// Labelled edges sorted into columns of longitude.
#[derive(Debug)]
pub(crate) struct MeridianIndex {
    columns: Columns,
    /// Per column the end of its run in `entries`.
    ends: Vec<u32>,
    /// Edges and their labels.
    entries: Vec<(u32, u32)>,
    /// Meridians on which edges reach the north pole, with the edges' labels.
    polar: Vec<(i64, u32)>,
}

impl MeridianIndex {
    pub(crate) fn new(
        graph: &BoundaryGraph,
        labelled: impl Iterator<Item = (DirectedEdge, u32)>,
    ) -> Self {
        let labelled: Vec<(DirectedEdge, u32)> = labelled.collect();
        let spans: Vec<(i64, i64)> = labelled
            .iter()
            .map(|(edge, _)| LatticeBox::around(&graph.edges[edge.edge() as usize]))
            .map(|edge_box| (edge_box.west, edge_box.east))
            .collect();
        let columns = Columns::new(&spans);
        let mut ends = vec![0_u32; columns.count()];
        for &span in &spans {
            columns.touched(span).for_each(|column| ends[column] += 1);
        }
        let mut total = 0;
        for end in &mut ends {
            total += *end;
            *end = total - *end;
        }
        let mut entries = vec![(0, 0); total as usize];
        let mut polar = Vec::new();
        for (&(directed, label), &span) in labelled.iter().zip(&spans) {
            for column in columns.touched(span) {
                entries[ends[column] as usize] = (directed.edge(), label);
                ends[column] += 1;
            }
            let edge = &graph.edges[directed.edge() as usize];
            let tips = [edge.start, edge.end].into_iter();
            let tips = tips.filter(|tip| tip.is_pole() && tip.lat > 0);
            polar.extend(tips.map(|tip| (wrap(tip.lon), label)));
        }
        Self {
            columns,
            ends,
            entries,
            polar,
        }
    }

    fn column_at(&self, lon: i64) -> &[(u32, u32)] {
        let column = self.columns.of(lon);
        let first = if column == 0 {
            0
        } else {
            self.ends[column - 1]
        };
        &self.entries[first as usize..self.ends[column] as usize]
    }

    /// How many edges [`Self::separating`] looks at for a point.
    pub(crate) fn passed(&self, point: LatticePoint) -> u64 {
        (self.column_at(point.lon).len() + self.polar.len()) as u64
    }

    /// Labels of the boundaries that separate `point` (not the north pole) from the neighbourhood of the
    /// north pole just beyond the meridian of 180°, sorted: those crossed an odd number of times
    /// on the way along the meridian and round the pole. `on_node` is called with the label of
    /// every edge that ends at the point itself: those are passed by on the north side, and a little
    /// to the east, as are edges that the point lies on.
    pub(crate) fn separating(
        &self,
        ellipsoid: &Ellipsoid,
        graph: &BoundaryGraph,
        point: LatticePoint,
        mut on_node: impl FnMut(u32),
    ) -> Vec<u32> {
        let mut crossed = Vec::new();
        for &(edge, label) in self.column_at(point.lon) {
            let edge = &graph.edges[edge as usize];
            if graph.nodes[edge.from as usize] == point || graph.nodes[edge.to as usize] == point {
                on_node(label);
            } else if passes_north_of(ellipsoid, edge, point) {
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

/// Columns of longitude in which about equally many edges begin, however unevenly they lie.
#[derive(Debug)]
struct Columns {
    /// Where columns begin, ascending; the last one ends where the first begins.
    starts: Vec<i64>,
}

impl Columns {
    /// Columns for edges that span these longitudes, west to east.
    fn new(spans: &[(i64, i64)]) -> Self {
        let mut begins: Vec<i64> = spans.iter().map(|&(west, _)| west).collect();
        begins.sort_unstable();
        let mut per_column = 8;
        loop {
            let mut starts: Vec<i64> = begins.iter().copied().step_by(per_column).collect();
            starts.dedup();
            let columns = Self { starts };
            // Long edges lie in many columns: make those wider until the entries are few.
            let entries: usize = spans.iter().map(|&span| columns.touched_count(span)).sum();
            if entries <= 16 * spans.len() || columns.starts.len() <= 1 {
                return columns;
            }
            per_column *= 2;
        }
    }

    fn count(&self) -> usize {
        self.starts.len().max(1)
    }

    /// The column of a longitude in (−180°, 180°].
    fn of(&self, lon: i64) -> usize {
        let begun = self.starts.partition_point(|&start| start <= lon);
        if begun == 0 {
            self.count() - 1
        } else {
            begun - 1
        }
    }

    fn touched_count(&self, (west, east): (i64, i64)) -> usize {
        let (first, last) = (self.of(west), self.of(wrap(east)));
        let more = if east - west >= TURN {
            self.count() - 1
        } else if last < first || last == first && wrap(east) < west {
            last + self.count() - first
        } else {
            last - first
        };
        more.min(self.count() - 1) + 1
    }

    fn touched(&self, span: (i64, i64)) -> impl Iterator<Item = usize> + use<> {
        let (first, count) = (self.of(span.0), self.count());
        (first..first + self.touched_count(span)).map(move |column| column % count)
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
            let index = MeridianIndex::new(&graph, edges.iter().copied());
            let separating = |lon, lat| {
                let point = LatticePoint::nearest(LonLat::new(lon, lat)).canonical();
                index.separating(&Ellipsoid::WGS84, &graph, point, |_| {
                    panic!("not on a node")
                })
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
