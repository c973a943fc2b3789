//! Where patterns might break: at the antimeridian, at poles, at edges of coarse terrain, where an image
//! ends, and where it is repeated often.

use glam::DVec2;
use globefill::{
    Extents, FillStyle, HatchKind, ImageFill, Length, LonLat, Pattern, Placement, Polygon, Region,
    Wrap,
};

use crate::{
    PLACES, SMALL,
    chart::{Layout, Spot},
    common::{
        headless::gpu,
        surface::{Surface, Terrain},
    },
    coverage,
    ink::{hatch, sheet},
    ramps::{Ramps, STEP},
    stage::{Stage, bare, built, figure, ground, over, pixel_m, pose},
};

/// What differences between neighbours tell.
#[derive(Debug, Default)]
struct Breaks {
    /// Texels by which a difference is off.
    texels: f64,
    pairs: usize,
}

/// Compares what changes from pixel to pixel with what should.
fn breaks(surface: &Surface, drawn: &[[u8; 4]], ramps: &Ramps, layout: &Layout) -> Breaks {
    let width = surface.size_px().x as usize;
    let level = |pixel: usize| {
        let uv = layout.uv(&figure(), surface.points_m[pixel]?);
        Some((uv, ramps.level(uv, Wrap::Repeat)))
    };
    let mut breaks = Breaks::default();
    for pixel in (0..surface.pixel_count() - width).filter(|p| (p + 1) % width > 0) {
        let [Some(here), Some(right), Some(below)] = [pixel, pixel + 1, pixel + width].map(level)
        else {
            continue;
        };
        let step = |other: DVec2| {
            let apart = other - here.0;
            ((apart - apart.round()) * ramps.size()).length()
        };
        // Where pixels span more, smaller copies of the image are shown.
        if step(right.0).max(step(below.0)) > 0.5 || surface.at_discontinuity(pixel) {
            continue;
        }
        for (other, (_, there)) in [(pixel + 1, right), (pixel + width, below)] {
            breaks.pairs += 1;
            for channel in 0..2 {
                let drawn_step =
                    f64::from(drawn[other][channel]) - f64::from(drawn[pixel][channel]);
                let off = (drawn_step - (there[channel] - here.1[channel])).abs() / STEP;
                breaks.texels = breaks.texels.max(off);
            }
        }
    }
    breaks
}

fn shows(fill: ImageFill) -> FillStyle {
    FillStyle {
        color: [0.0, 0.0, 0.0, 1.0],
        pattern: Some(Pattern::Image(fill)),
        ..Default::default()
    }
}

#[test]
fn no_seams_at_the_antimeridian_at_poles_and_on_coarse_terrain() {
    let Some(gpu) = gpu() else { return };
    let ramps = Ramps::new(200, 200);
    let mut worst = 0.0f64;
    for (at, terrain, height_m) in [
        (PLACES[3], Terrain::Bare, 1e3),
        (PLACES[3], Terrain::Bare, 3e6),
        (PLACES[1], Terrain::Bare, 30.0),
        (PLACES[1], Terrain::Bare, 2e7),
        (PLACES[2], Terrain::Bare, 1e6),
        (PLACES[0], Terrain::Coarse, 3e4),
        (PLACES[3], Terrain::Coarse, 2e5),
        (PLACES[1], Terrain::Coarse, 3e4),
    ] {
        let surface = over(terrain, &pose(at, height_m, 0.5), SMALL);
        let mut stage = Stage::new(gpu, ground(at), &surface);
        let image = stage.renderer.insert_image(&gpu.queue, &ramps.image());
        let image = image.expect("a small image");
        let side_m = 12.0 * pixel_m(&surface) * ramps.size().x;
        // About the eye, and about a place from which the way leads over the pole or the antimeridian.
        for center in [at, LonLat::new(at.lon_deg - 60.0, 0.7 * at.lat_deg)] {
            let size_m = DVec2::splat(f64::from(side_m.min(3e8) as f32));
            let layout = Layout::new(Spot::Local { center, size_m });
            let placement = Placement::Local {
                center,
                size_m: size_m.as_vec2().to_array(),
            };
            let wrap = Wrap::Repeat;
            let fill = ImageFill {
                placement,
                wrap,
                ..ImageFill::new(image)
            };
            stage.set(0, shows(fill));
            let drawn = stage.draw(&surface).texels;
            let found = breaks(&surface, &drawn, &ramps, &layout);
            println!("{at:?} {terrain:?} {height_m} m about {center:?}: {found:.4?}");
            assert!(found.pairs > 3000, "{found:?}");
            worst = worst.max(found.texels);
        }
    }
    // Rounding of two levels.
    assert!(worst <= 0.03, "{worst}");
}

/// A box that crosses the antimeridian.
fn fiji() -> Region {
    let corners = [
        (177.0, -19.0),
        (-178.0, -19.0),
        (-178.0, -15.0),
        (177.0, -15.0),
    ];
    Region {
        polygons: vec![Polygon {
            shell: corners
                .map(|(lon_deg, lat_deg)| LonLat::new(lon_deg, lat_deg))
                .to_vec(),
            holes: vec![],
        }],
        edges: globefill::EdgeKind::Straight,
        ..Default::default()
    }
}

#[test]
fn images_lie_over_the_extents_of_their_fill_and_end_there() {
    let Some(gpu) = gpu() else { return };
    let at = LonLat::new(179.7, -17.0);
    let surface = bare(&pose(at, 5e5, 0.2), SMALL);
    let ramps = Ramps::new(10, 10);
    let whole = Extents {
        west_deg: 177.0,
        south_deg: -19.0,
        east_deg: -178.0,
        north_deg: -15.0,
    };
    let part = Extents {
        west_deg: 178.5,
        south_deg: -18.0,
        east_deg: 181.0,
        north_deg: -16.0,
    };
    let mut worst = 0.0f64;
    for (mesh, asked, extents) in [
        (built(&[fiji()]), None, whole),
        (ground(at), Some(whole), whole),
        (built(&[fiji()]), Some(part), part),
    ] {
        let mut stage = Stage::new(gpu, mesh, &surface);
        let image = stage.renderer.insert_image(&gpu.queue, &ramps.image());
        let image = image.expect("a small image");
        for geocentric in [false, true] {
            let spot = Spot::Angles {
                extents,
                geocentric,
            };
            let layout = Layout::new(spot);
            let placement = if geocentric {
                Placement::Spherical(asked)
            } else {
                Placement::Geodetic(asked)
            };
            stage.set(
                0,
                shows(ImageFill {
                    placement,
                    ..ImageFill::new(image)
                }),
            );
            let drawn = stage.draw(&surface).texels;
            let (mut inside, mut outside) = (0, 0);
            for (point_m, texel) in surface.points_m.iter().zip(&drawn) {
                let Some(point_m) = point_m else { continue };
                let uv = layout.uv(&figure(), *point_m);
                let to_edge = (uv - 0.5).abs().max_element() - 0.5;
                if to_edge < -0.05 {
                    inside += 1;
                    let wanted = ramps.level(uv, Wrap::Clip);
                    let off = (0..3).map(|k| (f64::from(texel[k]) - wanted[k]).abs());
                    worst = worst.max(off.fold(0.0, f64::max) / STEP);
                } else if to_edge > 0.05 {
                    outside += 1;
                    // The colour of the fill, or nothing where the fill has ended too.
                    assert_eq!(texel[..3], [0, 0, 0], "{uv}");
                }
            }
            assert!(inside > 300 && outside > 300, "{inside} {outside}");
        }
    }
    println!("extents: {worst:.4} texels");
    assert!(worst <= 0.03, "{worst}");
}

#[test]
fn images_are_hatched_from_their_anchor_on() {
    let Some(gpu) = gpu() else { return };
    // Twice as wide as high: one is `spacing` wide, upright, its lower left corner on the anchor.
    let ramps = Ramps::new(100, 50);
    let mut worst = 0.0f64;
    for (at, height_m) in [(PLACES[0], 2.0), (PLACES[3], 4e4), (PLACES[1], 2e6)] {
        let surface = bare(&pose(at, height_m, 0.4), SMALL);
        let mut stage = Stage::new(gpu, ground(at), &surface);
        let image = stage.renderer.insert_image(&gpu.queue, &ramps.image());
        let image = HatchKind::Image(image.expect("a small image"));
        let spacing = (600.0 * pixel_m(&surface)) as f32;
        let anchor = LonLat::new(at.lon_deg + 1.0, 0.99 * at.lat_deg);
        let hatch = hatch(image, Length::Metres(spacing), 0.25, 0.4, anchor);
        stage.set(0, coverage::style_of(hatch));
        let drawn = stage.draw(&surface).texels;
        let sheet = sheet(anchor, 0.4);
        let size_m = f64::from(spacing) * DVec2::new(1.0, -0.5);
        let mut judged = 0;
        for (pixel, texel) in drawn.iter().enumerate() {
            let Some(point_m) =
                surface.points_m[pixel].filter(|_| !surface.at_discontinuity(pixel))
            else {
                continue;
            };
            // Far away the image is shown smaller than it is.
            if point_m.distance(surface.lens.eye_m) > 1.6 * height_m {
                continue;
            }
            judged += 1;
            let wanted = ramps.level(sheet.at_m(point_m) / size_m, Wrap::Repeat);
            for (level, wanted) in texel.iter().zip(wanted).take(2) {
                worst = worst.max((f64::from(*level) - wanted).abs() / STEP);
            }
        }
        assert!(judged > 500, "{judged}");
    }
    println!("hatched images: {worst:.4} texels");
    assert!(worst <= 0.03, "{worst}");
}

/// How far, texels, an image that is repeated often over longitudes is off.
fn repeated_off(repeats: f64) -> f64 {
    let Some(gpu) = gpu() else { return 0.0 };
    let at = LonLat::new(97.3, 31.4);
    let ramps = Ramps::new(100, 100);
    let extents = Extents::GLOBE;
    // A texel takes some ten pixels.
    let height_m = 4e7 / repeats / 100.0 * 7.0;
    let surface = bare(&pose(at, height_m, 0.0), SMALL);
    let mut stage = Stage::new(gpu, ground(at), &surface);
    let image = stage.renderer.insert_image(&gpu.queue, &ramps.image());
    let repeats = DVec2::splat(f64::from(repeats as f32));
    let geocentric = false;
    let layout = Layout {
        repeats,
        ..Layout::new(Spot::Angles {
            extents,
            geocentric,
        })
    };
    stage.set(
        0,
        shows(ImageFill {
            placement: Placement::Geodetic(Some(extents)),
            wrap: Wrap::Repeat,
            repeats: repeats.as_vec2().to_array(),
            ..ImageFill::new(image.expect("a small image"))
        }),
    );
    let drawn = stage.draw(&surface).texels;
    let mut worst = 0.0f64;
    for (point_m, texel) in surface.points_m.iter().zip(&drawn) {
        let Some(point_m) = point_m else { continue };
        let wanted = ramps.level(layout.uv(&figure(), *point_m), Wrap::Repeat);
        for channel in 0..2 {
            let off = (f64::from(texel[channel]) - wanted[channel]).abs() / STEP;
            worst = worst.max(off);
        }
    }
    println!("repeated {} times: {worst:.4} texels", repeats.x);
    worst
}

#[test]
fn images_are_repeated_thousands_of_times() {
    for repeats in [10.0, 100.0, 1e3, 1e4] {
        assert!(repeated_off(repeats) <= 0.25, "{repeats}");
    }
}
