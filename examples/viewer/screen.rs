//! Windows and labels over the globe: egui, painted into the same picture.

use std::time::Duration;

use glam::UVec2;
use globefill::wgpu;

use crate::host::gpu::Gpu;

/// egui and what paints it.
pub struct Screen {
    pub context: egui::Context,
    painter: egui_wgpu::Renderer,
    output: Option<egui::FullOutput>,
    /// When the interface changes by itself.
    pub repaint_after: Duration,
}

impl Screen {
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        let context = egui::Context::default();
        context.set_visuals(visuals());
        Self {
            context,
            painter: egui_wgpu::Renderer::new(&gpu.device, format, Default::default()),
            output: None,
            repaint_after: Duration::ZERO,
        }
    }

    /// Keeps what was laid out for the next [`Self::paint`].
    pub fn take(&mut self, newer: egui::FullOutput) {
        let windows = newer.viewport_output.values();
        let delays = windows.map(|window| window.repaint_delay);
        self.repaint_after = delays.min().unwrap_or(Duration::MAX);
        match &mut self.output {
            Some(output) => output.append(newer),
            None => self.output = Some(newer),
        }
    }

    /// Records painting over `target`. Returns what the window is to do.
    pub fn paint(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        size_px: UVec2,
    ) -> egui::PlatformOutput {
        let Some(mut output) = self.output.take() else {
            return egui::PlatformOutput::default();
        };
        for (id, deltas) in output.textures_delta.set.drain() {
            for delta in &deltas {
                self.painter
                    .update_texture(&gpu.device, &gpu.queue, id, delta);
            }
        }
        let descriptor = egui_wgpu::ScreenDescriptor {
            size_in_pixels: size_px.to_array(),
            pixels_per_point: output.pixels_per_point,
        };
        let shapes = std::mem::take(&mut output.shapes);
        let meshes = self.context.tessellate(shapes, output.pixels_per_point);
        let (device, queue) = (&gpu.device, &gpu.queue);
        let uploads = self
            .painter
            .update_buffers(device, queue, encoder, &meshes, &descriptor);
        gpu.queue.submit(uploads);
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("interface"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Load,
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        self.painter
            .render(&mut pass.forget_lifetime(), &meshes, &descriptor);
        for id in output.textures_delta.free.drain() {
            self.painter.free_texture(&id);
        }
        std::mem::take(&mut output.platform_output)
    }
}

fn visuals() -> egui::Visuals {
    let mut visuals = egui::Visuals::dark();
    visuals.panel_fill = egui::Color32::from_rgb(16, 20, 28);
    visuals.window_fill = visuals.panel_fill;
    visuals.selection.bg_fill = egui::Color32::from_rgb(36, 94, 160);
    visuals
}
