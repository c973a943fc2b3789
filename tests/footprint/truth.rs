//! What a sensor sees, by angles: written from the definitions, without the crate's own formulas.

use globefill::{
    FootprintBound,
    glam::{DVec2, DVec3},
};

use crate::draws::{Case, View};

/// A sensor for the judge.
pub struct Truth {
    pub case: Case,
    pub apex_m: DVec3,
    /// Right, up, boresight.
    axes: [DVec3; 3],
    /// Of a convex view, on the plane before the middle of its corners.
    outline: Vec<DVec2>,
    plane: [DVec3; 3],
}

/// Angle between directions, radians, as exact for small as for large ones (Kahan).
fn angle_rad(one: DVec3, other: DVec3) -> f64 {
    let (one, other) = (one.normalize(), other.normalize());
    2.0 * (one - other).length().atan2((one + other).length())
}

impl Truth {
    pub fn new(case: Case) -> Self {
        let pose = case.sensor.pose;
        let boresight = pose.boresight.normalize();
        let up = (pose.up - boresight * boresight.dot(pose.up)).normalize();
        let up = (up - boresight * boresight.dot(up)).normalize();
        let axes = [boresight.cross(up), up, boresight];
        let (mut outline, mut plane) = (Vec::new(), axes);
        if let View::Convex(corners) = &case.view {
            let corners: Vec<_> = corners
                .iter()
                .map(|corner| corner.x * axes[0] + corner.y * axes[1] + corner.z * axes[2])
                .map(|corner| corner.normalize())
                .collect();
            let middle = corners.iter().sum::<DVec3>().normalize();
            let across = middle.any_orthonormal_vector();
            plane = [across, middle.cross(across), middle];
            outline = corners
                .iter()
                .map(|&corner| gnomonic(&plane, corner))
                .collect();
        }
        Self {
            apex_m: pose.apex_ecef_m,
            case,
            axes,
            outline,
            plane,
        }
    }

    /// Every condition on a point of the ellipsoid with what it bounds and by how many radians it is
    /// met, negative if it is not.
    pub fn margins(&self, point_m: DVec3) -> Vec<(FootprintBound, f64)> {
        let line = point_m - self.apex_m;
        let normal = self.normal(point_m);
        // The plane at right angles to the normal is tangent: above it the whole line is outside the
        // ellipsoid, below it enters it before.
        let elevation_rad = (-normal.dot(line)).atan2(normal.cross(line).length());
        let mut margins = vec![(FootprintBound::Limb, elevation_rad)];
        if let Some(least_rad) = self.case.sensor.min_elevation_rad {
            margins.push((FootprintBound::MinElevation, elevation_rad - least_rad));
        }
        self.view_margins(line, &mut margins);
        margins
    }

    fn view_margins(&self, line: DVec3, margins: &mut Vec<(FootprintBound, f64)>) {
        let [right, up, ahead] = self.axes.map(|axis| axis.dot(line));
        match &self.case.view {
            View::Annular(inner_rad, outer_rad) => {
                let off_rad = angle_rad(self.axes[2], line);
                margins.push((FootprintBound::OuterCone, outer_rad - off_rad));
                if *inner_rad > 0.0 {
                    margins.push((FootprintBound::InnerCone, off_rad - inner_rad));
                }
            }
            View::Rectangular(right_rad, up_rad) => {
                let sides = [
                    up_rad - up.atan2(ahead),
                    right_rad + right.atan2(ahead),
                    up_rad + up.atan2(ahead),
                    right_rad - right.atan2(ahead),
                ];
                let name = |(side, margin)| (FootprintBound::Side(side), margin);
                margins.extend(sides.into_iter().enumerate().map(name));
            }
            View::Convex(_) => {
                let ahead = self.plane[2].dot(line) > 0.0;
                let point = gnomonic(&self.plane, line);
                let count = self.outline.len();
                let centre = self.outline.iter().sum::<DVec2>() / count as f64;
                for side in 0..count {
                    let (from, to) = (self.outline[side], self.outline[(side + 1) % count]);
                    let height = |point: DVec2| (to - from).normalize().perp_dot(point - from);
                    let margin = height(point) * height(centre).signum();
                    let margin = if ahead { margin } else { -1.0 };
                    margins.push((FootprintBound::Side(side), margin));
                }
            }
        }
    }

    pub fn sees(&self, point_m: DVec3) -> bool {
        self.margins(point_m)
            .iter()
            .all(|(_, margin)| *margin >= 0.0)
    }

    /// What rounding of positions and angles alone may do to a margin.
    pub fn rounding_rad(&self, point_m: DVec3) -> f64 {
        let reach = (point_m.length() + self.apex_m.length()) / (point_m - self.apex_m).length();
        // Far from its middle the plane of the corners is stretched.
        let stretch = self.outline.iter().map(|corner| corner.length_squared());
        2.0 * f64::EPSILON * (1.0 + reach) * (1.0 + stretch.fold(0.0, f64::max))
    }

    /// [`Self::sees`], up to rounding.
    pub fn sees_nearly(&self, point_m: DVec3) -> bool {
        let slack = -self.rounding_rad(point_m);
        self.margins(point_m)
            .iter()
            .all(|(_, margin)| *margin >= slack)
    }

    /// Whether rounding decides on a point.
    pub fn cannot_tell(&self, point_m: DVec3) -> bool {
        let rounding_rad = self.rounding_rad(point_m);
        let margins = self.margins(point_m);
        margins
            .iter()
            .any(|(_, margin)| margin.abs() <= rounding_rad)
    }

    /// Margin of what bounds an edge.
    pub fn margin(&self, bound: FootprintBound, point_m: DVec3) -> f64 {
        let margins = self.margins(point_m);
        let of = margins.iter().find(|(name, _)| *name == bound);
        of.expect("the sensor has no such bound").1
    }

    /// Outward unit normal, from the geodetic latitude.
    pub fn normal(&self, point_m: DVec3) -> DVec3 {
        let ellipsoid = &self.case.ellipsoid;
        let ratio = ellipsoid.a_m / ellipsoid.b_m;
        let axis_distance = point_m.x.hypot(point_m.y);
        let lat = (point_m.z * ratio * ratio).atan2(axis_distance);
        let lon = point_m.y.atan2(point_m.x);
        DVec3::new(lat.cos() * lon.cos(), lat.cos() * lon.sin(), lat.sin())
    }

    /// Height of the point above the ellipsoid, metres, for points near it.
    pub fn height_m(&self, point_m: DVec3) -> f64 {
        let radii = self.case.ellipsoid.radii_m();
        let (scaled, gradient) = (point_m / radii, point_m / (radii * radii));
        0.5 * (scaled.length_squared() - 1.0) / gradient.length()
    }

    /// The point put on the ellipsoid.
    pub fn on_ground(&self, mut point_m: DVec3) -> DVec3 {
        for _ in 0..8 {
            point_m -= self.normal(point_m) * self.height_m(point_m);
        }
        point_m
    }

    /// Where the ray from the apex hits the ellipsoid first.
    pub fn cast(&self, direction: DVec3) -> Option<DVec3> {
        let radii = self.case.ellipsoid.radii_m();
        let (from, step) = (self.apex_m / radii, direction / radii);
        let (a, b) = (step.length_squared(), from.dot(step));
        let c = from.length_squared() - 1.0;
        let discriminant = b * b - a * c;
        if discriminant < 0.0 || b > 0.0 {
            return None;
        }
        let distance = c / (discriminant.sqrt() - b);
        Some(self.on_ground(self.apex_m + direction * distance))
    }

    /// A direction of the field of view, often near its boundary, a few outside.
    pub fn direction(&self, draws: &mut crate::draws::Draws) -> DVec3 {
        let tilt = |right_rad: f64, up_rad: f64| {
            let tan = DVec3::new(right_rad.tan(), up_rad.tan(), 1.0);
            tan.x * self.axes[0] + tan.y * self.axes[1] + tan.z * self.axes[2]
        };
        match &self.case.view {
            View::Annular(inner_rad, outer_rad) => {
                let part = edge_biased(draws);
                let off_rad = inner_rad + (outer_rad - inner_rad) * part;
                let turn = draws.real(-3.2, 3.2);
                let across = self.axes[0] * turn.cos() + self.axes[1] * turn.sin();
                self.axes[2] * off_rad.cos() + across * off_rad.sin()
            }
            View::Rectangular(right_rad, up_rad) => tilt(
                right_rad * (2.0 * edge_biased(draws) - 1.0).clamp(-1.0, 1.0),
                up_rad * (2.0 * edge_biased(draws) - 1.0).clamp(-1.0, 1.0),
            ),
            View::Convex(_) => {
                let count = self.outline.len();
                let mut pick = || self.outline[draws.below(count)];
                let (one, two, three) = (pick(), pick(), pick());
                let (s, t) = (edge_biased(draws), edge_biased(draws));
                let point = one.lerp(two.lerp(three, s), t);
                self.plane[2] + self.plane[0] * point.x + self.plane[1] * point.y
            }
        }
    }
}

/// 0 … 1, often close to 0 or 1, rarely beyond.
fn edge_biased(draws: &mut crate::draws::Draws) -> f64 {
    let near = draws.log(1e-6, 0.1);
    match draws.below(6) {
        0 => near,
        1 => 1.0 - near,
        2 => 1.0 + near,
        _ => draws.real(0.0, 1.0),
    }
}

fn gnomonic(plane: &[DVec3; 3], direction: DVec3) -> DVec2 {
    let ahead = plane[2].dot(direction);
    DVec2::new(plane[0].dot(direction), plane[1].dot(direction)) / ahead
}
