//! Cells of a column.

use std::{collections::BTreeSet, ops::Range};

use super::{Labelled, MeridianIndex, odd_ones, passes_corner};
use crate::{
    boundary::boundary_graph::BoundaryGraph,
    boundary::lattice::{LatticePoint, POLE},
    ellipsoid::Ellipsoid,
};

/// The part of a column between two parallels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// Its upper latitude, lattice steps; that is its own, the lower one is the next cell's.
    pub(super) ceiling: i64,
    first_entry: u32,
    entry_count: u32,
    first_label: u32,
    label_count: u32,
}

impl Cell {
    /// Its edges among the index's entries.
    pub(super) fn entries(&self) -> Range<usize> {
        let first = self.first_entry as usize;
        first..first + self.entry_count as usize
    }

    /// The labels that separate its upper western corner from the pole.
    pub(super) fn corner_labels(&self) -> Range<usize> {
        let first = self.first_label as usize;
        first..first + self.label_count as usize
    }
}

/// A cell has so many edges of its own, unless more than that reach into it from above, or more labels
/// separate its corner from the pole: so all cells together are no larger than what they index.
const LEAST_EDGES: usize = 8;

/// Divides a column's edges into cells.
pub(super) fn add_cells(
    index: &mut MeridianIndex,
    ellipsoid: &Ellipsoid,
    graph: &BoundaryGraph,
    column: usize,
    mut edges: Vec<Labelled>,
) {
    edges.sort_unstable_by_key(|edge| std::cmp::Reverse(edge.north));
    let meridian = index.columns.start(column);
    let mut separating: BTreeSet<u32> = labels_round_the_pole(index, meridian);
    // Edges of the cell before that reach further south.
    let mut cell_edges: Vec<Labelled> = Vec::new();
    let (mut next, mut ceiling) = (0, POLE);
    loop {
        let own = LEAST_EDGES.max(cell_edges.len()).max(separating.len());
        let below = edges.get(next + own..).unwrap_or_default();
        let floor = below
            .iter()
            .map(|edge| edge.north)
            .find(|&north| north < ceiling);
        let rest = &edges[next..];
        let added = rest.partition_point(|edge| floor.is_none_or(|floor| edge.north >= floor));
        cell_edges.extend_from_slice(&rest[..added]);
        next += added;
        index.add_cell(ceiling, &cell_edges, &separating);
        let Some(floor) = floor else { return };
        let [above, below] = [ceiling, floor].map(|lat| LatticePoint::new(meridian, lat));
        for edge in &cell_edges {
            let on = |corner| passes_corner(ellipsoid, &graph.edges[edge.edge as usize], corner);
            if on(above) != on(below) && !separating.remove(&edge.label) {
                separating.insert(edge.label);
            }
        }
        cell_edges.retain(|edge| edge.south <= floor);
        ceiling = floor;
    }
}

/// What separates the pole's neighbourhood just east of a meridian from that just beyond 180°.
fn labels_round_the_pole(index: &MeridianIndex, meridian: i64) -> BTreeSet<u32> {
    let passed = index.polar.partition_point(|&(lon, _)| lon <= meridian);
    let labels = index.polar[passed..].iter().map(|&(_, label)| label);
    let mut labels: Vec<u32> = labels.collect();
    labels.sort_unstable();
    odd_ones(&labels).into_iter().collect()
}

impl MeridianIndex {
    fn add_cell(&mut self, ceiling: i64, edges: &[Labelled], separating: &BTreeSet<u32>) {
        // Most corners are separated by what separates the corner before.
        let last = self.cells.last().map_or(0..0, Cell::corner_labels);
        let same = self.corner_labels[last.clone()].iter().eq(separating);
        let labels = if same {
            last
        } else {
            let first = self.corner_labels.len();
            self.corner_labels.extend(separating);
            first..self.corner_labels.len()
        };
        self.cells.push(Cell {
            ceiling,
            first_entry: self.entries.len() as u32,
            entry_count: edges.len() as u32,
            first_label: labels.start as u32,
            label_count: labels.len() as u32,
        });
        let entries = edges.iter().map(|edge| (edge.edge, edge.label));
        self.entries.extend(entries);
    }
}
