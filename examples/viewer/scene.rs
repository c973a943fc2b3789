//! What is on the globe, and drawing it.

use glam::UVec2;
use globefill::{Frame, FrameStats, Renderer, RendererOptions, View, wgpu};

use crate::{
    countries::Countries, files::Files, globe_view::GlobeView, host::gpu::Gpu,
    satellites::Satellites, zones::Zones,
};

/// Layers, and the renderer that has them.
pub struct Scene {
    pub renderer: Renderer,
    pub countries: Countries,
    pub zones: Zones,
    pub files: Files,
    /// How far, pixels, drawn boundaries may lie from the true ones.
    pub pixel_error: f64,
    /// Of the last frame.
    pub stats: FrameStats,
    view: View,
}

impl Scene {
    pub fn new(gpu: &Gpu, color_format: wgpu::TextureFormat) -> Result<Self, String> {
        let options = RendererOptions {
            color_format,
            smooth_edges: true,
            ..Default::default()
        };
        let mut renderer =
            Renderer::new(&gpu.device, options).map_err(|error| error.to_string())?;
        Ok(Self {
            countries: Countries::new(&mut renderer)?,
            zones: Zones::new(&mut renderer)?,
            files: Files::default(),
            pixel_error: 0.25,
            stats: FrameStats::default(),
            view: View::default(),
            renderer,
        })
    }

    /// Tells the renderer what has changed since the last frame.
    pub fn restyle(&mut self, satellites: &mut Satellites) -> Result<(), String> {
        let renderer = &mut self.renderer;
        self.files.receive(renderer);
        self.countries.restyle(renderer)?;
        self.zones.restyle(renderer)?;
        self.files.restyle(renderer)?;
        satellites.restyle(renderer)
    }

    /// Records the globe and all that lies on it.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        globe: &GlobeView,
        size_px: UVec2,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), String> {
        globe.draw(encoder);
        let frame = Frame {
            pixel_error: self.pixel_error,
            ..Frame::new(globe.eye.camera, size_px)
        };
        self.stats = self
            .renderer
            .prepare(&gpu.queue, &mut self.view, &frame)
            .map_err(|error| error.to_string())?;
        self.renderer
            .count(&mut self.view, encoder, &globe.targets.depth_view);
        let mut pass = globe.targets.fill_pass(encoder, wgpu::LoadOp::Load);
        self.renderer.resolve(&self.view, &mut pass);
        Ok(())
    }
}
