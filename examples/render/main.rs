//! Fills regions on a globe: the crate's main job from a file to a picture, and the instrument by
//! which it is measured. `--help` tells the options.

mod cli;
mod css_color;
mod drawing;
#[path = "../host/mod.rs"]
mod host;
mod invocations;
mod measure;
mod notation;
mod overlay;
mod pictures;
mod regions;
mod session;
mod simplestyle;
mod style;
mod style_args;

use std::process::ExitCode;

use crate::{
    cli::Arguments,
    host::{cli::from_command_line, progress::Progress},
};

fn main() -> ExitCode {
    let progress = Progress::new();
    let result = from_command_line()
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
