//! Which points of a repeating pattern are ink, by its definition.

use glam::{DVec2, UVec2};
use globefill::{Hatch, HatchKind, Length, LonLat};

use crate::{
    chart::Sheet,
    common::surface::Surface,
    stage::{figure, point_at},
};

/// A pattern in metres about an anchor: white on nothing.
pub fn hatch(
    kind: HatchKind,
    spacing: Length,
    share: f32,
    angle_rad: f32,
    anchor: LonLat,
) -> Hatch {
    Hatch {
        kind,
        color: [1.0; 4],
        spacing,
        share,
        angle_rad,
        anchor: Some(anchor),
    }
}

pub fn sheet(anchor: LonLat, angle_rad: f32) -> Sheet {
    Sheet::new(&figure(), anchor, f64::from(angle_rad))
}

/// Whether a point is ink, at coordinates counted in spacings.
pub fn is_ink(kind: HatchKind, share: f64, at: DVec2) -> bool {
    let from_line = (at - at.round()).abs();
    match kind {
        HatchKind::Lines => from_line.x <= 0.5 * share,
        HatchKind::Cross => from_line.min_element() <= 0.5 * share,
        HatchKind::Dots => from_line.length_squared() <= share / std::f64::consts::PI,
        HatchKind::Checker => {
            let square = at.floor();
            (square.x + square.y).rem_euclid(2.0) == 0.0
        }
        HatchKind::Image(_) => panic!("images have no ink"),
    }
}

/// Which share of the surface is ink.
pub fn mean_ink(kind: HatchKind, share: f64) -> f64 {
    match kind {
        HatchKind::Cross => 1.0 - (1.0 - share) * (1.0 - share),
        HatchKind::Checker => 0.5,
        _ => share,
    }
}

/// Places on a map, metres, at many points of some pixels.
pub struct Fan {
    /// Points across a pixel.
    side: u32,
    /// Of each pixel, those of all its points: only pixels that show nothing but the ground.
    pixels: Vec<(usize, Vec<DVec2>)>,
}

impl Fan {
    /// Every `stride`-th pixel.
    pub fn new(surface: &Surface, sheet: &Sheet, side: u32, stride: usize) -> Self {
        use rayon::prelude::*;
        let size: UVec2 = surface.size_px();
        let pixels = (0..surface.pixel_count())
            .into_par_iter()
            .step_by(stride)
            .filter_map(|pixel| {
                let (x, y) = (pixel as u32 % size.x, pixel as u32 / size.x);
                let corner = DVec2::new(f64::from(x), f64::from(y));
                let points: Option<Vec<DVec2>> = (0..side * side)
                    .map(|k| {
                        let step = UVec2::new(k % side, k / side).as_dvec2() + 0.5;
                        let at_px = corner + step / f64::from(side);
                        point_at(surface, at_px).map(|point_m| sheet.at_m(point_m))
                    })
                    .collect();
                points.map(|points| (pixel, points))
            })
            .collect();
        Self { side, pixels }
    }

    /// Periods that a pixel spans at most, one after the other.
    pub fn spans(&self, spacing_m: f64) -> impl Iterator<Item = f64> {
        let last = (self.side * self.side - 1) as usize;
        let row = self.side as usize - 1;
        let grown = f64::from(self.side) / (f64::from(self.side) - 1.0);
        self.pixels.iter().map(move |(_, at)| {
            let one = (at[last] - at[0]).length();
            let other = (at[row] - at[last - row]).length();
            one.max(other) * grown / spacing_m
        })
    }

    /// Pixels, and which share of each is ink.
    pub fn shares(
        &self,
        kind: HatchKind,
        share: f64,
        spacing_m: f64,
    ) -> impl Iterator<Item = (usize, f64)> {
        self.pixels.iter().map(move |(pixel, at)| {
            let ink = at.iter().filter(|&&at| is_ink(kind, share, at / spacing_m));
            (*pixel, ink.count() as f64 / at.len() as f64)
        })
    }
}
