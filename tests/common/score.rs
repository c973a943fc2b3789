//! Wrong pixels, counted: what was drawn against what the oracle says.

use std::fmt;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::{
    oracle::{Oracle, Scratch},
    surface::{Surface, sample_positions},
};

/// Half-width of the band about a true boundary in which either answer is right, pixels.
pub const BAND_PX: f64 = 1.0 / 32.0;

/// The verdict on one picture. A pixel holds fill + 1, or 0 where nothing was drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Score {
    /// Pixels that show the surface.
    pub surface: usize,
    /// Pixels that some fill covers, by the oracle.
    pub covered: usize,
    /// Pixels whose answer differs, whatever the distance.
    pub differing: usize,
    /// Differing pixels farther from the true boundary than the band allows.
    pub wrong: usize,
    /// Wrong pixels that show another region than the oracle's (not just nothing).
    pub stray: usize,
    /// Pixels within one pixel of the limb or of a step in depth that would have been wrong.
    pub wrong_at_limb: usize,
    /// Sky pixels with a fill.
    pub sky: usize,
    /// The greatest displacement of a judged pixel beyond its depth unit, pixels.
    pub worst_px: f64,
    /// The first wrong pixels: x, y, drawn, expected, displacement.
    pub examples: Vec<(u32, u32, u32, u32, f64)>,
}

impl Score {
    pub fn is_clean(&self) -> bool {
        self.wrong == 0 && self.sky == 0
    }
}

impl fmt::Display for Score {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "covered {} of {}, differing {}, wrong {} (stray {}, limb {}, sky {}), worst {:.4} px",
            self.covered,
            self.surface,
            self.differing,
            self.wrong,
            self.stray,
            self.wrong_at_limb,
            self.sky,
            self.worst_px
        )
    }
}

struct Verdict {
    pixel: usize,
    drawn: u32,
    expected: u32,
    /// Pixels to the nearest place where the drawn answer would be right.
    off_px: f64,
    /// What the depth unit excuses.
    depth_px: f64,
}

/// Answers of the oracle for each sample: fill + 1 of the topmost, 0 for none.
pub fn expected_ids(oracle: &Oracle, surface: &Surface) -> Vec<u32> {
    surface
        .points_m
        .par_iter()
        .map_init(Scratch::default, |scratch, point_m| {
            let Some(point_m) = point_m else { return 0 };
            let (foot, _) = oracle.figure.geodetic(*point_m);
            let last = oracle.containing(foot, scratch).pop();
            last.map_or(0, |fill| fill + 1)
        })
        .collect()
}

/// Judges a picture of one id a pixel. With several samples only pixels whose samples agree are
/// judged, and those within a pixel of the boundary are not. `expected` is [`expected_ids`].
pub fn judge(
    oracle: &Oracle,
    surface: &Surface,
    expected: &[u32],
    drawn: &[u32],
    budget_px: f64,
) -> Score {
    let count = surface.pixel_count();
    let samples = surface.samples() as usize;
    assert_eq!(drawn.len(), count);
    assert_eq!(expected.len(), count * samples);
    let band_px = if samples == 1 {
        BAND_PX.max(budget_px)
    } else {
        1.0
    };
    let mut score = Score::default();
    let mut differing = Vec::new();
    for pixel in 0..count {
        let ids = (0..samples).map(|s| expected[s * count + pixel]);
        let seen = (0..samples).all(|s| surface.points_m[s * count + pixel].is_some());
        if !seen {
            let sky = (0..samples).all(|s| surface.points_m[s * count + pixel].is_none());
            score.sky += usize::from(sky && drawn[pixel] != 0);
            continue;
        }
        score.surface += 1;
        score.covered += usize::from(expected[pixel] != 0);
        let agree = ids.clone().all(|id| id == expected[pixel]);
        if agree && drawn[pixel] != expected[pixel] {
            differing.push(pixel);
        }
    }
    score.differing = differing.len();
    let verdicts: Vec<Verdict> = differing
        .par_iter()
        .map_init(Scratch::default, |scratch, &pixel| {
            verdict(
                oracle,
                surface,
                pixel,
                drawn[pixel],
                expected[pixel],
                scratch,
            )
        })
        .collect();
    for v in verdicts {
        let beyond_px = v.off_px - v.depth_px;
        let wrong = beyond_px > band_px;
        if surface.at_discontinuity(v.pixel) {
            score.wrong_at_limb += usize::from(wrong);
            continue;
        }
        score.worst_px = score.worst_px.max(beyond_px);
        if wrong {
            score.wrong += 1;
            score.stray += usize::from(v.drawn != 0);
            if score.examples.len() < 8 {
                let width = surface.size_px().x;
                let (x, y) = (v.pixel as u32 % width, v.pixel as u32 / width);
                score.examples.push((x, y, v.drawn, v.expected, v.off_px));
            }
        }
    }
    score
}

fn verdict(
    oracle: &Oracle,
    surface: &Surface,
    pixel: usize,
    drawn: u32,
    expected: u32,
    scratch: &mut Scratch,
) -> Verdict {
    let width = surface.size_px().x as usize;
    let offset = sample_positions(surface.samples())[0];
    let at_px = DVec2::new((pixel % width) as f64, (pixel / width) as f64) + offset;
    let point_m = surface.points_m[pixel].expect("sky is not judged");
    let (foot, height_m) = oracle.figure.geodetic(point_m);
    let holds_drawn = drawn != 0 && oracle.containing(foot, scratch).contains(&(drawn - 1));
    // Drawn where it is not: how far is it? Not drawn, or drawn beneath: how far to the edge of
    // what should be seen?
    let region = if drawn != 0 && !holds_drawn {
        drawn - 1
    } else {
        expected - 1
    };
    let off_px = if region < oracle.region_count() {
        boundary_distance_px(oracle, surface, region, at_px, point_m, height_m)
    } else {
        f64::INFINITY
    };
    let up = oracle.figure.normal(foot);
    let depth_px = surface.lens.depth_unit_px(at_px, surface.depths[pixel], up);
    Verdict {
        pixel,
        drawn,
        expected,
        off_px,
        depth_px,
    }
}

/// Distance on the screen from a pixel to a region's boundary, raised to the surface's height.
pub fn boundary_distance_px(
    oracle: &Oracle,
    surface: &Surface,
    region: u32,
    at_px: DVec2,
    point_m: DVec3,
    height_m: f64,
) -> f64 {
    let figure = &oracle.figure;
    let foot_m = figure.ecef(figure.geodetic(point_m).0, 0.0);
    let clearance_m =
        |edge: &super::edge::TrueEdge| ((edge.middle_m - foot_m).length() - edge.radius_m).max(0.0);
    let mut near: Vec<_> = oracle
        .boundary(region)
        .map(|edge| (clearance_m(edge), edge))
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut nearest_m = f64::INFINITY;
    let mut found = Vec::new();
    // Seen at a slant, a boundary farther on the ground may be nearer on the screen.
    const SLANT: f64 = 50.0;
    for (clearance_m, edge) in near {
        if clearance_m > nearest_m.min(point_m.length()) * SLANT || found.len() > 400 {
            break;
        }
        let (distance_m, t) = edge.nearest(figure, foot_m);
        nearest_m = nearest_m.min(distance_m);
        found.push((distance_m, t, edge));
    }
    found
        .into_iter()
        .filter(|&(distance_m, ..)| distance_m <= SLANT * nearest_m)
        .map(|(_, t, edge)| {
            let at = |t: f64| figure.ecef(edge.point(figure, t), height_m);
            let speed_m = (at((t + 1e-5).min(1.0)) - at((t - 1e-5).max(0.0))).length()
                / ((t + 1e-5).min(1.0) - (t - 1e-5).max(0.0));
            let reach = SLANT * nearest_m / speed_m;
            const STEPS: i32 = 100;
            let points: Vec<DVec2> = (-STEPS..=STEPS)
                .map(|k| (t + reach * f64::from(k) / f64::from(STEPS)).clamp(0.0, 1.0))
                .map(|t| surface.lens.project(at(t)))
                .filter(|&(_, distance_m)| distance_m > 0.0 || surface.lens.parallel)
                .map(|(px, _)| px)
                .collect();
            points
                .windows(2)
                .map(|w| segment_distance(at_px, w[0], w[1]))
                .fold(f64::INFINITY, f64::min)
        })
        .fold(f64::INFINITY, f64::min)
}

fn segment_distance(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let t = if along.length_squared() > 0.0 {
        ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (a + along * t - p).length()
}
