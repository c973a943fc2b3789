//! How much of each pixel is ink, against points counted in f64.

use globefill::{FillStyle, Hatch, HatchKind, Length, LonLat, Pattern};

use crate::{
    HEIGHTS_M, PLACES, SMALL,
    common::headless::gpu,
    ink::{Fan, hatch, mean_ink, sheet},
    stage::{Stage, bare, ground, pixel_m, pose},
};

pub fn style_of(hatch: Hatch) -> FillStyle {
    FillStyle {
        color: [0.0, 0.0, 0.0, 1.0],
        pattern: Some(Pattern::Hatch(hatch)),
        ..Default::default()
    }
}

/// Differences of coverage.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    /// Of a pixel that spans at most a quarter of a period, and of any.
    pixel: f64,
    blurred: f64,
    /// Of the pixels of a picture, the root of the mean square, where a period takes some pixels.
    rms: f64,
    /// Of the mean over all pixels.
    mean: f64,
}

const KINDS: [(HatchKind, f32); 7] = [
    (HatchKind::Lines, 0.25),
    (HatchKind::Lines, 0.04),
    (HatchKind::Lines, 0.8),
    (HatchKind::Cross, 0.2),
    (HatchKind::Dots, 0.25),
    (HatchKind::Dots, 0.6),
    (HatchKind::Checker, 0.5),
];

/// Pixels that a spacing takes in the middle of the picture.
const SPACINGS_PX: [f64; 5] = [0.35, 1.2, 3.1, 9.0, 37.0];

fn place(at: LonLat, heights_m: &[f64], shares: &[f64], side: u32, stride: usize) -> [Worst; 7] {
    let mut worst = [Worst::default(); 7];
    let Some(gpu) = gpu() else { return worst };
    let first = bare(&pose(at, 1e3, 0.0), SMALL);
    let mut stage = Stage::new(gpu, ground(at), &first);
    for &height_m in heights_m {
        for &tilt in shares {
            let surface = bare(&pose(at, height_m, tilt), SMALL);
            let sheet = sheet(at, 0.4);
            let fan = Fan::new(&surface, &sheet, side, stride);
            for spacing_px in SPACINGS_PX {
                let spacing = (spacing_px * pixel_m(&surface)) as f32;
                let spacing_m = f64::from(spacing);
                for ((kind, share), worst) in KINDS.into_iter().zip(&mut worst) {
                    let hatch = hatch(kind, Length::Metres(spacing), share, 0.4, at);
                    stage.set(0, style_of(hatch));
                    let drawn = stage.draw(&surface).texels;
                    let ink = fan.shares(kind, f64::from(share), spacing_m);
                    let (mut sum, mut squares, mut count) = (0.0, 0.0f64, 0.0);
                    for ((pixel, ink), span) in ink.zip(fan.spans(spacing_m)) {
                        let off = f64::from(drawn[pixel][0]) / 255.0 - ink;
                        worst.blurred = worst.blurred.max(off.abs());
                        squares += off * off;
                        if span <= 0.25 {
                            worst.pixel = worst.pixel.max(off.abs());
                        }
                        sum += off;
                        count += 1.0;
                    }
                    if spacing_px > 3.0 {
                        worst.rms = worst.rms.max((squares / count).sqrt());
                    }
                    worst.mean = worst.mean.max((sum / count).abs());
                    assert!(count > 10.0 && mean_ink(kind, f64::from(share)) > 0.0);
                }
            }
        }
    }
    for ((kind, share), worst) in KINDS.iter().zip(&worst) {
        println!("{at:?} {shares:?} {kind:?} {share}: {worst:.4?}");
    }
    worst
}

/// Lines are averaged over a pixel as wide as they cross it; both coordinates of crosses and checkers as if
/// they did not depend on each other, which misses at corners of what is seen obliquely; dots as if their
/// edge were straight. The square pixel's corners make the rest.
fn assert_small(worst: [Worst; 7]) {
    for ((kind, share), worst) in KINDS.into_iter().zip(worst) {
        let (pixel, rms) = match kind {
            HatchKind::Cross => (0.25, 0.06),
            HatchKind::Dots => (0.2, 0.14),
            HatchKind::Checker => (0.45, 0.12),
            _ => (0.12, 0.035),
        };
        assert!(worst.pixel <= pixel, "{kind:?} {share}: {worst:?}");
        assert!(worst.rms <= rms, "{kind:?} {share}: {worst:?}");
        assert!(worst.mean <= 0.02, "{kind:?} {share}: {worst:?}");
    }
}

#[test]
fn pixels_hold_their_share_of_ink() {
    for (k, at) in PLACES.into_iter().enumerate() {
        let heights_m = [HEIGHTS_M[k], HEIGHTS_M[8 - k]];
        for tilt in [0.0, 0.8] {
            assert_small(place(at, &heights_m, &[tilt], 8, 5));
        }
    }
}

#[test]
#[ignore = "minutes"]
fn pixels_hold_their_share_of_ink_everywhere() {
    for at in PLACES {
        assert_small(place(at, &HEIGHTS_M, &[0.0, 0.5, 0.9], 16, 3));
    }
}
