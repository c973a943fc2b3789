//! Counting volumes the crate's way, for volumes that come from elsewhere: faces behind the scene's depth
//! are added up, then the sums become colours.

use globefill::wgpu::{self, util::DeviceExt};

use super::eye_uniform::{self, EyeBuffer};
use crate::{
    canvas::{Canvas, Paint},
    host::gpu::Gpu,
    invocations::InvocationQueries,
    stage::Stage,
    technique::Cost,
};

const VOLUME: &str = include_str!("volume.wgsl");
const RESOLVE: &str = include_str!("resolve.wgsl");
const SUMS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// Targets and resolve for the volumes of one stage.
pub struct VolumeSums {
    pub canvas: Canvas,
    sums: wgpu::TextureView,
    resolve: wgpu::RenderPipeline,
    resolve_group: wgpu::BindGroup,
    eye: EyeBuffer,
}

impl VolumeSums {
    pub fn new(gpu: &Gpu, stage: &Stage, paint: Paint) -> Result<Self, String> {
        if stage.mesh.fills.is_empty() {
            return Err("nothing in this scene has a mesh".into());
        }
        if !stage.mesh.overlaps.is_empty() {
            return Err("fills overlap: their sums are no numbers of fills".into());
        }
        let device = &gpu.device;
        if !device
            .features()
            .contains(wgpu::Features::FLOAT32_BLENDABLE)
        {
            return Err("the adapter cannot blend 32-bit floats".into());
        }
        let canvas = Canvas::new(gpu, stage, paint)?;
        let sums = device
            .create_texture(&wgpu::TextureDescriptor {
                label: Some("sums"),
                size: canvas.targets.color.size(),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: SUMS,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
            .create_view(&Default::default());
        let colors = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("colours"),
            contents: bytemuck::cast_slice(&paint.premultiplied(stage)),
            usage: wgpu::BufferUsages::STORAGE,
        });
        let resolve = resolve_pipeline(device, canvas.targets.format.color);
        let resolve_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("resolve"),
            layout: &resolve.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(&sums),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: colors.as_entire_binding(),
                },
            ],
        });
        Ok(Self {
            eye: EyeBuffer::new(gpu, stage),
            canvas,
            sums,
            resolve,
            resolve_group,
        })
    }

    /// The pipeline that adds faces up; `source` has a vertex shader `corner` that returns `face(…)`.
    pub fn pipeline(
        &self,
        gpu: &Gpu,
        source: &str,
        buffers: &[Option<wgpu::VertexBufferLayout<'_>>],
    ) -> wgpu::RenderPipeline {
        let source = [eye_uniform::SOURCE, VOLUME, source].concat();
        let module = module(&gpu.device, "volumes", source);
        let add = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        gpu.device
            .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("volumes"),
                layout: None,
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("corner"),
                    compilation_options: Default::default(),
                    buffers,
                },
                primitive: Default::default(),
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: self.canvas.targets.format.depth,
                    depth_write_enabled: Some(false),
                    // Depths are reversed: what passes lies behind the scene.
                    depth_compare: Some(wgpu::CompareFunction::Less),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some("weigh"),
                    compilation_options: Default::default(),
                    targets: &[Some(wgpu::ColorTargetState {
                        format: SUMS,
                        blend: Some(wgpu::BlendState {
                            color: add,
                            alpha: add,
                        }),
                        write_mask: wgpu::ColorWrites::ALL,
                    })],
                }),
                multiview_mask: None,
                cache: None,
            })
    }

    /// The camera, and the storage buffers behind it.
    pub fn group(
        &self,
        gpu: &Gpu,
        pipeline: &wgpu::RenderPipeline,
        buffers: &[&wgpu::Buffer],
    ) -> wgpu::BindGroup {
        let entries: Vec<_> = (0..)
            .zip(
                [&self.eye.buffer]
                    .into_iter()
                    .chain(buffers.iter().copied()),
            )
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("volumes"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        })
    }

    /// Two passes: the faces that `draw` draws, and the resolve.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        stage: &Stage,
        queries: Option<&InvocationQueries>,
        draw: impl Fn(&mut wgpu::RenderPass<'_>),
    ) -> Result<Cost, String> {
        let upload_bytes = self.eye.update(gpu, stage);
        let mut encoder = self.canvas.begin(gpu, stage);
        {
            let mut pass = self.count_pass(&mut encoder);
            measured(&mut pass, queries, 0, draw);
        }
        {
            let targets = &self.canvas.targets;
            let mut pass = targets.fill_pass(&mut encoder, self.canvas.load());
            measured(&mut pass, queries, 1, |pass| {
                pass.set_pipeline(&self.resolve);
                pass.set_bind_group(0, &self.resolve_group, &[]);
                pass.draw(0..3, 0..1);
            });
        }
        if let Some(queries) = queries {
            queries.resolve(&mut encoder);
        }
        gpu.run(encoder)?;
        Ok(Cost {
            draws: 2,
            passes: 2,
            upload_bytes,
            gpu_bytes: 0,
            count: None,
        })
    }

    fn count_pass<'a>(&self, encoder: &'a mut wgpu::CommandEncoder) -> wgpu::RenderPass<'a> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("volumes"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.sums,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.canvas.targets.depth_view,
                depth_ops: None,
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }
}

/// Draws with the statistics of the `index`-th query taken, if any are.
fn measured(
    pass: &mut wgpu::RenderPass<'_>,
    queries: Option<&InvocationQueries>,
    index: u32,
    draw: impl Fn(&mut wgpu::RenderPass<'_>),
) {
    if let Some(queries) = queries {
        pass.begin_pipeline_statistics_query(&queries.set, index);
    }
    draw(pass);
    if queries.is_some() {
        pass.end_pipeline_statistics_query();
    }
}

fn module(device: &wgpu::Device, label: &str, source: String) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    })
}

fn resolve_pipeline(device: &wgpu::Device, color: wgpu::TextureFormat) -> wgpu::RenderPipeline {
    let module = module(device, "resolve", RESOLVE.to_owned());
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("resolve"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("whole_picture"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("resolve"),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: color,
                blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
