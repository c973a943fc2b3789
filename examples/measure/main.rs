//! Measures ways of filling regions against each other: time, work and error of each, on the same scenes,
//! frame by frame in turn. `--help` tells the options, docs/performance.md what came out.

mod accuracy;
mod canvas;
mod cli;
#[path = "../../tests/common/mod.rs"]
mod common;
mod csv;
#[allow(dead_code, reason = "images are for another example")]
#[path = "../render/drawing.rs"]
mod drawing;
mod heat;
#[path = "../host/mod.rs"]
mod host;
#[path = "../render/invocations.rs"]
mod invocations;
mod plots;
mod processor_time;
mod race;
mod row;
mod scene;
mod scenes;
mod session;
mod settings;
mod stage;
mod statistics;
mod sweeps;
mod table;
mod technique;
mod techniques;

use std::process::ExitCode;

use crate::{
    cli::Arguments,
    host::{cli::from_command_line, progress::Progress},
};

fn main() -> ExitCode {
    let progress = Progress::new();
    let result =
        from_command_line::<Arguments>().and_then(|arguments| session::run(&arguments, &progress));
    progress.finish();
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
