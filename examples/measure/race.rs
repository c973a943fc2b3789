//! The entries of a heat drawing in turn.

use std::time::{Duration, Instant};

use crate::{
    accuracy::{Judge, PictureError},
    canvas::Paint,
    common::draw::id_of_color,
    heat::{Entry, Heat},
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

/// Who has drawn for so long has drawn enough, once there are [`LEAST_FRAMES`].
const ENOUGH: Duration = Duration::from_secs(20);
const LEAST_FRAMES: usize = 3;

/// One entry and what its frames took.
struct Contender<'a> {
    entry: &'a Entry,
    /// Index of its stage.
    stage: usize,
    technique: Box<dyn Technique>,
    wall_ms: Vec<f64>,
    /// Empty where the system does not tell.
    processor_ms: Vec<f64>,
    cost: Cost,
}

/// Times `frames` frames of each entry, one of each in turn: what slows the machine for a while slows them
/// alike. Then counts their work, and judges their pictures if there is a judge. `stage_of` tells
/// the stage of each entry.
pub fn run(
    gpu: &Gpu,
    heat: &Heat,
    stages: &mut [Stage],
    stage_of: &[usize],
    frames: u32,
    judge: Option<&Judge>,
    progress: &Progress,
) -> Result<Vec<Row>, String> {
    progress.step("preparing techniques");
    let mut contenders: Vec<Result<Contender<'_>, String>> = heat
        .entries
        .iter()
        .zip(stage_of)
        .map(|(entry, &stage)| Contender::new(gpu, entry, stage, &stages[stage]))
        .collect();
    progress.step("timing frames");
    progress.count(WARM_UP + frames);
    for frame in 0..WARM_UP + frames {
        for stage in &mut *stages {
            stage.advance(gpu, frame);
        }
        for contender in contenders.iter_mut().flatten() {
            contender.draw(gpu, &stages[contender.stage], frame >= WARM_UP)?;
        }
        progress.advance();
    }
    let is_globe = |contender: &&Contender<'_>| contender.entry.technique == TechniqueName::Globe;
    let globe = contenders
        .iter()
        .flatten()
        .find(is_globe)
        .map(|globe| (globe.wall_ms.clone(), globe.processor_ms.clone()));
    progress.step("judging pictures");
    for stage in &mut *stages {
        stage.advance(gpu, 0);
    }
    let mut rows = Vec::new();
    for ((contender, entry), stage) in contenders.into_iter().zip(&heat.entries).zip(stage_of) {
        let stage = &stages[*stage];
        let outcome = match contender {
            Ok(contender) => Ok(contender.measured(gpu, stage, globe.as_ref(), judge)?),
            Err(reason) => Err(reason),
        };
        rows.push(Row {
            scene: entry.scene.name.clone(),
            technique: entry.technique,
            variant: entry.variant.clone(),
            build_ms: stage.build_ms,
            outcome,
        });
    }
    Ok(rows)
}

impl<'a> Contender<'a> {
    /// Or why it cannot draw the stage.
    fn new(gpu: &Gpu, entry: &'a Entry, index: usize, stage: &Stage) -> Result<Self, String> {
        Ok(Self {
            entry,
            stage: index,
            technique: entry.technique.make(gpu, stage, Paint::Colors)?,
            wall_ms: Vec::new(),
            processor_ms: Vec::new(),
            cost: Cost::default(),
        })
    }

    fn draw(&mut self, gpu: &Gpu, stage: &Stage, timed: bool) -> Result<(), String> {
        let spent_ms: f64 = self.wall_ms.iter().sum();
        if self.wall_ms.len() >= LEAST_FRAMES && spent_ms > ENOUGH.as_secs_f64() * 1e3 {
            return Ok(());
        }
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
        let error = match judge {
            Some(judge) => self.error(gpu, stage, judge)?,
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
            error,
        })
    }

    /// `None` where the picture has no numbers of fills.
    fn error(
        &self,
        gpu: &Gpu,
        stage: &Stage,
        judge: &Judge,
    ) -> Result<Option<PictureError>, String> {
        if self.entry.technique == TechniqueName::Globe {
            return Ok(None);
        }
        let made = self.entry.technique.make(gpu, stage, Paint::Numbers);
        let Ok(mut technique) = made else {
            return Ok(None);
        };
        technique.draw(gpu, stage, None)?;
        let texels = gpu.read_texture(technique.color())?;
        let (texels, _) = texels.as_chunks::<4>();
        let drawn: Vec<u32> = texels.iter().copied().map(id_of_color).collect();
        Ok(Some(
            judge.error_of(&drawn, self.entry.settings.pixel_error),
        ))
    }
}
