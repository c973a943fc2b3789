//! What may be set for any scene.

use glam::UVec2;

/// How a scene is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    pub size_px: UVec2,
    /// [`globefill::Frame::pixel_error`].
    pub pixel_error: f64,
    pub yardstick: Yardstick,
    /// Whether the camera moves from frame to frame.
    pub moving: bool,
}

/// How the doubled vertices are stored and raised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Yardstick {
    pub encoding: Encoding,
    pub normals: Normals,
}

/// How positions are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// Single precision from the Earth's centre.
    Plain,
    /// Single precision from the middle of the mesh.
    #[default]
    Local,
    /// Two numbers of single precision that add up.
    HighLow,
    /// Integers of 1/128 m, with fractions of 2^-17 m.
    Fixed,
}

/// Which way columns stand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    /// At right angles to the ellipsoid.
    #[default]
    Geodetic,
    /// Away from the Earth's centre.
    Geocentric,
}
