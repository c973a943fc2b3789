//! Pipelines that resolve layers with patterns, strokes or fades, compiled when a frame first has some.

use std::collections::HashMap;

use glam::UVec2;

use crate::{
    frame::lens::LensKind, gpu::edge_pipelines::EdgePipelines, gpu::edge_view::edge_target,
    gpu::pipelines::layout, gpu::style_table::Needs, gpu::surface_binding::surface_layout,
    options::RendererOptions, shaders,
};

/// Layouts, the shader module and the pipelines made so far.
pub(crate) struct StylePipelines {
    options: RendererOptions,
    /// Styles of a layer, places of patterns, distances from boundaries.
    pub style_layout: wgpu::BindGroupLayout,
    pub surface_layout: wgpu::BindGroupLayout,
    /// One texel, for layers whose boundaries are not measured.
    pub no_edges: wgpu::TextureView,
    /// Made when a frame first needs distances from boundaries.
    pub edges: Option<EdgePipelines>,
    pipeline_layout: wgpu::PipelineLayout,
    module: wgpu::ShaderModule,
    made: HashMap<(Needs, LensKind), wgpu::RenderPipeline>,
}

impl StylePipelines {
    /// `layer_layout` is that of a layer's table and sums.
    pub(crate) fn new(
        device: &wgpu::Device,
        options: RendererOptions,
        layer_layout: &wgpu::BindGroupLayout,
        image_layout: &wgpu::BindGroupLayout,
    ) -> Self {
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let read = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let edges = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Uint,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let bindings = [read, read, edges];
        let style_layout = layout(device, "globefill styles", fragment, &bindings);
        let surface_layout = surface_layout(device, options.sample_count, both);
        let groups = [layer_layout, &style_layout, &surface_layout, image_layout];
        let source = shaders::resolve_styled(options.sample_count);
        Self {
            options,
            pipeline_layout: device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("globefill styled"),
                bind_group_layouts: &groups.map(Some),
                immediate_size: 0,
            }),
            no_edges: edge_target(device, UVec2::ONE),
            edges: None,
            style_layout,
            surface_layout,
            module: device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("globefill styled"),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            }),
            made: HashMap::new(),
        }
    }

    /// Compiles the pipeline if it does not exist yet.
    pub(crate) fn ensure(&mut self, device: &wgpu::Device, needs: Needs, lens: LensKind) {
        if !self.made.contains_key(&(needs, lens)) {
            let pipeline = self.make(device, needs, lens);
            self.made.insert((needs, lens), pipeline);
        }
    }

    /// A pipeline that `ensure` was called for.
    pub(crate) fn get(&self, needs: Needs, lens: LensKind) -> Option<&wgpu::RenderPipeline> {
        self.made.get(&(needs, lens))
    }

    fn make(&self, device: &wgpu::Device, needs: Needs, lens: LensKind) -> wgpu::RenderPipeline {
        let samples = self.options.sample_count;
        let entry = if samples > 1 {
            "fs_styled_sample"
        } else {
            "fs_styled"
        };
        let [parallel, logarithmic] = lens.constants();
        let constants = [("NEEDS", f64::from(needs)), parallel, logarithmic];
        let options = wgpu::PipelineCompilationOptions {
            constants: &constants,
            ..Default::default()
        };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(entry),
            layout: Some(&self.pipeline_layout),
            vertex: wgpu::VertexState {
                module: &self.module,
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
                module: &self.module,
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
