//! Pipelines of the edge pass, compiled when a frame first needs them.

use std::collections::HashMap;

use crate::{
    frame::edge_draws::EdgeInput,
    frame::edge_segments::EdgeSegment,
    frame::lens::LensKind,
    gpu::pipelines::{Pipelines, layout},
    options::RendererOptions,
    shaders,
};

/// What the edge pass writes; see `edge_of` in stroke.wgsl.
pub(crate) const EDGE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;
/// Its own depth: which boundary is nearest.
pub(crate) const NEAREST_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Names a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct EdgeKey {
    pub input: EdgeInput,
    /// Whether the projection mirrors the picture.
    pub mirrored: bool,
    pub lens: LensKind,
}

/// Layouts, the shader module and the pipelines made so far.
pub(crate) struct EdgePipelines {
    /// What is particular to edges, reaches, slots.
    pub edge_layout: wgpu::BindGroupLayout,
    pipeline_layout: wgpu::PipelineLayout,
    shader: wgpu::ShaderModule,
    made: HashMap<EdgeKey, wgpu::RenderPipeline>,
}

impl EdgePipelines {
    pub(crate) fn new(
        device: &wgpu::Device,
        pipelines: &Pipelines,
        surface_layout: &wgpu::BindGroupLayout,
        options: RendererOptions,
    ) -> Self {
        let buffer = |ty| wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let uniform = buffer(wgpu::BufferBindingType::Uniform);
        let storage = buffer(wgpu::BufferBindingType::Storage { read_only: true });
        let vertex = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let bindings = [uniform, storage, storage];
        let edge_layout = layout(device, "globefill edge", vertex, &bindings);
        let layouts = [
            &pipelines.frame_layout,
            &pipelines.mesh_layout,
            surface_layout,
            &edge_layout,
        ];
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("globefill edge"),
            bind_group_layouts: &layouts.map(Some),
            immediate_size: 0,
        });
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("globefill edge"),
            source: wgpu::ShaderSource::Wgsl(shaders::edge(options.sample_count).into()),
        });
        Self {
            edge_layout,
            pipeline_layout,
            shader,
            made: HashMap::new(),
        }
    }

    /// Compiles the pipeline if it does not exist yet.
    pub(crate) fn ensure(&mut self, device: &wgpu::Device, key: EdgeKey) {
        if !self.made.contains_key(&key) {
            let pipeline = self.make(device, key);
            self.made.insert(key, pipeline);
        }
    }

    /// A pipeline that `ensure` was called for.
    pub(crate) fn get(&self, key: EdgeKey) -> &wgpu::RenderPipeline {
        &self.made[&key]
    }

    fn make(&self, device: &wgpu::Device, key: EdgeKey) -> wgpu::RenderPipeline {
        let [vertex_entry, fragment_entry] = key.input.entries();
        let compilation_options = wgpu::PipelineCompilationOptions {
            constants: &key.lens.constants(),
            ..Default::default()
        };
        let attributes = wgpu::vertex_attr_array![0 => Sint32x4, 1 => Sint32x4, 2 => Uint32x4];
        let segments = [Some(wgpu::VertexBufferLayout {
            array_stride: size_of::<EdgeSegment>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &attributes,
        })];
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(vertex_entry),
            layout: Some(&self.pipeline_layout),
            vertex: wgpu::VertexState {
                module: &self.shader,
                entry_point: Some(vertex_entry),
                compilation_options: compilation_options.clone(),
                buffers: match key.input {
                    EdgeInput::Segments => &segments,
                    EdgeInput::Chords | EdgeInput::Flat => &[],
                },
            },
            primitive: wgpu::PrimitiveState {
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                front_face: if key.mirrored {
                    wgpu::FrontFace::Cw
                } else {
                    wgpu::FrontFace::Ccw
                },
                // The eye may be inside: back faces alone hold everything.
                cull_mode: match key.input {
                    EdgeInput::Chords | EdgeInput::Segments => Some(wgpu::Face::Front),
                    EdgeInput::Flat => None,
                },
                ..Default::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: NEAREST_FORMAT,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Less),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.shader,
                entry_point: Some(fragment_entry),
                compilation_options: compilation_options.clone(),
                targets: &[Some(EDGE_FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
