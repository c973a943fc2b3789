//! Pairs of edges that may meet: a grid over longitude and latitude.

use rayon::prelude::*;

use crate::{
    boundary_graph::Edge,
    lattice::{POLE, TURN},
    region::EdgeKind,
};

/// A box on the lon/lat plane, in lattice steps; `west` in (−180°, 180°], `east` maybe beyond.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LatticeBox {
    pub(crate) west: i64,
    pub(crate) east: i64,
    pub(crate) south: i64,
    pub(crate) north: i64,
}

impl LatticeBox {
    /// A box that holds the true edge.
    pub(crate) fn around(edge: &Edge) -> Self {
        let (mut west, mut east) = (edge.start.lon, edge.end.lon);
        if west > east {
            (west, east) = (east, west);
        }
        if west <= -TURN / 2 {
            (west, east) = (west + TURN, east + TURN);
        }
        let (south, north) = (
            edge.start.lat.min(edge.end.lat),
            edge.start.lat.max(edge.end.lat),
        );
        // Longitude and the latitude of straight edges and rhumbs are monotonous. A geodesic strays
        // from the latitudes of its ends by half its length at most.
        let stray = match edge.kind {
            EdgeKind::Geodesic => ((east - west) + (north - south)) / 2 + TURN / 360_000,
            EdgeKind::Rhumb | EdgeKind::Straight => 0,
        };
        Self {
            west,
            east,
            south: (south - stray).max(-POLE),
            north: (north + stray).min(POLE),
        }
    }

    /// Whether the boxes have a point in common, this turn or the next.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        let overlap =
            |shift: i64| self.west <= other.east + shift && other.west + shift <= self.east;
        self.south <= other.north
            && other.south <= self.north
            && (overlap(0) || overlap(TURN) || overlap(-TURN))
    }
}

/// More pairs of edges lie in common cells than the budget allows: the input is a tangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tangle;

/// Largest number of pairs looked at, some seconds of work: a constant and so many per edge.
/// Real coasts have about ten pairs per edge.
const PAIR_BUDGET: (u64, u64) = (200_000_000, 200);

/// Edges sorted into the cells of a grid over the lon/lat plane.
pub(crate) struct EdgeGrid {
    columns: i64,
    rows: i64,
    /// Per cell the end of its run in `entries`.
    cell_ends: Vec<u32>,
    entries: Vec<u32>,
    boxes: Vec<LatticeBox>,
}

impl EdgeGrid {
    pub(crate) fn new(edges: &[Edge]) -> Self {
        let boxes: Vec<LatticeBox> = edges.par_iter().map(LatticeBox::around).collect();
        // Twice as many columns as edges would need to lie one to a cell; fewer while long edges
        // would fill too many cells.
        let mut rows = ((edges.len() as f64).sqrt() as i64).clamp(8, 2048);
        let budget = 16 * edges.len() as u64 + 4096;
        while rows > 8 && entry_count(&boxes, 2 * rows, rows, budget) > budget {
            rows /= 2;
        }
        let columns = 2 * rows;
        let mut grid = Self {
            columns,
            rows,
            cell_ends: Vec::new(),
            entries: Vec::new(),
            boxes,
        };
        grid.fill();
        grid
    }

    fn fill(&mut self) {
        let mut ends = vec![0_u32; (self.columns * self.rows) as usize];
        for cells in self
            .boxes
            .iter()
            .map(|b| Cells::of(b, self.columns, self.rows))
        {
            cells.for_each(|cell| ends[cell] += 1);
        }
        let mut total = 0;
        for end in &mut ends {
            total += *end;
            *end = total - *end;
        }
        let mut entries = vec![0_u32; total as usize];
        for (edge, edge_box) in self.boxes.iter().enumerate() {
            Cells::of(edge_box, self.columns, self.rows).for_each(|cell| {
                entries[ends[cell] as usize] = edge as u32;
                ends[cell] += 1;
            });
        }
        self.cell_ends = ends;
        self.entries = entries;
    }

    fn cell(&self, cell: usize) -> &[u32] {
        let first = if cell == 0 {
            0
        } else {
            self.cell_ends[cell - 1]
        };
        &self.entries[first as usize..self.cell_ends[cell] as usize]
    }

    /// Calls `visit` with every pair of edges (smaller first) whose boxes meet and of which one at
    /// least is `fresh`, and gathers what it returns, sorted. A pair may be visited more than once.
    pub(crate) fn pairs<T: Ord + Send>(
        &self,
        fresh: impl Fn(u32) -> bool + Sync,
        visit: impl Fn(u32, u32, &mut Vec<T>) + Sync,
    ) -> Result<Vec<T>, Tangle> {
        let budget = PAIR_BUDGET.0 + PAIR_BUDGET.1 * self.boxes.len() as u64;
        let pairs = |cell: usize| (self.cell(cell).len() as u64).pow(2) / 2;
        if (0..self.cell_ends.len()).map(pairs).sum::<u64>() > budget {
            return Err(Tangle);
        }
        let mut found: Vec<T> = (0..self.cell_ends.len())
            .into_par_iter()
            .with_min_len(64)
            .fold(Vec::new, |mut found, cell| {
                let members = self.cell(cell);
                for (index, &first) in members.iter().enumerate() {
                    let first_fresh = fresh(first);
                    let first_box = &self.boxes[first as usize];
                    for &second in &members[index + 1..] {
                        if (first_fresh || fresh(second))
                            && first_box.meets(&self.boxes[second as usize])
                        {
                            visit(first, second, &mut found);
                        }
                    }
                }
                found
            })
            .reduce(Vec::new, |mut all, mut more| {
                if all.len() < more.len() {
                    std::mem::swap(&mut all, &mut more);
                }
                all.append(&mut more);
                all
            });
        found.sort_unstable();
        found.dedup();
        Ok(found)
    }
}

/// The cells that a box touches; columns wrap round.
struct Cells {
    first_column: i64,
    last_column: i64,
    first_row: i64,
    last_row: i64,
    columns: i64,
}

impl Cells {
    fn of(edge_box: &LatticeBox, columns: i64, rows: i64) -> Self {
        let column = |lon: i64| (lon + TURN / 2).div_euclid(TURN / columns + 1);
        let row = |lat: i64| (lat + POLE) / (2 * POLE / rows + 1);
        // The last column is narrower, so a box beyond 180° is counted from the west again.
        let (first_column, last_column) = if edge_box.east > TURN / 2 {
            (
                column(edge_box.west),
                columns + column((edge_box.east - TURN).min(TURN / 2)),
            )
        } else {
            (column(edge_box.west), column(edge_box.east))
        };
        Self {
            first_column,
            last_column: last_column.min(first_column + columns - 1),
            first_row: row(edge_box.south),
            last_row: row(edge_box.north),
            columns,
        }
    }

    fn count(&self) -> u64 {
        ((self.last_column - self.first_column + 1) * (self.last_row - self.first_row + 1)) as u64
    }

    fn for_each(&self, mut visit: impl FnMut(usize)) {
        for row in self.first_row..=self.last_row {
            for column in self.first_column..=self.last_column {
                visit((row * self.columns + column % self.columns) as usize);
            }
        }
    }
}

/// Entries that a grid would hold; stops counting beyond `limit`.
fn entry_count(boxes: &[LatticeBox], columns: i64, rows: i64, limit: u64) -> u64 {
    let mut count = 0;
    for edge_box in boxes {
        count += Cells::of(edge_box, columns, rows).count();
        if count > limit {
            break;
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{boundary_graph::BoundaryGraph, lattice::LatticePoint};

    #[test]
    fn all_pairs_whose_boxes_meet_are_visited() {
        let mut graph = BoundaryGraph::default();
        let mut state = 1_u64;
        let mut random = |range: i64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            ((state >> 11) as i64).rem_euclid(range) - range / 2
        };
        for k in 0..300 {
            let start = LatticePoint::new(random(TURN), random(2 * POLE));
            let reach = TURN >> (1 + k % 9);
            let lat = (start.lat + random(reach)).clamp(-POLE, POLE);
            let kind = [EdgeKind::Straight, EdgeKind::Geodesic][k % 2];
            graph.insert(
                kind,
                start,
                LatticePoint::new(start.lon + random(reach), lat),
            );
        }
        let boxes: Vec<_> = graph.edges.iter().map(LatticeBox::around).collect();
        let mut expected = Vec::new();
        for first in 0..boxes.len() {
            for second in first + 1..boxes.len() {
                if boxes[first].meets(&boxes[second]) {
                    expected.push((first as u32, second as u32));
                }
            }
        }
        let grid = EdgeGrid::new(&graph.edges);
        let found = grid
            .pairs(|_| true, |a, b, found| found.push((a, b)))
            .unwrap();
        assert!(expected.len() > 500 && expected.len() < 40_000);
        assert_eq!(found, expected);
    }
}
