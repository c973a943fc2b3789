//! What was repaired in the input, and where.

use std::fmt;

/// Where in the input something was found. All indices count from 0; ring 0 is the shell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Place {
    /// Index of the region (the GeoJSON feature).
    pub region: usize,
    /// Index of the polygon in the region.
    pub polygon: usize,
    /// Index of the ring in the polygon.
    pub ring: usize,
    /// Index of the vertex in the ring.
    pub vertex: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "feature {}, polygon {}, ring {}, vertex {}",
            self.region, self.polygon, self.ring, self.vertex
        )
    }
}

/// A defect of the input that was repaired by a documented rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Repair {
    /// Where it was found.
    pub place: Place,
    /// What it was, and what became of it.
    pub kind: RepairKind,
}

/// The documented repairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum RepairKind {
    /// The ring did not repeat its first vertex at the end; it was closed.
    Unclosed,
    /// A vertex equal to its predecessor was dropped.
    Duplicate,
    /// An edge walked in both directions by one region bounds nothing and was dropped: a spike, or
    /// an artificial edge such as those along ±180° and −90° that close Antarctica on a flat map.
    Seam,
    /// A vertex visited more than once was kept; the ring touches itself there (a pinch).
    Pinch,
    /// The ring crossed itself; it was split at the crossing and filled by the even-odd rule.
    Crossing,
    /// A hole outside its shell, or within another hole, removes nothing and was dropped.
    IdleHole,
}
