//! The least that a host does to fill a region: make a renderer, hand it a mesh, and call it three
//! times a frame. This host draws no globe at all: it clears its depth buffer to the distance of the
//! ground, a plane that touches the globe under the camera. Put your engine's globe there.

use glam::{DMat3, DVec3, UVec2, dcamera::rh::proj::directx::perspective_infinite_reverse};
use globefill::{
    Camera, Ellipsoid, FillMesh, FillStyle, Frame, HeightRange, LonLat, MeshOptions, Renderer,
    RendererOptions, View, countries::Dataset, wgpu,
};
use wgpu::TextureUsages as Usage;

const SIZE: UVec2 = UVec2::new(640, 480);
const HEIGHT_M: f64 = 1.6e6;
const NEAR_M: f64 = 1e4;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The host: a device, a colour target, and a depth texture that can also be sampled.
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
        required_features: Renderer::wanted_features() & adapter.features(),
        ..Default::default()
    }))?;
    let options = RendererOptions::default(); // sRGB colour, reversed float depth, one sample
    let color = texture(&device, options.color_format, Usage::COPY_SRC);
    let depth = texture(&device, options.depth_format, Usage::TEXTURE_BINDING);
    let (color_view, depth_view) = (
        color.create_view(&Default::default()),
        depth.create_view(&Default::default()),
    );

    // Once: a renderer, and what is to be filled.
    let mut renderer = Renderer::new(&device, options)?;
    let italy = Dataset::Countries50m
        .country("Italy")
        .ok_or("no such country")?;
    let mesh = FillMesh::build(&[italy.region], &MeshOptions::default())?;
    let italy = renderer.insert(mesh);
    renderer.set_style(
        italy,
        0,
        FillStyle {
            color: [0.1, 0.6, 0.3, 0.8],
            ..Default::default()
        },
    )?;
    let mut view = View::default(); // one for each camera

    // Every frame: the camera (in double precision), and how high the ground reaches.
    let frame = Frame {
        camera: camera(LonLat::new(12.5, 42.0)),
        size_px: SIZE,
        terrain: HeightRange {
            min_m: 0.0,
            max_m: 1e5,
        },
        pixel_error: 0.25,
        host_pixel_error: 0.0,
    };
    let mut encoder = device.create_command_encoder(&Default::default());
    draw_globe(&mut encoder, &color_view, &depth_view);
    let stats = renderer.prepare(&queue, &mut view, &frame)?;
    renderer.count(&view, &mut encoder, &depth_view);
    renderer.resolve(
        &view,
        &mut color_pass(&mut encoder, &color_view, wgpu::LoadOp::Load, None),
    );
    println!("{stats:?}");

    let pixels = read(&device, &queue, encoder, &color)?;
    std::fs::create_dir_all("out")?;
    image::save_buffer(
        "out/embed.png",
        &pixels,
        SIZE.x,
        SIZE.y,
        image::ColorType::Rgba8,
    )?;
    println!("out/embed.png");
    Ok(())
}

/// Looks straight down from above `foot`, north up.
fn camera(foot: LonLat) -> Camera {
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
fn draw_globe(
    encoder: &mut wgpu::CommandEncoder,
    color: &wgpu::TextureView,
    depth: &wgpu::TextureView,
) {
    let ground = wgpu::LoadOp::Clear(wgpu::Color {
        r: 0.02,
        g: 0.05,
        b: 0.12,
        a: 1.0,
    });
    let reversed_depth = (NEAR_M / HEIGHT_M) as f32;
    color_pass(encoder, color, ground, Some((depth, reversed_depth)));
}

fn color_pass<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    color: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
    depth: Option<(&wgpu::TextureView, f32)>,
) -> wgpu::RenderPass<'a> {
    let store = wgpu::StoreOp::Store;
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: color,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load, store },
        })],
        depth_stencil_attachment: depth.map(|(view, clear)| {
            let depth_ops = Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(clear),
                store,
            });
            wgpu::RenderPassDepthStencilAttachment {
                view,
                depth_ops,
                stencil_ops: None,
            }
        }),
        ..Default::default()
    })
}

fn extent() -> wgpu::Extent3d {
    wgpu::Extent3d {
        width: SIZE.x,
        height: SIZE.y,
        depth_or_array_layers: 1,
    }
}

fn texture(device: &wgpu::Device, format: wgpu::TextureFormat, usage: Usage) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: extent(),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: usage | Usage::RENDER_ATTACHMENT,
        view_formats: &[],
    })
}

/// Submits the frame and reads its picture; the width is a multiple of 64, so rows need no padding.
fn read(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    mut encoder: wgpu::CommandEncoder,
    color: &wgpu::Texture,
) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(SIZE.x * SIZE.y * 4),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout {
        bytes_per_row: Some(SIZE.x * 4),
        ..Default::default()
    };
    let target = wgpu::TexelCopyBufferInfo {
        buffer: &buffer,
        layout,
    };
    encoder.copy_texture_to_buffer(color.as_image_copy(), target, extent());
    queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |_| {});
    device.poll(wgpu::PollType::wait_indefinitely())?;
    Ok(buffer.get_mapped_range(..)?.to_vec())
}
