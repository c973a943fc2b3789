//! Where shapes are put: rigid turns of the sphere of directions.

use glam::{DMat3, DVec3};
use globefill::LonLat;

use crate::shape::Shape;

/// What of a shape comes to lie at the place.
#[derive(Clone, Copy, Debug)]
pub enum Anchor {
    Centre,
    /// The first vertex of the first shell.
    Vertex,
    /// The middle of the first edge.
    Edge,
}

/// A place, and the heading there of the shape: of its north, or of the edge that leaves the anchor.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    pub name: &'static str,
    pub anchor: Anchor,
    pub at: LonLat,
    pub heading_deg: f64,
}

const fn put(
    name: &'static str,
    anchor: Anchor,
    lon_deg: f64,
    lat_deg: f64,
    heading_deg: f64,
) -> Placement {
    Placement {
        name,
        anchor,
        at: LonLat::new(lon_deg, lat_deg),
        heading_deg,
    }
}

pub const GENERIC: Placement = put("mid-latitude", Anchor::Centre, 13.4, 47.3, 20.0);
pub const SOUTHERN: Placement = put("southern", Anchor::Centre, -70.1, -33.2, 200.0);
pub const EQUATOR: Placement = put("edge along the equator", Anchor::Edge, 0.0, 0.0, 90.0);
pub const DATELINE: Placement = put("over the antimeridian", Anchor::Centre, 180.0, -17.0, 70.0);
pub const DATELINE_EDGE: Placement =
    put("edge on the antimeridian", Anchor::Edge, 180.0, 30.0, 0.0);
pub const DATELINE_VERTEX: Placement = put("vertex at 180°, 0°", Anchor::Vertex, 180.0, 0.0, 45.0);
pub const NORTH_POLE: Placement = put("about the north pole", Anchor::Centre, 20.0, 90.0, 10.0);
pub const NEAR_SOUTH_POLE: Placement =
    put("near the south pole", Anchor::Centre, -100.0, -89.7, 30.0);
pub const POLE_VERTEX: Placement = put(
    "vertex at the south pole",
    Anchor::Vertex,
    40.0,
    -90.0,
    77.0,
);
pub const POLE_EDGE: Placement = put("edge over the north pole", Anchor::Edge, 20.0, 90.0, 0.0);
/// The pole is one of 2³⁶ steps of a degree away: 1 mm.
pub const BESIDE_POLE: Placement = put(
    "edge 1 mm beside the south pole",
    Anchor::Edge,
    50.0,
    -89.999_999_99,
    90.0,
);

pub const PLACEMENTS: [Placement; 11] = [
    GENERIC,
    SOUTHERN,
    EQUATOR,
    DATELINE,
    DATELINE_EDGE,
    DATELINE_VERTEX,
    NORTH_POLE,
    NEAR_SOUTH_POLE,
    POLE_VERTEX,
    POLE_EDGE,
    BESIDE_POLE,
];

impl Placement {
    /// The turn that puts a shape here.
    pub fn globe_from_shape(&self, shape: &Shape) -> DMat3 {
        let [start, next] = shape.first_edge();
        let (anchor, ahead) = match self.anchor {
            Anchor::Centre => (DVec3::X, DVec3::Z),
            Anchor::Vertex => (start, next),
            Anchor::Edge => ((start + next).normalize(), next),
        };
        let up = direction(self.at);
        let (sin_lon, cos_lon) = self.at.lon_deg.to_radians().sin_cos();
        let east = DVec3::new(-sin_lon, cos_lon, 0.0);
        let (sin, cos) = self.heading_deg.to_radians().sin_cos();
        let heading = up.cross(east) * cos + east * sin;
        frame(up, heading) * frame(anchor, ahead).transpose()
    }
}

/// Axes: up, ahead as far as it is square to up, and square to both.
fn frame(up: DVec3, ahead: DVec3) -> DMat3 {
    let ahead = (ahead - up * ahead.dot(up)).normalize();
    DMat3::from_cols(up, ahead, up.cross(ahead))
}

/// The direction of a geodetic normal, exact at the poles.
pub fn direction(at: LonLat) -> DVec3 {
    let (sin_lon, cos_lon) = at.lon_deg.to_radians().sin_cos();
    let (sin_lat, cos_lat) = at.lat_deg.to_radians().sin_cos();
    if at.lat_deg.abs() == 90.0 {
        return DVec3::Z * at.lat_deg.signum();
    }
    DVec3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat)
}

/// Where a direction points to. What a turn leaves within 10 µm of a pole, of the equator or of a
/// meridian of whole tens is put there; and all is rounded to 2⁻³⁶°, as the documented lattice of
/// the crate is, so that both sides speak of the same vertices.
pub fn lon_lat(direction: DVec3) -> LonLat {
    let across = direction.x.hypot(direction.y);
    let lat_deg = direction.z.atan2(across).to_degrees();
    let lon_deg = direction.y.atan2(direction.x).to_degrees();
    let near = |value: f64, grid: f64| {
        let snapped = (value / grid).round() * grid;
        if (value - snapped).abs() < 1e-10 {
            snapped
        } else {
            value
        }
    };
    let lat_deg = on_lattice(near(lat_deg, 90.0));
    if lat_deg.abs() == 90.0 {
        return LonLat::new(0.0, lat_deg);
    }
    let lon_deg = on_lattice(near(lon_deg, 10.0));
    LonLat::new(if lon_deg == -180.0 { 180.0 } else { lon_deg }, lat_deg)
}

fn on_lattice(angle_deg: f64) -> f64 {
    const STEPS: f64 = (1_u64 << 36) as f64;
    (angle_deg * STEPS).round() / STEPS
}
