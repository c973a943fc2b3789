//! Boxes on the plane of longitude and latitude.

use crate::{
    boundary::boundary_graph::Edge,
    boundary::lattice::{LatticePoint, POLE, TURN, orientation},
    curve::CurveKind,
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
            CurveKind::Geodesic => ((east - west) + (north - south)) / 2 + TURN / 360_000,
            CurveKind::Rhumb | CurveKind::Straight => 0,
            // Split where their latitude turns back, up to rounding.
            CurveKind::Circle(_) | CurveKind::Beside(_) => TURN / 360_000_000,
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

    /// Whether an edge may have a point in the box, if its own box has. Of straight edges that is certain:
    /// the boxes of slanting ones are mostly empty.
    pub(crate) fn is_touched_by(&self, edge: &Edge) -> bool {
        let (a, b) = (edge.start, edge.end);
        if edge.kind != CurveKind::Straight {
            return true;
        }
        [-TURN, 0, TURN].into_iter().any(|shift| {
            let (west, east) = (self.west + shift, self.east + shift);
            if a.lon.max(b.lon) < west || east < a.lon.min(b.lon) {
                return false;
            }
            let corners = [
                LatticePoint::new(west, self.south),
                LatticePoint::new(west, self.north),
                LatticePoint::new(east, self.south),
                LatticePoint::new(east, self.north),
            ];
            let sides = corners.map(|corner| orientation(a, b, corner).signum());
            sides != [1; 4] && sides != [-1; 4]
        })
    }
}
