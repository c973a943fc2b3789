//! Test cameras: a place, a direction, a lens, a depth convention.

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4, UVec2};
use globefill::{Camera, DepthConvention, LogDepth, LonLat};

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
    /// Height of the picture, metres, where lines of sight are parallel; the field of view is then none.
    pub parallel_m: Option<f64>,
    /// How far behind that place the eye stands, metres along the view axis.
    pub behind_m: f64,
    /// Where the view axis passes through the picture: from its middle, halves of its width and height.
    pub aside: DVec2,
    /// 1, or -1 where the projection turns the picture's right or its top over.
    pub signs: DVec2,
}

impl Pose {
    pub fn nadir(lon_deg: f64, lat_deg: f64, height_m: f64) -> Self {
        Self {
            at: LonLat::new(lon_deg, lat_deg),
            height_m,
            heading_deg: 0.0,
            pitch_deg: -90.0,
            fov_deg: 60.0,
            parallel_m: None,
            behind_m: 0.0,
            aside: DVec2::ZERO,
            signs: DVec2::ONE,
        }
    }

    /// The same place seen along parallel lines, in a picture of that height.
    pub fn parallel(self, height_m: f64) -> Self {
        Self {
            parallel_m: Some(height_m),
            ..self
        }
    }

    /// The same direction from that far behind.
    pub fn back_by(self, behind_m: f64) -> Self {
        Self { behind_m, ..self }
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
    ReversedFinite { near_m: f64, far_m: f64 },
    StandardFinite { near_m: f64, far_m: f64 },
    Logarithmic(LogDepth),
}

impl DepthRange {
    pub fn convention(self) -> DepthConvention {
        match self {
            Self::ReversedInfinite { .. } | Self::ReversedFinite { .. } => {
                DepthConvention::Reversed
            }
            // Logarithms are said frame by frame, whatever the other frames have.
            Self::StandardFinite { .. } | Self::Logarithmic(_) => DepthConvention::Standard,
        }
    }

    /// Depth of the sky.
    pub fn cleared(self) -> f32 {
        match self {
            Self::ReversedInfinite { .. } | Self::ReversedFinite { .. } => 0.0,
            Self::StandardFinite { .. } | Self::Logarithmic(_) => 1.0,
        }
    }

    /// `x` and `y` of x + y / distance, which is the depth, or of x + y · distance in parallel views.
    fn coefficients(self, parallel: bool) -> DVec2 {
        // At the near and at the far plane, and those.
        let (depths, planes_m) = match self {
            Self::ReversedInfinite { near_m } => ([1.0, 0.0], [near_m, f64::INFINITY]),
            Self::ReversedFinite { near_m, far_m } => ([1.0, 0.0], [near_m, far_m]),
            Self::StandardFinite { near_m, far_m }
            | Self::Logarithmic(LogDepth { near_m, far_m, .. }) => ([0.0, 1.0], [near_m, far_m]),
        };
        let at = planes_m.map(|plane_m| if parallel { plane_m } else { 1.0 / plane_m });
        let slope = (depths[1] - depths[0]) / (at[1] - at[0]);
        DVec2::new(depths[0] - slope * at[0], slope)
    }
}

/// How finely depths are stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DepthSteps {
    Float,
    /// Shares of 2^24 - 1.
    Bits24,
}

impl DepthSteps {
    pub fn stored(self, depth: f64) -> f32 {
        match self {
            Self::Float => depth as f32,
            Self::Bits24 => ((depth * MOST_24_BITS).round() / MOST_24_BITS) as f32,
        }
    }

    /// One unit more and one less.
    fn beside(self, depth: f32) -> [f64; 2] {
        match self {
            Self::Float => [depth.next_up(), depth.next_down()].map(f64::from),
            Self::Bits24 => [1.0, -1.0].map(|step| f64::from(depth) + step / MOST_24_BITS),
        }
    }
}

const MOST_24_BITS: f64 = 16_777_215.0;

/// A camera and its pixels, in f64.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    pub eye_m: DVec3,
    view_from_ecef: DMat3,
    /// x and y of clip space at a view distance of 1, or at any where lines of sight are parallel.
    scale: DVec2,
    /// Where the view axis passes through the picture, in clip space at a view distance of 1.
    aside: DVec2,
    pub parallel: bool,
    /// Depth = `depth.x + depth.y / distance`, or · distance where lines of sight are parallel.
    depth: DVec2,
    /// Instead: depths in proportion to a logarithm.
    pub log_depth: Option<LogDepth>,
    pub steps: DepthSteps,
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
        let focal = match pose.parallel_m {
            Some(height_m) => 2.0 / height_m,
            None => 1.0 / (pose.fov_deg.to_radians() * 0.5).tan(),
        };
        let parallel = pose.parallel_m.is_some();
        // A host works in f32: the matrix it has is the rounded one.
        let f32_of = |v: DVec2| v.as_vec2().as_dvec2();
        Self {
            eye_m: figure.ecef(pose.at, pose.height_m) - forward * pose.behind_m,
            view_from_ecef: DMat3::from_cols(right, above, -forward).transpose(),
            scale: f32_of(pose.signs * DVec2::new(focal / aspect, focal)),
            aside: f32_of(pose.aside),
            parallel,
            depth: f32_of(range.coefficients(parallel)),
            log_depth: match range {
                DepthRange::Logarithmic(log_depth) if !parallel => Some(log_depth),
                _ => None,
            },
            steps: DepthSteps::Float,
            size_px,
        }
    }

    pub fn camera(&self) -> Camera {
        let (a, b) = (self.depth.x, self.depth.y);
        let [z, last] = if self.parallel {
            let last = DVec4::new(self.aside.x, self.aside.y, a, 1.0);
            [DVec4::new(0.0, 0.0, -b, 0.0), last]
        } else {
            let z = DVec4::new(-self.aside.x, -self.aside.y, -a, -1.0);
            [z, DVec4::new(0.0, 0.0, b, 0.0)]
        };
        Camera {
            eye_ecef_m: self.eye_m,
            view_from_ecef: self.view_from_ecef,
            clip_from_view: DMat4::from_cols(
                DVec4::new(self.scale.x, 0.0, 0.0, 0.0),
                DVec4::new(0.0, self.scale.y, 0.0, 0.0),
                z,
                last,
            ),
        }
    }

    /// Sideways from the eye, metres at a view distance of 1 or at any.
    fn sideways(&self, at_px: DVec2) -> DVec3 {
        let ndc = at_px / self.size_px.as_dvec2() * 2.0 - 1.0;
        let off = (ndc * DVec2::new(1.0, -1.0) - self.aside) / self.scale;
        off.extend(0.0)
    }

    /// Height of a pixel, metres, at a view distance of 1, or at any where lines of sight are parallel.
    pub fn pixel_m(&self) -> f64 {
        2.0 / (self.scale.y.abs() * f64::from(self.size_px.y))
    }

    /// Direction, ECEF, of the line of sight at a point of the picture, of length 1 along the view axis.
    pub fn ray(&self, at_px: DVec2) -> DVec3 {
        let sideways = if self.parallel {
            DVec3::ZERO
        } else {
            self.sideways(at_px)
        };
        self.view_from_ecef.transpose() * (sideways - DVec3::Z)
    }

    /// Where the line of sight at a point of the picture starts.
    pub fn origin_m(&self, at_px: DVec2) -> DVec3 {
        if !self.parallel {
            return self.eye_m;
        }
        self.eye_m + self.view_from_ecef.transpose() * self.sideways(at_px)
    }

    /// The point at a distance along the view axis.
    pub fn point_m(&self, at_px: DVec2, distance_m: f64) -> DVec3 {
        self.origin_m(at_px) + self.ray(at_px) * distance_m
    }

    /// Where a point appears, pixels from the top left corner, and its distance along the view axis.
    pub fn project(&self, ecef_m: DVec3) -> (DVec2, f64) {
        let view = self.view_from_ecef * (ecef_m - self.eye_m);
        let nearer = if self.parallel { 1.0 } else { -view.z };
        let ndc = view.truncate() * self.scale / nearer + self.aside;
        let at = DVec2::new(ndc.x, -ndc.y);
        ((at + 1.0) * 0.5 * self.size_px.as_dvec2(), -view.z)
    }

    /// Depth stored for a distance along the view axis.
    pub fn stored_depth(&self, distance_m: f64) -> f32 {
        if let Some(log) = &self.log_depth {
            let at = |distance_m: f64| (log.per_m * (distance_m - log.from_m)).ln_1p();
            return self.steps.stored(at(distance_m) / at(log.far_m));
        }
        let at = if self.parallel {
            distance_m
        } else {
            1.0 / distance_m
        };
        self.steps.stored(self.depth.x + self.depth.y * at)
    }

    /// Distance along the view axis of a stored depth.
    pub fn distance_m(&self, depth: f32) -> f64 {
        self.distance_of(f64::from(depth))
    }

    fn distance_of(&self, depth: f64) -> f64 {
        if let Some(log) = &self.log_depth {
            let most = (log.per_m * (log.far_m - log.from_m)).ln_1p();
            return (depth * most).exp_m1() / log.per_m + log.from_m;
        }
        let at = (depth - self.depth.x) / self.depth.y;
        if self.parallel { at } else { 1.0 / at }
    }

    /// How far, pixels along the axis of the view, the point of the ground seen at `at_px` may be
    /// displaced because its depth is known to one unit only.
    pub fn depth_unit_px(&self, at_px: DVec2, depth: f32, up: DVec3) -> f64 {
        let ray = self.ray(at_px);
        let distance_m = self.distance_m(depth);
        let here_m = self.point_m(at_px, distance_m);
        self.steps
            .beside(depth)
            .map(|other| {
                let shift_m = ray * (self.distance_of(other) - distance_m);
                let along_ground_m = shift_m - up * shift_m.dot(up);
                (self.project(here_m + along_ground_m).0 - at_px).length()
            })
            .into_iter()
            .fold(0.0, f64::max)
    }
}
