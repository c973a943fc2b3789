//! The host's frame: writes a surface's depths into a depth texture.

use globefill::wgpu;

use super::{
    headless::{Gpu, read_texture},
    surface::Surface,
};

const WRITE_DEPTH: &str = "
@group(0) @binding(0) var depths: texture_2d_array<f32>;

@vertex fn corner(@builtin(vertex_index) k: u32) -> @builtin(position) vec4<f32> {
    return vec4(f32(k & 1u) * 4.0 - 1.0, f32(k >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment fn write(
    @builtin(position) at: vec4<f32>,
    @builtin(sample_index) sample: u32,
) -> @builtin(frag_depth) f32 {
    return textureLoad(depths, vec2<i32>(at.xy), i32(sample), 0).r;
}
";

/// A depth texture that holds exactly the surface's depths, and its view.
pub fn depth_texture(
    gpu: &Gpu,
    surface: &Surface,
    format: wgpu::TextureFormat,
) -> (wgpu::Texture, wgpu::TextureView) {
    let source = upload(gpu, surface);
    let (width, height) = surface.size_px().into();
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("host depth"),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: surface.samples(),
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = texture.create_view(&Default::default());
    let pipeline = pipeline(gpu, format, surface.samples());
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("depths"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::TextureView(&source),
        }],
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("host globe"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(surface.range.cleared()),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
    gpu.queue.submit([encoder.finish()]);
    (texture, view)
}

fn upload(gpu: &Gpu, surface: &Surface) -> wgpu::TextureView {
    let (width, height) = surface.size_px().into();
    let size = wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: surface.samples(),
    };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("depths"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    gpu.queue.write_texture(
        texture.as_image_copy(),
        bytemuck::cast_slice(&surface.depths),
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * width),
            rows_per_image: Some(height),
        },
        size,
    );
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

fn pipeline(gpu: &Gpu, format: wgpu::TextureFormat, samples: u32) -> wgpu::RenderPipeline {
    let module = gpu
        .device
        .create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("write depth"),
            source: wgpu::ShaderSource::Wgsl(WRITE_DEPTH.into()),
        });
    gpu.device
        .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("write depth"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState {
                count: samples,
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("write"),
                compilation_options: Default::default(),
                targets: &[],
            }),
            multiview_mask: None,
            cache: None,
        })
}

/// The depths a single-sampled `Depth32Float` texture holds, row after row.
pub fn read_depths(gpu: &Gpu, texture: &wgpu::Texture) -> Vec<f32> {
    read_texture(gpu, texture, wgpu::TextureAspect::DepthOnly)
        .into_iter()
        .map(f32::from_ne_bytes)
        .collect()
}
