//! Pipelines of the sensors, compiled when a frame first has some.

use crate::{gpu::pipelines::layout, options::RendererOptions, shaders};

/// What a fragment shows of the sensors that cover it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shown {
    Blended,
    Coverage,
}

/// Layouts and pipelines; those not needed yet are not made.
pub(crate) struct SensorPipelines {
    options: RendererOptions,
    /// Camera, sensors, planes, colours of the coverage.
    pub scene_layout: wgpu::BindGroupLayout,
    /// Tiles and lists, written.
    pub binned_layout: wgpu::BindGroupLayout,
    /// Tiles and lists, read.
    pub tiles_layout: wgpu::BindGroupLayout,
    pub depth_layout: wgpu::BindGroupLayout,
    /// What is read back.
    pub answer_layout: wgpu::BindGroupLayout,
    /// Ranges of depth, blocks, tiles.
    pub binning: Vec<wgpu::ComputePipeline>,
    /// Counting at one pixel.
    pub counting: Vec<wgpu::ComputePipeline>,
    blended: Option<wgpu::RenderPipeline>,
    coverage: Option<wgpu::RenderPipeline>,
}

impl SensorPipelines {
    pub(crate) fn new(device: &wgpu::Device, options: RendererOptions) -> Self {
        let stages = wgpu::ShaderStages::VERTEX_FRAGMENT | wgpu::ShaderStages::COMPUTE;
        let buffer = |ty| wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let read = buffer(wgpu::BufferBindingType::Storage { read_only: true });
        let written = buffer(wgpu::BufferBindingType::Storage { read_only: false });
        let uniform = buffer(wgpu::BufferBindingType::Uniform);
        let depth = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Depth,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: options.sample_count > 1,
        };
        let compute = wgpu::ShaderStages::COMPUTE;
        let make = |label, stages, bindings: &[_]| layout(device, label, stages, bindings);
        let scene_layout = make("globefill sensors", stages, &[uniform, read, read, read]);
        let binned_layout = make("globefill binned", compute, &[written; 4]);
        let tiles_layout = make(
            "globefill tiles",
            wgpu::ShaderStages::VERTEX_FRAGMENT,
            &[read; 3],
        );
        let depth_layout = make("globefill depth", stages, &[depth]);
        let answer_layout = make("globefill answer", compute, &[written]);
        let samples = options.sample_count;
        let steps = |source, groups, entries| {
            let layout = pipeline_layout(device, [&scene_layout, groups, &depth_layout]);
            compute_pipelines(device, source, &layout, entries)
        };
        let binning = ["cs_range", "cs_bin_blocks", "cs_bin_tiles"];
        Self {
            options,
            binning: steps(shaders::bin_sensors(samples), &binned_layout, &binning),
            counting: steps(
                shaders::count_sensors(samples),
                &answer_layout,
                &["cs_count"],
            ),
            scene_layout,
            binned_layout,
            tiles_layout,
            depth_layout,
            answer_layout,
            blended: None,
            coverage: None,
        }
    }

    /// Compiles the resolve if it does not exist yet.
    pub(crate) fn ensure(&mut self, device: &wgpu::Device, shown: Shown) {
        if self.get(shown).is_none() {
            let made = Some(self.make(device, shown));
            match shown {
                Shown::Blended => self.blended = made,
                Shown::Coverage => self.coverage = made,
            }
        }
    }

    /// The resolve, if `ensure` was called for it.
    pub(crate) fn get(&self, shown: Shown) -> Option<&wgpu::RenderPipeline> {
        match shown {
            Shown::Blended => self.blended.as_ref(),
            Shown::Coverage => self.coverage.as_ref(),
        }
    }

    fn make(&self, device: &wgpu::Device, shown: Shown) -> wgpu::RenderPipeline {
        let samples = self.options.sample_count;
        let entry = match (shown, samples > 1) {
            (Shown::Blended, false) => "fs_blended",
            (Shown::Blended, true) => "fs_blended_sample",
            (Shown::Coverage, false) => "fs_coverage",
            (Shown::Coverage, true) => "fs_coverage_sample",
        };
        let module = module(device, shaders::resolve_sensors(samples));
        let layouts = [&self.scene_layout, &self.tiles_layout, &self.depth_layout];
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(entry),
            layout: Some(&pipeline_layout(device, layouts)),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs_block"),
                compilation_options: Default::default(),
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
                module: &module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
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

fn compute_pipelines(
    device: &wgpu::Device,
    source: String,
    layout: &wgpu::PipelineLayout,
    entries: &[&str],
) -> Vec<wgpu::ComputePipeline> {
    let module = module(device, source);
    entries
        .iter()
        .map(|entry| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: Some(layout),
                module: &module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                cache: None,
            })
        })
        .collect()
}

fn module(device: &wgpu::Device, source: String) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("globefill sensors"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    })
}

fn pipeline_layout(
    device: &wgpu::Device,
    layouts: [&wgpu::BindGroupLayout; 3],
) -> wgpu::PipelineLayout {
    device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("globefill sensors"),
        bind_group_layouts: &layouts.map(Some),
        immediate_size: 0,
    })
}
