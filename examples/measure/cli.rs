//! The command line.

use std::path::PathBuf;

use clap::Parser;
use glam::UVec2;

use crate::{
    host::cli::{parse_finite, parse_size},
    technique::TechniqueName,
};

/// Measures ways of filling regions: time, work and error.
#[derive(Debug, Parser)]
#[command(version)]
pub struct Arguments {
    /// Scenes or groups of them: paper (110m-all … 50m-horizon), fills (fills-1 … fills-10000), depth
    /// (overlapping, separate), oblique, footprints; and sweep: run time against error.
    #[arg(long, num_args = 1.., default_value = "paper")]
    pub scene: Vec<String>,
    /// Ways of filling.
    #[arg(long, num_args = 1.., default_values = ["globe", "stencil", "winding", "records", "doubled", "surface", "sensors"])]
    pub technique: Vec<TechniqueName>,
    /// Frames of each technique that are timed.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..))]
    pub frames: u32,
    /// Size of the picture.
    #[arg(long, default_value = "1280x720", value_parser = parse_size)]
    pub size: UVec2,
    /// How far, pixels, a drawn boundary may lie from the true one.
    #[arg(long, default_value = "0.25", value_parser = parse_budget)]
    pub pixel_error: f64,
    /// Move the camera a little from frame to frame: nothing can be kept from the last one.
    #[arg(long)]
    pub moving: bool,
    /// Do not compare the pictures with the true boundaries.
    #[arg(long)]
    pub no_error: bool,
    /// Write all rows as JSON.
    #[arg(long)]
    pub json: Option<PathBuf>,
    /// Write all rows as CSV into this directory, and plots of what was swept.
    #[arg(long)]
    pub plot: Option<PathBuf>,
}

fn parse_budget(text: &str) -> Result<f64, String> {
    let budget_px = parse_finite(text)?;
    if budget_px >= 0.0 {
        Ok(budget_px)
    } else {
        Err("it must not be negative".into())
    }
}
