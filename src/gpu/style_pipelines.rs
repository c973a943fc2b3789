//! Pipelines that resolve layers with patterns, strokes or fades, compiled when a frame first has some.

use std::collections::HashMap;

use glam::UVec2;

use crate::{
    frame::code::CodeShape, frame::lens::LensKind, gpu::edge_pipelines::EdgePipelines,
    gpu::edge_view::edge_target, gpu::pipelines::layout, gpu::style_record::Needs,
    gpu::surface_binding::surface_layout, options::RendererOptions, shaders,
};

/// What a pipeline is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct StyleKey {
    pub code: CodeShape,
    pub needs: Needs,
    /// Whether styles and places are few enough for uniforms.
    pub few: bool,
    pub lens: LensKind,
}

impl StyleKey {
    /// The same with so many bits of the check in the plane of the id.
    pub(crate) fn joined(self, joined: u32) -> Self {
        let code = self.code.joined(joined);
        Self { code, ..self }
    }
}

/// Layouts, the shader modules and the pipelines made so far.
pub(crate) struct StylePipelines {
    options: RendererOptions,
    layer_layout: wgpu::BindGroupLayout,
    pub surface_layout: wgpu::BindGroupLayout,
    image_layout: wgpu::BindGroupLayout,
    /// One texel, for layers whose boundaries are not measured.
    pub no_edges: wgpu::TextureView,
    /// Made when a frame first needs distances from boundaries.
    pub edges: Option<EdgePipelines>,
    /// For styles that are few, and for many.
    programs: HashMap<bool, Program>,
    made: HashMap<StyleKey, wgpu::RenderPipeline>,
}

struct Program {
    /// Styles of a layer, places of patterns, distances from boundaries.
    style_layout: wgpu::BindGroupLayout,
    pipeline_layout: wgpu::PipelineLayout,
    module: wgpu::ShaderModule,
}

impl StylePipelines {
    /// `layer_layout` is that of a layer's table and sums.
    pub(crate) fn new(
        device: &wgpu::Device,
        options: RendererOptions,
        layer_layout: &wgpu::BindGroupLayout,
        image_layout: &wgpu::BindGroupLayout,
    ) -> Self {
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
        Self {
            options,
            layer_layout: layer_layout.clone(),
            surface_layout: surface_layout(device, options.sample_count, both),
            image_layout: image_layout.clone(),
            no_edges: edge_target(device, UVec2::ONE),
            edges: None,
            programs: HashMap::new(),
            made: HashMap::new(),
        }
    }

    /// Compiles the pipeline if it does not exist yet.
    pub(crate) fn ensure(&mut self, device: &wgpu::Device, key: StyleKey) {
        if self.made.contains_key(&key) {
            return;
        }
        if !self.programs.contains_key(&key.few) {
            let program = self.program(device, key.few);
            self.programs.insert(key.few, program);
        }
        let pipeline = self.make(device, &self.programs[&key.few], key);
        self.made.insert(key, pipeline);
    }

    /// A pipeline that `ensure` was called for.
    pub(crate) fn get(&self, key: StyleKey) -> Option<&wgpu::RenderPipeline> {
        self.made.get(&key)
    }

    /// How styles and places are bound, for a key that `ensure` was called for.
    pub(crate) fn style_layout(&self, key: StyleKey) -> &wgpu::BindGroupLayout {
        &self.programs[&key.few].style_layout
    }

    fn program(&self, device: &wgpu::Device, few: bool) -> Program {
        let ty = if few {
            wgpu::BufferBindingType::Uniform
        } else {
            wgpu::BufferBindingType::Storage { read_only: true }
        };
        let table = wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let edges = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Uint,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let style_layout = layout(device, "globefill styles", fragment, &[table, table, edges]);
        let groups = [
            &self.layer_layout,
            &style_layout,
            &self.surface_layout,
            &self.image_layout,
        ];
        let source = shaders::resolve_styled(self.options.sample_count, few);
        Program {
            pipeline_layout: device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("globefill styled"),
                bind_group_layouts: &groups.map(Some),
                immediate_size: 0,
            }),
            module: device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("globefill styled"),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            }),
            style_layout,
        }
    }

    fn make(
        &self,
        device: &wgpu::Device,
        program: &Program,
        key: StyleKey,
    ) -> wgpu::RenderPipeline {
        let samples = self.options.sample_count;
        let entry = if samples > 1 {
            "fs_styled_sample"
        } else {
            "fs_styled"
        };
        let [parallel, logarithmic] = key.lens.constants();
        let mut constants = vec![("NEEDS", f64::from(key.needs)), parallel, logarithmic];
        constants.extend(key.code.constants());
        let options = wgpu::PipelineCompilationOptions {
            constants: &constants,
            ..Default::default()
        };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(entry),
            layout: Some(&program.pipeline_layout),
            vertex: wgpu::VertexState {
                module: &program.module,
                entry_point: Some("vs_styled"),
                compilation_options: options.clone(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState {
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                ..Default::default()
            },
            depth_stencil: None,
            multisample: wgpu::MultisampleState {
                count: samples,
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: &program.module,
                entry_point: Some(entry),
                compilation_options: options,
                targets: &[Some(wgpu::ColorTargetState {
                    format: self.options.color_format,
                    blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
