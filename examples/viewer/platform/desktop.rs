//! What a desktop does in its own way: threads, files, dialogs, waiting.

use std::{
    future::Future,
    path::{Path, PathBuf},
};

use glam::UVec2;
use winit::{
    application::ApplicationHandler,
    dpi::PhysicalSize,
    event_loop::EventLoop,
    window::{Window, WindowAttributes},
};

use crate::{graphics::Graphics, host::elevation::Elevation};

/// Hands events to an application until it is closed.
pub fn run_app<T>(
    events: EventLoop<T>,
    mut app: impl ApplicationHandler<T> + 'static,
) -> Result<(), String> {
    events
        .run_app(&mut app)
        .map_err(|error| format!("no window: {error}"))
}

/// The window to ask for.
pub fn window(size_px: UVec2) -> Result<WindowAttributes, String> {
    Ok(Window::default_attributes()
        .with_title("globefill")
        .with_inner_size(PhysicalSize::new(size_px.x, size_px.y)))
}

/// Runs a future to its end.
pub fn run(future: impl Future<Output = ()> + 'static) {
    pollster::block_on(future);
}

/// Works beside the thread that draws.
pub fn spawn(job: impl FnOnce() + Send + 'static) {
    std::thread::spawn(job);
}

/// Asks for a GeoJSON file, and hands on its name and text, or what went wrong; nothing if nothing is chosen.
pub fn ask_file(then: impl FnOnce(String, Result<String, String>) + Send + 'static) {
    spawn(move || {
        let dialog = rfd::FileDialog::new().add_filter("GeoJSON", &["geojson", "json"]);
        if let Some(path) = dialog.pick_file() {
            then(name(&path), read(&path));
        }
    });
}

/// Reads a dropped file beside the thread that draws.
pub fn read_file(
    path: PathBuf,
    then: impl FnOnce(String, Result<String, String>) + Send + 'static,
) {
    spawn(move || then(name(&path), read(&path)));
}

/// Files dropped on the window come as its events.
pub fn watch_drops(
    _dropped: impl Fn(String, Result<String, String>) + 'static,
    _hovers: impl Fn(bool) + 'static,
) {
}

pub fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// What was drawn last, as PNG.
pub fn picture(graphics: &Graphics, then: impl FnOnce(Result<Vec<u8>, String>)) {
    then(graphics.png());
}

/// Writes a picture, and tells where to.
pub fn save(file: &str, bytes: &[u8]) -> Result<String, String> {
    std::fs::write(file, bytes).map_err(|error| format!("{file}: {error}"))?;
    let path = std::fs::canonicalize(file).unwrap_or_else(|_| file.into());
    Ok(format!("Saved {}", path.display()))
}

/// The world's terrain, which comes with the source.
pub fn elevation(then: impl FnOnce(Result<Elevation, String>) + Send + 'static) {
    spawn(|| {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/demo/terrain-world.png");
        then(Elevation::read(Path::new(path)));
    });
}

/// Words of the command line.
pub fn arguments() -> Vec<String> {
    std::env::args().skip(1).collect()
}

/// Says why the viewer cannot go on, and ends it.
pub fn give_up(error: &str) {
    eprintln!("{error}");
    std::process::exit(1)
}

/// A line for whoever drives the viewer from outside, if `VIEWER_LOG` is set.
pub fn log(line: impl FnOnce() -> String) {
    if std::env::var_os("VIEWER_LOG").is_some() {
        println!("{}", line());
    }
}
