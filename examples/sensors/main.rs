//! Moves sensors over a globe: satellites propagated from element sets, the footprints of their
//! sensors drawn over the countries in every frame, and what that costs. `--help` tells the options.

mod circles;
mod cli;
mod colors;
mod constellation;
mod country_layer;
mod drawing;
mod elements;
mod field_of_view;
#[path = "../host/mod.rs"]
mod host;
mod measure;
mod scene;
mod session;
mod walker;

use std::process::ExitCode;

use crate::{
    cli::Arguments,
    host::{cli::from_command_line, progress::Progress},
};

fn main() -> ExitCode {
    let progress = Progress::new();
    let result = from_command_line()
        .and_then(Arguments::checked)
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
