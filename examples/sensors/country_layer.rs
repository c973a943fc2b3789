//! The countries, drawn once: neither they nor the camera move, so every frame shows the same picture
//! of them beneath the footprints.

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

const COMPOSITE: &str = "
@group(0) @binding(0) var layer: texture_2d<f32>;

@vertex fn vs(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment fn fs(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {
    return textureLoad(layer, vec2<i32>(pixel.xy), 0);
}
";

/// A picture of the countries, and what lays it over another.
pub struct CountryLayer {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
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
        let colors = palette::colors(&mesh);
        let mut renderer =
            Renderer::new(&gpu.device, options).map_err(|error| error.to_string())?;
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
        let layer = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("countries"),
            size: targets.color.size(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: options.color_format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let layer = layer.create_view(&Default::default());
        let mut view = View::default();
        renderer
            .prepare(&gpu.queue, &mut view, frame)
            .map_err(|error| error.to_string())?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        targets.draw_ground(&mut encoder, ground.0, ground.1, true);
        gpu.run(encoder)?;
        let mut drawn_ms = 0.0;
        // The first time compiles the shaders.
        for _ in 0..2 {
            let start = Instant::now();
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            renderer.count(&mut view, &mut encoder, &targets.depth_view);
            renderer.resolve(&view, &mut clear_pass(&mut encoder, &layer));
            gpu.run(encoder)?;
            drawn_ms = milliseconds_since(start);
        }
        let pipeline = composite(gpu, options.color_format);
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("countries"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&layer),
            }],
        });
        Ok(Self {
            pipeline,
            group,
            drawn_ms,
        })
    }

    /// Lays the countries over what is there.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn clear_pass<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("countries"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                store: wgpu::StoreOp::Store,
            },
        })],
        ..Default::default()
    })
}

fn composite(gpu: &Gpu, format: wgpu::TextureFormat) -> wgpu::RenderPipeline {
    let module = gpu
        .device
        .create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("composite"),
            source: wgpu::ShaderSource::Wgsl(COMPOSITE.into()),
        });
    gpu.device
        .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("composite"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fs"),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format,
                    blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
}
