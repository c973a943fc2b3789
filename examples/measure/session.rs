//! One run of the program: from the arguments to the finished report.

use serde_json::json;

use crate::{
    accuracy::Judge,
    cli::Arguments,
    csv,
    heat::Heat,
    host::{
        gpu::Gpu,
        output::{self, Outputs},
        progress::Progress,
    },
    plots, race,
    row::Row,
    scenes,
    settings::{Settings, Yardstick},
    stage::Stage,
    sweeps, table,
};

/// Runs the program.
pub fn run(arguments: &Arguments, progress: &Progress) -> Result<(), String> {
    if let Some(path) = &arguments.json {
        output::check_writable(path)?;
    }
    if let Some(directory) = &arguments.plot {
        std::fs::create_dir_all(directory)
            .map_err(|error| format!("{}: {error}", directory.display()))?;
    }
    let heats = heats(arguments)?;
    progress.step("opening the graphics adapter");
    let gpu = Gpu::open()?;
    println!(
        "{}, {}x{}, {} frames, budget {} px",
        gpu.name, arguments.size.x, arguments.size.y, arguments.frames, arguments.pixel_error
    );
    println!("{}", table::heading());
    let mut rows = Vec::new();
    for heat in heats {
        let measured = measure(arguments, &gpu, &heat, progress)?;
        progress.finish();
        measured
            .iter()
            .for_each(|row| println!("{}", table::line(row)));
        rows.extend(measured);
    }
    write(arguments, &gpu, &rows)
}

/// What the command line asks for.
fn heats(arguments: &Arguments) -> Result<Vec<Heat>, String> {
    let settings = Settings {
        size_px: arguments.size,
        pixel_error: arguments.pixel_error,
        yardstick: Yardstick::default(),
        moving: arguments.moving,
    };
    let mut heats = Vec::new();
    for word in &arguments.scene {
        if word == "sweep" {
            heats.extend(sweeps::all(settings)?);
            continue;
        }
        let scenes = scenes::named(word)?;
        heats.extend(
            scenes
                .iter()
                .map(|scene| Heat::of_techniques(scene, settings, &arguments.technique)),
        );
    }
    Ok(heats)
}

/// All entries of one heat. Those of the same settings share what they draw.
fn measure(
    arguments: &Arguments,
    gpu: &Gpu,
    heat: &Heat,
    progress: &Progress,
) -> Result<Vec<Row>, String> {
    progress.step("meshing");
    let mut stages: Vec<Stage> = Vec::new();
    let mut stage_of = Vec::new();
    for entry in &heat.entries {
        let same = stages.iter().position(|stage| {
            stage.settings == entry.settings && stage.scene.tolerance_m == entry.scene.tolerance_m
        });
        stage_of.push(same.unwrap_or(stages.len()));
        if same.is_none() {
            stages.push(Stage::new(gpu, &entry.scene, entry.settings)?);
        }
    }
    progress.step("asking the oracle");
    let judge = stages
        .first()
        .filter(|stage| !arguments.no_error && !stage.scene.regions.is_empty())
        .map(Judge::new);
    race::run(
        gpu,
        heat,
        &mut stages,
        &stage_of,
        arguments.frames,
        judge.as_ref(),
        progress,
    )
}

fn write(arguments: &Arguments, gpu: &Gpu, rows: &[Row]) -> Result<(), String> {
    let mut outputs = Outputs::default();
    if let Some(path) = &arguments.json {
        let report = json!({
            "adapter": gpu.name,
            "size": [arguments.size.x, arguments.size.y],
            "frames": arguments.frames,
            "pixel_error": arguments.pixel_error,
            "moving": arguments.moving,
            "rows": rows.iter().map(Row::json).collect::<Vec<_>>(),
        });
        outputs.add(path, format!("{report:#}\n").into_bytes());
    }
    if let Some(directory) = &arguments.plot {
        outputs.add(&directory.join("rows.csv"), csv::text(rows).into_bytes());
        for (name, svg) in plots::all(rows)? {
            outputs.add(&directory.join(name), svg.into_bytes());
        }
    }
    outputs.write()
}
