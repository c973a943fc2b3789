//! Spacings in pixels: how far lines are apart on the screen, and how much they cover.

use std::f64::consts::SQRT_2;

use glam::{DVec2, UVec2};
use globefill::{HatchKind, Length, LonLat};

use crate::{
    PLACES,
    chart::Sheet,
    common::{headless::gpu, surface::Surface},
    coverage::style_of,
    ink::{hatch, mean_ink, sheet},
    stage::{Stage, bare, ground, point_at, pose},
};

const SIZE: UVec2 = UVec2::new(240, 135);
const ANGLE_RAD: f32 = 0.35;

/// A line as a row crosses it.
#[derive(Clone, Copy, Debug)]
struct Line {
    middle_px: f64,
    /// All ink of it, pixels.
    ink_px: f64,
}

/// The lines that a row crosses between empty pixels.
fn lines_of(row: &[f64]) -> Vec<Line> {
    let mut lines = Vec::new();
    let mut open: Option<Line> = None;
    let mut after_gap = false;
    for (x, &ink) in row.iter().enumerate() {
        if ink < 0.012 {
            lines.extend(open.take().filter(|_| after_gap));
            after_gap = true;
        } else if after_gap {
            let line = open.get_or_insert(Line {
                middle_px: 0.0,
                ink_px: 0.0,
            });
            line.ink_px += ink;
            // The mean of the places of its ink.
            line.middle_px += ink * (x as f64 + 0.5 - line.middle_px) / line.ink_px;
        }
    }
    lines
}

/// Metres across the lines, and their change per pixel.
fn across(surface: &Surface, sheet: &Sheet, at_px: DVec2) -> Option<(f64, DVec2)> {
    let at = |step: DVec2| point_at(surface, at_px + step).map(|point_m| sheet.at_m(point_m).x);
    let per_px = DVec2::new(
        at(0.5 * DVec2::X)? - at(-0.5 * DVec2::X)?,
        at(0.5 * DVec2::Y)? - at(-0.5 * DVec2::Y)?,
    );
    Some((at(DVec2::ZERO)?, per_px))
}

/// What spacings came out.
#[derive(Clone, Copy, Debug)]
struct Met {
    least: f64,
    most: f64,
    /// How far lines lie from multiples of the greatest 2ᵏ m that is at most half of what was asked, px.
    off_px: f64,
    gaps: usize,
}

impl Met {
    const NONE: Self = Self {
        least: f64::INFINITY,
        most: 0.0,
        off_px: 0.0,
        gaps: 0,
    };

    fn with(self, other: Self) -> Self {
        Self {
            least: self.least.min(other.least),
            most: self.most.max(other.most),
            off_px: self.off_px.max(other.off_px),
            gaps: self.gaps + other.gaps,
        }
    }
}

fn measure(surface: &Surface, sheet: &Sheet, drawn: &[[u8; 4]], asked_px: f64) -> Met {
    let mut met = Met::NONE;
    let width = SIZE.x as usize;
    for y in (5..SIZE.y as usize).step_by(9) {
        let row: Vec<f64> = drawn[y * width..(y + 1) * width]
            .iter()
            .map(|texel| f64::from(texel[0]) / 255.0)
            .collect();
        let lines = lines_of(&row);
        // Ink across the line, of a row that meets it slantwise; none where a row runs along it or merges two.
        let thick_px = |line: &Line| {
            let at_px = DVec2::new(line.middle_px, y as f64 + 0.5);
            let (_, way) = across(surface, sheet, at_px)?;
            let thick_px = line.ink_px * way.x.abs() / way.length();
            (way.x.abs() > 0.4 * way.length() && thick_px < 0.3 * asked_px).then_some(thick_px)
        };
        let thick: Vec<Option<f64>> = lines.iter().map(thick_px).collect();
        // Lines that fade in or out count from half of their ink on: a third of what their neighbours have.
        let counts: Vec<Option<Line>> = (0..lines.len())
            .filter_map(|k| {
                let Some(own) = thick[k] else {
                    return Some(None);
                };
                let around = &thick[k.saturating_sub(1)..(k + 2).min(lines.len())];
                let most = around
                    .iter()
                    .flatten()
                    .fold(0.0, |most: f64, &px| most.max(px));
                (3.0 * own > most).then_some(Some(lines[k]))
            })
            .collect();
        for pair in counts.windows(2) {
            let [Some(one), Some(other)] = pair else {
                continue;
            };
            let at = |x: f64| across(surface, sheet, DVec2::new(x, y as f64 + 0.5));
            let (first, second) = (one.middle_px, other.middle_px);
            let (Some((from_m, start)), Some((_, way)), Some((_, end))) =
                (at(first), at(0.5 * (first + second)), at(second))
            else {
                continue;
            };
            let uneven = (start.length() / end.length()).ln().abs();
            // Where lines run along the row or their scale changes from one to the next, none is between.
            if way.x.abs() < 0.5 * way.length() || uneven > 0.1 {
                continue;
            }
            let gap = (second - first) * way.x.abs() / way.length() / asked_px;
            met.least = met.least.min(gap);
            met.most = met.most.max(gap);
            met.gaps += 1;
            // Where lines grow, or are met slantwise, the middle of the ink is not theirs.
            let level = (asked_px * start.length()).log2();
            let grows = (level - level.floor() - 0.5).abs() < 0.2;
            if grows || uneven > 0.02 || way.x.abs() < 0.9 * way.length() {
                continue;
            }
            let unit_m = (0.5 * asked_px * way.length()).log2().floor().exp2();
            let beside_m = from_m - (from_m / unit_m).round() * unit_m;
            met.off_px = met.off_px.max(beside_m.abs() / start.length());
        }
    }
    met
}

fn spacings(places: &[LonLat], heights_m: &[f64], tilts: &[f64], asked: &[f64]) -> Met {
    let Some(gpu) = gpu() else { return Met::NONE };
    let mut all = Met::NONE;
    for &at in places {
        let first = bare(&pose(at, 1e3, 0.0), SIZE);
        let mut stage = Stage::new(gpu, ground(at), &first);
        let anchor = LonLat::new(at.lon_deg + 5.0, at.lat_deg - 3.0 * at.lat_deg.signum());
        let sheet = sheet(anchor, ANGLE_RAD);
        for &height_m in heights_m {
            for &tilt in tilts {
                let surface = bare(&pose(at, height_m, tilt), SIZE);
                for &asked_px in asked {
                    let spacing = Length::Pixels(asked_px as f32);
                    let lines = hatch(HatchKind::Lines, spacing, 0.25, ANGLE_RAD, anchor);
                    stage.set(0, style_of(lines));
                    let drawn = stage.draw(&surface).texels;
                    let met = measure(&surface, &sheet, &drawn, asked_px);
                    if met.least < 0.686 || met.most.max(10.0 * met.off_px) > 1.45 {
                        println!("{at:?} {height_m} m {tilt} {asked_px} px: {met:?}");
                    }
                    all = all.with(met);
                }
            }
        }
    }
    println!("spacing: {all:.4?}");
    all
}

fn assert_met(met: Met) {
    // Beyond √2, what scale changes within a period.
    assert!(met.gaps > 100 && met.off_px < 0.1, "{met:?}");
    assert!(
        met.least > 0.97 / SQRT_2 && met.most < 1.03 * SQRT_2,
        "{met:?}"
    );
}

/// Not powers of two, 1 m to beyond the Moon.
fn heights_m(count: i32) -> Vec<f64> {
    let ratio = 4e8f64.powf(1.0 / f64::from(count - 1));
    (0..count).map(|k| ratio.powi(k)).collect()
}

#[test]
fn lines_are_as_far_apart_as_asked() {
    let met = spacings(&PLACES[..1], &heights_m(21), &[0.0, 0.7, 0.93], &[12.0]);
    assert_met(met);
}

#[test]
#[ignore = "minutes"]
fn lines_are_as_far_apart_as_asked_everywhere() {
    let asked = [9.0, 12.0, 17.3, 31.0];
    assert_met(spacings(
        &PLACES,
        &heights_m(41),
        &[0.0, 0.4, 0.7, 0.95],
        &asked,
    ));
}

const KINDS: [(HatchKind, f32); 5] = [
    (HatchKind::Lines, 0.25),
    (HatchKind::Lines, 0.06),
    (HatchKind::Cross, 0.2),
    (HatchKind::Dots, 0.1),
    (HatchKind::Checker, 0.5),
];
/// Dots that grow beyond the middle between them and the next.
const LARGE_DOTS: [(HatchKind, f32); 2] = [(HatchKind::Dots, 0.25), (HatchKind::Dots, 0.6)];

/// How far the mean coverage is off: absolute, and as a share of what it should be.
fn means(
    kinds: &[(HatchKind, f32)],
    places: &[LonLat],
    heights_m: &[f64],
    tilts: &[f64],
) -> [f64; 2] {
    let Some(gpu) = gpu() else { return [0.0; 2] };
    let mut worst = [0.0f64; 2];
    for &at in places {
        let first = bare(&pose(at, 1e3, 0.0), SIZE);
        let mut stage = Stage::new(gpu, ground(at), &first);
        for &height_m in heights_m {
            for &tilt in tilts {
                let surface = bare(&pose(at, height_m, tilt), SIZE);
                for &(kind, share) in kinds {
                    // Small enough that the picture holds some hundred periods.
                    let pattern = hatch(kind, Length::Pixels(7.0), share, ANGLE_RAD, at);
                    stage.set(0, style_of(pattern));
                    let drawn = stage.draw(&surface).texels;
                    let shown = (0..surface.pixel_count())
                        .filter(|&pixel| !surface.at_discontinuity(pixel));
                    let inks: Vec<f64> = shown
                        .map(|pixel| f64::from(drawn[pixel][0]) / 255.0)
                        .collect();
                    let wanted = mean_ink(kind, f64::from(share));
                    let off = (inks.iter().sum::<f64>() / inks.len() as f64 - wanted).abs();
                    if off > 0.02 {
                        println!("{at:?} {height_m} m {tilt} {kind:?} {share}: {off:.4}");
                    }
                    worst = [worst[0].max(off), worst[1].max(off / wanted)];
                }
            }
        }
    }
    println!(
        "mean coverage off by {:.4}, {:.4} of it",
        worst[0], worst[1]
    );
    worst
}

#[test]
fn patterns_cover_their_share_at_every_scale() {
    let worst = means(&KINDS, &PLACES[..1], &heights_m(21), &[0.0, 0.8]);
    assert!(worst[0] <= 0.02, "{worst:?}");
}

#[test]
#[ignore = "minutes"]
fn patterns_cover_their_share_at_every_scale_everywhere() {
    let worst = means(&KINDS, &PLACES, &heights_m(41), &[0.0, 0.5, 0.93]);
    assert!(worst[0] <= 0.02, "{worst:?}");
}

#[test]
fn large_dots_cover_their_share_at_every_scale() {
    let worst = means(&LARGE_DOTS, &PLACES[..1], &heights_m(21), &[0.0, 0.8]);
    assert!(worst[0] <= 0.02, "{worst:?}");
}
