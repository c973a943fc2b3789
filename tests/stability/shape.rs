//! Shapes as rings of directions about the X axis, north being Z.

use glam::{DMat3, DVec3};
use globefill::{EdgeKind, Ellipsoid, Inside, LonLat, Polygon, Region};

use crate::placement::lon_lat;

/// A shell and its holes.
#[derive(Clone, Debug)]
pub struct Rings {
    pub shell: Vec<DVec3>,
    pub holes: Vec<Vec<DVec3>>,
}

/// Regions that are placed together.
#[derive(Clone, Debug)]
pub struct Shape {
    pub name: &'static str,
    pub edges: &'static [EdgeKind],
    pub inside: Inside,
    pub ellipsoid: Ellipsoid,
    /// A list of polygons for each region.
    pub regions: Vec<Vec<Rings>>,
}

pub const ALL_EDGES: &[EdgeKind] = &[EdgeKind::Geodesic, EdgeKind::Rhumb, EdgeKind::Straight];
pub const GEODESIC: &[EdgeKind] = &[EdgeKind::Geodesic];

impl Shape {
    /// One region.
    pub fn new(name: &'static str, polygons: Vec<Rings>) -> Self {
        Self::regions(name, vec![polygons])
    }

    pub fn regions(name: &'static str, regions: Vec<Vec<Rings>>) -> Self {
        Self {
            name,
            edges: ALL_EDGES,
            inside: Inside::Smaller,
            ellipsoid: Ellipsoid::WGS84,
            regions,
        }
    }

    /// Inside is what lies to the left, joined by geodesics: of other edges a turned shape may cross
    /// itself, and then it has no left.
    pub fn left(self) -> Self {
        Self {
            inside: Inside::LeftOfRing,
            edges: GEODESIC,
            ..self
        }
    }

    pub fn with_edges(self, edges: &'static [EdgeKind]) -> Self {
        Self { edges, ..self }
    }

    pub fn on(self, ellipsoid: Ellipsoid) -> Self {
        Self { ellipsoid, ..self }
    }

    pub fn first_edge(&self) -> [DVec3; 2] {
        let shell = &self.regions[0][0].shell;
        [shell[0], shell[1]]
    }

    /// The greatest angle from the X axis to a vertex.
    pub fn radius_rad(&self) -> f64 {
        let polygons = self.regions.iter().flatten();
        let vertices = polygons.flat_map(|rings| &rings.shell);
        vertices
            .map(|vertex| vertex.cross(DVec3::X).length().atan2(vertex.x))
            .fold(0.0, f64::max)
    }

    pub fn placed(&self, globe_from_shape: DMat3, edges: EdgeKind) -> Vec<Region> {
        let ring = |ring: &Vec<DVec3>| -> Vec<LonLat> {
            ring.iter()
                .map(|&v| lon_lat(globe_from_shape * v))
                .collect()
        };
        let polygon = |rings: &Rings| Polygon {
            shell: ring(&rings.shell),
            holes: rings.holes.iter().map(ring).collect(),
        };
        let region = |polygons: &Vec<Rings>| Region {
            polygons: polygons.iter().map(polygon).collect(),
            edges,
            inside: self.inside,
            zones: Vec::new(),
        };
        self.regions.iter().map(region).collect()
    }
}

impl Rings {
    pub fn new(shell: Vec<DVec3>) -> Self {
        Self {
            shell,
            holes: Vec::new(),
        }
    }

    pub fn with(self, holes: Vec<Vec<DVec3>>) -> Self {
        Self { holes, ..self }
    }
}

/// The direction at an azimuth from north and an angle from the X axis.
pub fn polar(azimuth_deg: f64, angle_deg: f64) -> DVec3 {
    let (sin_azimuth, cos_azimuth) = azimuth_deg.to_radians().sin_cos();
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    DVec3::X * cos + (DVec3::Z * cos_azimuth + DVec3::Y * sin_azimuth) * sin
}

/// The direction at so many degrees east and north of the X axis.
pub fn local(east_deg: f64, north_deg: f64) -> DVec3 {
    let (sin_east, cos_east) = east_deg.to_radians().sin_cos();
    let (sin_north, cos_north) = north_deg.to_radians().sin_cos();
    DVec3::new(cos_north * cos_east, cos_north * sin_east, sin_north)
}

/// A regular polygon, counter-clockwise seen from outside.
pub fn regular(corners: u32, angle_deg: f64) -> Vec<DVec3> {
    (0..corners)
        .map(|k| polar(11.0 - 360.0 * f64::from(k) / f64::from(corners), angle_deg))
        .collect()
}

/// The same turned round.
pub fn clockwise(mut ring: Vec<DVec3>) -> Vec<DVec3> {
    ring.reverse();
    ring
}

/// A box between two longitudes and latitudes of the shape's own, counter-clockwise.
pub fn quad(west_deg: f64, south_deg: f64, east_deg: f64, north_deg: f64) -> Vec<DVec3> {
    vec![
        local(west_deg, south_deg),
        local(east_deg, south_deg),
        local(east_deg, north_deg),
        local(west_deg, north_deg),
    ]
}
