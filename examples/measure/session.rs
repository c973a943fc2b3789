//! One run of the program: from the arguments to the finished report.

use std::collections::BTreeSet;

use serde_json::json;

use crate::{
    accuracy::Judge,
    cli::Arguments,
    host::{
        gpu::Gpu,
        output::{self, Outputs},
        progress::Progress,
    },
    race,
    row::Row,
    scene::Scene,
    scenes,
    stage::Stage,
    table,
    technique::TechniqueName,
};

/// Runs the program.
pub fn run(arguments: &Arguments, progress: &Progress) -> Result<(), String> {
    if let Some(path) = &arguments.json {
        output::check_writable(path)?;
    }
    let mut scenes = Vec::new();
    for word in &arguments.scene {
        scenes.extend(scenes::named(word)?);
    }
    // The globe is what the extra is over.
    let names: BTreeSet<TechniqueName> = [TechniqueName::Globe]
        .into_iter()
        .chain(arguments.technique.iter().copied())
        .collect();
    let names: Vec<TechniqueName> = names.into_iter().collect();
    progress.step("opening the graphics adapter");
    let gpu = Gpu::open()?;
    println!(
        "{}, {}x{}, {} frames, budget {} px",
        gpu.name, arguments.size.x, arguments.size.y, arguments.frames, arguments.pixel_error
    );
    println!("{}", table::heading());
    let mut rows = Vec::new();
    for scene in scenes {
        let measured = measure(arguments, &gpu, scene, &names, progress)?;
        progress.finish();
        measured
            .iter()
            .for_each(|row| println!("{}", table::line(row)));
        rows.extend(measured);
    }
    let mut outputs = Outputs::default();
    if let Some(path) = &arguments.json {
        let report = json!({
            "adapter": gpu.name,
            "size": [arguments.size.x, arguments.size.y],
            "frames": arguments.frames,
            "pixel_error": arguments.pixel_error,
            "rows": rows.iter().map(Row::json).collect::<Vec<_>>(),
        });
        outputs.add(path, format!("{report:#}\n").into_bytes());
    }
    outputs.write()
}

/// All techniques in one scene.
fn measure(
    arguments: &Arguments,
    gpu: &Gpu,
    scene: Scene,
    names: &[TechniqueName],
    progress: &Progress,
) -> Result<Vec<Row>, String> {
    progress.step("meshing");
    let stage = Stage::new(gpu, scene, arguments.size, arguments.pixel_error)?;
    progress.step("asking the oracle");
    let judged = !arguments.no_error && !stage.scene.regions.is_empty();
    let judge = judged.then(|| Judge::new(&stage));
    race::run(
        gpu,
        &stage,
        names,
        arguments.frames,
        judge.as_ref(),
        progress,
    )
}
