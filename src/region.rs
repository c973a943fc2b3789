//! Regions: what a caller asks to have filled.

use crate::{geodetic::LonLat, zone::Zone};

/// How consecutive vertices of a ring are joined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum EdgeKind {
    /// The shortest path on the ellipsoid. Its ends must not be nearly antipodal.
    #[default]
    Geodesic,
    /// The line of constant azimuth. An edge with an end at a pole follows the other end's meridian.
    Rhumb,
    /// Linear in longitude and latitude, as RFC 7946 §3.1.1 defines GeoJSON's edges. It takes the
    /// shorter way round in longitude, except that a difference of exactly 360° is the whole
    /// parallel (the lower edge of a box from −180° to 180°).
    Straight,
}

/// Which side of a shell ring is inside. Holes are holes whatever their winding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Inside {
    /// The side with the smaller area, whatever the ring's winding.
    #[default]
    Smaller,
    /// The side on the left when walking along the shell. Allows more than a hemisphere.
    LeftOfRing,
}

/// A closed ring of vertices. The last vertex may repeat the first; the edge is the same.
pub type Ring = Vec<LonLat>;

/// A shell and the holes in it.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Polygon {
    /// The outer ring.
    pub shell: Ring,
    /// Rings cut out of the shell: of each, the side away from the shell is removed.
    #[cfg_attr(feature = "serde", serde(default))]
    pub holes: Vec<Ring>,
}

/// Polygons that are filled as one, with one style.
///
/// Polygons and zones of one region that overlap are drawn one above the other: where they do, a
/// translucent style is blended twice.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Region {
    /// The parts of the region.
    pub polygons: Vec<Polygon>,
    /// How the vertices of every ring are joined.
    pub edges: EdgeKind,
    /// Which side of every shell is inside.
    pub inside: Inside,
    /// Parts that are measured along the surface. `edges` and `inside` say nothing about them.
    pub zones: Vec<Zone>,
}
