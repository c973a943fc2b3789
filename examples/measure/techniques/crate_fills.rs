//! The crate's fills, as any host draws them.

use globefill::{Blend, CountTechnique, FillStyle, wgpu};

use crate::{
    canvas::Paint,
    drawing::{self, Background, Drawing},
    host::gpu::Gpu,
    invocations::InvocationQueries,
    stage::Stage,
    technique::{Cost, Technique},
};

pub struct CrateFills {
    drawing: Drawing,
    /// Counting passes of the last frame.
    passes: u32,
}

impl CrateFills {
    pub fn new(gpu: &Gpu, stage: &Stage, paint: Paint, stencil: bool) -> Result<Self, String> {
        if stage.mesh.fills.is_empty() {
            return Err("nothing in this scene has a mesh".into());
        }
        let background = match paint {
            Paint::Colors => Background::Ground,
            Paint::Numbers => Background::Nothing,
        };
        let count = if stencil {
            CountTechnique::Stencil
        } else {
            CountTechnique::Winding
        };
        let technique = drawing::Technique {
            count,
            smooth_edges: false,
        };
        // Numbers cannot be mixed: of fills that lie over each other the topmost is judged, if it can be.
        let blend = match paint {
            Paint::Colors if stage.scene.unordered => Blend::Unordered,
            _ => Blend::Alpha,
        };
        let mut drawing = Drawing::new(
            gpu,
            &stage.ground,
            paint.targets(gpu, stage)?,
            background,
            stage.mesh.clone(),
            technique,
        )?;
        for (fill, color) in (0..).zip(paint.colors(stage)) {
            let style = FillStyle {
                color,
                blend,
                ..Default::default()
            };
            drawing.set_style(fill, style)?;
        }
        let mut fills = Self { drawing, passes: 0 };
        // What cannot be drawn says so in its first frame.
        fills.draw(gpu, stage, None)?;
        Ok(fills)
    }
}

impl Technique for CrateFills {
    fn draw(
        &mut self,
        gpu: &Gpu,
        stage: &Stage,
        queries: Option<&InvocationQueries>,
    ) -> Result<Cost, String> {
        let stats = self
            .drawing
            .draw(gpu, &stage.ground, &stage.frame, queries)?;
        self.passes = stats.passes;
        Ok(Cost {
            draws: stats.draws,
            passes: stats.passes + 1,
            upload_bytes: stats.upload_bytes,
            gpu_bytes: stats.gpu_bytes,
            count: Some(stats.technique),
        })
    }

    fn queries(&self) -> u32 {
        self.passes + 1
    }

    fn color(&self) -> &wgpu::Texture {
        &self.drawing.targets.color
    }
}
