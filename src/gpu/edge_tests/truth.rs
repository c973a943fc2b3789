//! Boundaries measured in f64.

use glam::DVec2;

use crate::{
    common::{edge::TrueEdge, figure::Figure, pair_mesh::Pair, surface::Surface},
    ellipsoid::Ellipsoid,
};

/// The true boundaries of a pair, with the ids on either side.
pub struct Truth {
    pub figure: Figure,
    edges: Vec<(TrueEdge, [u32; 2])>,
}

/// What is true of a pixel and one edge.
#[derive(Clone, Copy, Debug)]
pub struct Measured {
    pub signed_m: f64,
    /// Distance on the screen between the pixel's centre and the edge, drawn at the height of the ground
    /// there.
    pub off_px: f64,
    /// Metres a pixel, along the edge as it is seen.
    pub along_m: f64,
    pub sides: [u32; 2],
    /// Whether the nearest point is an end.
    pub at_end: bool,
}

impl Truth {
    pub fn new(pair: &Pair) -> Self {
        let figure = Figure::new(Ellipsoid::WGS84);
        let walks = [
            (pair.a, pair.b, [1, 2]),
            (pair.b, pair.left, [1, 0]),
            (pair.left, pair.a, [1, 0]),
            (pair.b, pair.right, [0, 2]),
            (pair.right, pair.a, [0, 2]),
        ];
        let edges = walks
            .into_iter()
            .flat_map(|(from, to, sides)| {
                TrueEdge::between(&figure, pair.kind, from, to)
                    .into_iter()
                    .map(move |edge| (edge, sides))
            })
            .collect();
        Self { figure, edges }
    }

    /// All edges, measured from a pixel; none in the sky.
    pub fn at(&self, surface: &Surface, pixel: usize) -> Option<Vec<Measured>> {
        let figure = &self.figure;
        let (foot, height_m) = figure.geodetic(surface.points_m[pixel]?);
        let foot_m = figure.ecef(foot, 0.0);
        let width = surface.size_px().x as usize;
        let centre_px = DVec2::new((pixel % width) as f64, (pixel / width) as f64) + 0.5;
        let measure = |(edge, sides): &(TrueEdge, [u32; 2])| {
            let (off_m, t) = edge.nearest(figure, foot_m);
            let ahead_m = |t: f64| figure.ecef(edge.point(figure, t), 0.0);
            let [before_m, after_m] = [(t - 1e-4).max(0.0), (t + 1e-4).min(1.0)].map(ahead_m);
            let left = figure.normal(foot).cross(after_m - before_m);
            // On the screen: Newton's method from the nearest point on the ground.
            let project = |t: f64| {
                let at_m = figure.ecef(edge.point(figure, t), height_m);
                let (at_px, distance_m) = surface.lens.project(at_m);
                (distance_m > 0.0).then_some(at_px)
            };
            let step = (0.01 * off_m / edge.radius_m).clamp(1e-9, 1e-3);
            let per_t = |t: f64| Some((project(t + step)? - project(t - step)?) / (2.0 * step));
            let on_screen = (0..30).try_fold(t, |t, _| {
                let way_px = per_t(t)?;
                let change = (centre_px - project(t)?).dot(way_px) / way_px.length_squared();
                Some((t + change).clamp(0.0, 1.0))
            });
            let off_px = on_screen
                .and_then(|t| Some((centre_px - project(t)?).length()))
                .unwrap_or(f64::INFINITY);
            let along_m = on_screen.and_then(per_t).map_or(f64::NAN, |way_px| {
                let t = on_screen.unwrap_or(t);
                ahead_m(t + step).distance(ahead_m(t - step)) / (2.0 * step) / way_px.length()
            });
            Measured {
                signed_m: off_m * (foot_m - ahead_m(t)).dot(left).signum(),
                off_px,
                along_m,
                sides: *sides,
                at_end: [Some(t), on_screen]
                    .into_iter()
                    .flatten()
                    .any(|t| !(1e-7..=1.0 - 1e-7).contains(&t)),
            }
        };
        Some(self.edges.iter().map(measure).collect())
    }
}
