//! What render pipelines are made of.

/// What differs between the pipelines.
pub(crate) struct Recipe<'a> {
    pub module: &'a wgpu::ShaderModule,
    pub constants: Vec<(&'static str, f64)>,
    pub layouts: Vec<&'a wgpu::BindGroupLayout>,
    pub vertex: &'static str,
    pub fragment: Option<String>,
    pub targets: Vec<Option<wgpu::ColorTargetState>>,
    pub primitive: wgpu::PrimitiveState,
    pub depth_stencil: Option<wgpu::DepthStencilState>,
}

impl Recipe<'_> {
    /// The pipeline, with so many samples a pixel.
    pub(crate) fn build(&self, device: &wgpu::Device, sample_count: u32) -> wgpu::RenderPipeline {
        let layouts: Vec<_> = self.layouts.iter().map(|&layout| Some(layout)).collect();
        let compilation_options = wgpu::PipelineCompilationOptions {
            constants: &self.constants,
            ..Default::default()
        };
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(self.vertex),
            bind_group_layouts: &layouts,
            immediate_size: 0,
        });
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.fragment.as_deref().unwrap_or(self.vertex)),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some(self.vertex),
                compilation_options: compilation_options.clone(),
                buffers: &[],
            },
            primitive: self.primitive,
            depth_stencil: self.depth_stencil.clone(),
            multisample: wgpu::MultisampleState {
                count: sample_count,
                ..Default::default()
            },
            fragment: self.fragment.as_deref().map(|entry| wgpu::FragmentState {
                module: self.module,
                entry_point: Some(entry),
                compilation_options: compilation_options.clone(),
                targets: &self.targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
