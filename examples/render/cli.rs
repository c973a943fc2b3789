//! The command line.

use std::path::{Path, PathBuf};

use clap::{Parser, ValueEnum};
use glam::UVec2;
use globefill::{CountTechnique, DepthConvention, EdgeKind, Inside};

use crate::{
    host::{
        camera::Viewpoint,
        cli::{parse_finite, parse_fov, parse_size},
        output::DEFAULT_DIRECTORY,
    },
    style_args::StyleArguments,
};

/// Fills regions on a globe and writes pictures and measurements of it.
#[derive(Debug, Parser)]
#[command(name = "render", version, max_term_width = 100)]
pub struct Arguments {
    /// Regions to fill, a GeoJSON file. Without it: the embedded countries
    #[arg(long, value_name = "FILE")]
    pub regions: Option<PathBuf>,
    /// Which embedded countries to fill
    #[arg(long, value_enum, default_value = "50m", conflicts_with = "regions")]
    pub countries: CountryScale,
    /// Longitude, latitude, height above the ellipsoid; heading clockwise from north, pitch −90
    /// straight down
    #[arg(
        long,
        value_name = "LON,LAT,HEIGHT_M[,HEADING_DEG,PITCH_DEG]",
        allow_hyphen_values = true,
        default_value = "14,26,1.15e7"
    )]
    pub camera: Viewpoint,
    /// Vertical field of view, degrees
    #[arg(long, value_name = "DEG", default_value = "60", value_parser = parse_fov,
        allow_hyphen_values = true)]
    pub fov: f64,
    /// Picture size, pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = parse_size,
        allow_hyphen_values = true)]
    pub size: UVec2,
    /// The picture, PNG. With no output named at all: out/world.png
    #[arg(long, value_name = "PNG")]
    pub out: Option<PathBuf>,
    /// 8-bit grey PNG: 255 where any fill covers the pixel's centre
    #[arg(long, value_name = "PNG")]
    pub mask: Option<PathBuf>,
    /// 16-bit grey PNG: k where the k-th fill (from 1) is topmost, 0 for none
    #[arg(long, value_name = "PNG")]
    pub ids: Option<PathBuf>,
    /// NumPy float64 H×W×3: ECEF metres of the surface point in the depth buffer, NaN for sky
    #[arg(long, value_name = "NPY")]
    pub positions: Option<PathBuf>,
    /// What was drawn and what it cost, JSON
    #[arg(long, value_name = "JSON")]
    pub stats: Option<PathBuf>,
    /// Frames to time for --stats, with fills and without in turn; with styled fills those of plain
    /// colours too
    #[arg(long, value_name = "N", default_value_t = 10,
        value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub frames: u32,
    /// How vertices are joined. Default: straight (in longitude and latitude, as GeoJSON means it)
    #[arg(long, value_enum)]
    pub edges: Option<Edges>,
    /// Which side of a ring is inside. Default: the smaller
    #[arg(long, value_enum)]
    pub orientation: Option<Orientation>,
    /// How covered pixels are counted
    #[arg(long, value_enum, default_value = "winding")]
    pub count: Count,
    /// How far, pixels, a drawn boundary may lie from the true one; 0 for the best there is
    #[arg(long, value_name = "PX", default_value = "0.25", value_parser = parse_pixel_error,
        allow_hyphen_values = true)]
    pub pixel_error: f64,
    /// Terrain: a 16-bit grey PNG, with a JSON of the same stem that holds `west south east north`
    /// (degrees) and `scale offset` (metres = offset + scale · value)
    #[arg(long, value_name = "PNG")]
    pub terrain: Option<PathBuf>,
    /// Depth buffer: reversed and infinite, or standard with a finite far plane
    #[arg(long, value_enum, default_value = "reversed")]
    pub depth: Depth,
    /// Samples a pixel of the picture: 1 or 4
    #[arg(long, value_name = "N", default_value = "1", value_parser = parse_samples)]
    pub msaa: u32,
    #[command(flatten)]
    pub style: StyleArguments,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CountryScale {
    #[value(name = "110m")]
    Scale110m,
    #[value(name = "50m")]
    Scale50m,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Edges {
    Geodesic,
    Rhumb,
    Straight,
}

impl From<Edges> for EdgeKind {
    fn from(edges: Edges) -> Self {
        match edges {
            Edges::Geodesic => Self::Geodesic,
            Edges::Rhumb => Self::Rhumb,
            Edges::Straight => Self::Straight,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Orientation {
    Smaller,
    Left,
}

impl From<Orientation> for Inside {
    fn from(orientation: Orientation) -> Self {
        match orientation {
            Orientation::Smaller => Self::Smaller,
            Orientation::Left => Self::LeftOfRing,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Count {
    Winding,
    Stencil,
}

impl From<Count> for CountTechnique {
    fn from(count: Count) -> Self {
        match count {
            Count::Winding => Self::Winding,
            Count::Stencil => Self::Stencil,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Depth {
    Reversed,
    Standard,
}

impl From<Depth> for DepthConvention {
    fn from(depth: Depth) -> Self {
        match depth {
            Depth::Reversed => Self::Reversed,
            Depth::Standard => Self::Standard,
        }
    }
}

impl Arguments {
    /// Names `out/world.png` where no output was asked for.
    pub fn with_default_output(mut self) -> Self {
        let outputs = [
            &self.out,
            &self.mask,
            &self.ids,
            &self.positions,
            &self.stats,
        ];
        if outputs.iter().all(|path| path.is_none()) {
            self.out = Some(Path::new(DEFAULT_DIRECTORY).join("world.png"));
        }
        self
    }
}

fn parse_pixel_error(text: &str) -> Result<f64, String> {
    let pixels = parse_finite(text)?;
    if pixels >= 0.0 {
        Ok(pixels)
    } else {
        Err("it must not be negative".into())
    }
}

fn parse_samples(text: &str) -> Result<u32, String> {
    match text {
        "1" => Ok(1),
        "4" => Ok(4),
        _ => Err("it must be 1 or 4".into()),
    }
}
