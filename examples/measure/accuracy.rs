//! How far a picture is from the true boundaries.

use rayon::prelude::*;

use crate::{
    common::{
        camera::{DepthRange, DepthSteps, Pose},
        oracle::Oracle,
        score::{expected_ids, judge},
        surface::{Cast, Surface, Terrain},
    },
    stage::Stage,
};

/// Answers of the oracle for every pixel of a stage.
pub struct Judge {
    oracle: Oracle,
    surface: Surface,
    expected: Vec<u32>,
}

/// What is wrong with a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PictureError {
    /// Pixels farther beside the true boundary than the budget and 1/32 px allow.
    pub wrong_px: usize,
    /// Pixels that differ at all.
    pub differing_px: usize,
    /// The farthest, pixels; infinite where a fill shows that is nowhere near.
    pub worst_px: f64,
    /// The farthest, metres on the ground.
    pub worst_m: f64,
}

impl Judge {
    pub fn new(stage: &Stage) -> Self {
        let oracle = Oracle::new(&stage.scene.regions, stage.ellipsoid);
        let (view, lens) = (stage.scene.viewpoint, stage.eye.lens);
        let pose = Pose {
            fov_deg: lens.fov_deg,
            ..Pose::nadir(view.foot.lon_deg, view.foot.lat_deg, view.height_m)
                .turned(view.heading_deg, view.pitch_deg)
        };
        let terrain = match stage.scene.ground_m {
            0.0 => Terrain::Bare,
            height_m => Terrain::Plateau { height_m },
        };
        let cast = Cast::new(&oracle.figure, &pose, lens.size_px, 1, terrain);
        let range = DepthRange::ReversedInfinite {
            near_m: lens.near_m,
        };
        let surface = Surface::stored(&cast, range, DepthSteps::Float);
        Self {
            expected: expected_ids(&oracle, &surface),
            oracle,
            surface,
        }
    }

    /// Judges the fill of every pixel, counted from 1; 0 for none. Wrong is what is off by more
    /// than `budget_px`.
    pub fn error_of(&self, drawn: &[u32], budget_px: f64) -> PictureError {
        let score = judge(
            &self.oracle,
            &self.surface,
            &self.expected,
            drawn,
            budget_px,
        );
        PictureError {
            wrong_px: score.wrong + score.sky,
            differing_px: score.differing,
            worst_px: score.worst_px,
            worst_m: self.worst_m(drawn),
        }
    }

    fn worst_m(&self, drawn: &[u32]) -> f64 {
        let pixels = (0..drawn.len()).into_par_iter();
        pixels
            .filter(|&pixel| drawn[pixel] != self.expected[pixel])
            .filter(|&pixel| !self.surface.at_discontinuity(pixel))
            .map(|pixel| self.off_m(pixel, drawn[pixel]))
            .reduce(|| 0.0, f64::max)
    }

    /// From a pixel's place to the boundary of what should not show there, or should.
    fn off_m(&self, pixel: usize, drawn: u32) -> f64 {
        let Some(point_m) = self.surface.points_m[pixel] else {
            return 0.0;
        };
        let fill = if drawn != 0 {
            drawn
        } else {
            self.expected[pixel]
        } - 1;
        if fill >= self.oracle.region_count() {
            return f64::INFINITY;
        }
        let figure = &self.oracle.figure;
        let foot_m = figure.ecef(figure.geodetic(point_m).0, 0.0);
        let mut nearest_m = f64::INFINITY;
        for edge in self.oracle.boundary(fill) {
            let at_least_m = (edge.middle_m - foot_m).length() - edge.radius_m;
            if at_least_m < nearest_m {
                nearest_m = nearest_m.min(edge.nearest(figure, foot_m).0);
            }
        }
        nearest_m
    }
}
