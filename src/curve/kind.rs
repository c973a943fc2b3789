//! What an edge follows.

use crate::{
    curve::{Beside, Circle},
    region::EdgeKind,
};

/// What an edge follows between its ends: every [`EdgeKind`], and what zones are bounded by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CurveKind {
    /// [`EdgeKind::Geodesic`].
    Geodesic,
    /// [`EdgeKind::Rhumb`].
    Rhumb,
    /// [`EdgeKind::Straight`].
    Straight,
    /// An arc of a geodesic circle.
    Circle(Circle),
    /// The curve at a fixed distance beside a geodesic.
    Beside(Beside),
}

impl CurveKind {
    /// Whether only zones have such edges.
    pub(crate) fn is_of_zones(self) -> bool {
        matches!(self, Self::Circle(_) | Self::Beside(_))
    }
}

impl From<EdgeKind> for CurveKind {
    fn from(kind: EdgeKind) -> Self {
        match kind {
            EdgeKind::Geodesic => Self::Geodesic,
            EdgeKind::Rhumb => Self::Rhumb,
            EdgeKind::Straight => Self::Straight,
        }
    }
}

impl PartialEq<EdgeKind> for CurveKind {
    fn eq(&self, kind: &EdgeKind) -> bool {
        *self == Self::from(*kind)
    }
}
