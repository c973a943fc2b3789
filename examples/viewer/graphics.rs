//! Draws the viewer's state: globe or terrain, fills, sensors, panel.

use std::collections::HashMap;

use globefill::{Ellipsoid, Frame, FrameStats, Renderer, RendererOptions, View, wgpu};

use crate::{
    canvas::{self, Canvas},
    host::{
        elevation::Elevation,
        gpu::Gpu,
        ground::{Ground, GroundPipelines, TargetFormat},
    },
    viewer::Viewer,
};

/// Everything of the viewer that lives on the GPU.
pub struct Graphics {
    pub gpu: Gpu,
    pub canvas: Canvas,
    format: TargetFormat,
    renderer: Renderer,
    view: View,
    /// The terrain, once it is there.
    pub elevation: Option<Elevation>,
    globe: Option<Ground>,
    terrain: Option<Ground>,
    /// By whether it is terrain and the two specialisations.
    pipelines: HashMap<(bool, bool, bool), GroundPipelines>,
    egui: egui_wgpu::Renderer,
}

/// What egui wants drawn.
pub struct Paint {
    pub jobs: Vec<egui::ClippedPrimitive>,
    pub textures: egui::TexturesDelta,
    pub pixels_per_point: f32,
}

impl Graphics {
    pub fn new(gpu: Gpu, color: wgpu::TextureFormat, size_px: glam::UVec2) -> Result<Self, String> {
        let format = canvas::format(color);
        let options = RendererOptions {
            color_format: format.color,
            smooth_edges: true,
            ..Default::default()
        };
        let renderer = Renderer::new(&gpu.device, options).map_err(|error| error.to_string())?;
        let plain = format.color.remove_srgb_suffix();
        Ok(Self {
            canvas: Canvas::new(&gpu.device, &format, size_px),
            egui: egui_wgpu::Renderer::new(&gpu.device, plain, Default::default()),
            renderer,
            view: View::default(),
            format,
            elevation: None,
            globe: None,
            terrain: None,
            pipelines: HashMap::new(),
            gpu,
        })
    }

    /// Draws and submits a frame into the canvas.
    pub fn draw(
        &mut self,
        viewer: &mut Viewer,
        paint: Option<Paint>,
    ) -> Result<FrameStats, String> {
        let size_px = viewer.orbit.size_px;
        if self.canvas.size_px != size_px {
            self.canvas = Canvas::new(&self.gpu.device, &self.format, size_px);
        }
        viewer.sync(&mut self.renderer)?;
        let elevation = self.elevation.as_ref().filter(|_| viewer.terrain);
        viewer.orbit.ground_m = elevation.map_or(0.0, |elevation| {
            elevation.height_m(viewer.orbit.focus.canonical()).max(0.0)
        });
        let eye = viewer.orbit.eye(elevation);
        let place = if elevation.is_some() {
            &mut self.terrain
        } else {
            &mut self.globe
        };
        let wgs84 = Ellipsoid::WGS84;
        match (place.as_mut(), elevation) {
            (None, _) => *place = Some(Ground::new(&self.gpu, &wgs84, elevation, &eye)?),
            (Some(ground), Some(elevation)) => {
                ground.look_over(&self.gpu, &wgs84, elevation, &eye);
            }
            (Some(ground), None) => ground.look(&self.gpu, &wgs84, &eye),
        }
        let Some(ground) = place.as_ref() else {
            return Err("there is no ground".into());
        };
        let special = ground.specialisation();
        let key = (elevation.is_some(), special.magnified, special.detailed);
        let pipelines = self
            .pipelines
            .entry(key)
            .or_insert_with(|| ground.pipelines(&self.gpu, &self.format));

        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        ground.draw(pipelines, &mut self.canvas.ground_pass(&mut encoder));
        let frame = Frame {
            terrain: ground.heights(),
            pixel_error: viewer.pixel_error,
            host_pixel_error: 0.0,
            ..Frame::new(eye.camera, size_px)
        };
        let stats = self
            .renderer
            .prepare(&self.gpu.queue, &mut self.view, &frame)
            .map_err(|error| error.to_string())?;
        self.renderer
            .count(&mut self.view, &mut encoder, &self.canvas.depth_view);
        self.renderer.resolve(
            &self.view,
            &mut Canvas::over_pass(&self.canvas.color_view, &mut encoder),
        );
        let buffers = paint.map_or_else(Vec::new, |paint| self.paint(&paint, &mut encoder));
        let buffers = buffers.into_iter().chain([encoder.finish()]);
        self.gpu.queue.submit(buffers);
        Ok(stats)
    }

    fn paint(
        &mut self,
        paint: &Paint,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Vec<wgpu::CommandBuffer> {
        let Gpu { device, queue, .. } = &self.gpu;
        for (id, delta) in &paint.textures.set {
            for delta in delta {
                self.egui.update_texture(device, queue, *id, delta);
            }
        }
        let screen = egui_wgpu::ScreenDescriptor {
            size_in_pixels: self.canvas.size_px.to_array(),
            pixels_per_point: paint.pixels_per_point,
        };
        let buffers = self
            .egui
            .update_buffers(device, queue, encoder, &paint.jobs, &screen);
        let pass = Canvas::over_pass(&self.canvas.plain_view, encoder);
        self.egui
            .render(&mut pass.forget_lifetime(), &paint.jobs, &screen);
        for id in &paint.textures.free {
            self.egui.free_texture(id);
        }
        buffers
    }

    /// The canvas as PNG. Waits for the GPU.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn png(&self) -> Result<Vec<u8>, String> {
        let mut texels = self.gpu.read_texture(&self.canvas.color)?;
        if self.format.color == wgpu::TextureFormat::Bgra8UnormSrgb {
            texels
                .chunks_exact_mut(4)
                .for_each(|texel| texel.swap(0, 2));
        }
        crate::host::png::rgb(self.canvas.size_px, &texels)
    }
}
