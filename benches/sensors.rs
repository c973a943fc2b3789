//! What sensors cost before the GPU, a thousand at a time: moving them, preparing a frame, asking which
//! cover a point.
//!
//! `cargo bench --bench sensors`

use criterion::{Criterion, criterion_group, criterion_main};
use globefill::{
    Camera, Ellipsoid, FieldOfView, Frame, LonLat, Pose, Renderer, RendererOptions, Sensor,
    SensorId, SensorSet, SensorStyle, View,
    glam::{DMat3, DVec3, UVec2, dcamera::rh::proj::directx::perspective_infinite_reverse},
    wgpu,
};

const COUNT: usize = 1000;

/// Evenly spread at 550 km, looking down.
fn pose(k: usize, shift_deg: f64) -> Pose {
    let part = (k as f64 + 0.5) / COUNT as f64;
    let at = LonLat::new(
        137.507_764 * k as f64 + shift_deg,
        (1.0 - 2.0 * part).asin().to_degrees(),
    );
    Pose::nadir(&Ellipsoid::WGS84, Ellipsoid::WGS84.ecef(at, 550e3))
}

fn fill(sensors: &mut SensorSet, field_of_view: &FieldOfView) -> Vec<SensorId> {
    (0..COUNT)
        .map(|k| {
            let sensor = Sensor::new(pose(k, 0.0), field_of_view.clone());
            let inserted = sensors.insert(sensor, SensorStyle::default());
            inserted.expect("a sound sensor")
        })
        .collect()
}

fn fields_of_view() -> [(&'static str, FieldOfView); 2] {
    [
        ("conic", FieldOfView::conic(0.7)),
        ("rectangular", FieldOfView::rectangular(0.7, 0.2)),
    ]
    .map(|(name, field_of_view)| (name, field_of_view.expect("sound angles")))
}

fn change(criterion: &mut Criterion) {
    for (name, field_of_view) in fields_of_view() {
        let mut sensors = SensorSet::default();
        let ids = fill(&mut sensors, &field_of_view);
        let poses: Vec<Pose> = (0..COUNT).map(|k| pose(k, 0.1)).collect();
        criterion.bench_function(&format!("set_pose/1000 {name}"), |bencher| {
            bencher.iter(|| {
                for (&id, &pose) in ids.iter().zip(&poses) {
                    sensors.set_pose(id, pose).expect("a sound pose");
                }
            });
        });
        criterion.bench_function(&format!("remove and insert/1000 {name}"), |bencher| {
            let mut sensors = SensorSet::default();
            let mut ids = fill(&mut sensors, &field_of_view);
            bencher.iter(|| {
                for id in ids.drain(..) {
                    sensors.remove(id).expect("it is there");
                }
                ids = fill(&mut sensors, &field_of_view);
            });
        });
        criterion.bench_function(&format!("covering/1000 {name}"), |bencher| {
            bencher.iter(|| sensors.covering(LonLat::new(10.0, 50.0), 0.0).count());
        });
    }
}

fn prepare(criterion: &mut Criterion) {
    let Some((device, queue)) = pollster::block_on(open()) else {
        eprintln!("no adapter: preparing is not measured");
        return;
    };
    for (name, field_of_view) in fields_of_view() {
        let mut renderer =
            Renderer::new(&device, RendererOptions::default()).expect("sound options");
        fill(renderer.sensors_mut(), &field_of_view);
        let mut view = View::default();
        let mut height_m = 2e7;
        criterion.bench_function(&format!("prepare/1000 {name}, camera moved"), |bencher| {
            bencher.iter(|| {
                height_m += 1.0;
                let frame = Frame::new(above(height_m), UVec2::new(1280, 720));
                let prepared = renderer.prepare(&queue, &mut view, &frame);
                // Lets the queue hand what was written on.
                queue.submit([]);
                prepared.expect("a sound frame")
            });
        });
    }
}

/// A camera over the equator, looking down.
fn above(height_m: f64) -> Camera {
    Camera {
        eye_ecef_m: DVec3::new(Ellipsoid::WGS84.a_m + height_m, 0.0, 0.0),
        view_from_ecef: DMat3::from_cols(DVec3::Z, DVec3::X, DVec3::Y),
        clip_from_view: perspective_infinite_reverse(1.0, 16.0 / 9.0, 1.0),
    }
}

async fn open() -> Option<(wgpu::Device, wgpu::Queue)> {
    let instance =
        wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = instance
        .request_adapter(&wgpu::RequestAdapterOptions::default())
        .await
        .ok()?;
    adapter
        .request_device(&wgpu::DeviceDescriptor {
            required_features: Renderer::wanted_features() & adapter.features(),
            ..Default::default()
        })
        .await
        .ok()
}

criterion_group!(benches, change, prepare);
criterion_main!(benches);
