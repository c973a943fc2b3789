//! What surface.wgsl reads: the host's depth and the camera that it was drawn with.

use crate::{
    frame::sight_uniform::SightUniform, gpu::count::depth_only, gpu::pipelines::layout,
    gpu::stream_buffer::StreamBuffer,
};

/// The camera's buffer, and its bind group with the depth last seen.
pub(crate) struct SurfaceBinding {
    sight: StreamBuffer,
    bound: Option<(wgpu::TextureView, wgpu::BindGroup)>,
}

/// The layout of the bind group.
pub(crate) fn surface_layout(
    device: &wgpu::Device,
    sample_count: u32,
    stages: wgpu::ShaderStages,
) -> wgpu::BindGroupLayout {
    let depth = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: sample_count > 1,
    };
    let sight = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    layout(device, "globefill surface", stages, &[depth, sight])
}

impl SurfaceBinding {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        Self {
            sight: StreamBuffer::new(device, "globefill sight", wgpu::BufferUsages::UNIFORM),
            bound: None,
        }
    }

    /// Uploads the camera if it changed; returns the bytes. The buffer never grows, so what is bound
    /// stays.
    pub(crate) fn write(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        sight: &SightUniform,
    ) -> u64 {
        self.sight.write(device, queue, bytemuck::bytes_of(sight)).0
    }

    /// Binds a depth.
    pub(crate) fn bind(
        &mut self,
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        depth: &wgpu::TextureView,
    ) {
        if self.bound.as_ref().is_some_and(|(view, _)| view == depth) {
            return;
        }
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("globefill surface"),
            layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(&depth_only(depth)),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: self.sight.buffer.as_entire_binding(),
                },
            ],
        });
        self.bound = Some((depth.clone(), group));
    }

    /// The bind group with the depth last bound.
    pub(crate) fn group(&self) -> Option<&wgpu::BindGroup> {
        self.bound.as_ref().map(|(_, group)| group)
    }
}
