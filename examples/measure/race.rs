//! Techniques drawing the same scene in turn.

use std::time::Instant;

use crate::{
    accuracy::{Judge, PictureError},
    canvas::Paint,
    common::draw::id_of_color,
    host::{
        gpu::Gpu,
        progress::Progress,
        times::{WARM_UP, median, milliseconds_since},
    },
    invocations::InvocationQueries,
    processor_time::ProcessorTime,
    row::{Measured, Row},
    stage::Stage,
    statistics::{median_difference, quantile},
    technique::{Cost, Technique, TechniqueName},
};

/// One technique and what its frames took.
struct Contender {
    name: TechniqueName,
    technique: Box<dyn Technique>,
    wall_ms: Vec<f64>,
    /// Empty where the system does not tell.
    processor_ms: Vec<f64>,
    cost: Cost,
}

/// Times `frames` frames of each technique, one of each in turn: what slows the machine for a while slows
/// them alike. Then counts their work, and judges their pictures if there is a judge.
pub fn run(
    gpu: &Gpu,
    stage: &Stage,
    names: &[TechniqueName],
    frames: u32,
    judge: Option<&Judge>,
    progress: &Progress,
) -> Result<Vec<Row>, String> {
    let mut contenders = Vec::new();
    let mut rows = Vec::new();
    for &name in names {
        progress.step("preparing techniques");
        match name.make(gpu, stage, Paint::Colors) {
            Ok(technique) => contenders.push(Contender {
                name,
                technique,
                wall_ms: Vec::new(),
                processor_ms: Vec::new(),
                cost: Cost::default(),
            }),
            Err(reason) => rows.push(row(stage, name, Err(reason))),
        }
    }
    progress.step("timing frames");
    progress.count(WARM_UP + frames);
    for frame in 0..WARM_UP + frames {
        for contender in &mut contenders {
            contender.draw(gpu, stage, frame >= WARM_UP)?;
        }
        progress.advance();
    }
    let globe = contenders
        .iter()
        .find(|contender| contender.name == TechniqueName::Globe)
        .map(|globe| (globe.wall_ms.clone(), globe.processor_ms.clone()));
    progress.step("judging pictures");
    for contender in contenders {
        let name = contender.name;
        let measured = contender.measured(gpu, stage, globe.as_ref(), judge)?;
        rows.push(row(stage, name, Ok(measured)));
    }
    rows.sort_by_key(|row| row.technique);
    Ok(rows)
}

fn row(stage: &Stage, technique: TechniqueName, outcome: Result<Measured, String>) -> Row {
    Row {
        scene: stage.scene.name.clone(),
        technique,
        build_ms: stage.build_ms,
        outcome,
    }
}

impl Contender {
    fn draw(&mut self, gpu: &Gpu, stage: &Stage, timed: bool) -> Result<(), String> {
        let (processor, start) = (ProcessorTime::now(), Instant::now());
        self.cost = self.technique.draw(gpu, stage, None)?;
        let wall_ms = milliseconds_since(start);
        let processor_ms = processor.elapsed_ms();
        if timed {
            self.wall_ms.push(wall_ms);
            self.processor_ms.extend(processor_ms);
        }
        Ok(())
    }

    fn measured(
        mut self,
        gpu: &Gpu,
        stage: &Stage,
        globe: Option<&(Vec<f64>, Vec<f64>)>,
        judge: Option<&Judge>,
    ) -> Result<Measured, String> {
        let has_processor = !self.processor_ms.is_empty();
        let queries = match self.technique.queries() {
            0 => None,
            passes => InvocationQueries::new(gpu, passes),
        };
        let counted = match &queries {
            Some(queries) => {
                self.technique.draw(gpu, stage, Some(queries))?;
                Some(queries.read(gpu)?)
            }
            None => None,
        };
        Ok(Measured {
            median_ms: median(self.wall_ms.clone()),
            p95_ms: quantile(self.wall_ms.clone(), 0.95),
            extra_ms: globe.map(|(wall_ms, _)| median_difference(&self.wall_ms, wall_ms)),
            cpu_ms: has_processor.then(|| median(self.processor_ms.clone())),
            extra_cpu_ms: globe
                .filter(|_| has_processor)
                .map(|(_, processor_ms)| median_difference(&self.processor_ms, processor_ms)),
            vertex_invocations: counted.as_ref().map(|counted| counted.vertex),
            fragment_invocations: counted.as_ref().map(|counted| counted.fragment),
            cost: self.cost,
            error: match judge {
                Some(judge) => error(gpu, stage, self.name, judge)?,
                None => None,
            },
        })
    }
}

/// `None` where the picture has no numbers of fills.
fn error(
    gpu: &Gpu,
    stage: &Stage,
    name: TechniqueName,
    judge: &Judge,
) -> Result<Option<PictureError>, String> {
    if name == TechniqueName::Globe {
        return Ok(None);
    }
    let Ok(mut technique) = name.make(gpu, stage, Paint::Numbers) else {
        return Ok(None);
    };
    technique.draw(gpu, stage, None)?;
    let texels = gpu.read_texture(technique.color())?;
    let (texels, _) = texels.as_chunks::<4>();
    let drawn: Vec<u32> = texels.iter().copied().map(id_of_color).collect();
    Ok(Some(judge.error_of(&drawn)))
}
