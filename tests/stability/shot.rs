//! Cameras: what they look at, from how far, which way.

use globefill::LonLat;

use crate::{
    common::{
        camera::Pose,
        figure::Figure,
        surface::{DepthKind, Terrain},
    },
    subject::Foci,
};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Focus {
    Edge,
    Vertex,
    Centre,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Height {
    /// Above the host's surface, metres.
    M(f64),
    /// In radii of the shape, though not below 1 m nor above 20 000 km.
    Radii(f64),
}

#[derive(Clone, Copy, Debug)]
pub struct Shot {
    pub focus: Focus,
    pub height: Height,
    /// Clockwise from the bearing of the boundary.
    pub heading_deg: f64,
    pub pitch_deg: f64,
    pub terrain: Terrain,
    pub depth: DepthKind,
}

const fn shot(focus: Focus, height: Height, heading_deg: f64, pitch_deg: f64) -> Shot {
    Shot {
        focus,
        height,
        heading_deg,
        pitch_deg,
        terrain: Terrain::Bare,
        depth: DepthKind::Reversed,
    }
}

const fn down(focus: Focus, height: Height) -> Shot {
    shot(focus, height, 0.0, -90.0)
}

impl Shot {
    const fn over(self, terrain: Terrain) -> Self {
        Self { terrain, ..self }
    }

    const fn standard(self) -> Self {
        Self {
            depth: DepthKind::Standard,
            ..self
        }
    }

    pub fn pose(&self, figure: &Figure, foci: &Foci) -> Pose {
        let at: LonLat = match self.focus {
            Focus::Edge => foci.edge,
            Focus::Vertex => foci.vertex,
            Focus::Centre => foci.centre,
        };
        let height_m = match self.height {
            Height::M(height_m) => height_m,
            Height::Radii(radii) => (radii * foci.radius_m).clamp(1.0, 2e7),
        };
        let ground_m = self.terrain.height_m(figure.normal(at));
        let pose = Pose::nadir(at.lon_deg, at.lat_deg, ground_m + height_m + foci.lift_m)
            .turned(foci.bearing_deg + self.heading_deg, self.pitch_deg);
        Pose {
            // From beyond the Moon, through a telescope.
            fov_deg: if height_m > 1e8 { 2.5 } else { 60.0 },
            ..pose
        }
    }

    pub fn name(&self) -> String {
        let height = match self.height {
            Height::M(height_m) if height_m < 1e4 => format!("{height_m} m"),
            Height::M(height_m) => format!("{} km", height_m / 1e3),
            Height::Radii(radii) => format!("{radii} radii"),
        };
        let look = if self.pitch_deg == -90.0 {
            "down".to_owned()
        } else {
            format!("{}°/{}°", self.heading_deg, self.pitch_deg)
        };
        let mut name = format!("{:?} {height} {look}", self.focus);
        if self.terrain != Terrain::Bare {
            name += &format!(" {:?}", self.terrain);
        }
        if self.depth == DepthKind::Standard {
            name += " standard z";
        }
        name
    }
}

use Focus::{Centre, Edge, Vertex};
use Height::{M, Radii};

/// Over the bare ellipsoid.
pub const BARE: [Shot; 12] = [
    down(Edge, M(1.0)),
    down(Edge, M(100.0)).standard(),
    shot(Edge, M(1e4), 20.0, -35.0),
    shot(Edge, M(2.0), 10.0, -8.0),
    shot(Edge, M(3e5), 95.0, -12.0),
    down(Vertex, M(3.0)),
    down(Vertex, M(1e6)).standard(),
    shot(Vertex, M(30.0), 60.0, -15.0),
    down(Centre, Radii(1.7)),
    shot(Edge, Radii(0.6), -60.0, -40.0),
    down(Centre, M(2e7)),
    down(Centre, M(4e8)),
];

const TOP: Terrain = Terrain::Plateau { height_m: 9000.0 };
const BOTTOM: Terrain = Terrain::Plateau {
    height_m: -11_000.0,
};

/// Over terrain between −11 and 9 km: the eye is inside the volume, or walls cut the near plane.
pub const HIGH_AND_LOW: [Shot; 9] = [
    down(Edge, M(1.0)).over(TOP),
    shot(Edge, M(100.0), 15.0, -12.0).over(BOTTOM),
    down(Vertex, M(10.0)).over(BOTTOM).standard(),
    down(Edge, M(1.0)).over(Terrain::Deep),
    down(Vertex, M(50.0)).over(Terrain::Rough),
    shot(Edge, M(2e4), 40.0, -25.0).over(Terrain::Deep),
    down(Edge, M(1.0)).over(Terrain::Level),
    shot(Edge, M(2.0), 12.0, -10.0).over(Terrain::Level),
    shot(Centre, Radii(0.5), 30.0, -30.0).over(Terrain::Level),
];
