//! A host without a window. It draws no globe at all: it clears its depth to the distance of the
//! ground, a plane that touches the globe under the camera. Your engine's globe goes there.

use std::error::Error;

use glam::{DMat3, DVec3, UVec2, dcamera::rh::proj::directx::perspective_infinite_reverse};
use globefill::{Camera, Ellipsoid, LonLat, RendererOptions, wgpu};
use wgpu::TextureUsages as Usage;

/// Pixels of the picture.
pub const SIZE: UVec2 = UVec2::new(640, 480);
const HEIGHT_M: f64 = 1.6e6;
const NEAR_M: f64 = 1e4;

/// Device and targets.
pub struct Host {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub depth_view: wgpu::TextureView,
    color: wgpu::Texture,
    color_view: wgpu::TextureView,
}

impl Host {
    /// Opens the first adapter with what it has of the wanted features.
    pub fn open(wanted: wgpu::Features, options: &RendererOptions) -> Result<Self, Box<dyn Error>> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
        let (device, queue) =
            pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
                required_features: wanted & adapter.features(),
                ..Default::default()
            }))?;
        let color = texture(&device, options.color_format, Usage::COPY_SRC);
        let depth = texture(&device, options.depth_format, Usage::TEXTURE_BINDING);
        Ok(Self {
            depth_view: depth.create_view(&Default::default()),
            color_view: color.create_view(&Default::default()),
            color,
            device,
            queue,
        })
    }

    /// Looks straight down on Italy, north up.
    pub fn camera(&self) -> Camera {
        let foot = LonLat::new(12.5, 42.0);
        let up = Ellipsoid::WGS84.normal(foot);
        let east = DVec3::Z.cross(up).normalize();
        let aspect = f64::from(SIZE.x) / f64::from(SIZE.y);
        Camera {
            eye_ecef_m: Ellipsoid::WGS84.ecef(foot, HEIGHT_M),
            view_from_ecef: DMat3::from_cols(east, up.cross(east), up).transpose(),
            clip_from_view: perspective_infinite_reverse(60_f64.to_radians(), aspect, NEAR_M),
        }
    }

    /// Stands in for the host's own drawing.
    pub fn draw_globe(&self, encoder: &mut wgpu::CommandEncoder) {
        let ground = wgpu::Color {
            r: 0.02,
            g: 0.05,
            b: 0.12,
            a: 1.0,
        };
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth_view,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear((NEAR_M / HEIGHT_M) as f32),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        };
        self.begin(encoder, wgpu::LoadOp::Clear(ground), Some(depth));
    }

    /// The pass that the fills are resolved in.
    pub fn color_pass<'a>(&self, encoder: &'a mut wgpu::CommandEncoder) -> wgpu::RenderPass<'a> {
        self.begin(encoder, wgpu::LoadOp::Load, None)
    }

    fn begin<'a>(
        &self,
        encoder: &'a mut wgpu::CommandEncoder,
        load: wgpu::LoadOp<wgpu::Color>,
        depth_stencil_attachment: Option<wgpu::RenderPassDepthStencilAttachment<'_>>,
    ) -> wgpu::RenderPass<'a> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.color_view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load,
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment,
            ..Default::default()
        })
    }

    /// Submits the frame and writes its picture; the width is a multiple of 64, so rows need no
    /// padding.
    pub fn save(
        &self,
        mut encoder: wgpu::CommandEncoder,
        path: &str,
    ) -> Result<(), Box<dyn Error>> {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(SIZE.x * SIZE.y * 4),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let target = wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                bytes_per_row: Some(SIZE.x * 4),
                ..Default::default()
            },
        };
        encoder.copy_texture_to_buffer(self.color.as_image_copy(), target, self.color.size());
        self.queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        let pixels = buffer.get_mapped_range(..)?.to_vec();
        std::fs::create_dir_all("out")?;
        image::save_buffer(path, &pixels, SIZE.x, SIZE.y, image::ColorType::Rgba8)?;
        println!("{path}");
        Ok(())
    }
}

fn texture(device: &wgpu::Device, format: wgpu::TextureFormat, usage: Usage) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: SIZE.x,
            height: SIZE.y,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: usage | Usage::RENDER_ATTACHMENT,
        view_formats: &[],
    })
}
