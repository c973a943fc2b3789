//! What `prepare` allocates, counted by a global allocator. Alone in its binary, since others need none.

mod common;

use allocation_counter::measure;
use common::{
    camera,
    draw::COLOR,
    figure::Figure,
    headless::gpu,
    surface::{Cast, DepthKind, Surface, Terrain},
};
use glam::UVec2;
use globefill::{
    Ellipsoid, FieldOfView, FillMesh, FillStyle, Frame, Hatch, HatchKind, LonLat, Pattern, Pose,
    Region, Renderer, RendererOptions, Sensor, SensorStyle, Stroke, View, Zone,
    fill_mesh::MeshOptions,
};

/// A thousand circles all round the globe.
fn circles() -> FillMesh {
    let regions: Vec<Region> = (0..1_000)
        .map(|index| {
            let turn = f64::from(index);
            let lon_deg = 360.0 * (turn * 0.618_034).fract() - 180.0;
            let lat_deg = (2.0 * (turn + 0.5) / 1_000.0 - 1.0).asin().to_degrees();
            Region::from(Zone::circle(LonLat::new(lon_deg, lat_deg), 100_000.0))
        })
        .collect();
    FillMesh::build(&regions, &MeshOptions::default()).expect("circles")
}

#[test]
fn a_still_frame_allocates_and_uploads_nothing() {
    let Some(gpu) = gpu() else { return };
    let figure = Figure::new(Ellipsoid::WGS84);
    let pose = camera::Pose::nadir(11.0, 47.0, 5e6).turned(30.0, -70.0);
    let cast = Cast::new(&figure, &pose, UVec2::new(160, 90), 1, Terrain::Bare);
    let surface = Surface::new(&cast, DepthKind::Reversed);
    let options = RendererOptions {
        color_format: COLOR,
        depth_format: surface.depth_format(),
        ..Default::default()
    };
    let mut renderer = Renderer::new(&gpu.device, options).expect("the options are sound");
    let mesh = renderer.insert(circles());
    let hatched = FillStyle {
        pattern: Some(Pattern::Hatch(Hatch {
            kind: HatchKind::Lines,
            ..Default::default()
        })),
        stroke: Some(Stroke::default()),
        ..Default::default()
    };
    let mut view = View::default();
    let mut frame = Frame::new(surface.lens.camera(), surface.size_px());
    let mut prepare = |renderer: &mut Renderer, frame: &Frame| {
        let mut stats = None;
        let info = measure(|| stats = renderer.prepare(&gpu.queue, &mut view, frame).ok());
        (info.count_total, stats.expect("the frame can be drawn"))
    };
    for scene in ["plain", "hatched, stroked", "with a sensor"] {
        match scene {
            "plain" => {}
            "hatched, stroked" => renderer.set_style(mesh, 7, hatched).expect("fill 7"),
            _ => {
                let pose = Pose::nadir(
                    &Ellipsoid::WGS84,
                    Ellipsoid::WGS84.ecef(LonLat::new(11.0, 47.0), 7e5),
                );
                let cone = FieldOfView::conic(0.4).expect("a cone");
                let sensor = Sensor::new(pose, cone);
                let sensors = renderer.sensors_mut();
                sensors
                    .insert(sensor, SensorStyle::default())
                    .expect("a sensor");
            }
        }
        frame.camera.eye_ecef_m.x += 1_000.0;
        let (first, stats) = prepare(&mut renderer, &frame);
        assert!(first > 0 && stats.upload_bytes > 0 && stats.drawn > 0);
        let (again, stats) = prepare(&mut renderer, &frame);
        println!("{scene}: {first} allocations, then {again}");
        assert_eq!((again, stats.upload_bytes), (0, 0), "{scene}");
    }
}
