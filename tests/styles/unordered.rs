//! Fills that are mixed in no order, against filters that lie on each other, computed in f64.

use globefill::{
    Blend, CountTechnique, Ellipsoid, FillStyle, LonLat, Pattern, Region, RendererError, Stroke,
    StyleError, Zone, wgpu,
};

use crate::{
    PLACES, SMALL,
    colors::assert_near,
    common::{
        draw::frame_of,
        headless::{gpu, gpu_without},
        surface::{Cast, DepthKind, Surface, Terrain},
        zone_oracle::ZoneOracle,
    },
    stage::{Stage, bare, built, figure, ground, middle_px, pixel_m, point_at, pose},
};

const BOTH: [CountTechnique; 2] = [CountTechnique::Winding, CountTechnique::Stencil];
/// Pixels left out on either side of a boundary: the budget, samples, and half a pixel's diagonal.
const BAND_PX: f64 = 2.0;

/// Half a level of rounding for each blend, and what weights in integers add where so many fit in a scene: half
/// a level at the very most for each fill, far less where few overlap.
const MOST_LEVELS: f64 = 1.5;

/// Weights of 8 bits: 64 units per optical depth here.
const MOST_HALF_LEVELS: f64 = 4.0;

/// The k-th of numbers that fill 0 … 1 evenly.
fn part(k: usize, step: f64) -> f64 {
    (k as f64 * step).fract()
}

/// Circles about a place as large as what is seen of it, of all colours.
fn circles(at: LonLat, count: usize, seen_m: f64) -> Vec<(Zone, FillStyle)> {
    let to = ZoneOracle::new(&Zone::circle(at, 1.0), Ellipsoid::WGS84);
    let circle = |k: usize| {
        let middle = to.go(at, 360.0 * part(k, 0.618), 0.5 * seen_m * part(k, 0.414));
        let zone = Zone::circle(middle, seen_m * (0.05 + 0.4 * part(k, 0.732)));
        let color = [0.236, 0.449, 0.874].map(|step| part(k, step) as f32);
        let [red, green, blue] = color;
        let style = FillStyle {
            color: [red, green, blue, 0.02 + 0.9 * part(k, 0.317).powi(4) as f32],
            opacity: if k.is_multiple_of(3) { 0.7 } else { 1.0 },
            blend: Blend::Unordered,
            ..Default::default()
        };
        (zone, style)
    };
    (0..count).map(circle).collect()
}

/// What filters look like over `below`, all premultiplied.
fn filtered(styles: &[FillStyle], below: [f64; 4]) -> [f64; 4] {
    let (mut colors, mut depth) = ([0.0; 3], 0.0);
    for style in styles {
        let absorbed = -(1.0 - f64::from(style.color[3]) * f64::from(style.opacity)).ln();
        for (sum, color) in colors.iter_mut().zip(style.color) {
            *sum += absorbed * f64::from(color);
        }
        depth += absorbed;
    }
    let alpha = 1.0 - (-depth).exp();
    let mixed = colors.map(|sum| if depth > 0.0 { sum / depth } else { 0.0 });
    let [red, green, blue] = mixed.map(|part| part * alpha);
    let above = [red, green, blue, alpha];
    std::array::from_fn(|k| above[k] + below[k] * (1.0 - alpha))
}

/// Draws circles over one ordered fill, and compares every pixel away from their boundaries.
fn compare(
    stage: &mut Stage<'_>,
    surface: &Surface,
    zones: &[(Zone, FillStyle)],
    levels: f64,
    what: &str,
) {
    let oracles: Vec<ZoneOracle> = zones
        .iter()
        .map(|(zone, _)| ZoneOracle::new(zone, Ellipsoid::WGS84))
        .collect();
    let below = FillStyle {
        color: [0.1, 0.2, 0.6, 0.5],
        ..Default::default()
    };
    stage.set(0, below);
    for (fill, (_, style)) in (1..).zip(zones) {
        stage.set(fill, *style);
    }
    let painted = stage.draw(surface);
    assert_eq!(painted.stats.layers, 2, "{what}");
    assert_eq!(painted.stats.styled_layers, 0, "{what}");
    assert_eq!(painted.stats.technique, stage.options.count, "{what}");
    let band_m = BAND_PX * pixel_m(surface);
    let (mut compared, mut deepest, mut worst) = (0, 0, 0.0_f64);
    for (pixel, &texel) in painted.texels.iter().enumerate() {
        let Some(point_m) = point_at(surface, middle_px(surface, pixel)) else {
            continue;
        };
        let at = figure().geodetic(point_m).0;
        let outside_m: Vec<f64> = oracles.iter().map(|oracle| oracle.outside_m(at)).collect();
        if outside_m.iter().any(|outside_m| outside_m.abs() < band_m) {
            continue;
        }
        let inside = zones.iter().zip(&outside_m).filter(|(_, m)| **m < 0.0);
        let styles: Vec<FillStyle> = inside.map(|((_, style), _)| *style).collect();
        let wanted = filtered(&styles, [0.05, 0.1, 0.3, 0.5]);
        worst = worst.max(assert_near(texel, wanted, levels, what));
        compared += 1;
        deepest = deepest.max(styles.len());
    }
    println!("{what}: {compared} pixels, {deepest} deep, {worst:.2} levels");
    assert!(8 * compared > painted.texels.len() && deepest > 5, "{what}");
}

fn mesh_of(at: LonLat, zones: &[(Zone, FillStyle)]) -> globefill::FillMesh {
    let below = Region::from(Zone::circle(at, 1.9e7));
    let above = zones.iter().map(|(zone, _)| Region::from(zone.clone()));
    built(&std::iter::once(below).chain(above).collect::<Vec<_>>())
}

#[test]
fn unordered_fills_mix_like_filters() {
    let Some(gpu) = gpu() else { return };
    for at in PLACES {
        for (height_m, share) in [(1e4, 0.0), (1e6, 0.3), (2e7, 0.0)] {
            let surface = bare(&pose(at, height_m, share), SMALL);
            let seen_m = (pixel_m(&surface) * f64::from(SMALL.x)).min(8e6);
            let zones = circles(at, 24, seen_m);
            for count in BOTH {
                let mut stage = Stage::counted(gpu, mesh_of(at, &zones), &surface, count);
                let what = format!("{at:?} from {height_m} m by {count:?}");
                compare(&mut stage, &surface, &zones, MOST_LEVELS, &what);
            }
        }
    }
}

#[test]
fn over_mountains_and_with_four_samples_too() {
    let Some(gpu) = gpu() else { return };
    let (at, height_m) = (PLACES[0], 3e5);
    let pose = pose(at, height_m, 0.4);
    for (samples, terrain) in [(1, Terrain::Rough), (4, Terrain::Bare)] {
        let cast = Cast::new(&figure(), &pose, SMALL, samples, terrain);
        let surface = Surface::new(&cast, DepthKind::Reversed);
        let zones = circles(at, 24, pixel_m(&surface) * f64::from(SMALL.x));
        for count in BOTH {
            let mut stage = Stage::counted(gpu, mesh_of(at, &zones), &surface, count);
            let what = format!("{terrain:?}, {samples} samples, by {count:?}");
            compare(&mut stage, &surface, &zones, MOST_LEVELS, &what);
        }
    }
}

/// Where 32-bit floats do not blend the stencil counts, and half floats add weights of 8 bits.
#[test]
fn half_floats_mix_more_coarsely() {
    let Some(poorer) = gpu_without(wgpu::Features::FLOAT32_BLENDABLE) else {
        return;
    };
    let surface = bare(&pose(PLACES[0], 1e6, 0.3), SMALL);
    let zones = circles(PLACES[0], 24, pixel_m(&surface) * f64::from(SMALL.x));
    let mesh = mesh_of(PLACES[0], &zones);
    let mut stage = Stage::counted(&poorer, mesh, &surface, CountTechnique::Stencil);
    compare(
        &mut stage,
        &surface,
        &zones,
        MOST_HALF_LEVELS,
        "half floats",
    );
}

/// What chains of ordered fills would need hundreds of layers for.
#[test]
fn hundreds_that_overlap_take_one_layer_and_few_draws() {
    let Some(gpu) = gpu() else { return };
    let surface = bare(&pose(PLACES[0], 2e6, 0.0), SMALL);
    let zones = circles(PLACES[0], 400, 1e6);
    let regions: Vec<Region> = zones.iter().map(|(zone, _)| zone.clone().into()).collect();
    let mut stage = Stage::new(gpu, built(&regions), &surface);
    for fill in 0..400 {
        stage.set(fill, FillStyle::default());
    }
    let frame = frame_of(&surface, 0.25);
    let refused = stage.renderer.prepare(&gpu.queue, &mut stage.view, &frame);
    assert!(
        matches!(refused, Err(RendererError::TooManyLayers { .. })),
        "{refused:?}"
    );
    for fill in 0..400 {
        let style = FillStyle {
            color: [1.0, 0.3, 0.1, 0.02],
            blend: Blend::Unordered,
            ..Default::default()
        };
        stage.set(fill, style);
    }
    let painted = stage.draw(&surface);
    assert_eq!(painted.stats.layers, 1);
    assert_eq!(painted.stats.technique, CountTechnique::Winding);
    assert!(painted.stats.draws < 10, "{:?}", painted.stats);
    assert_eq!(stage.draw(&surface).stats.upload_bytes, 0);
}

#[test]
fn what_is_hidden_takes_no_layer() {
    let Some(gpu) = gpu() else { return };
    let surface = bare(&pose(PLACES[0], 1e5, 0.0), SMALL);
    let mut stage = Stage::new(gpu, ground(PLACES[0]), &surface);
    let style = FillStyle {
        color: [1.0, 0.0, 0.0, 0.5],
        blend: Blend::Unordered,
        ..Default::default()
    };
    stage.set(0, style);
    assert_eq!(stage.draw(&surface).stats.layers, 1);
    stage.set(
        0,
        FillStyle {
            visible: false,
            ..style
        },
    );
    let painted = stage.draw(&surface);
    assert_eq!((painted.stats.layers, painted.stats.draws), (0, 0));
    assert!(painted.texels.iter().all(|texel| *texel == [0; 4]));
}

#[test]
fn unordered_fills_are_plain() {
    let Some(gpu) = gpu() else { return };
    let surface = bare(&pose(PLACES[0], 1e5, 0.0), SMALL);
    let mut stage = Stage::new(gpu, ground(PLACES[0]), &surface);
    let plain = FillStyle {
        blend: Blend::Unordered,
        ..Default::default()
    };
    let mut faded = plain;
    faded.fade.distance_m = Some(globefill::Ramp {
        full: 1.0,
        gone: 2.0,
    });
    let pattern = Some(Pattern::Hatch(Default::default()));
    let stroke = Some(Stroke::default());
    for style in [
        FillStyle { pattern, ..plain },
        FillStyle { stroke, ..plain },
        faded,
    ] {
        let refused = stage.renderer.set_style(stage.mesh, 0, style);
        let error = StyleError::UnorderedIsPlain;
        assert_eq!(refused, Err(RendererError::InvalidStyle { fill: 0, error }));
    }
}
