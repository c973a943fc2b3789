//! A globe to turn and zoom: countries, zones, satellites, and GeoJSON files dropped on it.
//!
//! ```sh
//! cargo run --release --example viewer
//! cargo run --release --example viewer -- --camera 10.4,51.2,900000 --screenshot germany.png
//! ```
//!
//! Drag turns the globe; the wheel zooms to the pointer; right or ctrl drag tilts; arrows or WASD move,
//! plus and minus zoom, N or R turns north up, Home goes home, space plays. One finger drags, two zoom and turn.
//! `viewer.rs` is the state, without
//! window or GPU; `graphics.rs` draws it; `app.rs` is the window, `platform/` what differs
//! between desktops and browsers.

mod app;
mod canvas;
mod flags;
mod graphics;
mod host;
mod labels;
mod layers;
mod orbit;
mod panel;
mod platform;
mod screen;
mod touches;
mod viewer;

#[cfg(test)]
mod tests;

fn main() {
    let ran = flags::Flags::parse(platform::arguments()).and_then(app::run);
    if let Err(error) = ran {
        platform::give_up(&error);
    }
}
