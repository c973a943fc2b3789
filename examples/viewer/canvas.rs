//! The textures that a frame is drawn into, before it goes to the window or a file.

use glam::UVec2;
use globefill::{DepthConvention, wgpu};

use crate::host::ground::TargetFormat;

/// Colour and depth of the window's size.
pub struct Canvas {
    pub size_px: UVec2,
    pub color: wgpu::Texture,
    pub depth_view: wgpu::TextureView,
    pub color_view: wgpu::TextureView,
    /// The same texels, for egui, which blends in sRGB itself.
    pub plain_view: wgpu::TextureView,
}

/// Formats of a canvas for a window of some colour format.
pub fn format(color: wgpu::TextureFormat) -> TargetFormat {
    TargetFormat {
        color: color.add_srgb_suffix(),
        depth: wgpu::TextureFormat::Depth32Float,
        convention: DepthConvention::Reversed,
        sample_count: 1,
    }
}

impl Canvas {
    pub fn new(device: &wgpu::Device, format: &TargetFormat, size_px: UVec2) -> Self {
        let plain = format.color.remove_srgb_suffix();
        let texture = |label, format, views: &[wgpu::TextureFormat]| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d {
                    width: size_px.x,
                    height: size_px.y,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING
                    | wgpu::TextureUsages::COPY_SRC,
                view_formats: views,
            })
        };
        let color = texture("canvas", format.color, &[plain]);
        let depth = texture("canvas depth", format.depth, &[]);
        Self {
            size_px,
            color_view: color.create_view(&Default::default()),
            plain_view: color.create_view(&wgpu::TextureViewDescriptor {
                format: Some(plain),
                ..Default::default()
            }),
            depth_view: depth.create_view(&Default::default()),
            color,
        }
    }

    pub fn ground_pass<'a>(&self, encoder: &'a mut wgpu::CommandEncoder) -> wgpu::RenderPass<'a> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("ground"),
            color_attachments: &[Some(attachment(
                &self.color_view,
                wgpu::LoadOp::Clear(wgpu::Color::BLACK),
            ))],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth_view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }

    /// A pass over what is there, without depth.
    pub fn over_pass<'a>(
        view: &wgpu::TextureView,
        encoder: &'a mut wgpu::CommandEncoder,
    ) -> wgpu::RenderPass<'a> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("over"),
            color_attachments: &[Some(attachment(view, wgpu::LoadOp::Load))],
            ..Default::default()
        })
    }
}

fn attachment(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load,
            store: wgpu::StoreOp::Store,
        },
    }
}
