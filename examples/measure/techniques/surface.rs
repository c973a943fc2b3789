//! A plain surface mesh: the caps in a vertex and an index buffer, blended over the globe in one draw.

use bytemuck::{Pod, Zeroable};
use globefill::wgpu::{self, util::DeviceExt};

use super::{
    eye_uniform::{self, EyeBuffer},
    fill_faces,
};
use crate::{
    canvas::{Canvas, Paint},
    host::gpu::Gpu,
    invocations::InvocationQueries,
    stage::Stage,
    technique::{Cost, Technique},
};

const SHADER: &str = include_str!("surface.wgsl");

/// Metres from the origin, and a premultiplied colour.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Vertex {
    position: [f32; 3],
    color: [u8; 4],
}

pub struct Surface {
    canvas: Canvas,
    pipeline: wgpu::RenderPipeline,
    eye: EyeBuffer,
    eye_group: wgpu::BindGroup,
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    index_count: u32,
}

impl Surface {
    pub fn new(gpu: &Gpu, stage: &Stage, paint: Paint) -> Result<Self, String> {
        if stage.mesh.fills.is_empty() {
            return Err("nothing in this scene has a mesh".into());
        }
        let canvas = Canvas::new(gpu, stage, paint)?;
        let (vertices, indices) = mesh(stage, paint);
        let pipeline = pipeline(gpu, &canvas);
        let eye = EyeBuffer::new(gpu, stage);
        let eye_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("surface"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: eye.buffer.as_entire_binding(),
            }],
        });
        let buffer = |contents: &[u8], usage| {
            gpu.device
                .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: Some("surface"),
                    contents,
                    usage,
                })
        };
        Ok(Self {
            canvas,
            pipeline,
            eye,
            eye_group,
            vertices: buffer(bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX),
            index_count: indices.len() as u32,
            indices: buffer(bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX),
        })
    }
}

fn mesh(stage: &Stage, paint: Paint) -> (Vec<Vertex>, Vec<u32>) {
    let origin_m = eye_uniform::origin_m(stage);
    let (mut vertices, mut indices) = (Vec::new(), Vec::new());
    let colors = paint.premultiplied(stage);
    for (fill, color) in fill_faces::all(&stage.mesh).iter().zip(colors) {
        let first = vertices.len() as u32;
        let color = color.map(|channel| (channel * 255.0).round() as u8);
        let placed = fill.vertices_m.iter().map(|&position_m| Vertex {
            position: (position_m - origin_m).as_vec3().to_array(),
            color,
        });
        vertices.extend(placed);
        indices.extend(fill.triangles.iter().flatten().map(|corner| first + corner));
    }
    (vertices, indices)
}

fn pipeline(gpu: &Gpu, canvas: &Canvas) -> wgpu::RenderPipeline {
    let module = gpu
        .device
        .create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("surface"),
            source: wgpu::ShaderSource::Wgsl([eye_uniform::SOURCE, SHADER].concat().into()),
        });
    let format = canvas.targets.format;
    gpu.device
        .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("surface"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: Default::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: size_of::<Vertex>() as u64,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Unorm8x4],
                })],
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: Some(wgpu::Face::Back),
                ..Default::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: format.depth,
                depth_write_enabled: Some(false),
                depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("paint"),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: format.color,
                    blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
}

impl Technique for Surface {
    fn draw(
        &mut self,
        gpu: &Gpu,
        stage: &Stage,
        queries: Option<&InvocationQueries>,
    ) -> Result<Cost, String> {
        let upload_bytes = self.eye.update(gpu, stage);
        let mut encoder = self.canvas.begin(gpu, stage);
        {
            let load = self.canvas.load();
            let mut pass = self.canvas.targets.surface_pass(&mut encoder, load);
            if let Some(queries) = queries {
                pass.begin_pipeline_statistics_query(&queries.set, 0);
            }
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.eye_group, &[]);
            pass.set_vertex_buffer(0, self.vertices.slice(..));
            pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..self.index_count, 0, 0..1);
            if queries.is_some() {
                pass.end_pipeline_statistics_query();
            }
        }
        if let Some(queries) = queries {
            queries.resolve(&mut encoder);
        }
        gpu.run(encoder)?;
        Ok(Cost {
            draws: 1,
            passes: 1,
            upload_bytes,
            gpu_bytes: self.vertices.size() + self.indices.size(),
            count: None,
        })
    }

    fn queries(&self) -> u32 {
        1
    }

    fn color(&self) -> &wgpu::Texture {
        &self.canvas.targets.color
    }
}
