//! Lost devices: everything is dropped and made again from the same meshes.

use globefill::{
    Align, Ellipsoid, FieldOfView, FillStyle, Frame, Length, LonLat, Pose, Sensor, SensorStyle,
    Stroke, View, wgpu,
};

use crate::{
    common::{
        draw::{COLOR, IdPainter},
        headless::{Gpu, gpu_without},
        surface::{DepthKind, Surface, Terrain},
    },
    gate::{Subject, TECHNIQUES, cast},
};

fn open() -> Option<Gpu> {
    gpu_without(wgpu::Features::empty())
}

/// The host destroys its device, as losing it does, and goes on for a while before it notices: nothing
/// panics that it does not provoke. Then it makes all again; meshes are on the CPU and may be kept.
#[test]
fn a_lost_device_is_replaced() {
    let subject = Subject::pair();
    let pose = subject.pose(Terrain::Bare, 5e3);
    let surface = Surface::new(&cast(&pose, Terrain::Bare), DepthKind::Reversed);
    for count in TECHNIQUES {
        let Some(first) = open() else { return };
        // What a lost device reports is the host's to hear: without a handler it panics.
        first
            .device
            .on_uncaptured_error(std::sync::Arc::new(|_| ()));
        let mut painter = IdPainter::new(&first, subject.mesh.clone(), &surface, count);
        let mut view = View::default();
        let before = painter.draw(&first, &mut view, &surface, 0.0);
        assert!(before.ids.contains(&1) && before.ids.contains(&2));
        first.device.destroy();
        go_on(&mut painter, &first, &mut view, &surface);
        drop((painter, view, first));

        let Some(second) = open() else { return };
        let mut painter = IdPainter::new(&second, subject.mesh.clone(), &surface, count);
        let after = painter.draw(&second, &mut View::default(), &surface, 0.0);
        assert!(after.ids == before.ids);
        assert_eq!(after.stats, before.stats);
    }
}

/// Frames of a host that has not noticed yet, and that asks for what takes new buffers and pipelines.
fn go_on(painter: &mut IdPainter, gpu: &Gpu, view: &mut View, surface: &Surface) {
    let renderer = &mut painter.renderer;
    let style = FillStyle {
        stroke: Some(Stroke {
            color: [1.0; 4],
            width: Length::Pixels(3.0),
            align: Align::Center,
            dash: None,
        }),
        ..Default::default()
    };
    renderer
        .set_style(painter.mesh, 0, style)
        .expect("the fill exists");
    let apex_m = Ellipsoid::WGS84.ecef(LonLat::new(11.0, 47.0), 5e5);
    let sensor = Sensor::new(
        Pose::nadir(&Ellipsoid::WGS84, apex_m),
        FieldOfView::conic(0.1).expect("a sound angle"),
    );
    renderer
        .sensors_mut()
        .insert(sensor, SensorStyle::default())
        .expect("a sound sensor");
    for height in [180, 90] {
        let (width, format) = (320, surface.depth_format());
        let texture = |format, usage| {
            let size = wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            };
            let made = gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            });
            made.create_view(&Default::default())
        };
        let depth = texture(format, wgpu::TextureUsages::TEXTURE_BINDING);
        let target = texture(COLOR, wgpu::TextureUsages::COPY_SRC);
        let frame = Frame::new(surface.lens.camera(), glam::UVec2::new(width, height));
        renderer
            .prepare(&gpu.queue, view, &frame)
            .expect("the frame is sound");
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        renderer.count(view, &mut encoder, &depth);
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &target,
                    depth_slice: None,
                    resolve_target: None,
                    ops: Default::default(),
                })],
                ..Default::default()
            });
            renderer.resolve(view, &mut pass);
        }
        gpu.queue.submit([encoder.finish()]);
    }
}
