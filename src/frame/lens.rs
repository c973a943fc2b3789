//! The host's projection: where lines of sight start, how they run, and what depths they have.

use glam::{DMat2, DMat3, DMat4, DVec2, DVec3, DVec4, Vec4Swizzles as _};

use crate::{
    ellipsoid::Ellipsoid,
    error::RendererError,
    options::{DepthConvention, Frame, LogDepth, RendererOptions},
};

/// Slack, metres, for rounding of a host that draws its surface in single precision.
pub(crate) const SLACK_M: f64 = 0.25;
/// Depth steps of a host by which its surface may lie off.
const SLACK_STEPS: f64 = 4.0;
/// The least angle, radians, that a pixel spans: single precision tells no finer ones apart.
const FINEST_PIXEL_RAD: f64 = 1e-5;

/// How far exponentials of drivers may be off, in parts.
const SLACK_EXP: f64 = 1e-5;

/// How distances follow from depths, and points from distances.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) enum LensKind {
    #[default]
    Perspective,
    /// A perspective with logarithmic depths.
    Logarithmic,
    /// Parallel lines of sight.
    Parallel,
}

impl LensKind {
    /// The overrides of host.wgsl.
    pub(crate) fn constants(self) -> [(&'static str, f64); 2] {
        let is = |kind| f64::from(u8::from(self == kind));
        [
            ("PARALLEL", is(Self::Parallel)),
            ("LOGARITHMIC", is(Self::Logarithmic)),
        ]
    }
}

/// What a pixel spans in the middle of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Pixel {
    /// Radians: lines of sight meet in the eye.
    Angle(f64),
    /// Metres: lines of sight are parallel.
    Length(f64),
}

impl Pixel {
    /// Metres at a distance from the eye.
    pub(crate) fn at_m(self, distance_m: f64) -> f64 {
        match self {
            Self::Angle(rad) => rad * distance_m,
            Self::Length(metres) => metres,
        }
    }

    /// The distance, metres, at which pixels of `rad` would be as large as these are at `distance_m`, but
    /// no more than that.
    pub(crate) fn distance_m(self, rad: f64, distance_m: f64) -> f64 {
        match self {
            Self::Angle(pixel_rad) => distance_m * (pixel_rad.max(FINEST_PIXEL_RAD) / rad).min(1.0),
            Self::Length(metres) => metres / rad,
        }
    }
}

/// A host's projection, in f64.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Lens {
    /// Where lines of sight meet. Those that are parallel do not: then a point on the one in the middle of
    /// the picture, near the surface, so that little is far from it on the screen.
    pub eye_ecef_m: DVec3,
    /// From metres relative to that point along ECEF axes: x and y of clip space, distance along the view
    /// axis, w.
    pub clip_from_relative: DMat4,
    pub kind: LensKind,
    /// The host's logarithm. Depths are then copied, and those below are the copy's.
    pub log_depth: Option<LogDepth>,
    /// Depth is `depth[0]` + `depth[1]` / distance; where lines of sight are parallel, · distance.
    pub depth: [f64; 2],
    /// Nothing nearer is drawn, metres along the view axis; may be negative where lines are parallel.
    pub near_m: f64,
    /// Whether depth ends at a far plane.
    pub far_plane: bool,
    /// What a pixel spans across and down in the middle of the picture: radians, or metres where lines of
    /// sight are parallel.
    pub spans: DVec2,
}

impl Lens {
    /// Reads a frame's projection. Parallel lines of sight get their point where the one in the middle
    /// meets the ellipsoid raised by `height_m`.
    pub(crate) fn of(
        frame: &Frame,
        convention: DepthConvention,
        ellipsoid: &Ellipsoid,
        height_m: f64,
    ) -> Result<Self, RendererError> {
        let rows = frame.camera.clip_from_view.transpose();
        let oblique = rows.z_axis.xy() != DVec2::ZERO;
        let through_eye = rows.w_axis == DVec4::new(0.0, 0.0, -1.0, 0.0);
        let lens = if let Some(log_depth) = frame.log_depth {
            check(&log_depth)?;
            let copied = |lens| Self {
                kind: LensKind::Logarithmic,
                log_depth: Some(log_depth),
                depth: [0.0, log_depth.near_m],
                near_m: log_depth.near_m,
                far_plane: false,
                ..lens
            };
            let lens = through_eye.then(|| Self::perspective(frame, convention));
            lens.flatten().map(copied)
        } else if through_eye && !oblique {
            Self::perspective(frame, convention)
        } else if rows.w_axis == DVec4::W && !oblique {
            Self::parallel(frame, convention, ellipsoid, height_m)
        } else {
            None
        };
        let lens = lens.ok_or(RendererError::Unsupported(
            "camera.clip_from_view must look along -z, as a perspective (w = -z) or orthographically \
             (w = 1, without log_depth), not sheared and with a near plane at right angles to the view",
        ))?;
        let whole = lens.clip_from_relative.is_finite()
            && lens.eye_ecef_m.is_finite()
            && lens.spans.is_finite()
            && lens.near_m.is_finite()
            && (lens.is_parallel() || lens.near_m > 0.0);
        whole
            .then_some(lens)
            .ok_or(RendererError::InvalidFrame("camera.clip_from_view"))
    }

    /// None if the picture is not centred on where lines of sight meet.
    fn perspective(frame: &Frame, convention: DepthConvention) -> Option<Self> {
        let camera = &frame.camera;
        let rows = camera.clip_from_view.transpose();
        if rows.x_axis.w != 0.0 || rows.y_axis.w != 0.0 {
            return None;
        }
        let (constant, inverse_m) = (-rows.z_axis.z, rows.z_axis.w);
        let [near_depth, far_depth] = ends(convention);
        Some(Self {
            eye_ecef_m: camera.eye_ecef_m,
            clip_from_relative: clip_from_relative(rows, camera.view_from_ecef),
            kind: LensKind::Perspective,
            log_depth: None,
            depth: [constant, inverse_m],
            near_m: inverse_m / (near_depth - constant),
            far_plane: (constant - far_depth).abs() > 1e-12,
            spans: spans(rows, frame),
        })
    }

    /// None if lines of sight are not at right angles to the picture.
    fn parallel(
        frame: &Frame,
        convention: DepthConvention,
        ellipsoid: &Ellipsoid,
        height_m: f64,
    ) -> Option<Self> {
        let camera = &frame.camera;
        let mut rows = camera.clip_from_view.transpose();
        if rows.x_axis.z != 0.0 || rows.y_axis.z != 0.0 {
            return None;
        }
        let ecef_from_view = camera.view_from_ecef.transpose();
        let sideways = DMat2::from_cols(rows.x_axis.xy(), rows.y_axis.xy()).transpose();
        let aside = DVec2::new(rows.x_axis.w, rows.y_axis.w);
        let middle = sideways.inverse() * -aside;
        (rows.x_axis.w, rows.y_axis.w) = (0.0, 0.0);
        let start_m = camera.eye_ecef_m + ecef_from_view * middle.extend(0.0);
        let axis = -ecef_from_view.z_axis;
        let (constant, slope) = (rows.z_axis.w, -rows.z_axis.z);
        // Where depth is a number of single precision, so that it is not rounded on its way.
        let aim_m = nearest_m(start_m, axis, ellipsoid.radii_m() + height_m);
        let depth = f64::from((constant + slope * aim_m) as f32);
        let ahead_m = (depth - constant) / slope;
        let [near_depth, far_depth] = ends(convention);
        // The wrong way round there is no near plane.
        let right_way = slope * (far_depth - near_depth) > 0.0;
        let near_m = if right_way {
            (near_depth - depth) / slope
        } else {
            f64::NAN
        };
        Some(Self {
            eye_ecef_m: start_m + axis * ahead_m,
            clip_from_relative: clip_from_relative(rows, camera.view_from_ecef),
            kind: LensKind::Parallel,
            log_depth: None,
            depth: [depth, slope],
            near_m,
            far_plane: true,
            spans: spans(rows, frame),
        })
    }

    pub(crate) fn is_parallel(&self) -> bool {
        self.kind == LensKind::Parallel
    }

    /// The smaller of what a pixel spans across and down.
    pub(crate) fn pixel(&self) -> Pixel {
        let least = self.spans.min_element();
        if self.is_parallel() {
            Pixel::Length(least)
        } else {
            Pixel::Angle(least)
        }
    }

    /// The view axis, a unit vector along ECEF axes.
    pub(crate) fn axis(&self) -> DVec3 {
        self.clip_from_relative.transpose().z_axis.xyz()
    }

    /// Slack for the host's depth steps: constant, linear and quadratic coefficient of the distance.
    pub(crate) fn slack(&self, options: &RendererOptions) -> [f64; 3] {
        let step = SLACK_STEPS * 2f64.powi(-24);
        if let Some(log) = &self.log_depth {
            let relative = step * std::f64::consts::LN_2 * log_range(log) + SLACK_EXP;
            return [SLACK_M + relative / log.per_m, relative, 0.0];
        }
        if self.is_parallel() {
            return [SLACK_M + step / self.depth[1].abs(), step, 0.0];
        }
        let float = matches!(
            options.depth_format,
            wgpu::TextureFormat::Depth32Float | wgpu::TextureFormat::Depth32FloatStencil8
        );
        match options.depth {
            DepthConvention::Reversed if float => [SLACK_M, step, 0.0],
            _ => [SLACK_M, step, step / self.near_m],
        }
    }
}

/// The logarithm at the far plane.
pub(crate) fn log_range(log: &LogDepth) -> f64 {
    (1.0 + log.per_m * (log.far_m - log.from_m)).log2()
}

fn check(log: &LogDepth) -> Result<(), RendererError> {
    let finite = [log.near_m, log.far_m, log.from_m, log.per_m]
        .iter()
        .all(|number| number.is_finite());
    let sound = finite
        && log.near_m > 0.0
        && log.per_m > 0.0
        && log.from_m <= log.near_m
        && log.far_m > log.near_m;
    let error = RendererError::InvalidFrame("log_depth");
    sound.then_some(()).ok_or(error)
}

/// Depths of the near and of the far plane.
fn ends(convention: DepthConvention) -> [f64; 2] {
    match convention {
        DepthConvention::Reversed => [1.0, 0.0],
        DepthConvention::Standard => [0.0, 1.0],
    }
}

/// The projection's rows for metres along ECEF axes, and distance in the place of depth.
fn clip_from_relative(rows: DMat4, view_from_ecef: DMat3) -> DMat4 {
    let distance = DVec4::new(0.0, 0.0, -1.0, 0.0);
    let clip_from_view = DMat4::from_cols(rows.x_axis, rows.y_axis, distance, rows.w_axis);
    clip_from_view.transpose() * DMat4::from_mat3(view_from_ecef)
}

fn spans(rows: DMat4, frame: &Frame) -> DVec2 {
    let scales = DVec2::new(rows.x_axis.xy().length(), rows.y_axis.xy().length());
    2.0 / (scales * frame.size_px.as_dvec2())
}

/// How far along a line it first meets an ellipsoid, or is nearest to it.
fn nearest_m(start_m: DVec3, axis: DVec3, radii_m: DVec3) -> f64 {
    let (start, axis) = (start_m / radii_m, axis / radii_m);
    let (quadratic, linear) = (axis.length_squared(), start.dot(axis));
    let miss = start - axis * (linear / quadratic);
    let root = (quadratic * (1.0 - miss.length_squared())).max(0.0).sqrt();
    (-linear - root) / quadratic
}
