//! Strokes and smooth edges of a circle, against shares of pixels in f64.

use glam::DVec2;
use globefill::{
    Align, Dash, Ellipsoid, FillStyle, Length, LonLat, Region, Renderer, RendererOptions, Stroke,
    Zone,
};

use crate::common::{
    camera::Pose,
    headless::gpu,
    surface::{Cast, DepthKind, Surface, Terrain},
    zone_oracle::ZoneOracle,
};
use crate::{
    SMALL,
    stage::{Stage, bare, built, figure, pixel_m, point_at, pose},
};

/// Rays a pixel, each way.
const RAYS: u32 = 10;
pub const AT: LonLat = LonLat::new(11.3, 47.2);

/// A circle whose boundary passes under the eye, its radius fitting the view.
pub fn circle(height_m: f64) -> Zone {
    let radius_m = (0.6 * height_m).clamp(20.0, 3e6);
    let centre = LonLat::new(11.3, 47.2 - (radius_m / 111.2e3));
    Zone::circle(centre, radius_m)
}

/// For each pixel the share of its rays for which `covered` says so of the metres outside the circle.
/// Pixels that show sky are none.
pub fn shares(surface: &Surface, zone: &Zone, covered: impl Fn(f64) -> bool) -> Vec<Option<f64>> {
    let oracle = ZoneOracle::new(zone, Ellipsoid::WGS84);
    let width = surface.size_px().x as usize;
    let share = |pixel: usize| {
        let corner = DVec2::new((pixel % width) as f64, (pixel / width) as f64);
        let mut hits = 0;
        for ray in 0..RAYS * RAYS {
            let within = DVec2::new(f64::from(ray % RAYS), f64::from(ray / RAYS)) + 0.5;
            let point_m = point_at(surface, corner + within / f64::from(RAYS))?;
            let (foot, _) = figure().geodetic(point_m);
            hits += u32::from(covered(oracle.outside_m(foot)));
        }
        Some(f64::from(hits) / f64::from(RAYS * RAYS))
    };
    (0..surface.pixel_count()).map(share).collect()
}

/// Root mean square and greatest difference of alphas from shares over the pixels that are partly covered
/// or drawn so, and the drawn sum over the wanted one.
pub fn compare(texels: &[[u8; 4]], shares: &[Option<f64>]) -> (f64, f64, f64) {
    let (mut squares, mut count, mut worst) = (0.0, 0, 0.0f64);
    let (mut drawn, mut wanted) = (0.0, 0.0);
    for (texel, share) in texels.iter().zip(shares) {
        let Some(share) = share else { continue };
        let alpha = f64::from(texel[3]) / 255.0;
        (drawn, wanted) = (drawn + alpha, wanted + share);
        if (0.0..1.0).contains(share) && *share > 0.0 || (alpha - share).abs() > 0.01 {
            squares += (alpha - share) * (alpha - share);
            count += 1;
            worst = worst.max((alpha - share).abs());
        }
    }
    assert!(count > 30, "{count}");
    ((squares / f64::from(count)).sqrt(), worst, drawn / wanted)
}

pub fn stroked(stroke: Stroke) -> FillStyle {
    FillStyle {
        color: [0.0; 4],
        stroke: Some(stroke),
        ..Default::default()
    }
}

#[test]
fn strokes_are_as_wide_as_asked_on_the_side_asked() {
    let Some(gpu) = gpu() else { return };
    for height_m in [30.0, 1e3, 1e5, 4e6] {
        let zone = circle(height_m);
        let surface = bare(&pose(AT, height_m, 0.0), SMALL);
        let px_m = pixel_m(&surface);
        let mut stage = Stage::new(gpu, built(&[Region::from(zone.clone())]), &surface);
        for align in [Align::Inner, Align::Center, Align::Outer] {
            for width_px in [0.25, 1.0, 4.0] {
                let width_m = width_px * px_m;
                // None is that wide.
                if width_m > 2e5 {
                    continue;
                }
                let pixels = Length::Pixels(width_px as f32);
                let metres = Length::Metres(width_m as f32);
                // Pixels are metres only where all is seen from straight above.
                let widths = if height_m < 1e6 {
                    vec![pixels, metres]
                } else {
                    vec![metres]
                };
                for width in widths {
                    stage.set(
                        0,
                        stroked(Stroke {
                            width,
                            align,
                            ..Default::default()
                        }),
                    );
                    let painted = stage.draw_within(&surface, 0.0);
                    assert_eq!(painted.stats.edge_passes, 1);
                    let outer_m = match align {
                        Align::Inner => 0.0,
                        Align::Center => 0.5 * width_m,
                        Align::Outer => width_m,
                    };
                    let band = outer_m - width_m..outer_m;
                    let wanted = shares(&surface, &zone, |outside_m| band.contains(&outside_m));
                    let (rms, worst, mean) = compare(&painted.texels, &wanted);
                    println!(
                        "{height_m} m {align:?} {width:?}: rms {rms:.3} worst {worst:.3} mean {mean:.4}"
                    );
                    assert!(rms <= 0.08 && worst <= 0.3, "{rms} {worst}");
                    assert!((mean - 1.0).abs() <= 0.04, "{mean}");
                }
            }
        }
    }
}

/// Broad strokes in metres of a circle seen aslant, where what is nearest on the screen is not nearest on
/// the ground, and where metres a pixel change across the stroke.
#[test]
fn broad_strokes_keep_their_width_aslant() {
    let Some(gpu) = gpu() else { return };
    let aslant = |height_m: f64, tilt| (height_m, pose(AT, height_m, tilt));
    let parallel = |picture_m: f64, pitch_deg| {
        let pose = Pose::nadir(AT.lon_deg, AT.lat_deg, 0.0).turned(33.0, pitch_deg);
        (picture_m, pose.parallel(picture_m).back_by(1e6))
    };
    let mirrored = |(height_m, pose)| {
        let signs = DVec2::new(-1.0, 1.0);
        (height_m, Pose { signs, ..pose })
    };
    for (height_m, pose) in [
        aslant(1e3, 0.6),
        aslant(1e5, 0.6),
        aslant(1e5, 0.75),
        aslant(3e5, 0.6),
        parallel(1e3, -35.0),
        parallel(1e5, -25.0),
        mirrored(parallel(1e5, -60.0)),
    ] {
        let surface = bare(&pose, SMALL);
        let px_m = pixel_m(&surface);
        let middle_m = point_at(&surface, SMALL.as_dvec2() * 0.5).expect("the ground");
        let zone = Zone::circle(figure().geodetic(middle_m).0, 20.0 * px_m);
        let mut stage = Stage::new(gpu, built(&[Region::from(zone.clone())]), &surface);
        for (align, width_px, budget_px) in [
            (Align::Inner, 4.0, 0.0),
            (Align::Outer, 4.0, 0.0),
            (Align::Inner, 4.0, 0.25),
            (Align::Outer, 12.0, 0.25),
            (Align::Inner, 12.0, 0.25),
        ] {
            let width_m = width_px * px_m;
            stage.set(
                0,
                stroked(Stroke {
                    width: Length::Metres(width_m as f32),
                    align,
                    ..Default::default()
                }),
            );
            let painted = stage.draw_within(&surface, budget_px);
            let outer_m = if align == Align::Inner { 0.0 } else { width_m };
            let band = outer_m - width_m..outer_m;
            let wanted = shares(&surface, &zone, |outside_m| band.contains(&outside_m));
            let (rms, worst, mean) = compare(&painted.texels, &wanted);
            println!(
                "{height_m} m, {} deg, {align:?} {width_px} px, budget {budget_px}: rms {rms:.3} worst \
                 {worst:.3} mean {mean:.4}",
                pose.pitch_deg
            );
            assert!(rms <= 0.08 && worst <= 0.3, "{rms} {worst}");
            assert!((mean - 1.0).abs() <= 0.04, "{mean}");
        }
    }
}

#[test]
fn smooth_edges_are_as_good_as_four_samples() {
    let Some(gpu) = gpu() else { return };
    let opaque = FillStyle {
        color: [1.0; 4],
        ..Default::default()
    };
    for (height_m, tilt) in [(30.0, 0.0), (1e3, 0.25), (1e5, 0.3), (4e6, 0.0), (4e6, 0.3)] {
        let zone = circle(height_m);
        let drawn = |samples: u32, smooth_edges: bool| {
            let cast = Cast::new(
                &figure(),
                &pose(AT, height_m, tilt),
                SMALL,
                samples,
                Terrain::Bare,
            );
            let surface = Surface::new(&cast, DepthKind::Reversed);
            let mut stage = Stage::new(gpu, built(&[Region::from(zone.clone())]), &surface);
            stage.options = RendererOptions {
                smooth_edges,
                ..stage.options
            };
            stage.renderer = Renderer::new(&gpu.device, stage.options).expect("sound");
            stage.mesh = stage.renderer.insert(built(&[Region::from(zone.clone())]));
            stage.set(0, opaque);
            stage.draw_within(&surface, 0.0).texels
        };
        let surface = bare(&pose(AT, height_m, tilt), SMALL);
        let wanted = shares(&surface, &zone, |outside_m| outside_m <= 0.0);
        let [hard, four, smooth] = [(1, false), (4, false), (1, true)]
            .map(|(samples, smooth)| compare(&drawn(samples, smooth), &wanted));
        println!(
            "{height_m} m, tilt {tilt}: rms (worst) hard {:.3} ({:.2}), 4 samples {:.3} ({:.2}), smooth {:.3} ({:.2})",
            hard.0, hard.1, four.0, four.1, smooth.0, smooth.1
        );
        assert!(
            smooth.0 <= 0.05 && smooth.0 <= four.0,
            "{smooth:?} {four:?}"
        );
    }
}

#[test]
fn dashes_draw_their_share() {
    let Some(gpu) = gpu() else { return };
    for height_m in [1e3, 1e5] {
        let zone = circle(height_m);
        let surface = bare(&pose(AT, height_m, 0.0), SMALL);
        let px_m = pixel_m(&surface);
        let mut stage = Stage::new(gpu, built(&[Region::from(zone)]), &surface);
        let stroke = Stroke {
            width: Length::Pixels(3.0),
            ..Default::default()
        };
        let sum = |stage: &mut Stage<'_>, dash| {
            stage.set(0, stroked(Stroke { dash, ..stroke }));
            let texels = stage.draw(&surface).texels;
            texels.iter().map(|texel| f64::from(texel[3])).sum::<f64>()
        };
        let solid = sum(&mut stage, None);
        for period in [Length::Pixels(5.0), Length::Metres((5.0 * px_m) as f32)] {
            let share = 0.4;
            let dashed = sum(&mut stage, Some(Dash { period, share }));
            println!("{height_m} m, {period:?}: {:.3}", dashed / solid);
            assert!((dashed / solid - 0.4).abs() <= 0.03, "{}", dashed / solid);
        }
    }
}

#[test]
fn frames_without_strokes_measure_no_boundaries_and_still_ones_upload_nothing() {
    let Some(gpu) = gpu() else { return };
    let surface = bare(&pose(AT, 1e4, 0.0), SMALL);
    let mut stage = Stage::new(gpu, built(&[Region::from(circle(1e4))]), &surface);
    let before = stage.draw(&surface).stats;
    assert_eq!((before.edge_passes, before.styled_layers), (0, 0));
    stage.set(0, stroked(Stroke::default()));
    let first = stage.draw(&surface).stats;
    assert_eq!((first.edge_passes, first.styled_layers), (1, 1));
    assert_eq!(stage.draw(&surface).stats.upload_bytes, 0);
    stage.set(0, FillStyle::default());
    let after = stage.draw(&surface).stats;
    assert_eq!(
        (after.draws, after.vertices, after.passes),
        (before.draws, before.vertices, before.passes)
    );
    assert_eq!(after.edge_passes, 0);
}
