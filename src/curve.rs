//! The true edge between two vertices, as a curve that can be evaluated anywhere.

use crate::{geodetic::LonLat, region::EdgeKind};

/// One edge of a ring: the true curve from one vertex to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// How the ends are joined.
    pub kind: EdgeKind,
    /// Where the curve starts (t = 0).
    pub from: LonLat,
    /// Where it ends (t = 1). Longitudes are unwrapped: `to.lon_deg - from.lon_deg` is the signed
    /// difference along the curve.
    pub to: LonLat,
}
