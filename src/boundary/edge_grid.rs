//! Pairs of edges that may meet: a grid over longitude and latitude.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::{
    boundary::boundary_graph::Edge,
    boundary::edge_star::EdgeStar,
    boundary::lattice::{POLE, TURN},
    boundary::lattice_box::LatticeBox,
};

/// More pairs of edges lie in common cells than the budget allows: the input is a tangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tangle;

/// Largest number of pairs looked at, some seconds of work: a constant and so many per edge.
/// Real coasts have about ten pairs per edge.
const PAIR_BUDGET: (u64, u64) = (200_000_000, 200);

/// Edges sorted into the cells of a grid over the lon/lat plane.
pub(crate) struct EdgeGrid<'a> {
    edges: &'a [Edge],
    columns: i64,
    rows: i64,
    /// Per cell the end of its run in `entries`.
    cell_ends: Vec<u32>,
    entries: Vec<u32>,
    boxes: Vec<LatticeBox>,
}

impl<'a> EdgeGrid<'a> {
    pub(crate) fn new(edges: &'a [Edge]) -> Self {
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
            edges,
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
        for edge in 0..self.boxes.len() {
            self.for_each_cell_of(edge, |cell| ends[cell] += 1);
        }
        let mut total = 0;
        for end in &mut ends {
            total += *end;
            *end = total - *end;
        }
        let mut entries = vec![0_u32; total as usize];
        for edge in 0..self.boxes.len() {
            self.for_each_cell_of(edge, |cell| {
                entries[ends[cell] as usize] = edge as u32;
                ends[cell] += 1;
            });
        }
        self.cell_ends = ends;
        self.entries = entries;
    }

    fn for_each_cell_of(&self, edge: usize, mut visit: impl FnMut(usize)) {
        let cells = Cells::of(&self.boxes[edge], self.columns, self.rows);
        // Short edges are in nearly all cells of their box.
        let is_short = cells.count() <= 4;
        cells.for_each(|cell| {
            if is_short || self.cell_box(cell).is_touched_by(&self.edges[edge]) {
                visit(cell);
            }
        });
    }

    fn cell(&self, cell: usize) -> &[u32] {
        let first = if cell == 0 {
            0
        } else {
            self.cell_ends[cell - 1]
        };
        &self.entries[first as usize..self.cell_ends[cell] as usize]
    }

    /// Calls `visit` with every pair of edges (smaller first) that may meet and of which one at least is
    /// `fresh`, and gathers what it returns, sorted. A pair may be visited more than once; one of an
    /// [`EdgeStar`] that has nothing but its middle in common may be left out.
    pub(crate) fn pairs<T: Ord + Send>(
        &self,
        fresh: impl Fn(u32) -> bool + Sync,
        visit: impl Fn(u32, u32, &mut Vec<T>) + Sync,
    ) -> Result<Vec<T>, Tangle> {
        let search = Search {
            edges: self.edges,
            boxes: &self.boxes,
            fresh,
            visit,
            visited: AtomicU64::new(0),
            budget: PAIR_BUDGET.0 + PAIR_BUDGET.1 * self.boxes.len() as u64,
        };
        let mut found: Vec<T> = (0..self.cell_ends.len())
            .into_par_iter()
            .with_min_len(64)
            .try_fold(Vec::new, |mut found, cell| {
                let members = self.cell(cell);
                if members.len() > 1 {
                    search.cell(members, self.cell_box(cell), 0, &mut found)?;
                }
                Ok(found)
            })
            .try_reduce(Vec::new, |mut all, mut more| {
                if all.len() < more.len() {
                    std::mem::swap(&mut all, &mut more);
                }
                all.append(&mut more);
                Ok(all)
            })?;
        found.sort_unstable();
        found.dedup();
        Ok(found)
    }

    fn cell_box(&self, cell: usize) -> LatticeBox {
        let (row, column) = (cell as i64 / self.columns, cell as i64 % self.columns);
        let (width, height) = (TURN / self.columns + 1, 2 * POLE / self.rows + 1);
        LatticeBox {
            west: column * width - TURN / 2,
            east: (column + 1) * width - TURN / 2,
            south: row * height - POLE,
            north: (row + 1) * height - POLE,
        }
    }
}

/// Cells with more edges are divided again: a city's plots may lie on a map of the world.
const MAX_MEMBERS: usize = 96;
/// Each division makes cells this many times smaller, either way.
const DIVISION: i64 = 8;
/// After so many divisions a cell is a lattice step wide.
const MAX_DEPTH: u32 = 12;

struct Search<'a, Fresh, Visit> {
    edges: &'a [Edge],
    boxes: &'a [LatticeBox],
    fresh: Fresh,
    visit: Visit,
    visited: AtomicU64,
    budget: u64,
}

impl<Fresh: Fn(u32) -> bool, Visit> Search<'_, Fresh, Visit> {
    /// Visits the pairs of a cell's members.
    fn cell<T>(
        &self,
        members: &[u32],
        cell_box: LatticeBox,
        depth: u32,
        found: &mut Vec<T>,
    ) -> Result<(), Tangle>
    where
        Visit: Fn(u32, u32, &mut Vec<T>),
    {
        let star = EdgeStar::of(self.edges, members, MAX_MEMBERS);
        if members.len() > MAX_MEMBERS && depth < MAX_DEPTH {
            let parts = self.divide(members, cell_box);
            let cost = |(part, _): &(Vec<u32>, LatticeBox)| {
                EdgeStar::of(self.edges, part, MAX_MEMBERS).pair_count()
            };
            // Edges longer than the cell lie in all its parts: dividing them gains nothing.
            if parts.iter().map(cost).sum::<u64>() < star.pair_count() / 10 * 9 {
                drop(star);
                return parts
                    .into_iter()
                    .try_for_each(|(part, part_box)| self.cell(&part, part_box, depth + 1, found));
            }
        }
        let pairs = star.pair_count();
        if self.visited.fetch_add(pairs, Ordering::Relaxed) + pairs > self.budget {
            return Err(Tangle);
        }
        star.for_each_pair(|first, second| {
            let is_fresh = (self.fresh)(first) || (self.fresh)(second);
            if is_fresh && self.boxes[first as usize].meets(&self.boxes[second as usize]) {
                (self.visit)(first, second, found);
            }
        });
        Ok(())
    }

    /// The part of a cell in which members lie.
    fn common_box(&self, members: &[u32], cell_box: LatticeBox) -> LatticeBox {
        let mut common = LatticeBox {
            west: cell_box.east,
            east: cell_box.west,
            south: cell_box.north,
            north: cell_box.south,
        };
        for &member in members {
            let member = &self.boxes[member as usize];
            for shift in [-TURN, 0, TURN] {
                let (west, east) = (member.west + shift, member.east + shift);
                if west <= cell_box.east && cell_box.west <= east {
                    common.west = common.west.min(west.max(cell_box.west));
                    common.east = common.east.max(east.min(cell_box.east));
                }
            }
            common.south = common.south.min(member.south.max(cell_box.south));
            common.north = common.north.max(member.north.min(cell_box.north));
        }
        common
    }

    /// The members of the parts of a cell that have more than one.
    fn divide(&self, members: &[u32], cell_box: LatticeBox) -> Vec<(Vec<u32>, LatticeBox)> {
        let cell_box = self.common_box(members, cell_box);
        let width = (cell_box.east - cell_box.west) / DIVISION + 1;
        let height = (cell_box.north - cell_box.south) / DIVISION + 1;
        let mut parts = Vec::new();
        for part in 0..DIVISION * DIVISION {
            let west = cell_box.west + part % DIVISION * width;
            let south = cell_box.south + part / DIVISION * height;
            let part_box = LatticeBox {
                west,
                east: west + width,
                south,
                north: south + height,
            };
            let is_in = |member: &&u32| {
                let member = **member as usize;
                self.boxes[member].meets(&part_box) && part_box.is_touched_by(&self.edges[member])
            };
            let part: Vec<u32> = members.iter().filter(is_in).copied().collect();
            if part.len() > 1 {
                parts.push((part, part_box));
            }
        }
        parts
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
    use crate::{
        boundary::boundary_graph::BoundaryGraph, boundary::lattice::LatticePoint,
        boundary::meeting::meetings, curve::CurveKind, region::EdgeKind,
    };

    #[test]
    fn a_dense_place_is_no_tangle_and_a_tangle_is_found_out() {
        let edges = |reach: i64| {
            let mut graph = BoundaryGraph::default();
            for k in 0..30_000_i64 {
                // A city of 0.1°: squares of 0.6 m without order.
                let start = LatticePoint::new(
                    TURN / 2 - 5 + k * 7_919 % 104_729 * 65_536,
                    k * 104_729 % 99_991 * 65_536,
                );
                let turned = LatticePoint::new(start.lon + reach + k, start.lat + reach - k);
                graph.insert(EdgeKind::Straight, start, turned);
            }
            graph.edges
        };
        let count = |edges: &[Edge]| {
            let pairs = EdgeGrid::new(edges).pairs(|_| true, |a, b, found| found.push((a, b)));
            pairs.map(|pairs| pairs.len())
        };
        assert!(count(&edges(400_000)).unwrap() < 100_000);
        assert_eq!(count(&edges(TURN / 5)), Err(Tangle));
    }

    #[test]
    fn all_pairs_that_may_meet_are_visited() {
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
                let edges = [first, second].map(|index| &graph.edges[index]);
                // A straight edge reaches whatever box it touches; two of them meet or do not.
                let may_meet = match edges.map(|edge| edge.kind == CurveKind::Straight) {
                    [true, true] => {
                        let mut meets = false;
                        meetings(edges, || unreachable!(), |_| meets = true);
                        meets
                    }
                    _ => {
                        boxes[first].is_touched_by(edges[1])
                            && boxes[second].is_touched_by(edges[0])
                    }
                };
                if may_meet && boxes[first].meets(&boxes[second]) {
                    expected.push((first as u32, second as u32));
                }
            }
        }
        let grid = EdgeGrid::new(&graph.edges);
        let found = grid
            .pairs(|_| true, |a, b, found| found.push((a, b)))
            .unwrap();
        assert!(expected.len() > 500 && expected.len() < 40_000);
        assert!(
            expected
                .iter()
                .all(|pair| found.binary_search(pair).is_ok())
        );
    }
}
