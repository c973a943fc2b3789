//! Many sensors and many frames: counts against brute force, blending, what a change uploads, reading
//! back, and scenes without sensors.

mod common;

use common::{
    camera::Pose,
    draw::{COLOR, paint},
    figure::Figure,
    headless::{Gpu, gpu, gpu_limited},
    surface::{Cast, DepthKind, Surface, Terrain},
    watch::{CountPainter, judge_counts},
    watcher::{Optics, Watcher},
};
use glam::UVec2;
use globefill::{
    CoverageColors, Ellipsoid, Extrusion, FrameStats, LonLat, Renderer, RendererError,
    RendererOptions, SensorDisplay, SensorSet, SensorStyle, View, wgpu,
};

const SIZE: UVec2 = UVec2::new(160, 90);

fn surface(pose: Pose, samples: u32, terrain: Terrain) -> Surface {
    let figure = Figure::new(Ellipsoid::WGS84);
    let cast = Cast::new(&figure, &pose, SIZE, samples, terrain);
    Surface::new(&cast, DepthKind::Reversed)
}

/// From where a third of the globe is seen.
fn globe(samples: u32) -> Surface {
    let mut pose = Pose::nadir(10.0, 20.0, 2e7);
    pose.fov_deg = 35.0;
    surface(pose, samples, Terrain::Bare)
}

/// A Walker-like shell at 550 km: `count` sensors spread evenly, seeing down to an elevation of 5°.
fn shell(count: usize) -> Vec<Watcher> {
    (0..count)
        .map(|k| {
            let part = (k as f64 + 0.5) / count as f64;
            let at = LonLat::new(
                (k as f64 * 137.507_764).rem_euclid(360.0) - 180.0,
                (1.0 - 2.0 * part).asin().to_degrees(),
            );
            let optics = Optics::Annulus {
                inner_rad: 0.0,
                outer_rad: 1.2,
            };
            let mut watcher = Watcher::new(at, 5.5e5, 0.0, 0.0, optics);
            watcher.min_elevation_rad = Some(5_f64.to_radians());
            if k % 3 == 0 {
                watcher.extrusion = Extrusion::Apex;
            }
            watcher
        })
        .collect()
}

#[test]
fn a_shell_is_counted_as_by_brute_force() {
    let Some(gpu) = gpu() else { return };
    let watchers = shell(1000);
    let near = Pose::nadir(-30.0, 71.0, 3e5).turned(60.0, -20.0);
    for surface in [globe(1), surface(near, 1, Terrain::Rough)] {
        let mut painter = CountPainter::new(gpu, &watchers, &surface);
        let (drawn, stats) = painter.draw(gpu, &mut View::default(), &surface);
        let score = judge_counts(&watchers, &surface, &drawn);
        println!("{score}; {stats:?}");
        assert_eq!(score.wrong, 0, "{score}");
        let most = drawn.iter().filter(|&&count| count != u32::MAX).max();
        assert!(most >= Some(&15), "hardly any overlap: {most:?}");
    }
}

#[test]
fn tiles_with_too_many_sensors_ask_them_all() {
    // 32 kB hold 248 pages of lists, where these crowds need thousands, and 256 records.
    let limit = 32 << 10;
    let Some(gpu) = gpu_limited(|limits| limits.max_storage_buffer_binding_size = limit) else {
        return;
    };
    let surface = globe(1);
    let crowd = |count: usize| {
        let mut watchers = shell(count);
        for (k, watcher) in watchers.iter_mut().enumerate() {
            let here = LonLat::new(10.0 + 1e-3 * k as f64, 20.0);
            let optics = Optics::Annulus {
                inner_rad: 0.0,
                outer_rad: 0.9,
            };
            *watcher = Watcher::new(here, 5.5e5, 0.0, 0.0, optics);
        }
        watchers
    };
    let watchers = crowd(256);
    let mut painter = CountPainter::new(&gpu, &watchers, &surface);
    let (drawn, _) = painter.draw(&gpu, &mut View::default(), &surface);
    let score = judge_counts(&watchers, &surface, &drawn);
    assert_eq!(score.wrong, 0, "{score}");
    assert!(drawn.contains(&256));

    let sensors = painter.renderer.sensors_mut();
    let one_more = crowd(1)[0].sensor();
    sensors
        .insert(one_more, SensorStyle::default())
        .expect("a sound sensor");
    let frame = globefill::Frame::new(surface.lens.camera(), SIZE);
    assert_eq!(
        painter
            .renderer
            .prepare(&gpu.queue, &mut View::default(), &frame),
        Err(RendererError::TooManySensors {
            sensors: 257,
            most: 256
        })
    );
}

#[test]
fn multisampled_hosts_get_the_same_counts() {
    let Some(gpu) = gpu() else { return };
    let watchers = shell(60);
    let surface = globe(4);
    let mut painter = CountPainter::new(gpu, &watchers, &surface);
    let (drawn, _) = painter.draw(gpu, &mut View::default(), &surface);
    let count = surface.pixel_count();
    let mut judged = 0;
    for (pixel, &drawn) in drawn.iter().enumerate() {
        let counts = (0..4).map(|sample| {
            let point_m = surface.points_m[sample * count + pixel]?;
            Some(watchers.iter().filter(|w| w.covers(point_m)).count() as u32)
        });
        let counts: Option<Vec<u32>> = counts.collect();
        if let Some(counts) = counts.filter(|counts| counts.iter().all(|&c| c == counts[0])) {
            judged += 1;
            assert_eq!(drawn, counts[0], "pixel {pixel}");
        }
    }
    assert!(judged > 3000, "{judged}");
}

#[test]
fn footprints_blend_alike_in_any_order() {
    let Some(gpu) = gpu() else { return };
    let surface = globe(1);
    let options = RendererOptions {
        color_format: COLOR,
        ..Default::default()
    };
    let watchers = shell(300);
    let style = |k: usize| SensorStyle {
        color: [
            (k % 3) as f32 / 2.0,
            (k % 5) as f32 / 4.0,
            (k % 7) as f32 / 6.0,
            0.3,
        ],
        visible: true,
    };
    let picture = |order: &mut dyn Iterator<Item = usize>| {
        let mut renderer = Renderer::new(&gpu.device, options).expect("sound options");
        for k in order {
            let sensors = renderer.sensors_mut();
            sensors
                .insert(watchers[k].sensor(), style(k))
                .expect("a sound sensor");
        }
        paint(
            gpu,
            &mut renderer,
            &options,
            &mut View::default(),
            &surface,
            0.0,
        )
        .texels
    };
    let forwards = picture(&mut (0..300));
    assert!(forwards == picture(&mut (0..300).rev()));
    // The meaning: opacity 1 − ∏(1 − α), colour in the ratio of the optical depths.
    let mut compared = 0;
    for (pixel, texel) in forwards.iter().enumerate() {
        let Some(point_m) = surface.points_m[pixel] else {
            continue;
        };
        let covering = (0..300).filter(|&k| watchers[k].covers(point_m));
        let mut depth = 0.0;
        let mut color = [0.0; 3];
        for k in covering {
            let [red, green, blue, alpha] = style(k).color.map(f64::from);
            let sheet = -(1.0 - alpha).ln();
            depth += sheet;
            color[0] += sheet * red;
            color[1] += sheet * green;
            color[2] += sheet * blue;
        }
        let alpha = 1.0 - (-depth).exp();
        let parts = color.map(|part| {
            if depth > 0.0 {
                part / depth * alpha
            } else {
                0.0
            }
        });
        let expected = [parts[0], parts[1], parts[2], alpha].map(|part| (part * 255.0).round());
        let off = expected
            .iter()
            .zip(texel)
            .map(|(e, &t)| (e - f64::from(t)).abs());
        compared += usize::from(off.fold(0.0, f64::max) <= 1.0);
    }
    // All but the pixels on an edge.
    let surface_count = surface.points_m.iter().flatten().count();
    assert!(
        compared as f64 > 0.999 * surface_count as f64,
        "{compared} of {surface_count}"
    );
}

#[test]
fn only_what_changed_is_uploaded() {
    let Some(gpu) = gpu() else { return };
    let surface = globe(1);
    let watchers = shell(200);
    let mut painter = CountPainter::new(gpu, &watchers, &surface);
    let mut view = View::default();
    let (first, stats) = painter.draw(gpu, &mut view, &surface);
    assert_eq!((stats.sensors, stats.dispatches, stats.draws), (200, 3, 1));
    assert!(stats.upload_bytes / 200 < 256, "{stats:?}");
    let (still, stats) = painter.draw(gpu, &mut view, &surface);
    assert_eq!(stats.upload_bytes, 0);
    assert!(still == first);

    let id = painter.ids[7];
    let sensors = painter.renderer.sensors_mut();
    sensors
        .set_pose(id, watchers[90].pose)
        .expect("a sound pose");
    let (moved, stats) = painter.draw(gpu, &mut view, &surface);
    assert_eq!(stats.upload_bytes, 128);
    let mut expected = watchers.clone();
    expected[7].pose = watchers[90].pose;
    assert_eq!(judge_counts(&expected, &surface, &moved).wrong, 0);

    painter
        .renderer
        .sensors_mut()
        .remove(id)
        .expect("it is there");
    expected.remove(7);
    let (removed, stats) = painter.draw(gpu, &mut view, &surface);
    assert!(stats.upload_bytes <= 512, "{stats:?}");
    assert_eq!(judge_counts(&expected, &surface, &removed).wrong, 0);

    let hidden = SensorStyle {
        visible: false,
        ..Default::default()
    };
    let sensors = painter.renderer.sensors_mut();
    sensors
        .set_style(painter.ids[0], hidden)
        .expect("it is there");
    expected.remove(0);
    let (without, stats) = painter.draw(gpu, &mut view, &surface);
    assert_eq!(stats.sensors, 198);
    assert_eq!(judge_counts(&expected, &surface, &without).wrong, 0);
}

#[test]
fn a_scene_without_sensors_pays_nothing() {
    let Some(gpu) = gpu() else { return };
    let surface = globe(1);
    let mut painter = CountPainter::new(gpu, &shell(3), &surface);
    let mut view = View::default();
    let colors = CoverageColors::ramp([0.0; 4], &[[1.0; 4]], 3).expect("sound colours");
    let sensors = painter.renderer.sensors_mut();
    sensors.set_display(SensorDisplay::Coverage(colors));
    painter.draw(gpu, &mut view, &surface);
    painter.renderer.sensors_mut().clear();
    let (_, stats) = painter.draw(gpu, &mut view, &surface);
    assert_eq!(stats, FrameStats::default());
}

#[test]
fn the_count_at_a_pixel_can_be_read_back() {
    let Some(gpu) = gpu() else { return };
    let surface = globe(1);
    let watchers = shell(100);
    let mut painter = CountPainter::new(gpu, &watchers, &surface);
    let mut view = View::default();
    let (drawn, _) = painter.draw(gpu, &mut view, &surface);
    let pixels = [UVec2::new(80, 45), UVec2::new(100, 30), UVec2::new(0, 0)];
    let read = read_back(gpu, &painter.renderer, &view, &pixels);
    for (pixel, count) in pixels.into_iter().zip(read) {
        let shown = drawn[(pixel.y * SIZE.x + pixel.x) as usize];
        assert_eq!(count, if shown == u32::MAX { 0 } else { shown });
        let here = surface.points_m[(pixel.y * SIZE.x + pixel.x) as usize];
        if let Some(point_m) = here {
            let (foot, height_m) = Ellipsoid::WGS84.geodetic(point_m);
            let covering = painter.renderer.sensors().covering(foot, height_m);
            assert_eq!(covering.count() as u32, count);
        }
    }
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let beside = painter
        .renderer
        .read_coverage(&view, &mut encoder, SIZE, &readable(gpu, 4), 0);
    assert_eq!(beside, Err(RendererError::NoSuchPixel(SIZE)));
}

fn readable(gpu: &Gpu, size: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("counts"),
        size,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    })
}

fn read_back(gpu: &Gpu, renderer: &Renderer, view: &View, pixels: &[UVec2]) -> Vec<u32> {
    let counts = readable(gpu, 4 * pixels.len() as u64);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    for (offset, &pixel) in (0..).step_by(4).zip(pixels) {
        renderer
            .read_coverage(view, &mut encoder, pixel, &counts, offset)
            .expect("the pixel is in the picture");
    }
    gpu.queue.submit([encoder.finish()]);
    counts.map_async(wgpu::MapMode::Read, .., |mapped| {
        mapped.expect("it can be read")
    });
    gpu.device
        .poll(wgpu::PollType::wait_indefinitely())
        .expect("the device answers");
    let bytes = counts.get_mapped_range(..).expect("it is mapped");
    bytes
        .chunks_exact(4)
        .map(|four| u32::from_le_bytes(four.try_into().expect("four bytes")))
        .collect()
}

#[test]
fn what_is_no_surface_is_left_out() {
    let Some(gpu) = gpu() else { return };
    // A wall of satellites 100 km up, of which the host says nothing.
    let pose = Pose::nadir(10.0, 20.0, 2e6);
    let high = surface(pose, 1, Terrain::Plateau { height_m: 1e5 });
    let watchers = shell(100);
    let mut painter = CountPainter::new(gpu, &watchers, &high);
    let mut view = View::default();
    let (drawn, _) = painter.draw(gpu, &mut view, &high);
    assert_eq!(judge_counts(&watchers, &high, &drawn).wrong, 0);
    let mut unexpected = high;
    unexpected.terrain = Terrain::Bare;
    let (drawn, _) = painter.draw(gpu, &mut view, &unexpected);
    assert!(drawn.iter().all(|&count| count == u32::MAX));
    let read = read_back(gpu, &painter.renderer, &view, &[UVec2::new(80, 45)]);
    assert_eq!(read, [0]);
}

#[test]
fn sets_can_be_exchanged() {
    let Some(gpu) = gpu() else { return };
    let surface = globe(1);
    let few = &shell(3)[..];
    let mut other = SensorSet::default();
    let watchers = &shell(40)[17..21];
    for watcher in watchers {
        other
            .insert(watcher.sensor(), SensorStyle::default())
            .expect("a sound sensor");
    }
    // The set drawn first was changed last.
    let mut painter = CountPainter::new(gpu, few, &surface);
    let display = painter.renderer.sensors().display().clone();
    let mut view = View::default();
    let (drawn, _) = painter.draw(gpu, &mut view, &surface);
    assert_eq!(judge_counts(few, &surface, &drawn).wrong, 0);
    other.set_display(display);
    let first = std::mem::replace(painter.renderer.sensors_mut(), other);
    let (drawn, _) = painter.draw(gpu, &mut view, &surface);
    assert_eq!(judge_counts(watchers, &surface, &drawn).wrong, 0);
    assert!(painter.renderer.sensors().get(painter.ids[0]).is_none());
    *painter.renderer.sensors_mut() = first;
    let (drawn, _) = painter.draw(gpu, &mut view, &surface);
    assert_eq!(judge_counts(few, &surface, &drawn).wrong, 0);
}

#[test]
fn planes_follow_their_sensors() {
    let Some(gpu) = gpu() else { return };
    let surface = globe(1);
    let mut watchers = shell(60);
    for (k, watcher) in watchers.iter_mut().enumerate() {
        watcher.min_elevation_rad = None;
        match k % 3 {
            0 => {
                watcher.optics = Optics::Rectangle {
                    right_rad: 0.9,
                    up_rad: 0.4,
                }
            }
            1 => watcher.optics = Optics::Corners(vec![(1.2, -0.9), (0.3, 1.5), (-1.2, -0.6)]),
            _ => {}
        }
    }
    let mut painter = CountPainter::new(gpu, &watchers, &surface);
    let mut view = View::default();
    for _ in 0..20 {
        let (drawn, _) = painter.draw(gpu, &mut view, &surface);
        assert_eq!(judge_counts(&watchers, &surface, &drawn).wrong, 0);
        let sensors = painter.renderer.sensors_mut();
        sensors.remove(painter.ids.remove(5)).expect("it is there");
        watchers.remove(5);
        // And one takes a field of view with more sides.
        watchers[1].optics = watchers[0].optics.clone();
        sensors
            .set_sensor(painter.ids[1], watchers[1].sensor())
            .expect("a sound sensor");
        watchers.rotate_left(1);
        painter.ids.rotate_left(1);
    }
}

#[test]
fn views_and_sizes_change() {
    let Some(gpu) = gpu() else { return };
    let watchers = shell(200);
    let wide = globe(1);
    let cast = Cast::new(
        wide.figure(),
        &Pose::nadir(-100.0, -60.0, 5e6),
        UVec2::new(333, 77),
        1,
        Terrain::Bare,
    );
    let other = Surface::new(&cast, DepthKind::Reversed);
    let mut painter = CountPainter::new(gpu, &watchers, &wide);
    let (mut first, mut second) = (View::default(), View::default());
    for surface in [&wide, &other, &wide] {
        for view in [&mut first, &mut second] {
            let (drawn, _) = painter.draw(gpu, view, surface);
            assert_eq!(judge_counts(&watchers, surface, &drawn).wrong, 0);
        }
    }
    let display = painter.renderer.sensors().display().clone();
    painter
        .renderer
        .sensors_mut()
        .set_display(SensorDisplay::Blended);
    let (blended, _) = painter.draw(gpu, &mut first, &wide);
    painter.renderer.sensors_mut().set_display(display);
    let (drawn, stats) = painter.draw(gpu, &mut first, &wide);
    assert!(blended != drawn);
    assert_eq!(judge_counts(&watchers, &wide, &drawn).wrong, 0);
    assert!(stats.upload_bytes < 4096, "{stats:?}");
}

#[test]
fn a_frame_that_cannot_be_drawn_leaves_the_last() {
    let Some(gpu) = gpu() else { return };
    let surface = globe(1);
    let watchers = shell(10);
    let mut painter = CountPainter::new(gpu, &watchers, &surface);
    let mut view = View::default();
    let unseen = globefill::Frame::new(surface.lens.camera(), SIZE);
    let renderer = &mut painter.renderer;
    renderer
        .prepare(&gpu.queue, &mut view, &unseen)
        .expect("a sound frame");
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let early = renderer.read_coverage(&view, &mut encoder, UVec2::ONE, &readable(gpu, 4), 0);
    assert_eq!(early, Err(RendererError::NoSuchPixel(UVec2::ONE)));
    painter.draw(gpu, &mut view, &surface);
    let mut broken = globefill::Frame::new(surface.lens.camera(), 2 * SIZE);
    broken.camera.eye_ecef_m.x = f64::NAN;
    let refused = painter.renderer.prepare(&gpu.queue, &mut view, &broken);
    assert_eq!(
        refused,
        Err(RendererError::InvalidFrame("camera.eye_ecef_m"))
    );
    let beyond = painter
        .renderer
        .read_coverage(&view, &mut encoder, SIZE, &readable(gpu, 4), 0);
    assert_eq!(beyond, Err(RendererError::NoSuchPixel(SIZE)));
}
