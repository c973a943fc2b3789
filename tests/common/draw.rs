//! Draws fills over a surface through the façade and reads back which fill each pixel shows.

use globefill::{
    CountTechnique, FillMesh, FillStyle, Frame, FrameStats, HeightRange, MeshId, Renderer,
    RendererOptions, View, wgpu,
};

use super::{
    headless::{Gpu, read_texture},
    scene::depth_texture,
    surface::Surface,
};

pub const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// A renderer whose fills are painted with their number.
pub struct IdPainter {
    pub renderer: Renderer,
    pub mesh: MeshId,
    pub options: RendererOptions,
}

/// A picture: for each pixel fill + 1, or 0; what is no id shows as `u32::MAX`.
pub struct Picture {
    pub ids: Vec<u32>,
    pub stats: FrameStats,
}

impl IdPainter {
    pub fn new(gpu: &Gpu, mesh: FillMesh, surface: &Surface, count: CountTechnique) -> Self {
        let options = RendererOptions {
            color_format: COLOR,
            depth_format: surface.depth_format(),
            depth: surface.range.convention(),
            sample_count: surface.samples(),
            count,
            ..Default::default()
        };
        let mut renderer = Renderer::new(&gpu.device, options).expect("the options are sound");
        let fills = mesh.fills.len() as u32;
        let mesh = renderer.insert(mesh);
        for fill in 0..fills {
            let style = FillStyle {
                color: id_color(fill + 1),
                ..Default::default()
            };
            renderer
                .set_style(mesh, fill, style)
                .expect("the fill exists");
        }
        Self {
            renderer,
            mesh,
            options,
        }
    }

    /// One frame of a view.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        view: &mut View,
        surface: &Surface,
        pixel_error: f64,
    ) -> Picture {
        let painted = paint(
            gpu,
            &mut self.renderer,
            &self.options,
            view,
            surface,
            pixel_error,
        );
        Picture {
            ids: painted.texels.into_iter().map(id_of_color).collect(),
            stats: painted.stats,
        }
    }
}

/// What a renderer left in the host's colour target.
pub struct Painted {
    pub texels: Vec<[u8; 4]>,
    pub stats: FrameStats,
}

/// One frame of a host that shows nothing but what the renderer draws.
pub fn paint(
    gpu: &Gpu,
    renderer: &mut Renderer,
    options: &RendererOptions,
    view: &mut View,
    surface: &Surface,
    pixel_error: f64,
) -> Painted {
    let (_, depth) = depth_texture(gpu, surface, options.depth_format);
    let frame = frame_of(surface, pixel_error);
    let stats = renderer
        .prepare(&gpu.queue, view, &frame)
        .expect("the frame can be drawn");
    let target = color_texture(gpu, surface, 1);
    let target_view = target.create_view(&Default::default());
    let multisampled = (surface.samples() > 1)
        .then(|| color_texture(gpu, surface, surface.samples()).create_view(&Default::default()));
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    renderer.count(view, &mut encoder, &depth);
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("host colour"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: multisampled.as_ref().unwrap_or(&target_view),
                depth_slice: None,
                resolve_target: multisampled.is_some().then_some(&target_view),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        renderer.resolve(view, &mut pass);
    }
    gpu.queue.submit([encoder.finish()]);
    Painted {
        texels: read_texture(gpu, &target, wgpu::TextureAspect::All),
        stats,
    }
}

/// What a host says of a frame that shows the surface.
pub fn frame_of(surface: &Surface, pixel_error: f64) -> Frame {
    let (min_m, max_m) = surface.terrain.range_m();
    Frame {
        camera: surface.lens.camera(),
        size_px: surface.size_px(),
        terrain: HeightRange { min_m, max_m },
        pixel_error,
        host_pixel_error: 0.0,
        log_depth: surface.lens.log_depth,
    }
}

fn color_texture(gpu: &Gpu, surface: &Surface, sample_count: u32) -> wgpu::Texture {
    let (width, height) = surface.size_px().into();
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("host colour"),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format: COLOR,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// An opaque colour for an id below 65 536: the low byte in red, the high one in green.
pub fn id_color(id: u32) -> [f32; 4] {
    let part = |byte: u32| (byte & 255) as f32 / 255.0;
    [part(id), part(id >> 8), 0.0, 1.0]
}

pub fn id_of_color([red, green, blue, alpha]: [u8; 4]) -> u32 {
    match (blue, alpha) {
        (0, 255) => u32::from(red) + 256 * u32::from(green),
        (0, 0) if red == 0 && green == 0 => 0,
        _ => u32::MAX,
    }
}
