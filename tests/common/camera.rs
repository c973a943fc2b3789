//! Test cameras: a place, a direction, a lens, a depth convention.

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4, UVec2};
use globefill::{Camera, DepthConvention, LonLat};

use super::figure::Figure;

/// Where a camera stands and looks, in the terms of the command line of `examples/render`.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    pub at: LonLat,
    /// Height of the eye above the ellipsoid.
    pub height_m: f64,
    /// Clockwise from north.
    pub heading_deg: f64,
    /// −90 looks straight down.
    pub pitch_deg: f64,
    /// Vertical field of view.
    pub fov_deg: f64,
}

impl Pose {
    pub fn nadir(lon_deg: f64, lat_deg: f64, height_m: f64) -> Self {
        Self {
            at: LonLat::new(lon_deg, lat_deg),
            height_m,
            heading_deg: 0.0,
            pitch_deg: -90.0,
            fov_deg: 60.0,
        }
    }

    pub fn turned(self, heading_deg: f64, pitch_deg: f64) -> Self {
        Self {
            heading_deg,
            pitch_deg,
            ..self
        }
    }
}

/// How depths are stored. Lengths are distances along the view axis.
#[derive(Clone, Copy, Debug)]
pub enum DepthRange {
    ReversedInfinite { near_m: f64 },
    StandardFinite { near_m: f64, far_m: f64 },
}

impl DepthRange {
    pub fn convention(self) -> DepthConvention {
        match self {
            Self::ReversedInfinite { .. } => DepthConvention::Reversed,
            Self::StandardFinite { .. } => DepthConvention::Standard,
        }
    }

    /// Depth of the sky.
    pub fn cleared(self) -> f32 {
        match self {
            Self::ReversedInfinite { .. } => 0.0,
            Self::StandardFinite { .. } => 1.0,
        }
    }
}

/// A camera and its pixels, in f64.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    pub eye_m: DVec3,
    view_from_ecef: DMat3,
    /// x and y of clip space at a view distance of 1.
    scale: DVec2,
    /// Stored depth = `depth.x + depth.y / distance`.
    depth: DVec2,
    pub size_px: UVec2,
}

impl Lens {
    pub fn new(figure: &Figure, pose: &Pose, size_px: UVec2, range: DepthRange) -> Self {
        let up = figure.normal(pose.at);
        let east = if pose.at.lat_deg.abs() == 90.0 {
            let (sin, cos) = pose.at.lon_deg.to_radians().sin_cos();
            DVec3::new(-sin, cos, 0.0)
        } else {
            DVec3::Z.cross(up).normalize()
        };
        let north = up.cross(east);
        let (sin_h, cos_h) = pose.heading_deg.to_radians().sin_cos();
        let (sin_p, cos_p) = pose.pitch_deg.to_radians().sin_cos();
        let ahead = north * cos_h + east * sin_h;
        let forward = ahead * cos_p + up * sin_p;
        let right = east * cos_h - north * sin_h;
        let above = right.cross(forward);
        let aspect = f64::from(size_px.x) / f64::from(size_px.y);
        let focal = 1.0 / (pose.fov_deg.to_radians() * 0.5).tan();
        // A host works in f32: the matrix it has is the rounded one.
        let f32_of = |x: f64| f64::from(x as f32);
        let depth = match range {
            DepthRange::ReversedInfinite { near_m } => DVec2::new(0.0, near_m),
            DepthRange::StandardFinite { near_m, far_m } => {
                DVec2::new(far_m, -near_m * far_m) / (far_m - near_m)
            }
        };
        Self {
            eye_m: figure.ecef(pose.at, pose.height_m),
            view_from_ecef: DMat3::from_cols(right, above, -forward).transpose(),
            scale: DVec2::new(f32_of(focal / aspect), f32_of(focal)),
            depth: DVec2::new(f32_of(depth.x), f32_of(depth.y)),
            size_px,
        }
    }

    pub fn camera(&self) -> Camera {
        Camera {
            eye_ecef_m: self.eye_m,
            view_from_ecef: self.view_from_ecef,
            clip_from_view: DMat4::from_cols(
                DVec4::new(self.scale.x, 0.0, 0.0, 0.0),
                DVec4::new(0.0, self.scale.y, 0.0, 0.0),
                DVec4::new(0.0, 0.0, -self.depth.x, -1.0),
                DVec4::new(0.0, 0.0, self.depth.y, 0.0),
            ),
        }
    }

    /// Direction, ECEF, through a point of the picture, of length 1 along the view axis.
    pub fn ray(&self, at_px: DVec2) -> DVec3 {
        let ndc = at_px / self.size_px.as_dvec2() * 2.0 - 1.0;
        let direction = DVec3::new(ndc.x / self.scale.x, -ndc.y / self.scale.y, -1.0);
        self.view_from_ecef.transpose() * direction
    }

    /// Where a point appears, pixels from the top left corner, and its distance along the view axis.
    pub fn project(&self, ecef_m: DVec3) -> (DVec2, f64) {
        let view = self.view_from_ecef * (ecef_m - self.eye_m);
        let ndc = DVec2::new(view.x * self.scale.x, -view.y * self.scale.y) / -view.z;
        ((ndc + 1.0) * 0.5 * self.size_px.as_dvec2(), -view.z)
    }

    /// Depth stored for a distance along the view axis.
    pub fn stored_depth(&self, distance_m: f64) -> f32 {
        (self.depth.x + self.depth.y / distance_m) as f32
    }

    /// Distance along the view axis of a stored depth.
    pub fn distance_m(&self, depth: f32) -> f64 {
        self.depth.y / (f64::from(depth) - self.depth.x)
    }

    /// How far, pixels along the axis of the view, the point of the ground seen at `at_px` may be
    /// displaced because its depth is known to one unit only.
    pub fn depth_unit_px(&self, at_px: DVec2, depth: f32, up: DVec3) -> f64 {
        let ray = self.ray(at_px);
        let distance_m = self.distance_m(depth);
        let here_m = self.eye_m + ray * distance_m;
        [depth.next_up(), depth.next_down()]
            .map(|other| {
                let shift_m = ray * (self.distance_m(other) - distance_m);
                let along_ground_m = shift_m - up * shift_m.dot(up);
                (self.project(here_m + along_ground_m).0 - at_px).length()
            })
            .into_iter()
            .fold(0.0, f64::max)
    }
}
