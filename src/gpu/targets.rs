//! The textures of one view: winding planes of each layer, and depth-stencil where it is counted so.

use glam::UVec2;

use crate::{
    frame::code::MAX_PLANES,
    frame::layers::Counting,
    gpu::fixed_function::copy_format,
    gpu::layer_tables::LayerTables,
    gpu::pipelines::{FIRST_PLANE, Key, Pipelines},
    gpu::planes::Planes,
    gpu::stream_buffer::StreamBuffer,
    pick::Pick,
};

/// What targets depend on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TargetsKey {
    pub size_px: UVec2,
    /// Planes of each layer.
    pub planes: Vec<Planes>,
    /// Whether the host's depth is copied, and that beside a stencil.
    pub copied: Option<Copied>,
    /// Which layer tables the bind groups refer to.
    pub layer_revision: (u64, Counting),
}

/// A copy of the host's depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Copied {
    /// By itself.
    Alone,
    /// With a stencil that counts layers.
    WithStencil,
}

/// Textures of one view.
pub(crate) struct Targets {
    pub key: TargetsKey,
    /// Those of ids, the lowest first; behind them that of a mixture.
    pub layers: Vec<LayerTarget>,
    /// Of a mixture: `Mixture` of resolve_mixture.wgsl.
    pub mixture: Option<StreamBuffer>,
    /// What the ids in the layers mean.
    pub pick: Pick,
    /// The copy of the host's depth.
    pub copy: Option<wgpu::TextureView>,
}

/// Winding planes of one layer.
pub(crate) struct LayerTarget {
    pub planes: Vec<wgpu::TextureView>,
    /// As in [`Planes`].
    pub joined: u32,
    pub resolve_group: wgpu::BindGroup,
    /// The pipeline that resolves it where plain colours do.
    pub resolved_by: Key,
}

impl Targets {
    pub(crate) fn new(
        device: &wgpu::Device,
        pipelines: &Pipelines,
        sample_count: u32,
        tables: &LayerTables,
        pick: Pick,
        key: TargetsKey,
    ) -> Self {
        let texture = |label, format, usage| {
            device
                .create_texture(&wgpu::TextureDescriptor {
                    label: Some(label),
                    size: wgpu::Extent3d {
                        width: key.size_px.x,
                        height: key.size_px.y,
                        depth_or_array_layers: 1,
                    },
                    mip_level_count: 1,
                    sample_count,
                    dimension: wgpu::TextureDimension::D2,
                    format,
                    usage,
                    view_formats: &[],
                })
                .create_view(&wgpu::TextureViewDescriptor::default())
        };
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let joined: Vec<u32> = key.planes.iter().map(|planes| planes.joined).collect();
        let mixture = tables.layering.mixture.as_ref().map(|_| {
            let usage = wgpu::BufferUsages::UNIFORM;
            StreamBuffer::new(device, "globefill mixture", usage)
        });
        let layers = (0..)
            .zip(&key.planes)
            .zip(tables.resolved_by(&joined))
            .map(|((index, planes), resolved_by)| {
                let joined = planes.joined;
                let formats = planes.formats(sample_count).into_iter();
                let usage = attachment | wgpu::TextureUsages::TEXTURE_BINDING;
                let planes: Vec<_> = formats
                    .map(|format| texture("globefill winding", format, usage))
                    .collect();
                let (layout, buffers) = match tables.tables.get::<usize>(index) {
                    Some(table) => (
                        &pipelines.resolve_layout,
                        vec![&table.head, &table.packed, &table.colors],
                    ),
                    None => (
                        &pipelines.mixture_layout,
                        mixture.iter().map(|stream| &stream.buffer).collect(),
                    ),
                };
                LayerTarget {
                    resolve_group: resolve_group(device, layout, sample_count, &buffers, &planes),
                    planes,
                    joined,
                    resolved_by,
                }
            })
            .collect();
        let copy = key.copied.map(|copied| {
            let format = copy_format(copied == Copied::WithStencil);
            texture("globefill depth", format, attachment)
        });
        Self {
            key,
            layers,
            mixture,
            pick,
            copy,
        }
    }
}

fn resolve_group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    sample_count: u32,
    buffers: &[&wgpu::Buffer],
    planes: &[wgpu::TextureView],
) -> wgpu::BindGroup {
    let mut entries: Vec<_> = (0..)
        .zip(buffers)
        .map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    // The shader masks planes that the code does not have; any texture does for them.
    let bound = if sample_count > 1 { MAX_PLANES } else { 1 };
    entries.extend((0..bound).map(|plane| wgpu::BindGroupEntry {
        binding: FIRST_PLANE + plane,
        resource: wgpu::BindingResource::TextureView(
            &planes[(plane as usize).min(planes.len() - 1)],
        ),
    }));
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("globefill resolve"),
        layout,
        entries: &entries,
    })
}
