//! One way of drawing the fills, from the ground to the finished frame.

use std::path::Path;

use globefill::{
    CountTechnique, FillMesh, FillStyle, Frame, FrameStats, ImageId, MeshId, Renderer,
    RendererOptions, View, wgpu,
};

use crate::{
    host::{
        gpu::Gpu,
        ground::{Ground, GroundPipelines},
        targets::Targets,
    },
    invocations::{InvocationQueries, Invocations},
};

/// Targets, and a renderer that matches them.
pub struct Drawing {
    pub targets: Targets,
    pipelines: GroundPipelines,
    /// What the fills are blended with.
    background: Background,
    renderer: Renderer,
    view: View,
    mesh: MeshId,
}

/// How fills are drawn, whatever their styles.
#[derive(Clone, Copy, Debug)]
pub struct Technique {
    pub count: CountTechnique,
    pub smooth_edges: bool,
}

/// What lies under the fills.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Background {
    /// The ground's picture.
    Ground,
    /// Zero: only the fills show.
    Nothing,
}

impl Drawing {
    pub fn new(
        gpu: &Gpu,
        ground: &Ground,
        targets: Targets,
        background: Background,
        mesh: FillMesh,
        technique: Technique,
    ) -> Result<Self, String> {
        let options = RendererOptions {
            color_format: targets.format.color,
            depth_format: targets.format.depth,
            depth: targets.format.convention,
            sample_count: targets.format.sample_count,
            count: technique.count,
            smooth_edges: technique.smooth_edges,
        };
        let mut renderer =
            Renderer::new(&gpu.device, options).map_err(|error| error.to_string())?;
        let mesh = gpu.allocate("the regions", || renderer.insert(mesh))?;
        Ok(Self {
            pipelines: ground.pipelines(gpu, &targets.format),
            targets,
            background,
            renderer,
            view: View::default(),
            mesh,
        })
    }

    /// Gives the renderer an image.
    pub fn insert_image(&mut self, gpu: &Gpu, path: &Path) -> Result<ImageId, String> {
        let in_file = |error: &dyn std::error::Error| format!("{}: {error}", path.display());
        let image = globefill::Image::open(path).map_err(|error| in_file(&error))?;
        self.renderer
            .insert_image(&gpu.queue, &image)
            .map_err(|error| in_file(&error))
    }

    pub fn set_style(&mut self, fill: u32, style: FillStyle) -> Result<(), String> {
        self.renderer
            .set_style(self.mesh, fill, style)
            .map_err(|error| error.to_string())
    }

    /// Draws the ground alone and waits for it.
    pub fn draw_ground(&self, gpu: &Gpu, ground: &Ground) -> Result<(), String> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.targets
            .draw_ground(&mut encoder, ground, &self.pipelines, true);
        gpu.run(encoder)
    }

    /// Draws ground and fills and waits for them. `queries`, if any, take the statistics of the fills'
    /// passes: as many as the frame's [`FrameStats::passes`], and one for the resolve.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        ground: &Ground,
        frame: &Frame,
        queries: Option<&InvocationQueries>,
    ) -> Result<FrameStats, String> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.targets
            .draw_ground(&mut encoder, ground, &self.pipelines, false);
        let stats = self
            .renderer
            .prepare(&gpu.queue, &mut self.view, frame)
            .map_err(|error| error.to_string())?;
        let depth = &self.targets.depth_view;
        match queries {
            Some(queries) => {
                self.renderer
                    .count_measured(&mut self.view, &mut encoder, depth, &queries.set);
            }
            None => self.renderer.count(&mut self.view, &mut encoder, depth),
        }
        {
            let load = match self.background {
                Background::Ground => wgpu::LoadOp::Load,
                Background::Nothing => wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
            };
            let mut pass = self.targets.fill_pass(&mut encoder, load);
            if let Some(queries) = queries {
                pass.begin_pipeline_statistics_query(&queries.set, queries.last());
            }
            self.renderer.resolve(&self.view, &mut pass);
            if queries.is_some() {
                pass.end_pipeline_statistics_query();
            }
        }
        if let Some(queries) = queries {
            queries.resolve(&mut encoder);
        }
        gpu.run(encoder)?;
        Ok(stats)
    }

    /// What the fills make the adapter do; `None` where it cannot tell.
    pub fn invocations(
        &mut self,
        gpu: &Gpu,
        ground: &Ground,
        frame: &Frame,
        passes: u32,
    ) -> Result<Option<Invocations>, String> {
        let Some(queries) = InvocationQueries::new(gpu, passes + 1) else {
            return Ok(None);
        };
        self.draw(gpu, ground, frame, Some(&queries))?;
        queries.read(gpu).map(Some)
    }
}
