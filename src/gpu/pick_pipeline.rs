//! Asking the counted layers of a view about one pixel; compiled when first asked.

use std::sync::OnceLock;

use glam::UVec2;
use wgpu::util::BufferInitDescriptor;

use crate::{
    frame::layers::MAX_LAYERS, gpu::filled_buffer::FilledBuffer as _, gpu::pipelines::layout,
    gpu::targets::LayerTarget, shaders,
};

/// The head of `Answer` in pick.wgsl; an id for each layer follows.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct AnswerHead {
    pub pixel: [u32; 2],
    pub layers: u32,
    pub unused: u32,
}

/// Where the ids start, bytes.
pub(crate) const IDS_AT: u64 = size_of::<AnswerHead>() as u64;

pub(crate) struct PickPipeline {
    layout: wgpu::PipelineLayout,
    module: wgpu::ShaderModule,
    /// By bits of checks in the plane of ids, as in [`LayerTarget::joined`].
    made: [OnceLock<wgpu::ComputePipeline>; 8],
    answer_layout: wgpu::BindGroupLayout,
}

impl PickPipeline {
    pub(crate) fn new(
        device: &wgpu::Device,
        resolve_layout: &wgpu::BindGroupLayout,
        sample_count: u32,
    ) -> Self {
        let written = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: false },
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let compute = wgpu::ShaderStages::COMPUTE;
        let answer_layout = layout(device, "globefill pick", compute, &[written]);
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("globefill pick"),
            bind_group_layouts: &[Some(resolve_layout), Some(&answer_layout)],
            immediate_size: 0,
        });
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("globefill pick"),
            source: wgpu::ShaderSource::Wgsl(shaders::pick(sample_count).into()),
        });
        Self {
            layout: pipeline_layout,
            module,
            made: Default::default(),
            answer_layout,
        }
    }

    fn pipeline(&self, device: &wgpu::Device, joined: u32) -> &wgpu::ComputePipeline {
        self.made[joined as usize].get_or_init(|| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some("globefill pick"),
                layout: Some(&self.layout),
                module: &self.module,
                entry_point: Some("cs_pick"),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &[("JOINED", joined.into())],
                    ..Default::default()
                },
                cache: None,
            })
        })
    }

    /// Records the question; returns the buffer that will hold the ids from [`IDS_AT`] on.
    pub(crate) fn ask(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        layers: &[&LayerTarget],
        pixel: UVec2,
    ) -> wgpu::Buffer {
        let head = AnswerHead {
            pixel: pixel.to_array(),
            ..Default::default()
        };
        let mut contents = bytemuck::bytes_of(&head).to_vec();
        contents.resize(contents.len() + 4 * MAX_LAYERS, 0);
        let answer = device.filled_buffer(&BufferInitDescriptor {
            label: Some("globefill pick"),
            contents: &contents,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("globefill pick"),
            layout: &self.answer_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: answer.as_entire_binding(),
            }],
        });
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("globefill pick"),
            timestamp_writes: None,
        });
        pass.set_bind_group(1, &group, &[]);
        for layer in layers {
            pass.set_pipeline(self.pipeline(device, layer.joined));
            pass.set_bind_group(0, &layer.resolve_group, &[]);
            pass.dispatch_workgroups(1, 1, 1);
        }
        drop(pass);
        answer
    }
}
