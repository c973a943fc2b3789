//! Which tiles of longitude and latitude the terrain is drawn with.

use std::collections::HashSet;

use globefill::LonLat;

/// Cells along a side of a tile.
pub const CELLS: u32 = 32;

/// Deepest level: its tiles are about a metre wide, finer than any camera here needs.
const DEEPEST: u32 = 24;

/// A square of longitude and latitude. Level `l` has 2^(l+1) columns and 2^l rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Tile {
    pub level: u32,
    pub column: u32,
    pub row: u32,
}

/// A side of a tile, as a bit of a mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    West = 1,
    East = 2,
    South = 4,
    North = 8,
}

impl Side {
    pub const ALL: [Self; 4] = [Self::West, Self::East, Self::South, Self::North];
}

impl Tile {
    /// Width and height, degrees.
    pub fn span_deg(&self) -> f64 {
        180.0 / f64::from(1u32 << self.level)
    }

    /// A vertex of the tile, counted from its south-west corner. All the arithmetic is exact: the
    /// same point has the same bits in every tile that has it, up to whole turns.
    pub fn vertex(&self, x: u32, y: u32) -> LonLat {
        let along = |index: u32, offset: u32| {
            let steps = u64::from(index) * u64::from(CELLS) + u64::from(offset);
            steps as f64 * self.span_deg() / f64::from(CELLS)
        };
        LonLat::new(along(self.column, x) - 180.0, along(self.row, y) - 90.0)
    }

    /// The tile beside this one on the same level; none beyond the poles.
    fn neighbour(&self, side: Side) -> Option<Self> {
        let (columns, rows) = (2u32 << self.level, 1u32 << self.level);
        let (column, row) = match side {
            Side::West => ((self.column + columns - 1) % columns, self.row),
            Side::East => ((self.column + 1) % columns, self.row),
            Side::South => (self.column, self.row.checked_sub(1)?),
            Side::North => (self.column, self.row + 1),
        };
        (row < rows).then_some(Self {
            level: self.level,
            column,
            row,
        })
    }

    fn parent(&self) -> Option<Self> {
        let level = self.level.checked_sub(1)?;
        Some(Self {
            level,
            column: self.column / 2,
            row: self.row / 2,
        })
    }

    fn children(&self) -> [Self; 4] {
        [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| Self {
            level: self.level + 1,
            column: self.column * 2 + x,
            row: self.row * 2 + y,
        })
    }
}

/// Tiles that cover the globe without overlap, neighbours differing by at most one level.
pub struct Cover {
    leaves: HashSet<Tile>,
}

impl Cover {
    /// Splits every tile for which `too_large` answers yes.
    pub fn new(too_large: impl Fn(&Tile) -> bool) -> Self {
        let mut leaves = HashSet::new();
        let mut open: Vec<Tile> = [0, 1]
            .map(|column| Tile {
                level: 0,
                column,
                row: 0,
            })
            .to_vec();
        while let Some(tile) = open.pop() {
            if tile.level < DEEPEST && too_large(&tile) {
                open.extend(tile.children());
            } else {
                leaves.insert(tile);
            }
        }
        let mut cover = Self { leaves };
        cover.balance();
        cover
    }

    /// Every tile, with the mask of its sides where the neighbour is one level coarser.
    pub fn tiles(&self) -> Vec<(Tile, u32)> {
        let mut tiles: Vec<_> = self
            .leaves
            .iter()
            .map(|tile| (*tile, self.coarser_sides(tile)))
            .collect();
        // Sets have no order; equal cameras must draw equal pictures.
        tiles.sort_by_key(|(tile, _)| (tile.level, tile.row, tile.column));
        tiles
    }

    fn coarser_sides(&self, tile: &Tile) -> u32 {
        Side::ALL
            .into_iter()
            .filter(|side| {
                let covering = tile
                    .neighbour(*side)
                    .and_then(|beside| self.covering(beside));
                covering.is_some_and(|leaf| leaf.level < tile.level)
            })
            .fold(0, |mask, side| mask | side as u32)
    }

    fn balance(&mut self) {
        let mut open: Vec<Tile> = self.leaves.iter().copied().collect();
        while let Some(tile) = open.pop() {
            if !self.leaves.contains(&tile) {
                continue;
            }
            for beside in Side::ALL.iter().filter_map(|side| tile.neighbour(*side)) {
                let Some(leaf) = self.covering(beside) else {
                    continue;
                };
                if leaf.level + 1 < tile.level {
                    self.leaves.remove(&leaf);
                    self.leaves.extend(leaf.children());
                    open.extend(leaf.children());
                    open.push(tile);
                }
            }
        }
    }

    /// The leaf that covers a tile; none where finer leaves do.
    fn covering(&self, tile: Tile) -> Option<Tile> {
        let mut candidate = Some(tile);
        while let Some(tile) = candidate {
            if self.leaves.contains(&tile) {
                return Some(tile);
            }
            candidate = tile.parent();
        }
        None
    }
}
