//! Meshes huge input, and says what that takes: time, peak memory (Linux only), and how both grow.
//!
//! ```text
//! cargo run --release --example stress -- target/stress/*.geojson
//! cargo run --release --example stress -- --synthetic ring,holes,parts,pie --sizes 1e4,1e5,1e6
//! ```
//!
//! `scripts/stress-data` fetches files to try it on. Each case runs in a process of its own, so that its
//! peak memory is its own, and every mesh is judged: are the caps closed, is their area that of the
//! true edges, does the locator answer as a plain test of the same polygon does.

mod case;
mod judge;
mod plane;
mod process;
mod report;
mod synthetic;

use std::{
    path::PathBuf,
    process::{Command, ExitCode},
};

use clap::Parser;

use crate::{
    case::{Case, Orientation},
    report::Report,
    synthetic::{Edges, Shape},
};

/// Meshes huge input and reports time and peak memory.
#[derive(Parser)]
struct Arguments {
    /// GeoJSON files.
    files: Vec<PathBuf>,
    /// Shapes to make.
    #[arg(long, value_delimiter = ',')]
    synthetic: Vec<Shape>,
    /// Vertices of each shape.
    #[arg(long, value_delimiter = ',', default_value = "1e4,1e5,1e6")]
    sizes: Vec<f64>,
    /// How the vertices of shapes are joined.
    #[arg(long, default_value = "straight")]
    edges: Edges,
    /// Which side of a file's shells is inside.
    #[arg(long, default_value = "plane")]
    orientation: Orientation,
    /// Points at which the locator is asked and judged.
    #[arg(long, default_value_t = 2_000)]
    points: usize,
    /// Stop after meshing: no laws, no locator.
    #[arg(long)]
    only_build: bool,
    /// Write one JSON object a case, and nothing else.
    #[arg(long)]
    json: bool,
    /// Run in this process; for profilers.
    #[arg(long)]
    here: bool,
}

impl Arguments {
    fn cases(&self) -> Vec<Case> {
        let orientation = self.orientation;
        let files = self.files.iter().cloned();
        let files = files.map(|path| Case::File { path, orientation });
        let synthetic = self.synthetic.iter().flat_map(|&shape| {
            let vertices = self.sizes.iter().map(|&size| size as usize);
            vertices.map(move |vertices| Case::Synthetic {
                shape,
                vertices,
                edges: self.edges,
            })
        });
        files.chain(synthetic).collect()
    }

    /// What a case reports, from a process of its own unless it is to run here.
    fn run(&self, case: &Case) -> Result<Report, String> {
        if self.here {
            return case.run(self.points, self.only_build);
        }
        let program = std::env::current_exe().map_err(|error| error.to_string())?;
        let mut command = Command::new(program);
        command.args(case.arguments());
        command.args(["--here", "--json", "--points"]);
        command.arg(self.points.to_string());
        command.args(self.only_build.then_some("--only-build"));
        let output = command.output().map_err(|error| error.to_string())?;
        // A mesh that is not sound fails too, but reports.
        if output.stdout.is_empty() {
            let said = String::from_utf8_lossy(&output.stderr);
            return Err(format!("{}: {}", output.status, said.trim_end()));
        }
        serde_json::from_slice(&output.stdout)
            .map(Report::from_json)
            .map_err(|error| error.to_string())
    }
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let mut sound = true;
    let mut last: Option<(Case, Report)> = None;
    if !arguments.json {
        println!("{}", report::HEADING);
    }
    for case in arguments.cases() {
        let report = match arguments.run(&case) {
            Ok(report) => report,
            Err(error) => {
                eprintln!("{case}: {error}");
                sound = false;
                continue;
            }
        };
        sound &= report.is_sound();
        if arguments.json {
            println!("{}", report.to_json(&case));
        } else {
            let smaller = last.as_ref().filter(|(last, _)| last.grows_to(&case));
            println!("{}", report.line(&case, smaller.map(|(_, report)| report)));
        }
        last = Some((case, report));
    }
    if sound {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
