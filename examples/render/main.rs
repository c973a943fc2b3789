//! Fills regions on a globe: the crate's main job from a file to a picture, and the instrument by
//! which it is measured. `--help` tells the options.

mod camera;
mod cli;
mod drawing;
mod elevation;
mod globe;
mod gpu;
mod ground;
mod host_view;
mod measure;
mod output;
mod palette;
mod picture;
mod pictures;
mod progress;
mod regions;
mod relief;
mod session;
mod targets;
mod terrain;
mod terrain_mesh;
mod tiles;

use std::process::ExitCode;

use crate::{cli::Arguments, progress::Progress};

fn main() -> ExitCode {
    let progress = Progress::new();
    let result = Arguments::from_command_line()
        .map(Arguments::with_default_output)
        .and_then(|arguments| session::run(&arguments, &progress));
    progress.finish();
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
