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
    /// ψ at both ends, radians.
    ends_rad: [f64; 2],
    /// [`ScaledApex::hit_form`] of D at both ends.
    end_forms: [f64; 2],
    /// 0 if ψ is even in t, 1 if it starts and stops at rest.
    ease: f64,
}

impl ConeArc {
    /// From an angle over a sweep, radians; whether both ends are directions of tangents.
    pub(super) fn new(
        apex: ScaledApex,
        axes: [DVec3; 3],
        (from_rad, sweep_rad): (f64, f64),
        ends_on_limb: bool,
    ) -> Self {
        let mut arc = Self {
            axes: axes.map(|axis| axis / apex.radii_m),
            apex,
            ends_rad: [from_rad, from_rad + sweep_rad],
            end_forms: [0.0; 2],
            ease: 1.0,
        };
        if !ends_on_limb {
            arc.end_forms = arc.ends_rad.map(|end_rad| arc.form(end_rad));
            let least = arc.end_forms[0].min(arc.end_forms[1]).max(0.0);
            let middle = arc.form(from_rad + 0.5 * sweep_rad);
            // Towards the limb a hit moves as the root of this against the angle. With this ease it
            // moves as fast at the ends as in the middle.
            arc.ease = 1.0 - (least / middle).sqrt().min(1.0);
        }
        arc
    }

    fn unit(&self, t: f64) -> DVec3 {
        let (sin, cos) = (FRAC_PI_2 * t).sin_cos();
        let eased = |t: f64, root: f64| (1.0 - self.ease) * t + self.ease * root * root;
        let sweep_rad = self.ends_rad[1] - self.ends_rad[0];
        let (end, offset_rad) = if t < 0.5 {
            (0, sweep_rad * eased(t, sin))
        } else {
            (1, -sweep_rad * eased(1.0 - t, cos))
        };
        // What the hit depends on is counted from the end, where it is known: the root of its rounding
        // alone would be centimetres at the limb.
        let start = self.scaled(self.ends_rad[end]);
        let (sin, cos) = (self.ends_rad[end] + 0.5 * offset_rad).sin_cos();
        let change = (self.axes[1] * cos - self.axes[0] * sin) * (2.0 * (0.5 * offset_rad).sin());
        let hit_form = self.end_forms[end]
            + 2.0 * self.apex.hit_form(start, change)
            + self.apex.hit_form(change, change);
        self.apex.hit_at(start + change, hit_form)
    }

    fn form(&self, angle_rad: f64) -> f64 {
        let scaled = self.scaled(angle_rad);
        self.apex.hit_form(scaled, scaled)
    }

    fn scaled(&self, angle_rad: f64) -> DVec3 {
        let (sin, cos) = angle_rad.sin_cos();
        self.axes[0] * cos + self.axes[1] * sin + self.axes[2]
    }
}
