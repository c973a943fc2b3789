//! The kinds of curve that bound a footprint, as points of the unit sphere in scaled coordinates.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use super::{horizon::Horizon, scaled_apex::ScaledApex};

/// A curve from t = 0 to t = 1.
#[derive(Clone, Debug)]
pub(super) enum Course {
    /// Part of the horizon: from an angle, radians, over a sweep.
    Horizon(Box<Horizon>, f64, f64),
    /// Part of the section with a plane through the apex.
    Section(SectionArc),
    /// Part of the section with a circular cone about the apex.
    Cone(Box<ConeArc>),
}

impl Course {
    pub(super) fn unit(&self, t: f64) -> DVec3 {
        match self {
            Self::Horizon(horizon, from_rad, sweep_rad) => horizon.unit(from_rad + t * sweep_rad),
            Self::Section(arc) => arc.unit(t),
            Self::Cone(arc) => arc.unit(t),
        }
    }
}

/// A circle of the unit sphere, by the angle round it: as exact near the limb as elsewhere.
#[derive(Clone, Copy, Debug)]
pub(super) struct SectionArc {
    centre: DVec3,
    /// Radius towards the apex, and along.
    axes: [DVec3; 2],
    from_rad: f64,
    sweep_rad: f64,
}

impl SectionArc {
    /// Along the plane through the apex whose normal, to the left, is `inward`, between points of it.
    pub(super) fn between(apex: &ScaledApex, inward: DVec3, start: DVec3, end: DVec3) -> Self {
        let normal = (inward * apex.radii_m).normalize();
        let distance = normal.dot(apex.apex);
        let centre = normal * distance;
        let towards_apex = (apex.apex - centre).normalize();
        let along = normal.cross(towards_apex);
        let radius = (1.0 - distance * distance).max(0.0).sqrt();
        let [from_rad, to_rad] = [start, end].map(|point| {
            let out = point - centre;
            out.dot(along).atan2(out.dot(towards_apex))
        });
        Self {
            centre,
            axes: [towards_apex * radius, along * radius],
            from_rad,
            // All that is seen lies within a quarter turn of the apex: no other way round.
            sweep_rad: to_rad - from_rad,
        }
    }

    fn unit(&self, t: f64) -> DVec3 {
        let (sin, cos) = (self.from_rad + t * self.sweep_rad).sin_cos();
        self.centre + self.axes[0] * cos + self.axes[1] * sin
    }
}

/// Hits of the directions of a circular cone, by the angle round it.
#[derive(Clone, Copy, Debug)]
pub(super) struct ConeArc {
    apex: ScaledApex,
    /// Scaled directions: D = x cos ψ + y sin ψ + z.
    axes: [DVec3; 3],
    from_rad: f64,
    sweep_rad: f64,
    /// Whether both ends are directions of tangents.
    ends_on_limb: bool,
}

impl ConeArc {
    pub(super) fn new(
        apex: ScaledApex,
        axes: [DVec3; 3],
        from_rad: f64,
        sweep_rad: f64,
        ends_on_limb: bool,
    ) -> Self {
        Self {
            axes: axes.map(|axis| axis / apex.radii_m),
            apex,
            from_rad,
            sweep_rad,
            ends_on_limb,
        }
    }

    fn unit(&self, t: f64) -> DVec3 {
        if !self.ends_on_limb {
            let scaled = self.scaled(self.from_rad + t * self.sweep_rad);
            return self
                .apex
                .hit_at(scaled, self.apex.hit_form(scaled, scaled));
        }
        // Towards the limb a hit moves with the square root of the angle: as fast in t everywhere if
        // the angle follows sin²; and what the hit depends on is counted from the tangent at the end,
        // where it is 0, since the root of its rounding alone would be centimetres.
        let (sin, cos) = (FRAC_PI_2 * t).sin_cos();
        let (end_rad, offset_rad) = if t < 0.5 {
            (self.from_rad, self.sweep_rad * sin * sin)
        } else {
            (self.from_rad + self.sweep_rad, -self.sweep_rad * cos * cos)
        };
        let tangent = self.scaled(end_rad);
        let sin_half = (0.5 * offset_rad).sin();
        let (sin, cos) = (end_rad + 0.5 * offset_rad).sin_cos();
        let change = (self.axes[1] * cos - self.axes[0] * sin) * (2.0 * sin_half);
        let hit_form = 2.0 * self.apex.hit_form(tangent, change) + self.apex.hit_form(change, change);
        self.apex.hit_at(tangent + change, hit_form)
    }

    fn scaled(&self, angle_rad: f64) -> DVec3 {
        let (sin, cos) = angle_rad.sin_cos();
        self.axes[0] * cos + self.axes[1] * sin + self.axes[2]
    }
}
