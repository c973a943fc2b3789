//! Which boundaries a meridian crosses on its way from a point to the north pole.

mod cells;
mod columns;
#[cfg(test)]
mod tests;

use crate::{
    boundary::boundary_graph::{BoundaryGraph, DirectedEdge, Edge},
    boundary::lattice::{LatticePoint, POLE, TURN, wrap},
    boundary::lattice_box::LatticeBox,
    boundary::meeting::passes_north_of,
    ellipsoid::Ellipsoid,
};
use cells::{Cell, add_cells};
use columns::Columns;

/// Labelled boundaries, each closed, sorted into columns of longitude and these into cells of latitude.
///
/// Each cell knows the answer for its upper western corner, so that a question walks from its point to
/// that corner only, past the few edges of the cell, and not past all edges as far as the pole.
#[derive(Debug)]
pub(crate) struct MeridianIndex {
    columns: Columns,
    /// Per column the end of its run in `cells`.
    cell_ends: Vec<u32>,
    /// From north to south in each column.
    cells: Vec<Cell>,
    /// Edges and their labels, cell after cell.
    entries: Vec<(u32, u32)>,
    /// Labels that separate the cells' corners from the pole, each run sorted.
    corner_labels: Vec<u32>,
    /// Meridians on which edges reach the north pole, ascending, with the edges' labels.
    polar: Vec<(i64, u32)>,
}

/// An edge with its label and between which latitudes it lies, in lattice steps.
#[derive(Clone, Copy, Debug)]
struct Labelled {
    edge: u32,
    label: u32,
    south: i64,
    north: i64,
}

impl MeridianIndex {
    /// Indexes boundaries: all edges of one label together must be closed curves.
    pub(crate) fn new(
        ellipsoid: &Ellipsoid,
        graph: &BoundaryGraph,
        labelled: impl Iterator<Item = (DirectedEdge, u32)>,
    ) -> Self {
        let mut spans = Vec::new();
        let mut polar = Vec::new();
        let labelled: Vec<Labelled> = labelled
            .map(|(directed, label)| {
                let edge = &graph.edges[directed.edge() as usize];
                let edge_box = LatticeBox::around(edge);
                spans.push((edge_box.west, edge_box.east));
                let tips = [edge.start, edge.end].into_iter();
                let tips = tips.filter(|tip| tip.is_pole() && tip.lat > 0);
                polar.extend(tips.map(|tip| (wrap(tip.lon), label)));
                Labelled {
                    edge: directed.edge(),
                    label,
                    south: edge_box.south,
                    north: edge_box.north,
                }
            })
            .collect();
        polar.sort_unstable();
        let columns = Columns::new(&spans);
        let (ends, members) = columns.sorted_into(&spans);
        let mut index = Self {
            cell_ends: Vec::with_capacity(columns.count()),
            columns,
            cells: Vec::new(),
            entries: Vec::with_capacity(members.len()),
            corner_labels: Vec::new(),
            polar,
        };
        let mut first = 0;
        for (column, &end) in ends.iter().enumerate() {
            let members = members[first as usize..end as usize].iter();
            let column_edges = members.map(|&member| labelled[member as usize]).collect();
            add_cells(&mut index, ellipsoid, graph, column, column_edges);
            index.cell_ends.push(index.cells.len() as u32);
            first = end;
        }
        index
    }

    /// How many edges [`Self::separating`] looks at for a point.
    pub(crate) fn passed(&self, point: LatticePoint) -> u64 {
        let (_, row, cell) = self.cell_at(point);
        let polar = if row == 0 { self.polar.len() } else { 0 };
        (cell.entries().len() + cell.corner_labels().len() + polar) as u64
    }

    /// The cell that holds a point: its column, its row, itself.
    fn cell_at(&self, point: LatticePoint) -> (usize, usize, &Cell) {
        let column = self.columns.of(point.lon);
        let first_cell = match column.checked_sub(1) {
            Some(before) => self.cell_ends[before] as usize,
            None => 0,
        };
        let cells = &self.cells[first_cell..self.cell_ends[column] as usize];
        // The first cell reaches up to the pole.
        let above = cells.partition_point(|cell| cell.ceiling >= point.lat);
        let row = above.saturating_sub(1);
        (column, row, &cells[row])
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
        let (column, row, cell) = self.cell_at(point);
        let corner = LatticePoint::new(self.columns.start(column), cell.ceiling);
        let mut crossed = self.corner_labels[cell.corner_labels()].to_vec();
        let way = Way { corner, point };
        for &(edge, label) in &self.entries[cell.entries()] {
            let edge = &graph.edges[edge as usize];
            let is_end = [edge.from, edge.to]
                .iter()
                .any(|&node| graph.nodes[node as usize] == point);
            if is_end {
                on_node(label);
            }
            if way.crosses(ellipsoid, edge, is_end) {
                crossed.push(label);
            }
        }
        if row == 0 {
            // Along the pole, where all edges that end there are crossed.
            let beside = |&&(lon, _): &&(i64, u32)| way.passes(lon);
            crossed.extend(self.polar.iter().filter(beside).map(|&(_, label)| label));
        }
        crossed.sort_unstable();
        odd_ones(&crossed)
    }
}

/// The way from a point northward to the latitude of its cell's corner and along that westward.
///
/// All places on it are meant a little further north and, much less, further east: so no vertex lies on
/// it. Of an edge between both meridians the parts at either end are above the ceiling or not, and where
/// they differ it crosses the way. What that says of an edge that ends in between is taken back by the
/// next edge of the same closed boundary.
struct Way {
    corner: LatticePoint,
    point: LatticePoint,
}

impl Way {
    /// Lattice steps from the corner's meridian eastward.
    fn east(&self, lon: i64) -> i64 {
        (lon - self.corner.lon).rem_euclid(TURN)
    }

    /// Whether a meridian lies between the point's and the corner's.
    fn passes(&self, lon: i64) -> bool {
        (1..=self.east(self.point.lon)).contains(&self.east(lon))
    }

    /// Whether an edge crosses the way an odd number of times. `is_end`: the point is one of its ends.
    fn crosses(&self, ellipsoid: &Ellipsoid, edge: &Edge, is_end: bool) -> bool {
        let (west, east) = match edge.turn() >= 0 {
            true => (edge.start, edge.end),
            false => (edge.end, edge.start),
        };
        let length = self.east(self.point.lon);
        let above = |end: LatticePoint| end.lat > self.corner.lat;
        let first = self.east(west.lon);
        // The edge may enter the column once more from the west.
        [first, first - TURN].into_iter().fold(false, |odd, begin| {
            let end = begin + (east.lon - west.lon);
            if begin > length || end <= 0 {
                return odd;
            }
            let at_begin = match begin <= 0 {
                true => passes_corner(ellipsoid, edge, self.corner),
                false => above(west),
            };
            let at_end = match end > length {
                true => !is_end && passes_north_of(ellipsoid, edge, self.point),
                false => above(east),
            };
            odd ^ at_begin ^ at_end
        })
    }
}

/// Whether an edge runs over the meridian of a cell's corner north of it.
fn passes_corner(ellipsoid: &Ellipsoid, edge: &Edge, corner: LatticePoint) -> bool {
    corner.lat < POLE && passes_north_of(ellipsoid, edge, corner)
}

/// Of sorted labels those that occur an odd number of times.
fn odd_ones(sorted: &[u32]) -> Vec<u32> {
    let runs = sorted.chunk_by(|a, b| a == b);
    runs.filter(|run| run.len() % 2 == 1)
        .map(|run| run[0])
        .collect()
}
