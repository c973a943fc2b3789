//! Level of detail: which of a mesh's levels a view draws in one frame.

use glam::{DMat3, DVec2, DVec3};

use crate::{
    fill_mesh::{Arc, Bounds, FillMesh},
    frame::refine::needs_no_refinement,
    frame::sight::Sight,
    frame::window::Window,
};

/// How coarse a level of a mesh is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coarseness {
    /// How far, metres, a chord may lie beside the true edges.
    deviation_m: f64,
    /// Length of the longest chord, metres.
    chord_m: f64,
}

impl Coarseness {
    pub(crate) fn of(level: &FillMesh) -> Self {
        let deviations = level.boundary.iter().map(|vertex| vertex.deviation_m);
        Self {
            deviation_m: deviations.fold(0.0, f32::max).into(),
            chord_m: level.longest_chord_m(),
        }
    }

    /// Whether all that `sight` shows at `distance_m` or farther is within the budget as it is stored.
    pub(crate) fn suffices(&self, sight: &Sight, distance_m: f64) -> bool {
        needs_no_refinement(sight, distance_m, self.chord_m, self.deviation_m)
    }
}

impl Sight {
    /// Whether no point of what is in `bounds` is farther from its boundary than the budget allows: left
    /// out, it is not missed. `least_cos_squared` as below.
    pub(crate) fn is_within_budget(&self, bounds: &Bounds, least_cos_squared: f64) -> bool {
        let radius_m = bounds.radius_rad * self.ellipsoid.a_m.max(self.ellipsoid.b_m);
        let distance_m = self.distance_to_m(bounds) * least_cos_squared;
        radius_m <= self.tolerance_m(distance_m)
    }

    /// The least cos²θ of all lines of sight to surface, θ being the angle from the view axis.
    pub(crate) fn least_cos_squared(&self) -> f64 {
        if self.parallel {
            1.0
        } else {
            Rays::new(self).least_cos_squared()
        }
    }

    /// Lower bound, metres, of the distance at which boundary of `mesh` would have to be seen in the middle
    /// of the picture for its displacements to appear as large as they do where they are.
    ///
    /// At a distance d and an angle θ from the view axis that is d · cos²θ: displacements along the axis
    /// show by tan θ, and depth is d · cos θ.
    pub(crate) fn distance_to_detail_m(&self, mesh: &FillMesh) -> f64 {
        let seen =
            |arc: &&Arc| !self.outside_side_plane(&arc.bounds) && !self.beyond_horizon(&arc.bounds);
        let arcs = mesh.arcs.iter().filter(seen);
        let nearest_m = arcs
            .map(|arc| self.distance_to_m(&arc.bounds))
            .fold(f64::INFINITY, f64::min);
        let above_m = self.eye_height_m - self.nearest_surface_height_m();
        if self.parallel {
            return nearest_m.max(above_m);
        }
        let rays = Rays::new(self);
        (nearest_m * rays.least_cos_squared()).max(above_m * rays.least_cos_squared_over_descent())
    }
}

/// The lines of sight of a perspective, as vectors v of which the view axis has length one: cos²θ = 1 / v².
struct Rays {
    from_ndc: DMat3,
    /// The part of the picture that shows surface: least and greatest corner.
    window: [DVec2; 2],
    /// Unit vector from the eye to the ellipsoid.
    down: DVec3,
}

impl Rays {
    /// The picture is looked at in so many parts across and down.
    const PARTS: u32 = 6;

    fn new(sight: &Sight) -> Self {
        let (foot, _) = sight.ellipsoid.geodetic(sight.eye_ecef_m);
        let down = -sight.ellipsoid.normal(foot);
        Self {
            from_ndc: sight.rays_from_ndc(),
            window: sight.globe_window().common(Window::FULL).corners(),
            down,
        }
    }

    fn at(&self, ndc: DVec2) -> DVec3 {
        self.from_ndc * ndc.extend(1.0)
    }

    fn least_cos_squared(&self) -> f64 {
        let [least, greatest] = self.window;
        let corners = [
            least,
            DVec2::new(greatest.x, least.y),
            DVec2::new(least.x, greatest.y),
            greatest,
        ];
        let lengths = corners.map(|corner| self.at(corner).length_squared());
        1.0 / lengths.into_iter().fold(1.0, f64::max)
    }

    /// Lower bound of cos²θ / cos ψ, where ψ is a line's angle from straight down: a line meets no surface
    /// that is `h` below before h / cos ψ. With v, that is 1 / (|v| (v · down)); of both factors the
    /// greatest values in a part of the picture are at its corners, since they are convex.
    fn least_cos_squared_over_descent(&self) -> f64 {
        let [least, greatest_corner] = self.window;
        let side = (greatest_corner - least) / f64::from(Self::PARTS);
        let mut greatest = 0.0_f64;
        for row in 0..Self::PARTS {
            for column in 0..Self::PARTS {
                let part = DVec2::new(f64::from(column), f64::from(row));
                let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]
                    .map(|(x, y)| self.at(least + (part + DVec2::new(x, y)) * side));
                let length = corners
                    .iter()
                    .fold(0.0, |most: f64, v| most.max(v.length()));
                let descent = corners
                    .iter()
                    .fold(0.0, |most: f64, v| most.max(v.dot(self.down)));
                greatest = greatest.max(length * descent);
            }
        }
        1.0 / greatest
    }
}
