//! What a frame's camera sees, in f64: everything the selection needs, derived once a frame.

use glam::{DMat4, DVec2, DVec3, DVec4, Vec4Swizzles as _};

use crate::{
    ellipsoid::Ellipsoid,
    error::RendererError,
    fill_mesh::Bounds,
    frame::window::Window,
    options::{DepthConvention, Frame, RendererOptions},
};

/// Smallest displacement, pixels, that refinement works towards: half the 1/32 px of rounding that
/// rasterisation and single precision leave.
const FINEST_PIXEL_ERROR: f64 = 1.0 / 64.0;
/// Displacement, metres, below which refining is in vain: vertices are rounded to 3.8 µm an axis.
const FINEST_TOLERANCE_M: f64 = 4e-6;
/// Slack, metres, for rounding of a host that draws its surface in single precision.
const SLACK_M: f64 = 0.25;
/// Depth steps of a host by which its surface may lie off.
const SLACK_STEPS: f64 = 4.0;

/// How far the walls reach, as functions of the distance to the eye.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Extrusion {
    /// Height of the top, metres, before slack.
    pub top_m: f64,
    /// Height of the bottom, metres, before slack and push.
    pub bottom_m: f64,
    /// How far the bottom is pushed down per metre of distance.
    pub push_per_m: f64,
    /// Most that push and slack may each add, metres.
    pub limit_m: f64,
    /// Slack: constant, linear and quadratic coefficient of the distance.
    pub slack: [f64; 3],
}

impl Extrusion {
    /// What is added for a host's depth steps, metres, at a distance from the eye.
    pub(crate) fn slack_m(&self, distance_m: f64) -> f64 {
        let [constant, linear, quadratic] = self.slack;
        (constant + distance_m * (linear + distance_m * quadratic)).min(self.limit_m)
    }

    /// Height of a wall's top, metres, at a distance from the eye; as in extrude.wgsl.
    pub(crate) fn top_at_m(&self, distance_m: f64) -> f64 {
        self.top_m + self.slack_m(distance_m)
    }

    /// Height of a wall's bottom, metres, at a distance from the eye; as in extrude.wgsl.
    pub(crate) fn bottom_at_m(&self, distance_m: f64) -> f64 {
        let pushed_m = (self.push_per_m * distance_m).min(self.limit_m);
        self.bottom_m.min(-pushed_m) - self.slack_m(distance_m)
    }
}

/// A frame's camera and what follows from it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sight {
    pub ellipsoid: Ellipsoid,
    pub eye_ecef_m: DVec3,
    /// Height of the eye above the ellipsoid, metres.
    pub eye_height_m: f64,
    /// Clip space from metres relative to the eye along ECEF axes.
    pub clip_from_relative: DMat4,
    /// Whether the projection mirrors the picture.
    pub mirrored: bool,
    /// Whether depth ends at a far plane.
    pub far_plane: bool,
    /// Depth of a point at distance w along the view axis is `depth[0]` + `depth[1]`/w.
    pub depth: [f64; 2],
    /// Nothing nearer than this is drawn, metres.
    pub near_m: f64,
    /// Angle a pixel spans in the middle of the picture, radians; the smaller of the two axes'.
    pub pixel_rad: f64,
    /// How far, pixels, a drawn boundary may lie beside the true one.
    pub pixel_error: f64,
    /// Between which heights the host's surface lies, metres.
    pub surface_m: (f64, f64),
    pub extrusion: Extrusion,
    /// Inward normals of the frustum's side planes, which pass through the eye.
    pub side_planes: [DVec3; 4],
}

impl Sight {
    /// Validates a frame. `sag_m` is that of the meshes drawn.
    pub(crate) fn new(
        ellipsoid: Ellipsoid,
        sag_m: f64,
        frame: &Frame,
        options: &RendererOptions,
    ) -> Result<Self, RendererError> {
        validate(frame)?;
        let camera = &frame.camera;
        let projection = camera.clip_from_view;
        let rotation = DMat4::from_mat3(camera.view_from_ecef);
        let clip_from_relative = projection * rotation;
        let rows = clip_from_relative.transpose();
        let (x_row, y_row, w_row) = (rows.x_axis.xyz(), rows.y_axis.xyz(), rows.w_axis.xyz());
        let side_planes = [w_row + x_row, w_row - x_row, w_row + y_row, w_row - y_row];
        let depth = DepthRange::of(projection, options.depth)?;
        let pixels_rad = pixel_angles_rad(projection, frame)?;
        let eye_height_m = ellipsoid.geodetic(camera.eye_ecef_m).1;
        Ok(Self {
            ellipsoid,
            eye_ecef_m: camera.eye_ecef_m,
            eye_height_m,
            clip_from_relative,
            mirrored: x_row.cross(y_row).dot(w_row) > 0.0,
            far_plane: depth.far_plane,
            depth: depth.coefficients,
            near_m: depth.near_m,
            pixel_rad: pixels_rad.min_element(),
            pixel_error: frame.pixel_error.max(FINEST_PIXEL_ERROR),
            surface_m: (frame.terrain.min_m, frame.terrain.max_m),
            extrusion: Extrusion {
                top_m: frame.terrain.max_m + sag_m,
                bottom_m: frame.terrain.min_m,
                push_per_m: pixels_rad.max_element() * frame.host_pixel_error,
                limit_m: ellipsoid.b_m / 20.0,
                slack: depth.slack(options),
            },
            side_planes: side_planes.map(DVec3::normalize),
        })
    }

    /// Whether everything within `bounds`, up to the walls' heights, lies outside one side plane.
    pub(crate) fn outside_side_plane(&self, bounds: &Bounds) -> bool {
        let (middle_m, radius_m) = self.sphere(bounds);
        self.side_planes
            .iter()
            .any(|inward| inward.dot(middle_m) < -radius_m)
    }

    /// Whether the ellipsoid, as low as the host's surface may be, hides all surface in `bounds`.
    ///
    /// In coordinates divided by the radii the ellipsoid is the unit sphere: eye and point see each
    /// other if their angle is at most the sum of their horizon angles.
    pub(crate) fn beyond_horizon(&self, bounds: &Bounds) -> bool {
        let radii_m = self.ellipsoid.radii_m();
        let eye = self.eye_ecef_m / radii_m;
        let shortest_m = radii_m.min_element();
        let occluder = 1.0 + self.lowest_surface_m() / shortest_m;
        let eye_distance = eye.length();
        if eye_distance <= occluder {
            return false;
        }
        let highest = 1.0 + (self.surface_m.1.max(0.0) + SLACK_M) / shortest_m;
        let horizon_rad = (occluder / eye_distance).acos() + (occluder / highest).min(1.0).acos();
        let apart_rad = eye.angle_between(bounds.axis) - bounds.radius_rad;
        // Bounds hold foot points: divided by the radii, the normal that a point stands on leaves the
        // radial direction by up to twice the flattening.
        let leaning_rad = 2.0 * self.ellipsoid.flattening().abs() * (highest - 1.0);
        apart_rad > horizon_rad + leaning_rad + 1e-6
    }

    fn lowest_surface_m(&self) -> f64 {
        let farthest_m = self.eye_ecef_m.length() + self.ellipsoid.a_m;
        self.extrusion.bottom_at_m(farthest_m)
    }

    /// A sphere around everything in `bounds` at any height drawn: middle relative to the eye, radius.
    pub(crate) fn sphere(&self, bounds: &Bounds) -> (DVec3, f64) {
        let radii_m = self.ellipsoid.radii_m();
        let middle_m = bounds.axis * radii_m - self.eye_ecef_m;
        let reach = 2.0 * (0.5 * bounds.radius_rad.min(std::f64::consts::PI)).sin();
        let on_surface_m = reach * radii_m.max_element();
        let farthest_m = middle_m.length() + on_surface_m;
        let height_m =
            (self.extrusion.top_at_m(farthest_m)).max(-self.extrusion.bottom_at_m(farthest_m));
        (middle_m, on_surface_m + height_m)
    }

    /// What may be seen of the surface within `reach_m` of what is in `bounds`.
    pub(crate) fn window_of(&self, bounds: &Bounds, reach_m: f64) -> Window {
        let (middle_m, radius_m) = self.sphere(bounds);
        Window::of_sphere(&self.clip_from_relative, middle_m, radius_m + reach_m)
    }

    /// What may be seen of any surface.
    pub(crate) fn globe_window(&self) -> Window {
        let radius_m = self.ellipsoid.a_m.max(self.ellipsoid.b_m) + self.surface_m.1.max(0.0);
        Window::of_sphere(
            &self.clip_from_relative,
            -self.eye_ecef_m,
            radius_m + SLACK_M,
        )
    }

    /// Lower bound, metres, of the distance from the eye to visible surface in `bounds`.
    pub(crate) fn distance_to_m(&self, bounds: &Bounds) -> f64 {
        let (middle_m, radius_m) = self.sphere(bounds);
        (middle_m.length() - radius_m).max(self.near_m)
    }

    /// Height, metres, within the surface's range that is nearest to the eye's.
    pub(crate) fn nearest_surface_height_m(&self) -> f64 {
        self.eye_height_m.clamp(self.surface_m.0, self.surface_m.1)
    }

    /// Lower bound, metres, of the distance from the eye to visible surface at a wall that stands on
    /// the surface points `a` and `b` (ECEF metres). To first order in distance over radius: a far
    /// column's nearest point lies below the eye's height, which makes it nearer by less than a part in
    /// (distance / 2R)².
    pub(crate) fn distance_to_wall_m(&self, a: DVec3, b: DVec3) -> f64 {
        let height_m = self.nearest_surface_height_m();
        let a = a + self.ellipsoid.normal_at_surface(a) * height_m - self.eye_ecef_m;
        let b = b + self.ellipsoid.normal_at_surface(b) * height_m - self.eye_ecef_m;
        let along = b - a;
        let length_squared = along.length_squared();
        let nearest = if length_squared > 0.0 {
            a + along * (-a.dot(along) / length_squared).clamp(0.0, 1.0)
        } else {
            a
        };
        let sag_m = length_squared / (8.0 * self.ellipsoid.b_m);
        (nearest.length() - sag_m).max(self.near_m)
    }

    /// Displacement, metres at distance `distance_m`, that the pixel budget allows.
    pub(crate) fn tolerance_m(&self, distance_m: f64) -> f64 {
        (self.pixel_error * self.pixel_rad * distance_m).max(FINEST_TOLERANCE_M)
    }
}

/// Angles, radians, that a pixel spans across and down in the middle of the picture.
fn pixel_angles_rad(projection: DMat4, frame: &Frame) -> Result<DVec2, RendererError> {
    let rows = projection.transpose();
    let scales = DVec2::new(rows.x_axis.xy().length(), rows.y_axis.xy().length());
    let angles_rad = 2.0 / (scales * frame.size_px.as_dvec2());
    if angles_rad.is_finite() {
        Ok(angles_rad)
    } else {
        Err(RendererError::InvalidFrame("camera.clip_from_view"))
    }
}

fn validate(frame: &Frame) -> Result<(), RendererError> {
    let camera = &frame.camera;
    let rotation = camera.view_from_ecef;
    let skew = (rotation * rotation.transpose()) - glam::DMat3::IDENTITY;
    let checks = [
        (camera.eye_ecef_m.is_finite(), "camera.eye_ecef_m"),
        (
            rotation.is_finite() && skew.to_cols_array().iter().all(|e| e.abs() < 1e-6),
            "camera.view_from_ecef",
        ),
        (camera.clip_from_view.is_finite(), "camera.clip_from_view"),
        (frame.size_px.min_element() > 0, "size_px"),
        (
            frame.terrain.min_m.is_finite()
                && frame.terrain.max_m.is_finite()
                && frame.terrain.min_m <= frame.terrain.max_m,
            "terrain",
        ),
        (
            frame.pixel_error >= 0.0 && frame.pixel_error.is_finite(),
            "pixel_error",
        ),
        (
            frame.host_pixel_error >= 0.0 && frame.host_pixel_error.is_finite(),
            "host_pixel_error",
        ),
    ];
    match checks.into_iter().find(|(valid, _)| !valid) {
        Some((_, field)) => Err(RendererError::InvalidFrame(field)),
        None => Ok(()),
    }
}

/// How the host's depth depends on distance.
struct DepthRange {
    /// z/w = first + second/w.
    coefficients: [f64; 2],
    near_m: f64,
    far_plane: bool,
}

impl DepthRange {
    /// Reads a perspective projection; z/w = A + B/w with w the distance along the view axis.
    fn of(projection: DMat4, convention: DepthConvention) -> Result<Self, RendererError> {
        let rows = projection.transpose();
        let oblique = rows.z_axis.xy() != DVec2::ZERO;
        let offset = rows.x_axis.w != 0.0 || rows.y_axis.w != 0.0;
        if rows.w_axis != DVec4::new(0.0, 0.0, -1.0, 0.0) || oblique || offset {
            return Err(RendererError::Unsupported(
                "camera.clip_from_view must be a perspective along -z (w = -z), not an oblique one",
            ));
        }
        let constant = -rows.z_axis.z;
        let inverse_m = rows.z_axis.w;
        let (near_depth, far_depth) = match convention {
            DepthConvention::Reversed => (1.0, 0.0),
            DepthConvention::Standard => (0.0, 1.0),
        };
        let near_m = inverse_m / (near_depth - constant);
        if !(near_m.is_finite() && near_m > 0.0) {
            return Err(RendererError::InvalidFrame("camera.clip_from_view"));
        }
        Ok(Self {
            coefficients: [constant, inverse_m],
            near_m,
            far_plane: (constant - far_depth).abs() > 1e-12,
        })
    }

    /// Slack for the host's depth steps: z = near/w or 1 − near/w in 24 bits.
    fn slack(&self, options: &RendererOptions) -> [f64; 3] {
        let step = SLACK_STEPS * 2f64.powi(-24);
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
