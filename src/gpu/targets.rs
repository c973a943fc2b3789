//! The textures of one view: winding planes of each layer, and depth-stencil where it is counted so.

use glam::UVec2;

use crate::{
    frame::code::MAX_PLANES,
    frame::layers::Counting,
    gpu::fixed_function::copy_format,
    gpu::layer_tables::LayerTable,
    gpu::pipelines::{Pipelines, ResolveKey},
    gpu::planes::Planes,
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
    pub layers: Vec<LayerTarget>,
    /// What the ids in the layers mean.
    pub pick: Pick,
    /// The copy of the host's depth.
    pub copy: Option<wgpu::TextureView>,
}

/// Winding planes of one layer.
pub(crate) struct LayerTarget {
    pub planes: Vec<wgpu::TextureView>,
    pub resolve_group: wgpu::BindGroup,
    pub resolve_key: ResolveKey,
}

impl Targets {
    pub(crate) fn new(
        device: &wgpu::Device,
        pipelines: &Pipelines,
        sample_count: u32,
        layer_tables: &[LayerTable],
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
        let layers = key
            .planes
            .iter()
            .zip(layer_tables)
            .map(|(planes, table)| {
                let planes: Vec<_> = planes
                    .formats(sample_count)
                    .into_iter()
                    .map(|format| {
                        let usage = attachment | wgpu::TextureUsages::TEXTURE_BINDING;
                        texture("globefill winding", format, usage)
                    })
                    .collect();
                let resolve_group = resolve_group(device, pipelines, sample_count, table, &planes);
                LayerTarget {
                    planes,
                    resolve_group,
                    resolve_key: table.key,
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
            pick,
            copy,
        }
    }
}

fn resolve_group(
    device: &wgpu::Device,
    pipelines: &Pipelines,
    sample_count: u32,
    table: &LayerTable,
    planes: &[wgpu::TextureView],
) -> wgpu::BindGroup {
    let tables = [&table.head, &table.packed, &table.colors].map(wgpu::Buffer::as_entire_binding);
    let mut entries: Vec<_> = (0..)
        .zip(tables)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
        .collect();
    // The shader masks planes that the code does not have; any texture does for them.
    let bound = if sample_count > 1 { MAX_PLANES } else { 1 };
    entries.extend((0..bound).map(|plane| wgpu::BindGroupEntry {
        binding: plane + 3,
        resource: wgpu::BindingResource::TextureView(
            &planes[(plane as usize).min(planes.len() - 1)],
        ),
    }));
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("globefill resolve"),
        layout: &pipelines.resolve_layout,
        entries: &entries,
    })
}
