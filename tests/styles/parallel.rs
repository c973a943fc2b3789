//! Styles along parallel lines of sight.

use globefill::{
    Align, Fade, FillStyle, HatchKind, Length, Ramp, Region, Renderer, RendererOptions, Stroke,
};

use crate::{
    PLACES, SMALL,
    colors::{left, seen},
    common::{
        camera::Pose,
        headless::gpu,
        surface::{Surface, Terrain},
    },
    coordinates::{Off, fill_of, judge, layouts, style_of},
    coverage,
    edges::edges_off,
    ink::{hatch, sheet},
    ramps::Ramps,
    stage::{Stage, bare, built, ground, over, pixel_m},
    strokes::{AT, circle, compare, shares, stroked},
};

/// A place in the middle of a picture of some height, seen from very near or from far away.
fn pose(at: globefill::LonLat, picture_m: f64, pitch_deg: f64) -> Pose {
    Pose::nadir(at.lon_deg, at.lat_deg, 0.0)
        .turned(33.0, pitch_deg)
        .parallel(picture_m)
        .back_by(if picture_m < 1e4 { 1e7 } else { 1e6 })
}

/// Heights of pictures, metres, and pitches.
const VIEWS: [(f64, f64); 6] = [
    (3.0, -90.0),
    (300.0, -35.0),
    (3e4, -90.0),
    (3e4, -20.0),
    (2e6, -60.0),
    (9e6, -90.0),
];

#[test]
fn pictures_lie_in_their_place() {
    let Some(gpu) = gpu() else { return };
    let mut worst = Off::default();
    for (k, at) in PLACES.into_iter().enumerate() {
        let first = bare(&pose(at, 2e4, -90.0), SMALL);
        let mut stage = Stage::new(gpu, ground(at), &first);
        let ramps = Ramps::new(250, 120);
        let image = stage.renderer.insert_image(&gpu.queue, &ramps.image());
        let image = image.expect("a small image");
        for (picture_m, pitch_deg) in VIEWS {
            let terrain = if k == 0 && picture_m == 3e4 {
                Terrain::Rough
            } else {
                Terrain::Bare
            };
            if at.is_pole() && picture_m > 1e6 {
                continue;
            }
            let surface = over(terrain, &pose(at, picture_m, pitch_deg), SMALL);
            let px = if terrain == Terrain::Bare { 5.0 } else { 20.0 };
            let side_m = px * pixel_m(&surface) * ramps.size().x;
            for (layout, wrap) in layouts(at, side_m) {
                stage.set(0, style_of(fill_of(image, &layout, wrap)));
                let drawn = stage.draw(&surface).texels;
                let off = judge(&surface, &drawn, &ramps, &layout, wrap);
                if off.gate > 0.5 {
                    println!("{at:?} {picture_m} m {pitch_deg} {layout:?} {wrap:?}: {off:?}");
                }
                worst = worst.with(off);
            }
        }
    }
    println!("{worst:?}");
    assert!(
        8 * worst.judged > worst.ground && worst.gate <= 1.0,
        "{worst:?}"
    );
}

#[test]
fn edges_of_lines_lie_where_they_should() {
    let Some(gpu) = gpu() else { return };
    let (mut most, mut count) = (0.0f64, 0);
    for at in PLACES {
        let first = bare(&pose(at, 1e3, -90.0), SMALL);
        let mut stage = Stage::new(gpu, ground(at), &first);
        for (picture_m, pitch_deg) in VIEWS {
            let surface = bare(&pose(at, picture_m, pitch_deg), SMALL);
            let spacing = (23.7 * pixel_m(&surface)) as f32;
            let lines = hatch(HatchKind::Lines, Length::Metres(spacing), 0.5, 0.35, at);
            stage.set(0, coverage::style_of(lines));
            let drawn = stage.draw(&surface).texels;
            let offs = edges_off(&surface, &sheet(at, 0.35), &drawn, f64::from(spacing), 0.5);
            let off = offs
                .values()
                .fold(0.0f64, |worst, off| worst.max(off.abs()));
            println!(
                "{at:?} {picture_m} m {pitch_deg}: {off:.4} px of {}",
                offs.len()
            );
            most = most.max(off);
            count += offs.len();
        }
    }
    assert!(count > 500 && most <= 0.05, "{most} px of {count}");
}

/// Fades by distance to the host's eye, by the size of a pixel, which is the same all over, by angle.
#[test]
fn fills_fade() {
    let Some(gpu) = gpu() else { return };
    let mut between = 0;
    for (picture_m, pitch_deg) in [(300.0, -35.0), (3e5, -20.0), (9e6, -90.0)] {
        let eye = pose(PLACES[0], picture_m, pitch_deg).back_by(2.0 * picture_m);
        let surface = bare(&eye, SMALL);
        let mut stage = Stage::new(gpu, ground(PLACES[0]), &surface);
        let all: Vec<(usize, [f64; 3])> = (0..surface.pixel_count())
            .filter_map(|pixel| seen(&surface, pixel).map(|seen| (pixel, seen)))
            .collect();
        let quarters = |k: usize| {
            let mut of: Vec<f64> = all.iter().map(|(_, seen)| seen[k]).collect();
            of.sort_by(f64::total_cmp);
            [of[of.len() / 4] as f32, of[3 * of.len() / 4] as f32]
        };
        let by_distance = quarters(0);
        let size = quarters(1)[0];
        let fade = Fade {
            distance_m: Some(Ramp {
                full: by_distance[0],
                gone: by_distance[1],
            }),
            pixel_m: Some(Ramp {
                full: 0.5 * size,
                gone: 2.0 * size,
            }),
            angle_rad: None,
        };
        let color = [1.0, 0.5, 0.0, 0.9];
        stage.set(
            0,
            FillStyle {
                color,
                fade,
                ..Default::default()
            },
        );
        let texels = stage.draw(&surface).texels;
        for &(pixel, seen) in &all {
            let left = left(fade.distance_m, seen[0]) * left(fade.pixel_m, seen[1]);
            let off = (f64::from(texels[pixel][3]) - 255.0 * 0.9 * left).abs();
            assert!(off <= 1.0, "{picture_m} m at {pixel}: {off}");
            between += usize::from((0.1..0.9).contains(&left));
        }
    }
    assert!(between > 1000, "{between}");
}

/// The circle of a view of that height, without the eye.
fn scene(picture_m: f64, pitch_deg: f64) -> (globefill::Zone, Surface) {
    let surface = bare(&pose(AT, picture_m, pitch_deg), SMALL);
    (circle(picture_m), surface)
}

#[test]
fn strokes_are_as_wide_as_asked_on_the_side_asked() {
    let Some(gpu) = gpu() else { return };
    for (picture_m, pitch_deg) in [(30.0, -90.0), (1e3, -90.0), (1e5, -90.0), (1e3, -35.0)] {
        let (zone, surface) = scene(picture_m, pitch_deg);
        let px_m = pixel_m(&surface);
        let mut stage = Stage::new(gpu, built(&[Region::from(zone.clone())]), &surface);
        for align in [Align::Inner, Align::Outer] {
            for width_px in [1.0, 4.0] {
                let width_m = width_px * px_m;
                let mut widths = vec![Length::Metres(width_m as f32)];
                // Pixels are metres only where all is seen from straight above.
                if pitch_deg == -90.0 {
                    widths.push(Length::Pixels(width_px as f32));
                }
                for width in widths {
                    let stroke = Stroke {
                        width,
                        align,
                        ..Default::default()
                    };
                    stage.set(0, stroked(stroke));
                    let painted = stage.draw_within(&surface, 0.0);
                    let outer_m = if align == Align::Inner { 0.0 } else { width_m };
                    let band = outer_m - width_m..outer_m;
                    let wanted = shares(&surface, &zone, |outside_m| band.contains(&outside_m));
                    let (rms, worst, mean) = compare(&painted.texels, &wanted);
                    println!(
                        "{picture_m} m, {pitch_deg}, {align:?} {width:?}: rms {rms:.3} worst {worst:.3} \
                         mean {mean:.4}"
                    );
                    assert!(rms <= 0.08 && worst <= 0.3, "{rms} {worst}");
                    assert!((mean - 1.0).abs() <= 0.04, "{mean}");
                }
            }
        }
    }
}

#[test]
fn edges_are_smooth() {
    let Some(gpu) = gpu() else { return };
    let opaque = FillStyle {
        color: [1.0; 4],
        ..Default::default()
    };
    for (picture_m, pitch_deg) in [(30.0, -90.0), (1e3, -35.0), (1e5, -25.0), (9e6, -90.0)] {
        let (zone, surface) = scene(picture_m, pitch_deg);
        let mesh = || built(&[Region::from(zone.clone())]);
        let mut stage = Stage::new(gpu, mesh(), &surface);
        stage.options = RendererOptions {
            smooth_edges: true,
            ..stage.options
        };
        stage.renderer = Renderer::new(&gpu.device, stage.options).expect("sound");
        stage.mesh = stage.renderer.insert(mesh());
        stage.set(0, opaque);
        let texels = stage.draw_within(&surface, 0.0).texels;
        let wanted = shares(&surface, &zone, |outside_m| outside_m <= 0.0);
        let (rms, worst, _) = compare(&texels, &wanted);
        println!("{picture_m} m, {pitch_deg}: rms {rms:.3} worst {worst:.3}");
        assert!(rms <= 0.05, "{rms}");
    }
}
