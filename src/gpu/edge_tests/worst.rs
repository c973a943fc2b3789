//! What texels are off by.

use glam::DVec3;
use rayon::prelude::*;

use super::{
    draw::Texel,
    truth::{Measured, Truth},
};
use crate::common::surface::Surface;

/// The worst of a picture.
#[derive(Debug, Default)]
pub struct Worst {
    compared: u32,
    /// Of those, pixels whose distance is none of the true edges'; not judged further.
    outliers: u32,
    signed_px: f64,
    /// Of the distance on the screen.
    screen_px: f64,
    /// Of that where less than 3 px.
    near_px: f64,
    along_ratio: f64,
    missing: u32,
    strangers: u32,
    wrong_sides: u32,
    not_nearest: u32,
}

pub fn compare(
    truth: &Truth,
    surface: &Surface,
    texels: &[Option<Texel>],
    reach: [f32; 2],
) -> Worst {
    let pixels: Vec<(Option<Vec<Measured>>, &Option<Texel>)> = texels
        .par_iter()
        .enumerate()
        .map(|(pixel, texel)| (truth.at(surface, pixel), texel))
        .collect();
    let mut worst = Worst::default();
    let reach = reach.map(f64::from);
    for (pixel, (measured, texel)) in pixels.iter().enumerate() {
        match (measured, texel) {
            (None, texel) => worst.strangers += u32::from(texel.is_some()),
            _ if near_sky(surface, pixel) || grazed(surface, pixel) => {}
            (Some(edges), None) => {
                let [metres, px] = reach;
                let within = |edge: &Measured| {
                    let on_screen = metres == 0.0 && edge.off_px < px;
                    !edge.at_end && (on_screen || edge.signed_m.abs() < metres)
                };
                worst.missing += u32::from(edges.iter().any(within));
            }
            (Some(edges), Some(texel)) => worst.judge(edges, texel, reach),
        }
    }
    worst
}

/// Whether a pixel lies so near to the limb that the ground within reach is not level.
fn near_sky(surface: &Surface, pixel: usize) -> bool {
    const NEAR_PX: i64 = 12;
    let [width, height] = surface.size_px().as_i64vec2().to_array();
    let (x, y) = (pixel as i64 % width, pixel as i64 / width);
    (-1..=1).any(|dx| {
        (-1..=1).any(|dy| {
            let (x, y) = (x + dx * NEAR_PX, y + dy * NEAR_PX);
            let inside = (0..width).contains(&x) && (0..height).contains(&y);
            inside && surface.points_m[(y * width + x) as usize].is_none()
        })
    })
}

/// Whether a pixel sees rough terrain so obliquely that its level is not what it shows: there pixels are
/// taken to span less.
fn grazed(surface: &Surface, pixel: usize) -> bool {
    const LEAST_SINE: f64 = 0.2;
    let (low_m, high_m) = surface.terrain.range_m();
    let is_grazed = |point_m: DVec3| {
        let (foot, _) = surface.figure().geodetic(point_m);
        let ray = (point_m - surface.lens.eye_m).normalize();
        -ray.dot(surface.figure().normal(foot)) < LEAST_SINE
    };
    low_m < high_m && surface.points_m[pixel].is_some_and(is_grazed)
}

impl Worst {
    pub fn passes(&self) -> bool {
        let wrong = self.missing + self.strangers + self.wrong_sides + self.not_nearest;
        self.compared >= 100 && self.near_px < 1.0 / 16.0 && self.outliers == 0 && wrong == 0
    }

    fn judge(&mut self, edges: &[Measured], texel: &Texel, [metres, px]: [f64; 2]) {
        // The texel tells of one of the edges: of that whose distance it has.
        let off_m = |edge: &&Measured| (edge.signed_m.abs() - texel.signed_m.abs()).abs();
        let edge = edges
            .iter()
            .min_by(|a, b| off_m(a).total_cmp(&off_m(b)))
            .expect("there are edges");
        // Where an end is near on the screen, what is nearest there and on the ground differ.
        let ends = |edge: &Measured| edge.at_end && edge.off_px < px + 3.0;
        if edge.at_end || edge.off_px.is_infinite() || edges.iter().any(ends) {
            return;
        }
        self.compared += 1;
        let signed_px = off_m(&edge) / texel.across_m;
        let allowed_px = if edge.off_px < 3.0 {
            1.0 / 16.0
        } else {
            1.0 / 8.0
        };
        if signed_px > allowed_px {
            self.outliers += 1;
            return;
        }
        self.signed_px = self.signed_px.max(signed_px);
        let flipped = texel.signed_m.signum() != edge.signed_m.signum()
            && edge.signed_m.abs() > 0.05 * texel.across_m;
        let twins = edges
            .iter()
            .filter(|twin| off_m(twin) < 0.05 * texel.across_m);
        self.wrong_sides += u32::from((texel.sides != edge.sides || flipped) && twins.count() == 1);
        if metres == 0.0 {
            let off_px = texel.signed_m.abs() / texel.across_m;
            let wrong_px = (off_px - edge.off_px).abs();
            self.screen_px = self.screen_px.max(wrong_px);
            self.strangers += u32::from(edge.off_px > px + 1.2);
            // Level ground is a fair guess of curved ground that is not too far.
            let nearer = |other: &Measured| !other.at_end && other.off_px < (off_px - 0.3).min(3.0);
            self.not_nearest += u32::from(edges.iter().any(nearer));
            if edge.off_px < 3.0 {
                self.near_px = self.near_px.max(wrong_px);
                let ratio = (texel.along_m / edge.along_m).ln().abs();
                self.along_ratio = self.along_ratio.max(ratio);
            }
        }
    }
}
