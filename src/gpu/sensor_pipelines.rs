//! Pipelines of the sensors, compiled when a frame first has some.

use std::collections::HashMap;

use crate::{
    frame::lens::LensKind, gpu::pipelines::layout, gpu::surface_binding::surface_layout,
    options::RendererOptions, sensor_set::Needs, shaders,
};

/// What a fragment shows of the sensors that cover it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Shown {
    Blended,
    Coverage,
}

/// Names the pipelines of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct SensorKey {
    pub shown: Shown,
    pub needs: Needs,
    pub lens: LensKind,
}

/// The pipelines of a frame.
pub(crate) struct SensorProgram {
    /// Ranges of depth, blocks, tiles.
    pub binning: Vec<wgpu::ComputePipeline>,
    /// Counting at one pixel.
    pub counting: Vec<wgpu::ComputePipeline>,
    pub resolve: wgpu::RenderPipeline,
}

/// Layouts, and the programs made so far.
pub(crate) struct SensorPipelines {
    options: RendererOptions,
    /// Sensors, planes, colours of the coverage.
    pub scene_layout: wgpu::BindGroupLayout,
    /// Tiles and lists, written.
    pub binned_layout: wgpu::BindGroupLayout,
    /// Tiles and lists, read.
    pub tiles_layout: wgpu::BindGroupLayout,
    pub surface_layout: wgpu::BindGroupLayout,
    /// What is read back.
    pub answer_layout: wgpu::BindGroupLayout,
    made: HashMap<SensorKey, SensorProgram>,
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
        let compute = wgpu::ShaderStages::COMPUTE;
        let make = |label, stages, bindings: &[_]| layout(device, label, stages, bindings);
        let scene_layout = make("globefill sensors", stages, &[read; 3]);
        let binned_layout = make("globefill binned", compute, &[written; 4]);
        let tiles_layout = make(
            "globefill tiles",
            wgpu::ShaderStages::VERTEX_FRAGMENT,
            &[read; 3],
        );
        let surface_layout = surface_layout(device, options.sample_count, stages);
        let answer_layout = make("globefill answer", compute, &[written]);
        Self {
            options,
            scene_layout,
            binned_layout,
            tiles_layout,
            surface_layout,
            answer_layout,
            made: HashMap::new(),
        }
    }

    /// Compiles the program if it does not exist yet.
    pub(crate) fn ensure(&mut self, device: &wgpu::Device, key: SensorKey) {
        if !self.made.contains_key(&key) {
            let program = self.make(device, key);
            self.made.insert(key, program);
        }
    }

    /// A program that `ensure` was called for.
    pub(crate) fn get(&self, key: SensorKey) -> Option<&SensorProgram> {
        self.made.get(&key)
    }

    fn make(&self, device: &wgpu::Device, key: SensorKey) -> SensorProgram {
        let samples = self.options.sample_count;
        let steps = |source, groups, entries: &[&str]| {
            let layout =
                pipeline_layout(device, [&self.scene_layout, groups, &self.surface_layout]);
            compute_pipelines(device, source, &layout, entries, key)
        };
        let binning = ["cs_range", "cs_bin_blocks", "cs_bin_tiles"];
        let counting = shaders::count_sensors(samples);
        SensorProgram {
            binning: steps(shaders::bin_sensors(samples), &self.binned_layout, &binning),
            counting: steps(counting, &self.answer_layout, &["cs_count"]),
            resolve: self.make_resolve(device, key),
        }
    }

    fn make_resolve(&self, device: &wgpu::Device, key: SensorKey) -> wgpu::RenderPipeline {
        let samples = self.options.sample_count;
        let entry = match (key.shown, samples > 1) {
            (Shown::Blended, false) => "fs_blended",
            (Shown::Blended, true) => "fs_blended_sample",
            (Shown::Coverage, false) => "fs_coverage",
            (Shown::Coverage, true) => "fs_coverage_sample",
        };
        let constants = constants(key);
        let module = module(device, shaders::resolve_sensors(samples));
        let layouts = [&self.scene_layout, &self.tiles_layout, &self.surface_layout];
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(entry),
            layout: Some(&pipeline_layout(device, layouts)),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs_block"),
                compilation_options: options(&constants),
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
                compilation_options: options(&constants),
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
    key: SensorKey,
) -> Vec<wgpu::ComputePipeline> {
    let constants = constants(key);
    let module = module(device, source);
    entries
        .iter()
        .map(|entry| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: Some(layout),
                module: &module,
                entry_point: Some(entry),
                compilation_options: options(&constants),
                cache: None,
            })
        })
        .collect()
}

/// The overrides of surface.wgsl and host.wgsl.
fn constants(key: SensorKey) -> [(&'static str, f64); 6] {
    let needs = key.needs;
    let needed = [
        ("APEXES", needs.apexes),
        ("INNER_CONES", needs.inner_cones),
        ("CORNERS", needs.corners),
        ("ELEVATIONS", needs.elevations),
    ]
    .map(|(name, needed)| (name, f64::from(u8::from(needed))));
    let [parallel, logarithmic] = key.lens.constants();
    let [apexes, inner_cones, corners, elevations] = needed;
    [
        parallel,
        logarithmic,
        apexes,
        inner_cones,
        corners,
        elevations,
    ]
}

fn options<'a>(constants: &'a [(&'a str, f64)]) -> wgpu::PipelineCompilationOptions<'a> {
    wgpu::PipelineCompilationOptions {
        constants,
        ..Default::default()
    }
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
