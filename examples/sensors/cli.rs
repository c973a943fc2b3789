//! The command line.

use std::path::{Path, PathBuf};

use clap::{Parser, ValueEnum};
use glam::UVec2;

use crate::{
    colors::parse_color,
    host::{
        camera::Viewpoint,
        cli::{parse_finite, parse_fov, parse_size},
        output::DEFAULT_DIRECTORY,
    },
};

/// Satellites of the shell, unless told otherwise.
const DEFAULT_COUNT: usize = 100;

/// Propagates satellites and draws the footprints of their sensors, one PNG a frame.
#[derive(Debug, Parser)]
#[command(name = "sensors", version, max_term_width = 100)]
pub struct Arguments {
    /// Element sets, TLE or 3LE text or OMM JSON. Without it: a Walker delta shell
    #[arg(long, value_name = "FILE")]
    pub elements: Option<PathBuf>,
    /// Satellites: of the shell [default: 100], or at most so many of the file [default: all]
    #[arg(long, value_name = "N", value_parser = parse_count, allow_hyphen_values = true)]
    pub count: Option<usize>,
    /// Height of the shell (of the sensors of --scene circles), metres
    #[arg(long, value_name = "M", default_value = "550000", value_parser = parse_height,
        allow_hyphen_values = true, conflicts_with = "elements")]
    pub height: f64,
    /// Inclination of the shell, degrees
    #[arg(long, value_name = "DEG", default_value = "53", value_parser = parse_inclination,
        allow_hyphen_values = true, conflicts_with = "elements")]
    pub inclination: f64,
    /// Planes of the shell, which must divide its satellites. Default: about as many as satellites
    /// in each
    #[arg(long, value_name = "P", value_parser = parse_count, conflicts_with = "elements")]
    pub planes: Option<usize>,
    /// What moves: satellites, or circles of 800 km radius that drift eastwards by 0.2° a frame
    #[arg(long, value_enum, default_value = "orbits")]
    pub scene: Scene,

    /// Field of view of every sensor: a cone, a rectangle four times as wide as along the track, or
    /// a hexagon
    #[arg(long, value_enum, default_value = "conic")]
    pub sensor: SensorKind,
    /// From the nadir to the edge (of a rectangle, across the track; of a hexagon, to its corners),
    /// degrees
    #[arg(long, value_name = "DEG", default_value = "50", value_parser = parse_half_angle,
        allow_hyphen_values = true)]
    pub half_angle: f64,
    /// Least elevation at which a sensor sees the ground, degrees. Default: down to the limb
    #[arg(long, value_name = "DEG", value_parser = parse_elevation, allow_hyphen_values = true)]
    pub min_elevation: Option<f64>,
    /// Which terrain a footprint covers: above and below what it covers on the ellipsoid, or what
    /// the sensor sees from its apex. Over the bare ellipsoid they are the same
    #[arg(long, value_enum, default_value = "normal")]
    pub extrusion: ExtrusionKind,

    /// Colour the ground by how many sensors see it
    #[arg(long)]
    pub coverage: bool,
    /// Show where at least N sensors see the ground, and highlight the gaps
    #[arg(long, value_name = "N", value_parser = parse_count, conflicts_with = "coverage")]
    pub threshold: Option<usize>,
    /// One colour for all footprints. Default: by orbital plane
    #[arg(long, value_name = "RRGGBB[AA]", value_parser = parse_color,
        conflicts_with_all = ["coverage", "threshold"])]
    pub color: Option<[f32; 4]>,
    /// Leave the countries out
    #[arg(long)]
    pub no_countries: bool,

    /// Longitude, latitude, height above the ellipsoid; heading clockwise from north, pitch −90
    /// straight down
    #[arg(
        long,
        value_name = "LON,LAT,HEIGHT_M[,HEADING_DEG,PITCH_DEG]",
        allow_hyphen_values = true,
        default_value = "10,20,2e7"
    )]
    pub camera: Viewpoint,
    /// Vertical field of view, degrees
    #[arg(long, value_name = "DEG", default_value = "36", value_parser = parse_fov,
        allow_hyphen_values = true)]
    pub fov: f64,
    /// Picture size, pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = parse_size,
        allow_hyphen_values = true)]
    pub size: UVec2,
    /// Terrain, as for the example `render`
    #[arg(long, value_name = "PNG")]
    pub terrain: Option<PathBuf>,

    /// Frames to draw
    #[arg(long, value_name = "N", default_value_t = 30,
        value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub frames: u32,
    /// Time from frame to frame, seconds
    #[arg(long, value_name = "S", default_value = "10", value_parser = parse_finite,
        allow_hyphen_values = true)]
    pub step: f64,
    /// Directory, made if need be, of the pictures frame-0000.png … With no output named at all:
    /// out/sensors
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// What was drawn and what it cost, JSON: medians over the frames by the clock, without
    /// propagation. update_us_per_sensor: moving all sensors and preparing the frame (on one core
    /// with RAYON_NUM_THREADS=1); script_ms: that and recording and submitting; frame_ms: all of it
    /// until the GPU is idle; upload_bytes: a sensor and frame
    #[arg(long, value_name = "FILE")]
    pub stats: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Scene {
    Orbits,
    Circles,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SensorKind {
    Conic,
    Rectangular,
    Custom,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ExtrusionKind {
    Normal,
    Apex,
}

impl From<ExtrusionKind> for globefill::Extrusion {
    fn from(kind: ExtrusionKind) -> Self {
        match kind {
            ExtrusionKind::Normal => Self::Normal,
            ExtrusionKind::Apex => Self::Apex,
        }
    }
}

impl Arguments {
    /// Refuses what does not go together, and names `out/sensors` where no output was asked for.
    pub fn checked(mut self) -> Result<Self, String> {
        if self.sensor != SensorKind::Conic && self.half_angle >= 90.0 {
            return Err("--half-angle: only a cone can have 90 degrees or more".into());
        }
        if self.scene == Scene::Circles
            && (self.elements.is_some() || self.sensor != SensorKind::Conic)
        {
            return Err("--scene circles has conic sensors and no --elements".into());
        }
        if self.out.is_none() && self.stats.is_none() {
            self.out = Some(Path::new(DEFAULT_DIRECTORY).join("sensors"));
        }
        Ok(self)
    }

    /// Satellites to make where there are no element sets.
    pub fn made(&self) -> usize {
        self.count.unwrap_or(DEFAULT_COUNT)
    }
}

fn parse_count(text: &str) -> Result<usize, String> {
    let count: usize = text
        .parse()
        .map_err(|error: std::num::ParseIntError| error.to_string())?;
    within(count, 1..=MOST_SENSORS, "")
}

/// What an ordinary machine draws within a minute.
const MOST_SENSORS: usize = 1_000_000;

fn parse_height(text: &str) -> Result<f64, String> {
    within(parse_finite(text)?, 150_000.0..=1e8, " metres")
}

fn parse_inclination(text: &str) -> Result<f64, String> {
    within(parse_finite(text)?, 0.0..=180.0, " degrees")
}

fn parse_half_angle(text: &str) -> Result<f64, String> {
    within(parse_finite(text)?, 0.001..=180.0, " degrees")
}

fn parse_elevation(text: &str) -> Result<f64, String> {
    within(parse_finite(text)?, -90.0..=90.0, " degrees")
}

fn within<T: PartialOrd + std::fmt::Display>(
    value: T,
    range: std::ops::RangeInclusive<T>,
    unit: &str,
) -> Result<T, String> {
    if range.contains(&value) {
        return Ok(value);
    }
    let (least, most) = (range.start(), range.end());
    Err(format!("it must lie within {least} … {most}{unit}"))
}
