//! The ground with the countries on it, drawn once: neither they nor the camera move, so every frame
//! starts from the same picture.

use std::time::Instant;

use globefill::{FillMesh, FillStyle, Frame, Renderer, RendererOptions, View, wgpu};

use crate::host::{
    gpu::Gpu,
    ground::{Ground, GroundPipelines},
    palette,
    targets::Targets,
    times::milliseconds_since,
};

/// The countries are a dark map on which the footprints shine.
const OPACITY: f32 = 0.6;
const BRIGHTNESS: f32 = 0.12;

/// A picture of the ground and the countries.
pub struct CountryLayer {
    picture: wgpu::Texture,
    /// What drawing the countries once more took.
    pub drawn_ms: f64,
}

impl CountryLayer {
    pub fn new(
        gpu: &Gpu,
        ground: (&Ground, &GroundPipelines),
        targets: &Targets,
        options: RendererOptions,
        frame: &Frame,
        mesh: FillMesh,
    ) -> Result<Self, String> {
        let mut renderer = dark_map(gpu, options, mesh)?;
        let mut view = View::default();
        renderer
            .prepare(&gpu.queue, &mut view, frame)
            .map_err(|error| error.to_string())?;
        let picture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("countries"),
            size: targets.color.size(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: options.color_format,
            usage: wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let mut drawn_ms = 0.0;
        // The first time compiles the shaders.
        for _ in 0..2 {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            targets.draw_ground(&mut encoder, ground.0, ground.1, true);
            gpu.run(encoder)?;
            let start = Instant::now();
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            renderer.count(&mut view, &mut encoder, &targets.depth_view);
            renderer.resolve(
                &view,
                &mut targets.fill_pass(&mut encoder, wgpu::LoadOp::Load),
            );
            gpu.run(encoder)?;
            drawn_ms = milliseconds_since(start);
        }
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        copy(&mut encoder, &targets.color, &picture);
        gpu.run(encoder)?;
        Ok(Self { picture, drawn_ms })
    }

    /// Replaces the ground in a picture by the ground with countries.
    pub fn copy_to(&self, encoder: &mut wgpu::CommandEncoder, color: &wgpu::Texture) {
        copy(encoder, &self.picture, color);
    }
}

fn dark_map(gpu: &Gpu, options: RendererOptions, mesh: FillMesh) -> Result<Renderer, String> {
    let colors = palette::colors(&mesh);
    let mut renderer = Renderer::new(&gpu.device, options).map_err(|error| error.to_string())?;
    let id = renderer.insert(mesh);
    for (fill, [red, green, blue, _]) in (0..).zip(colors) {
        let [red, green, blue] = [red, green, blue].map(|part| part * BRIGHTNESS);
        let style = FillStyle {
            color: [red, green, blue, OPACITY],
            ..Default::default()
        };
        renderer
            .set_style(id, fill, style)
            .map_err(|error| error.to_string())?;
    }
    Ok(renderer)
}

fn copy(encoder: &mut wgpu::CommandEncoder, from: &wgpu::Texture, to: &wgpu::Texture) {
    encoder.copy_texture_to_texture(from.as_image_copy(), to.as_image_copy(), from.size());
}
