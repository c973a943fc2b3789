//! Stands for your application: it owns the device, draws a globe into colour and depth, and knows
//! nothing of fills. Without a window; the picture becomes a file.

use std::error::Error;

use glam::{DMat3, DMat4, DVec3, UVec2, dcamera::rh::proj::directx::perspective_infinite_reverse};
use wgpu::{TextureFormat, TextureUsages as Usage};

/// Pixels of the picture.
pub const SIZE: UVec2 = UVec2::new(640, 480);
pub const COLOR: TextureFormat = TextureFormat::Rgba8UnormSrgb;
pub const DEPTH: TextureFormat = TextureFormat::Depth32Float;

const NEAR_M: f64 = 1e4;
/// WGS84, metres.
const RADII_M: DVec3 = DVec3::new(6_378_137.0, 6_378_137.0, 6_356_752.314_245_179);

/// Device, targets and the globe.
pub struct Host {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub depth_view: wgpu::TextureView,
    color: wgpu::Texture,
    color_view: wgpu::TextureView,
    globe: wgpu::RenderPipeline,
}

/// Where the camera is, metres from the Earth's centre; how it is turned; its projection.
pub struct Eye {
    pub position_m: DVec3,
    pub view_from_ecef: DMat3,
    pub clip_from_view: DMat4,
}

impl Host {
    /// Opens the first adapter with what it has of the wanted features.
    pub fn open(wanted: wgpu::Features) -> Result<Self, Box<dyn Error>> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
        let (device, queue) =
            pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
                required_features: wanted & adapter.features(),
                ..Default::default()
            }))?;
        let color = texture(&device, COLOR, Usage::COPY_SRC);
        let depth = texture(&device, DEPTH, Usage::TEXTURE_BINDING);
        Ok(Self {
            depth_view: depth.create_view(&Default::default()),
            color_view: color.create_view(&Default::default()),
            globe: globe(&device),
            color,
            device,
            queue,
        })
    }

    /// Above Italy, looking down, north up.
    pub fn eye(&self) -> Eye {
        let (lon, lat) = (12.5_f64.to_radians(), 42_f64.to_radians());
        let up = DVec3::new(lat.cos() * lon.cos(), lat.cos() * lon.sin(), lat.sin());
        let east = DVec3::Z.cross(up).normalize();
        let aspect = f64::from(SIZE.x) / f64::from(SIZE.y);
        Eye {
            position_m: 8e6 * up,
            view_from_ecef: DMat3::from_cols(east, up.cross(east), up).transpose(),
            clip_from_view: perspective_infinite_reverse(60_f64.to_radians(), aspect, NEAR_M),
        }
    }

    /// The globe, into colour and depth.
    pub fn draw_globe(&self, encoder: &mut wgpu::CommandEncoder) {
        let uniform = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&uniform, 0, &self.sight());
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.globe.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: uniform.as_entire_binding(),
            }],
        });
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth_view,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0.0),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        };
        let black = wgpu::LoadOp::Clear(wgpu::Color::BLACK);
        let mut pass = self.begin(encoder, black, Some(depth));
        pass.set_pipeline(&self.globe);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }

    /// A pass over the picture as it is, without depth.
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

    /// `Sight` of globe.wgsl.
    fn sight(&self) -> Vec<u8> {
        let eye = self.eye();
        let ahead = [
            eye.clip_from_view.x_axis.x,
            eye.clip_from_view.y_axis.y,
            -1.0,
        ];
        let view_from_clip = DMat3::from_diagonal(DVec3::from_array(ahead).recip());
        let scale = DMat3::from_diagonal(RADII_M.recip());
        let directions = scale * eye.view_from_ecef.transpose() * view_from_clip;
        let columns = [
            directions.x_axis.extend(0.0),
            directions.y_axis.extend(0.0),
            directions.z_axis.extend(0.0),
            (eye.position_m / RADII_M).extend(NEAR_M),
        ];
        let numbers = columns.iter().flat_map(|it| it.as_vec4().to_array());
        numbers.flat_map(f32::to_le_bytes).collect()
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

fn globe(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let shader = device.create_shader_module(wgpu::include_wgsl!("globe.wgsl"));
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("globe"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &shader,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[],
        },
        fragment: Some(wgpu::FragmentState {
            module: &shader,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(COLOR.into())],
        }),
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        multiview_mask: None,
        cache: None,
    })
}

fn texture(device: &wgpu::Device, format: TextureFormat, usage: Usage) -> wgpu::Texture {
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
