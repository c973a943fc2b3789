//! Textures that a frame is drawn into.

use glam::UVec2;
use globefill::wgpu;

use super::{
    gpu::Gpu,
    ground::{Ground, GroundPipelines, TargetFormat},
    picture::extent,
};

/// Colour and depth of one frame.
pub struct Targets {
    pub format: TargetFormat,
    /// One sample a pixel: what is read back.
    pub color: wgpu::Texture,
    pub depth: wgpu::Texture,
    pub depth_view: wgpu::TextureView,
    color_view: wgpu::TextureView,
    multisampled_view: Option<wgpu::TextureView>,
    clear_depth: f32,
}

impl Targets {
    pub fn new(
        gpu: &Gpu,
        size_px: UVec2,
        format: TargetFormat,
        clear_depth: f32,
    ) -> Result<Self, String> {
        let limit = gpu.device.limits().max_texture_dimension_2d;
        if size_px.max_element() > limit {
            return Err(format!(
                "--size {}x{}: this graphics adapter draws at most {limit} pixels each way",
                size_px.x, size_px.y
            ));
        }
        gpu.allocate("pictures of this size", || {
            let texture = |label, format, sample_count| {
                gpu.device.create_texture(&wgpu::TextureDescriptor {
                    label: Some(label),
                    size: extent(size_px),
                    mip_level_count: 1,
                    sample_count,
                    dimension: wgpu::TextureDimension::D2,
                    format,
                    usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                        | wgpu::TextureUsages::TEXTURE_BINDING
                        | wgpu::TextureUsages::COPY_SRC
                        | wgpu::TextureUsages::COPY_DST,
                    view_formats: &[],
                })
            };
            let color = texture("colour", format.color, 1);
            let depth = texture("depth", format.depth, format.sample_count);
            let multisampled = (format.sample_count > 1)
                .then(|| texture("multisampled colour", format.color, format.sample_count));
            Self {
                format,
                color_view: color.create_view(&Default::default()),
                depth_view: depth.create_view(&Default::default()),
                multisampled_view: multisampled
                    .map(|texture| texture.create_view(&Default::default())),
                color,
                depth,
                clear_depth,
            }
        })
    }

    /// Records the ground. `is_last` says that nothing more is drawn into this frame.
    pub fn draw_ground(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        ground: &Ground,
        pipelines: &GroundPipelines,
        is_last: bool,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("ground"),
            color_attachments: &[Some(
                self.color_attachment(wgpu::LoadOp::Clear(wgpu::Color::BLACK), is_last),
            )],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth_view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(self.clear_depth),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        ground.draw(pipelines, &mut pass);
    }

    /// Begins the pass that the fills resolve into: colour only.
    pub fn fill_pass<'a>(
        &self,
        encoder: &'a mut wgpu::CommandEncoder,
        load: wgpu::LoadOp<wgpu::Color>,
    ) -> wgpu::RenderPass<'a> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("fills"),
            color_attachments: &[Some(self.color_attachment(load, true))],
            ..Default::default()
        })
    }

    /// Begins a pass for what lies on the ground: colour, and the ground's depth read-only.
    pub fn surface_pass<'a>(
        &self,
        encoder: &'a mut wgpu::CommandEncoder,
        load: wgpu::LoadOp<wgpu::Color>,
    ) -> wgpu::RenderPass<'a> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("surface"),
            color_attachments: &[Some(self.color_attachment(load, true))],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth_view,
                depth_ops: None,
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }

    fn color_attachment(
        &self,
        load: wgpu::LoadOp<wgpu::Color>,
        is_last: bool,
    ) -> wgpu::RenderPassColorAttachment<'_> {
        wgpu::RenderPassColorAttachment {
            view: self.multisampled_view.as_ref().unwrap_or(&self.color_view),
            depth_slice: None,
            resolve_target: match &self.multisampled_view {
                Some(_) if is_last => Some(&self.color_view),
                _ => None,
            },
            ops: wgpu::Operations {
                load,
                store: wgpu::StoreOp::Store,
            },
        }
    }
}
