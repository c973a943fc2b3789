//! Colours: what a style says, computed on the CPU.

use glam::DVec2;
use globefill::{
    Blend, CountTechnique, Fade, FillStyle, Hatch, HatchKind, Image, ImageFill, Length, LonLat,
    Pattern, Ramp, Region, Zone,
};

use crate::{
    PLACES, SMALL,
    common::{
        headless::gpu,
        surface::{Surface, Terrain},
    },
    stage::{Stage, bare, built, figure, ground, middle_px, over, pose},
};

/// One fill over what is below, both premultiplied.
fn over_below(style: &FillStyle, ink: [f64; 4], faded: f64, below: [f64; 4]) -> [f64; 4] {
    let premultiplied = |color: [f32; 4]| {
        let [red, green, blue, alpha] = color.map(f64::from);
        [red * alpha, green * alpha, blue * alpha, alpha]
    };
    let lay = |above: [f64; 4], below: [f64; 4]| -> [f64; 4] {
        std::array::from_fn(|k| above[k] + below[k] * (1.0 - above[3]))
    };
    let painted = lay(
        premultiplied(style.highlight),
        lay(ink, premultiplied(style.color)),
    );
    let shown = painted.map(|part| part * f64::from(style.opacity) * faded);
    match style.blend {
        Blend::Alpha => lay(shown, below),
        Blend::Unordered => unreachable!("mixed fills have tests of their own"),
        Blend::Additive => {
            let [red, green, blue, _] = std::array::from_fn(|k| shown[k] + below[k]);
            [red, green, blue, below[3]]
        }
    }
}

fn assert_shows(found: [u8; 4], wanted: [f64; 4], what: &str) -> f64 {
    // Half a level of rounding for each fill on top of each other, and one.
    assert_near(found, wanted, 1.0, what)
}

/// Fails if a channel is off by more than so many levels of 255; by how many it is at most.
pub fn assert_near(found: [u8; 4], wanted: [f64; 4], levels: f64, what: &str) -> f64 {
    let wanted = wanted.map(|part| 255.0 * part.clamp(0.0, 1.0));
    let off = |k: usize| (f64::from(found[k]) - wanted[k]).abs();
    let worst = (0..4).map(off).fold(0.0, f64::max);
    assert!(worst <= levels + 1e-9, "{what}: {found:?}, not {wanted:?}");
    worst
}

/// Styles of two fills that lie one above the other.
fn styles() -> Vec<[FillStyle; 2]> {
    let plain = FillStyle {
        color: [0.2, 0.4, 0.9, 0.7],
        ..Default::default()
    };
    let light = FillStyle {
        color: [0.5, 0.1, 0.3, 0.6],
        highlight: [1.0, 0.9, 0.0, 0.25],
        opacity: 0.8,
        ..Default::default()
    };
    let added = FillStyle {
        blend: Blend::Additive,
        ..light
    };
    let hidden = FillStyle {
        opacity: 0.0,
        ..light
    };
    let raised = FillStyle {
        z_index: 3,
        ..plain
    };
    let lit_only = FillStyle {
        color: [1.0, 0.0, 0.0, 0.0],
        ..light
    };
    vec![
        [plain, light],
        [light, plain],
        [plain, added],
        [added, plain],
        [added, added],
        [plain, hidden],
        [raised, light],
        [raised, added],
        [plain, lit_only],
    ]
}

#[test]
fn fills_are_laid_over_each_other_as_their_styles_say() {
    let Some(gpu) = gpu() else { return };
    let surface = bare(&pose(PLACES[0], 1e5, 0.3), SMALL);
    let both = [1.8e7, 1.9e7].map(|radius_m| Region::from(Zone::circle(PLACES[0], radius_m)));
    let mut worst = 0.0f64;
    // The same with a pattern whose ink is everywhere, one without any, and images of one colour.
    let full = |share, color| {
        Some(Pattern::Hatch(Hatch {
            kind: HatchKind::Lines,
            share,
            color,
            spacing: Length::Metres(1e4),
            ..Default::default()
        }))
    };
    let glass = Image::from_rgba8(1, 1, &[0, 255, 255, 102]).expect("an image");
    for count in [CountTechnique::Winding, CountTechnique::Stencil] {
        let mut stage = Stage::counted(gpu, built(&both), &surface, count);
        let inserted = stage.renderer.insert_image(&gpu.queue, &glass);
        let image = inserted.expect("a small image");
        let shows = |opacity| {
            Some(Pattern::Image(ImageFill {
                opacity,
                ..ImageFill::new(image)
            }))
        };
        let patterns = [
            (None, [0.0; 4]),
            (full(1.0, [0.0, 1.0, 0.5, 0.4]), [0.0, 0.4, 0.2, 0.4]),
            (full(0.0, [0.0, 1.0, 0.5, 0.4]), [0.0; 4]),
            (shows(1.0), [0.0, 0.4, 0.4, 0.4]),
            (shows(0.25), [0.0, 0.1, 0.1, 0.1]),
        ];
        for (pattern, ink) in patterns {
            for pair in styles() {
                let pair = pair.map(|style| FillStyle { pattern, ..style });
                stage.set(0, pair[0]);
                stage.set(1, pair[1]);
                let painted = stage.draw(&surface);
                assert_eq!(painted.stats.styled_layers > 0, pattern.is_some());
                let mut order = [pair[0], pair[1]];
                order.sort_by_key(|style| style.z_index);
                let wanted = order
                    .iter()
                    .fold([0.0; 4], |below, style| over_below(style, ink, 1.0, below));
                for &texel in &painted.texels {
                    let what = format!("{count:?} {pair:?}");
                    worst = worst.max(assert_shows(texel, wanted, &what));
                }
            }
        }
    }
    println!("colours: {worst:.3} levels");
}

/// What is left between full and gone.
pub fn left(ramp: Option<Ramp>, at: f64) -> f64 {
    ramp.map_or(1.0, |Ramp { full, gone }| {
        let (full, gone) = (f64::from(full), f64::from(gone));
        ((at - gone) / (full - gone)).clamp(0.0, 1.0)
    })
}

/// Distance, metres that a pixel spans across the line of sight, and angle of view, of a pixel.
pub fn seen(surface: &Surface, pixel: usize) -> Option<[f64; 3]> {
    let point_m = surface.points_m[pixel]?;
    let lens = &surface.lens;
    let at_px = middle_px(surface, pixel);
    let way = point_m - lens.eye_m;
    let along = lens.ray(at_px);
    let (_, distance_m) = lens.project(point_m);
    let [here, below] = [DVec2::ZERO, DVec2::Y].map(|step| lens.point_m(at_px + step, distance_m));
    let (foot, _) = figure().geodetic(point_m);
    let sine = -along.normalize().dot(figure().normal(foot));
    Some([
        way.length(),
        here.distance(below),
        sine.clamp(-1.0, 1.0).asin(),
    ])
}

/// Levels that fading is off by with these ramps: by distance, pixel, angle.
fn fading_off(used: [bool; 3]) -> f64 {
    let Some(gpu) = gpu() else { return 0.0 };
    let mut worst = 0.0f64;
    let mut between = 0;
    for (height_m, tilt, terrain) in [
        (3.0, 0.9, Terrain::Bare),
        (5e4, 0.8, Terrain::Bare),
        (5e4, 0.8, Terrain::Rough),
        (4e6, 0.0, Terrain::Bare),
        (3.6e7, 0.7, Terrain::Bare),
    ] {
        let surface = over(terrain, &pose(PLACES[0], height_m, tilt), SMALL);
        let mut stage = Stage::new(gpu, ground(PLACES[0]), &surface);
        let all: Vec<(usize, [f64; 3])> = (0..surface.pixel_count())
            .filter_map(|pixel| seen(&surface, pixel).map(|seen| (pixel, seen)))
            .collect();
        let middle = |k: usize| {
            let mut of: Vec<f64> = all.iter().map(|(_, seen)| seen[k]).collect();
            of.sort_by(f64::total_cmp);
            (of[of.len() / 4] as f32, of[3 * of.len() / 4] as f32)
        };
        let ramps = [0, 1, 2].map(|k| {
            let (low, high) = middle(k);
            if k == 2 { [high, low] } else { [low, high] }
        });
        let [distance_m, pixel_m, angle_rad] = [0, 1, 2].map(|k| {
            let [full, gone] = ramps[k];
            used[k].then_some(Ramp { full, gone })
        });
        let fade = Fade {
            distance_m,
            pixel_m,
            angle_rad,
        };
        let style = FillStyle {
            color: [1.0, 0.5, 0.0, 0.9],
            fade,
            ..Default::default()
        };
        stage.set(0, style);
        let painted = stage.draw(&surface);
        assert_eq!(painted.stats.styled_layers, 1);
        for &(pixel, seen) in &all {
            if surface.at_discontinuity(pixel) {
                continue;
            }
            // Angles fade in proportion to their sines.
            let sines = angle_rad.map(|Ramp { full, gone }| Ramp {
                full: full.sin(),
                gone: gone.sin(),
            });
            let left =
                left(distance_m, seen[0]) * left(pixel_m, seen[1]) * left(sines, seen[2].sin());
            let wanted = over_below(&style, [0.0; 4], left, [0.0; 4]);
            let off = (f64::from(painted.texels[pixel][3]) - 255.0 * wanted[3]).abs();
            worst = worst.max(off);
            between += usize::from((0.1..0.9).contains(&left));
        }
    }
    println!("fades {used:?}: off by {worst:.3} levels, {between} pixels in between");
    assert!(between > 1000, "{between}");
    worst
}

#[test]
fn fills_fade_with_distance_and_size_of_pixels() {
    assert!(fading_off([true, false, false]) <= 1.0);
    assert!(fading_off([false, true, false]) <= 1.0);
    assert!(fading_off([true, true, false]) <= 1.0);
}

#[test]
fn fills_fade_with_the_angle() {
    assert!(fading_off([false, false, true]) <= 1.0);
}

#[test]
fn later_fills_and_greater_z_lie_on_top_across_meshes() {
    let Some(gpu) = gpu() else { return };
    let at = LonLat::new(8.0, 46.0);
    let surface = bare(&pose(at, 1e4, 0.0), SMALL);
    let mut stage = Stage::new(gpu, ground(at), &surface);
    let second = stage.renderer.insert(ground(at));
    let opaque = |color, z_index, pattern| FillStyle {
        color,
        z_index,
        pattern,
        ..Default::default()
    };
    let (red, blue) = ([1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]);
    let everywhere = Some(Pattern::Hatch(Hatch {
        share: 1.0,
        color: [0.0, 1.0, 0.0, 1.0],
        ..Default::default()
    }));
    for (first_z, second_z, pattern, wanted) in [
        (0, 0, None, [0, 0, 255, 255]),
        (1, 0, None, [255, 0, 0, 255]),
        (-1, -1, everywhere, [0, 0, 255, 255]),
        (i32::MAX, i32::MIN, everywhere, [0, 255, 0, 255]),
    ] {
        stage.set(0, opaque(red, first_z, pattern));
        let set = stage
            .renderer
            .set_style(second, 0, opaque(blue, second_z, None));
        set.expect("the style is sound");
        let texels = stage.draw(&surface).texels;
        assert!(
            texels.iter().all(|&texel| texel == wanted),
            "{first_z} {second_z}"
        );
    }
}
