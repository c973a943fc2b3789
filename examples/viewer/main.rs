//! A globe to look around on: countries, hatched zones, satellites with moving footprints, and files of your
//! own. Drag moves the ground, the wheel zooms to the pointer, the right button tilts; N turns north up,
//! Home shows the whole Earth, Space stops and starts the satellites, F hides the panel.
//!
//! ```sh
//! cargo run --release --example viewer
//! cargo run --release --example viewer -- --camera 10,46,9e5 zones.geojson
//! cargo run --release --example viewer -- --camera 10,20,2e7 --screenshot out/earth.png   # needs no window
//! ```

mod countries;
mod files;
mod globe_view;
#[path = "../host/mod.rs"]
mod host;
mod labels;
mod orbit;
mod panel;
mod satellites;
mod scene;
mod screen;
#[cfg(test)]
mod tests;
mod viewer;
mod window;
mod zones;

use std::path::PathBuf;

use clap::Parser;
use glam::UVec2;

use host::{camera::Viewpoint, cli::parse_size, gpu::Gpu, output::Outputs, png};
use viewer::Viewer;

/// Looks at a globe with fills on it.
#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    /// GeoJSON files to open.
    files: Vec<PathBuf>,
    /// Where to start: LON,LAT,HEIGHT_M or LON,LAT,HEIGHT_M,HEADING_DEG,PITCH_DEG.
    #[arg(long, default_value = "20,22,1.4e7", allow_hyphen_values = true)]
    camera: Viewpoint,
    /// Size of the window or picture.
    #[arg(long, default_value = "1280x720", value_parser = parse_size)]
    size: UVec2,
    /// Write a picture as PNG instead of opening a window.
    #[arg(long)]
    screenshot: Option<PathBuf>,
    /// Leave the panel out.
    #[arg(long)]
    bare: bool,
}

fn main() -> Result<(), String> {
    let arguments = Arguments::parse();
    match &arguments.screenshot {
        Some(path) => write_screenshot(&arguments, path),
        None => window::run(arguments),
    }
}

/// A picture of the first frame in which everything is there.
fn write_screenshot(arguments: &Arguments, path: &std::path::Path) -> Result<(), String> {
    let format = globefill::wgpu::TextureFormat::Rgba8UnormSrgb;
    let mut viewer = Viewer::new(Gpu::open()?, format, arguments.size, arguments.camera)?;
    viewer.show_panel = !arguments.bare;
    viewer.satellites.playing = false;
    arguments.files.iter().for_each(|file| viewer.open(file));
    for frame in 0.. {
        viewer.frame(viewer.still_input(0.1 * f64::from(frame)))?;
        if viewer.is_settled() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let mut outputs = Outputs::default();
    outputs.add(path, png::rgb(arguments.size, &viewer.picture()?)?);
    outputs.write()
}
