//! The edge pass of one frame, and the texels that it leaves.

use crate::{
    FillMesh, FillStyle,
    common::{headless::Gpu, scene::depth_texture, surface::Surface},
    frame::reference::Reference,
    frame::sight_uniform::SightUniform,
    frame::{
        code::Mantissa,
        edge_draws::{EdgeWants, LayerEdges},
        layer_set::LayerSet,
        layers::{Counting, Layer, Layering, Styled},
        select::Selection,
        sight::Sight,
    },
    gpu::{
        count::Drawn,
        edge_pipelines::EdgePipelines,
        edge_view::{EdgeFrame, EdgeSubject, EdgeView, edge_cost},
        gpu_mesh::GpuMesh,
        pipelines::Pipelines,
        surface_binding::{SurfaceBinding, surface_layout},
    },
    options::{Frame, HeightRange, RendererOptions},
    renderer::MeshId,
    view::{MeshView, Upload},
};

/// A texel as stroke.wgsl decodes it.
#[derive(Clone, Copy, Debug)]
pub struct Texel {
    pub signed_m: f64,
    pub across_m: f64,
    pub along_m: f64,
    /// Indices of the fills, plus one.
    pub sides: [u32; 2],
    #[expect(dead_code, reason = "dashes are judged in pictures")]
    pub along: u32,
}

fn half(bits: u32) -> f64 {
    let (exponent, fraction) = (bits >> 10 & 31, f64::from(bits & 1023) / 1024.0);
    let magnitude = if exponent == 0 {
        fraction * 2f64.powi(-14)
    } else {
        (1.0 + fraction) * 2f64.powi(exponent as i32 - 15)
    };
    if bits & 0x8000 == 0 {
        magnitude
    } else {
        -magnitude
    }
}

fn decoded([x, y, z, w]: [u32; 4], layer: &Layer) -> Option<Texel> {
    let side = |id: u32| match id {
        0 => 0,
        id => layer.fills[id as usize - 1].fill + 1,
    };
    (z != 0).then(|| Texel {
        signed_m: f32::from_bits(x).into(),
        across_m: half(y & 0xffff).exp2(),
        along_m: half(y >> 16).exp2(),
        sides: [z & 0xffff, z >> 16].map(side),
        along: w,
    })
}

/// Draws the edges of both fills of a mesh, each asked for as far as `reach` says.
pub fn draw(
    gpu: &Gpu,
    mesh: &FillMesh,
    surface: &Surface,
    reach: [f32; 2],
    mirrored: bool,
) -> Vec<Option<Texel>> {
    let (device, queue) = (&gpu.device, &gpu.queue);
    let options = RendererOptions {
        depth: surface.range.convention(),
        sample_count: surface.samples(),
        ..Default::default()
    };
    let (_texture, depth) = depth_texture(gpu, surface, options.depth_format);
    let (min_m, max_m) = surface.terrain.range_m();
    let mut camera = surface.lens.camera();
    if mirrored {
        camera.clip_from_view.x_axis.x *= -1.0;
    }
    let frame = Frame {
        terrain: HeightRange { min_m, max_m },
        pixel_error: 0.0,
        host_pixel_error: 0.0,
        ..Frame::new(camera, surface.size_px())
    };
    let styles = vec![FillStyle::default(); mesh.fills.len()];
    let styled = [Styled {
        mesh,
        styles: &styles,
    }];
    let layering = Layering::assign(&styled, Counting::Winding, Mantissa::Single).expect("fits");
    let layers: Vec<Option<LayerEdges>> = layering
        .layers
        .iter()
        .map(|layer| {
            let mut reaches = vec![reach; layer.fills.len() + 1];
            reaches[0] = [0.0; 2];
            Some(LayerEdges {
                code: layer.code,
                reaches,
            })
        })
        .collect();
    let sight = Sight::new(mesh.ellipsoid, mesh.sag_m, &frame, &options).expect("valid");
    let uploaded = GpuMesh::new(device, mesh);
    let slots = uploaded.edge_slots(device, mesh);
    let wants = EdgeWants {
        layers: &layers,
        slots: &slots.slots,
    };
    let selection = Selection::of(mesh, layering.coded(0), &sight, &wants);
    let cost = edge_cost(&layers, std::iter::once(&selection));
    println!("{cost:?}, {} refined", selection.patch.chords.len());

    let pipelines = Pipelines::new(device, options);
    let stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
    let layout = surface_layout(device, options.sample_count, stages);
    let mut surface = SurfaceBinding::new(device);
    let reference = Reference::new(sight.ellipsoid, sight.eye_ecef_m);
    let uniform = SightUniform::new(&sight, &reference, options.depth, frame.size_px);
    surface.write(device, queue, &uniform);
    surface.bind(device, &layout, &depth);
    let mut edge_pipelines = EdgePipelines::new(device, &pipelines, &layout, options);
    let mut edges = EdgeView::default();
    let subject = EdgeSubject {
        id: MeshId(0),
        gpu: &uploaded,
        sight: &sight,
        selection: &selection,
    };
    let asked = EdgeFrame {
        size_px: frame.size_px,
        depth: options.depth,
        layers: &layers,
    };
    edges.prepare(device, queue, &mut edge_pipelines, &asked, &[subject]);
    let (again, replaced) = edges.prepare(device, queue, &mut edge_pipelines, &asked, &[subject]);
    assert_eq!((again, replaced), (0, false), "the same frame is free");
    let mut view = MeshView::new(device, &pipelines);
    let to = Upload {
        device,
        queue,
        pipelines: &pipelines,
        mesh: &uploaded,
        weights: None,
    };
    let mut shown = LayerSet::default();
    selection.add_shown(&mut shown);
    view.upload(&to, 0, &sight, selection);
    let mut encoder = device.create_command_encoder(&Default::default());
    let drawn = [Drawn {
        id: MeshId(0),
        gpu: &uploaded,
        view: &view,
    }];
    let surface = surface.group().expect("the depth was bound");
    edges.record(&edge_pipelines, &mut encoder, surface, &drawn, shown);
    queue.submit([encoder.finish()]);
    let target = edges.target(0).expect("edges were asked for");
    read(gpu, target.texture())
        .into_iter()
        .map(|texel| decoded(texel, &layering.layers[0]))
        .collect()
}

fn read(gpu: &Gpu, texture: &wgpu::Texture) -> Vec<[u32; 4]> {
    let size = texture.size();
    let row_bytes = (size.width * 16).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size: u64::from(row_bytes) * u64::from(size.height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row_bytes),
                rows_per_image: None,
            },
        },
        size,
    );
    gpu.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |result| {
        result.expect("the buffer can be mapped");
    });
    gpu.device
        .poll(wgpu::PollType::wait_indefinitely())
        .expect("the device answers");
    let bytes = buffer.get_mapped_range(..).expect("it is mapped");
    bytes
        .chunks_exact(row_bytes as usize)
        .flat_map(|row| {
            row.chunks_exact(16)
                .take(size.width as usize)
                .map(bytemuck::pod_read_unaligned)
        })
        .collect()
}
