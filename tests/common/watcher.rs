//! The oracle of sensors: lines of sight and angles in f64, nothing of the crate but its input types.

use glam::DVec3;
use globefill::{Ellipsoid, Extrusion, FieldOfView, LonLat, Pose, Sensor};

use super::figure::Figure;

/// A field of view by its angles.
#[derive(Clone, Debug)]
pub enum Optics {
    Annulus {
        inner_rad: f64,
        outer_rad: f64,
    },
    Rectangle {
        right_rad: f64,
        up_rad: f64,
    },
    /// Corners, (right, up) at unit distance along the boresight, counter-clockwise.
    Corners(Vec<(f64, f64)>),
}

/// A sensor and what it must cover.
#[derive(Clone, Debug)]
pub struct Watcher {
    pub figure: Figure,
    pub pose: Pose,
    pub optics: Optics,
    pub min_elevation_rad: Option<f64>,
    pub extrusion: Extrusion,
}

impl Watcher {
    /// On another figure than the Earth's.
    pub fn moved_to(mut self, ellipsoid: Ellipsoid) -> Self {
        let (at, height_m) = self.figure.geodetic(self.pose.apex_ecef_m);
        self.figure = Figure::new(ellipsoid);
        self.pose.apex_ecef_m = self.figure.ecef(at, height_m);
        self
    }

    /// Above the Earth at a height, looking `off_nadir_rad` away from straight down towards `heading_rad`.
    pub fn new(
        at: LonLat,
        height_m: f64,
        off_nadir_rad: f64,
        heading_rad: f64,
        optics: Optics,
    ) -> Self {
        let figure = Figure::new(Ellipsoid::WGS84);
        let up = figure.normal(at);
        let east = DVec3::Z.cross(up).try_normalize().unwrap_or(DVec3::Y);
        let ahead = up.cross(east) * heading_rad.cos() + east * heading_rad.sin();
        Self {
            pose: Pose {
                apex_ecef_m: figure.ecef(at, height_m),
                boresight: ahead * off_nadir_rad.sin() - up * off_nadir_rad.cos(),
                up: ahead * off_nadir_rad.cos() + up * off_nadir_rad.sin(),
            },
            figure,
            optics,
            min_elevation_rad: None,
            extrusion: Extrusion::Normal,
        }
    }

    pub fn sensor(&self) -> Sensor {
        let field_of_view = match &self.optics {
            &Optics::Annulus {
                inner_rad,
                outer_rad,
            } => FieldOfView::annular(inner_rad, outer_rad),
            &Optics::Rectangle { right_rad, up_rad } => FieldOfView::rectangular(right_rad, up_rad),
            Optics::Corners(corners) => {
                let corners: Vec<DVec3> = corners
                    .iter()
                    .map(|&(right, up)| DVec3::new(right, up, 1.0))
                    .collect();
                FieldOfView::convex(&corners)
            }
        };
        Sensor {
            pose: self.pose,
            field_of_view: field_of_view.expect("a sound field of view"),
            min_elevation_rad: self.min_elevation_rad,
            extrusion: self.extrusion,
        }
    }

    /// Whether the surface point `point_m` is covered.
    pub fn covers(&self, point_m: DVec3) -> bool {
        let (foot, height_m) = self.figure.geodetic(point_m);
        let target_m = match self.extrusion {
            Extrusion::Normal => self.figure.ecef(foot, 0.0),
            Extrusion::Apex => point_m,
        };
        let line_m = target_m - self.pose.apex_ecef_m;
        let up = self.figure.normal(foot);
        let elevation_rad = (-line_m.dot(up) / line_m.length()).clamp(-1.0, 1.0).asin();
        let clear = match self.extrusion {
            Extrusion::Normal => elevation_rad >= 0.0,
            // What the host's depth holds of the bare ellipsoid counts as on it.
            Extrusion::Apex if height_m.abs() < 1e-6 => elevation_rad >= 0.0,
            Extrusion::Apex => self.is_clear(line_m),
        };
        clear
            && self
                .min_elevation_rad
                .is_none_or(|least| elevation_rad >= least)
            && self.looks_at(line_m)
    }

    /// Whether the line from the apex does not pass through the ellipsoid; or, if it ends inside, ends
    /// before the plane of the limb, which divides the chord harmonically.
    fn is_clear(&self, line_m: DVec3) -> bool {
        let Some((enter, leave)) = self.figure.hits(self.pose.apex_ecef_m, line_m, 0.0) else {
            return true;
        };
        if leave <= 0.0 || enter >= 1.0 {
            return true;
        }
        leave > 1.0 && 2.0 * enter * leave / (enter + leave) >= 1.0
    }

    fn looks_at(&self, line_m: DVec3) -> bool {
        let ahead = self.pose.boresight.normalize();
        let right = ahead.cross(self.pose.up).normalize();
        let above = right.cross(ahead);
        let (x, y, z) = (line_m.dot(right), line_m.dot(above), line_m.dot(ahead));
        match &self.optics {
            &Optics::Annulus {
                inner_rad,
                outer_rad,
            } => {
                let off_rad = x.hypot(y).atan2(z);
                off_rad >= inner_rad && off_rad <= outer_rad
            }
            &Optics::Rectangle { right_rad, up_rad } => {
                z > 0.0 && (x / z).atan().abs() <= right_rad && (y / z).atan().abs() <= up_rad
            }
            Optics::Corners(corners) => {
                let next = corners.iter().cycle().skip(1);
                z > 0.0
                    && corners.iter().zip(next).all(|(from, to)| {
                        (to.0 - from.0) * (y / z - from.1) >= (to.1 - from.1) * (x / z - from.0)
                    })
            }
        }
    }

    /// The point where coverage ends between two points, at heights given by `height_m`.
    pub fn edge_between(
        &self,
        inside: LonLat,
        outside: LonLat,
        height_m: impl Fn(DVec3) -> f64,
    ) -> LonLat {
        let at = |t: f64| {
            let (from, to) = (self.figure.normal(inside), self.figure.normal(outside));
            let normal = (from * (1.0 - t) + to * t).normalize();
            LonLat::new(
                normal.y.atan2(normal.x).to_degrees(),
                normal.z.clamp(-1.0, 1.0).asin().to_degrees(),
            )
        };
        let covered = |t: f64| {
            let p = at(t);
            self.covers(self.figure.ecef(p, height_m(self.figure.normal(p))))
        };
        assert!(
            covered(0.0) && !covered(1.0),
            "no edge between {inside:?} and {outside:?}: {self:?}"
        );
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if covered(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        at(low)
    }
}
