//! A frame with the ground in it.

use globefill::wgpu;

use crate::{
    host::{
        gpu::Gpu,
        ground::{GroundPipelines, TargetFormat},
        palette,
        targets::Targets,
    },
    stage::Stage,
};

/// What fills are painted with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// Translucent colours over the ground: the picture that is timed.
    Colors,
    /// Numbers over nothing: the picture that is judged.
    Numbers,
}

impl Paint {
    /// What the picture is stored as.
    pub fn format(self) -> TargetFormat {
        TargetFormat {
            color: match self {
                Self::Colors => wgpu::TextureFormat::Rgba8UnormSrgb,
                Self::Numbers => wgpu::TextureFormat::Rgba8Unorm,
            },
            depth: wgpu::TextureFormat::Depth32Float,
            convention: globefill::DepthConvention::Reversed,
            sample_count: 1,
        }
    }

    /// The colour of every fill: linear, not premultiplied.
    pub fn colors(self, stage: &Stage) -> Vec<[f32; 4]> {
        match self {
            Self::Colors => palette::colors(&stage.mesh),
            Self::Numbers => (0..stage.mesh.fills.len() as u32)
                .map(|fill| crate::common::draw::id_color(fill + 1))
                .collect(),
        }
    }

    /// The same, premultiplied.
    pub fn premultiplied(self, stage: &Stage) -> Vec<[f32; 4]> {
        let colors = self.colors(stage).into_iter();
        colors
            .map(|[red, green, blue, alpha]| [red * alpha, green * alpha, blue * alpha, alpha])
            .collect()
    }

    pub fn targets(self, gpu: &Gpu, stage: &Stage) -> Result<Targets, String> {
        Targets::new(
            gpu,
            stage.eye.lens.size_px,
            self.format(),
            stage.eye.clear_depth(),
        )
    }
}

/// Targets, and the ground's pipelines for them.
pub struct Canvas {
    pub targets: Targets,
    pipelines: GroundPipelines,
    paint: Paint,
}

impl Canvas {
    pub fn new(gpu: &Gpu, stage: &Stage, paint: Paint) -> Result<Self, String> {
        let targets = paint.targets(gpu, stage)?;
        Ok(Self {
            pipelines: stage.ground.pipelines(gpu, &targets.format),
            targets,
            paint,
        })
    }

    /// A frame that the ground was recorded into.
    pub fn begin(&self, gpu: &Gpu, stage: &Stage) -> wgpu::CommandEncoder {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.targets
            .draw_ground(&mut encoder, &stage.ground, &self.pipelines, false);
        encoder
    }

    /// What the fills' pass starts with.
    pub fn load(&self) -> wgpu::LoadOp<wgpu::Color> {
        match self.paint {
            Paint::Colors => wgpu::LoadOp::Load,
            Paint::Numbers => wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
        }
    }
}
