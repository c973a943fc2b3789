//! Orthographic hosts: fills, sensors and picking along parallel lines of sight.

use glam::{DMat4, DVec2, DVec4, UVec2};
use globefill::{
    Ellipsoid, FillMesh, Frame, LonLat, MeshOptions, Pick, Region, RendererError, View,
    countries::Dataset, wgpu,
};

use crate::{
    common::{
        camera::{DepthRange, DepthSteps, Pose},
        draw::IdPainter,
        headless::gpu,
        oracle::Oracle,
        score::{expected_ids, judge},
        surface::{Cast, DepthKind, Surface, Terrain},
        watch::{CountPainter, judge_counts},
        watcher::{Optics, Watcher},
    },
    gate::{Gate, PLATEAU, SIZE, Subject, TECHNIQUES, cast, figure},
};

const KINDS: [DepthKind; 3] = [
    DepthKind::Reversed,
    DepthKind::Standard,
    DepthKind::Standard24,
];

/// Pictures from 2 m to 300 km high of one edge, from above, aslant and along the ground.
#[test]
fn nothing_is_wrong_at_an_edge() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu);
    let subject = Subject::pair();
    for terrain in [Terrain::Bare, PLATEAU, Terrain::Rough] {
        for (picture_m, back_m) in [(2.0, 1.0), (20.0, 1e7), (1e3, 0.0), (3e4, 1e5), (3e5, 1e8)] {
            for (heading_deg, pitch_deg) in [(0.0, -90.0), (150.0, -35.0), (65.0, -8.0)] {
                // Rays along the ground of rough terrain take the oracle long.
                if terrain == Terrain::Rough && pitch_deg > -30.0 {
                    continue;
                }
                let pose = subject
                    .pose(terrain, 0.0)
                    .turned(heading_deg, pitch_deg)
                    .parallel(picture_m)
                    .back_by(back_m);
                let kinds = if picture_m == 1e3 {
                    &KINDS[..]
                } else {
                    &KINDS[..2]
                };
                gate.check(&subject, pose, terrain, kinds);
            }
        }
    }
    gate.finish();
}

/// The whole globe, a country, and what is seen along the ground.
#[test]
fn nothing_is_wrong_on_countries() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu);
    let countries = Dataset::Countries110m.countries();
    let regions: Vec<Region> = countries.into_iter().map(|c| c.region).collect();
    let subject = Subject {
        mesh: FillMesh::build(&regions, &MeshOptions::default()).expect("embedded data is sound"),
        oracle: Oracle::new(&regions, Ellipsoid::WGS84),
    };
    for (lon_deg, lat_deg, picture_m) in [
        (10.0, 20.0, 1.4e7),
        (180.0, -20.0, 1.2e7),
        (0.0, 90.0, 1.3e7),
        (10.4, 51.1, 1e6),
        (10.4, 51.1, 3e7),
    ] {
        let pose = Pose::nadir(lon_deg, lat_deg, 0.0)
            .parallel(picture_m)
            .back_by(2e7);
        gate.check(&subject, pose, Terrain::Bare, &KINDS[..2]);
    }
    for terrain in [Terrain::Bare, PLATEAU] {
        let pose = Pose::nadir(8.0, 47.0, 0.0)
            .turned(20.0, -5.0)
            .parallel(4e5)
            .back_by(1e7);
        gate.check(&subject, pose, terrain, &KINDS[..2]);
    }
    gate.finish();
}

/// Off the middle of the picture, and in a depth buffer that has to hold the whole globe.
#[test]
fn nothing_is_wrong_off_the_middle_nor_in_deep_buffers() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu);
    let subject = Subject::pair();
    for (picture_m, pitch_deg) in [(50.0, -90.0), (2e3, -40.0)] {
        let pose = Pose {
            aside: DVec2::new(0.4, -0.7),
            ..subject
                .pose(PLATEAU, 0.0)
                .turned(65.0, pitch_deg)
                .parallel(picture_m)
                .back_by(1e4)
        };
        let cast = cast(&pose, PLATEAU);
        let (near_m, far_m) = (-1e5, 2e7);
        for range in [
            DepthRange::ReversedFinite { near_m, far_m },
            DepthRange::StandardFinite { near_m, far_m },
        ] {
            let surface = Surface::stored(&cast, range, DepthSteps::Float);
            gate.judge(&format!("{picture_m} m, {range:?}"), &subject, &surface);
        }
    }
    gate.finish();
}

#[test]
fn nothing_is_wrong_with_four_samples() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu);
    let subject = Subject::pair();
    for (picture_m, pitch_deg) in [(100.0, -40.0), (1e6, -90.0)] {
        let pose = subject
            .pose(PLATEAU, 0.0)
            .turned(65.0, pitch_deg)
            .parallel(picture_m)
            .back_by(1e6);
        let cast = Cast::new(&figure(), &pose, SIZE, 4, PLATEAU);
        let surface = Surface::new(&cast, DepthKind::Reversed);
        gate.judge(&format!("{picture_m} m"), &subject, &surface);
    }
    gate.finish();
}

/// A host that changes its lens from frame to frame, in one view.
#[test]
fn lenses_may_change_from_frame_to_frame() {
    let Some(gpu) = gpu() else { return };
    let subject = Subject::pair();
    for count in TECHNIQUES {
        let straight = subject.pose(Terrain::Bare, 5e3);
        let poses = [straight, straight.parallel(4e3), straight];
        let surfaces =
            poses.map(|pose| Surface::new(&cast(&pose, Terrain::Bare), DepthKind::Reversed));
        let mut painter = IdPainter::new(gpu, subject.mesh.clone(), &surfaces[0], count);
        let mut view = View::default();
        for surface in &surfaces {
            let ids = painter.draw(gpu, &mut view, surface, 0.0).ids;
            let expected = expected_ids(&subject.oracle, surface);
            let score = judge(&subject.oracle, surface, &expected, &ids, 0.0);
            assert!(score.is_clean() && score.covered > 0, "{score}");
        }
    }
}

/// Pixels answer what they show.
#[test]
fn pixels_are_picked() {
    let Some(gpu) = gpu() else { return };
    let subject = Subject::pair();
    let pose = subject.pose(PLATEAU, 0.0).turned(10.0, -50.0).parallel(9e4);
    let surface = Surface::new(&cast(&pose, PLATEAU), DepthKind::Standard);
    let mut painter = IdPainter::new(gpu, subject.mesh.clone(), &surface, TECHNIQUES[0]);
    let mut view = View::default();
    let ids = painter.draw(gpu, &mut view, &surface, 0.0).ids;
    let mut seen = [0; 3];
    for y in (3..SIZE.y).step_by(25) {
        for x in (3..SIZE.x).step_by(25) {
            let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: Pick::BYTES,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            });
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let pixel = UVec2::new(x, y);
            let pick = painter
                .renderer
                .read_fills(&view, &mut encoder, pixel, &buffer, 0)
                .expect("the pixel is in the picture");
            gpu.queue.submit([encoder.finish()]);
            buffer.map_async(wgpu::MapMode::Read, .., |mapped| mapped.expect("readable"));
            gpu.device
                .poll(wgpu::PollType::wait_indefinitely())
                .expect("the device answers");
            let picked = pick.fills(&buffer.get_mapped_range(..).expect("mapped"));
            let shown = ids[(y * SIZE.x + x) as usize];
            assert_eq!(picked.last().map_or(0, |fill| fill.fill + 1), shown);
            seen[shown as usize] += 1;
        }
    }
    assert!(seen.iter().all(|&count| count > 2), "{seen:?}");
}

/// Footprints of every kind, near and far, over the ellipsoid and over mountains.
#[test]
fn footprints_lie_where_they_should() {
    let Some(gpu) = gpu() else { return };
    let at = LonLat::new(11.0, 47.0);
    let cone = |outer_rad| Optics::Annulus {
        inner_rad: 0.0,
        outer_rad,
    };
    let corners = vec![(-0.3, -0.2), (0.4, -0.1), (0.1, 0.5)];
    let optics = [
        cone(0.2),
        Optics::Annulus {
            inner_rad: 0.1,
            outer_rad: 0.4,
        },
        Optics::Rectangle {
            right_rad: 0.3,
            up_rad: 0.1,
        },
        Optics::Corners(corners),
        cone(1.5),
    ];
    for extrusion in [globefill::Extrusion::Normal, globefill::Extrusion::Apex] {
        let watchers: Vec<Watcher> = (0..)
            .zip(&optics)
            .map(|(k, optics)| {
                let k = f64::from(k);
                let mut watcher = Watcher::new(at, 5e5, 0.1 * k, 1.3 * k, optics.clone());
                watcher.extrusion = extrusion;
                watcher.min_elevation_rad = (k == 1.0).then_some(0.3);
                watcher
            })
            .collect();
        for (terrain, picture_m, pitch_deg) in [
            (Terrain::Bare, 1.3e7, -90.0),
            (Terrain::Bare, 5e5, -90.0),
            (Terrain::Bare, 4e5, -30.0),
            (PLATEAU, 1e6, -50.0),
            (Terrain::Rough, 3e5, -60.0),
        ] {
            let pose = Pose::nadir(at.lon_deg, at.lat_deg, 0.0)
                .turned(20.0, pitch_deg)
                .parallel(picture_m)
                .back_by(3e6);
            let cast = Cast::new(&figure(), &pose, SIZE, 1, terrain);
            for kind in &KINDS[..2] {
                let surface = Surface::new(&cast, *kind);
                let mut painter = CountPainter::new(gpu, &watchers, &surface);
                let (drawn, _) = painter.draw(gpu, &mut View::default(), &surface);
                let score = judge_counts(&watchers, &surface, &drawn);
                let name = format!("{extrusion:?} {terrain:?} {picture_m} m {pitch_deg} {kind:?}");
                println!("{name}: {score}");
                assert!(score.wrong == 0 && score.covered > 0, "{name}: {score}");
            }
        }
    }
}

#[test]
fn lenses_that_cannot_be_served_are_refused() {
    let Some(gpu) = gpu() else { return };
    let subject = Subject::pair();
    let pose = subject.pose(Terrain::Bare, 5e3).parallel(4e3);
    let surface = Surface::new(&cast(&pose, Terrain::Bare), DepthKind::Reversed);
    let mut painter = IdPainter::new(gpu, subject.mesh.clone(), &surface, TECHNIQUES[0]);
    let good = Frame::new(surface.lens.camera(), SIZE);
    type Spoil = fn(&mut DMat4);
    let cannot_be: [Spoil; 3] = [
        // The wrong way.
        |clip| clip.z_axis.z = -clip.z_axis.z,
        |clip| clip.z_axis.z = 0.0,
        |clip| clip.x_axis.x = 0.0,
    ];
    let not_served: [Spoil; 4] = [
        // Sheared.
        |clip| clip.z_axis.x = 0.1 * clip.x_axis.x,
        |clip| clip.x_axis.z = 1e-5,
        // Neither parallel nor through the eye.
        |clip| clip.z_axis.w = -0.5,
        |clip| clip.w_axis = DVec4::new(0.0, 0.0, clip.w_axis.z, 2.0),
    ];
    let mut refused = |spoil: Spoil| {
        let mut frame = good;
        spoil(&mut frame.camera.clip_from_view);
        let view = &mut View::default();
        painter
            .renderer
            .prepare(&gpu.queue, view, &frame)
            .map(|_| ())
    };
    for spoil in cannot_be {
        let error = RendererError::InvalidFrame("camera.clip_from_view");
        assert_eq!(refused(spoil), Err(error));
    }
    for spoil in not_served {
        assert!(matches!(refused(spoil), Err(RendererError::Unsupported(_))));
    }
    refused(|_| ()).expect("the lens itself is served");
}
