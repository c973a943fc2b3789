//! The globe alone.

use globefill::wgpu;

use crate::{
    canvas::{Canvas, Paint},
    host::gpu::Gpu,
    invocations::InvocationQueries,
    stage::Stage,
    technique::{Cost, Technique},
};

pub struct BareGlobe {
    canvas: Canvas,
}

impl BareGlobe {
    pub fn new(gpu: &Gpu, stage: &Stage, paint: Paint) -> Result<Self, String> {
        let canvas = Canvas::new(gpu, stage, paint)?;
        Ok(Self { canvas })
    }
}

impl Technique for BareGlobe {
    fn draw(
        &mut self,
        gpu: &Gpu,
        stage: &Stage,
        _: Option<&InvocationQueries>,
    ) -> Result<Cost, String> {
        gpu.run(self.canvas.begin(gpu, stage))?;
        Ok(Cost::default())
    }

    fn queries(&self) -> u32 {
        0
    }

    fn color(&self) -> &wgpu::Texture {
        &self.canvas.targets.color
    }
}
