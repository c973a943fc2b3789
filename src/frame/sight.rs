//! What a frame's camera sees, in f64: everything the selection needs, derived once a frame.

use glam::{DMat3, DMat4, DVec3, DVec4, Vec4Swizzles as _};

use crate::{
    ellipsoid::Ellipsoid,
    error::RendererError,
    fill_mesh::Bounds,
    frame::beyond::Beyond,
    frame::lens::{Lens, LensKind, Pixel, SLACK_M},
    frame::window::Window,
    options::{Frame, LogDepth, RendererOptions},
};

/// Smallest displacement, pixels, that refinement works towards: half the 1/32 px of rounding that
/// rasterisation and single precision leave.
const FINEST_PIXEL_ERROR: f64 = 1.0 / 64.0;
/// Displacement, metres, below which refining is in vain: vertices are rounded to 3.8 µm an axis.
const FINEST_TOLERANCE_M: f64 = 4e-6;
/// How far, pixels, rasterisers move a vertex: half of a 1/256 px an axis, doubled. A face seen at a slant
/// is moved in height by as much: where it touches the surface, in front of it.
const SNAP_PX: f64 = std::f64::consts::SQRT_2 / 256.0;

/// How often the horizon is found anew for what it says itself.
const HORIZON_ROUNDS: u32 = 4;

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
    /// The eye, or the point that stands for it where lines of sight are parallel.
    pub eye_ecef_m: DVec3,
    /// From the host's eye to that point, metres.
    pub from_host_eye_m: DVec3,
    /// Height of that point above the ellipsoid, metres.
    pub eye_height_m: f64,
    /// From metres relative to that point along ECEF axes: x and y of clip space, distance along the view
    /// axis, w.
    pub clip_from_relative: DMat4,
    /// Whether lines of sight are parallel.
    pub parallel: bool,
    pub kind: LensKind,
    /// The host's logarithm; what is said of depths below is then said of a copy of them.
    pub log_depth: Option<LogDepth>,
    /// Whether the projection mirrors the picture.
    pub mirrored: bool,
    /// Whether depth ends at a far plane.
    pub far_plane: bool,
    /// Depth at a distance along the view axis is `depth[0]` + `depth[1]` / distance; where lines of sight
    /// are parallel, · distance.
    pub depth: [f64; 2],
    /// Nothing nearer than this is drawn, metres.
    pub near_m: f64,
    /// What a pixel spans in the middle of the picture; the smaller of the two axes'.
    pub pixel: Pixel,
    /// How far, pixels, a drawn boundary may lie beside the true one.
    pub pixel_error: f64,
    /// Between which heights the host's surface lies, metres.
    pub surface_m: (f64, f64),
    pub extrusion: Extrusion,
    /// The frustum's side planes: inward unit normal, and how far inside the eye is.
    pub side_planes: [DVec4; 4],
    horizon: Option<(DVec3, f64)>,
    /// Where volumes have no height.
    pub beyond: Option<Beyond>,
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
        let terrain = &frame.terrain;
        let middle_m = 0.5 * (terrain.min_m + terrain.max_m);
        let lens = Lens::of(frame, options.depth, &ellipsoid, middle_m)?;
        let rows = lens.clip_from_relative.transpose();
        let (x_row, y_row, w_row) = (rows.x_axis, rows.y_axis, rows.w_axis);
        let side_planes = [w_row + x_row, w_row - x_row, w_row + y_row, w_row - y_row];
        let limit_m = ellipsoid.b_m / 20.0;
        let [constant, linear, quadratic] = lens.slack(options);
        let snapped = SNAP_PX * lens.spans.max_element();
        let mut extrusion = Extrusion {
            top_m: terrain.max_m + sag_m,
            bottom_m: terrain.min_m,
            push_per_m: 0.0,
            limit_m,
            slack: [constant, linear, quadratic],
        };
        let push = lens.spans.max_element() * frame.host_pixel_error;
        if lens.is_parallel() {
            extrusion.bottom_m = extrusion.bottom_m.min(-push.min(limit_m));
            extrusion.slack[0] += snapped;
        } else {
            extrusion.push_per_m = push;
            extrusion.slack[1] += snapped;
        }
        let sight = Self {
            ellipsoid,
            eye_height_m: ellipsoid.geodetic(lens.eye_ecef_m).1,
            from_host_eye_m: lens.eye_ecef_m - frame.camera.eye_ecef_m,
            mirrored: x_row.xyz().cross(y_row.xyz()).dot(lens.axis()) > 0.0,
            pixel: lens.pixel(),
            pixel_error: frame.pixel_error.max(FINEST_PIXEL_ERROR),
            surface_m: (terrain.min_m, terrain.max_m),
            extrusion,
            side_planes: side_planes.map(|plane| plane / plane.xyz().length()),
            eye_ecef_m: lens.eye_ecef_m,
            clip_from_relative: lens.clip_from_relative,
            parallel: lens.is_parallel(),
            kind: lens.kind,
            log_depth: lens.log_depth,
            far_plane: lens.far_plane,
            depth: lens.depth,
            near_m: lens.near_m,
            horizon: None,
            beyond: None,
        };
        Ok(sight.with_horizon())
    }

    pub(super) fn with_horizon(mut self) -> Self {
        self.horizon = self.find_horizon();
        self
    }

    /// The same where volumes have no height beyond the horizon, if none of the faces drawn has an edge longer
    /// than `edge_rad`, in coordinates divided by the radii.
    pub(crate) fn flat_beyond(mut self, edge_rad: f64) -> Self {
        self.beyond = Beyond::of(&self, edge_rad);
        self
    }

    /// Whether a volume has no height over anything in `bounds`.
    pub(crate) fn is_flat_over(&self, bounds: &Bounds) -> bool {
        self.beyond.is_some_and(|beyond| beyond.holds_all(bounds))
    }

    /// How far, metres, a point relative to the eye lies outside the frustum's sides; negative inside.
    pub(crate) fn outside_m(&self, point_m: DVec3) -> f64 {
        self.side_planes
            .iter()
            .map(|plane| -plane.dot(point_m.extend(1.0)))
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether everything within `bounds`, up to the walls' heights, lies outside one side plane.
    pub(crate) fn outside_side_plane(&self, bounds: &Bounds) -> bool {
        let (middle_m, radius_m) = self.sphere(bounds);
        self.outside_m(middle_m) > radius_m
    }

    /// Whether the ellipsoid, as low as the host's surface may be, hides all surface in `bounds`.
    pub(crate) fn beyond_horizon(&self, bounds: &Bounds) -> bool {
        self.horizon().is_some_and(|(eye, horizon_rad)| {
            eye.angle_between(bounds.axis) - bounds.radius_rad > horizon_rad
        })
    }

    /// In coordinates divided by the radii: the direction of the eye, and the angle from there about the centre
    /// within which the foot points of all surface lie that the ellipsoid, as low as the host's surface may be,
    /// does not hide. None if it hides nothing.
    pub(crate) fn horizon(&self) -> Option<(DVec3, f64)> {
        self.horizon
    }

    /// In those coordinates the ellipsoid is the unit sphere: eye and point see each other if their angle is at
    /// most the sum of their horizon angles.
    fn find_horizon(&self) -> Option<(DVec3, f64)> {
        let radii_m = self.ellipsoid.radii_m();
        let shortest_m = radii_m.min_element();
        let highest = 1.0 + (self.surface_m.1.max(0.0) + SLACK_M) / shortest_m;
        // Foot points: divided by the radii, the normal that a point stands on leaves the radial direction by
        // up to twice the flattening.
        let leaning_rad = 2.0 * self.ellipsoid.flattening().abs() * (highest - 1.0);
        let mut farthest_m = self.eye_ecef_m.length() + self.ellipsoid.a_m;
        let mut found = None;
        // Surface is the lower the farther it may be; what is found tells how far that is.
        for _ in 0..HORIZON_ROUNDS {
            let occluder = 1.0 + self.extrusion.bottom_at_m(farthest_m) / shortest_m;
            let (eye, from_above_rad) = self.horizon_of(occluder)?;
            let horizon_rad = from_above_rad + (occluder / highest).min(1.0).acos();
            found = Some((eye.normalize(), horizon_rad + leaning_rad + 1e-6));
            if self.parallel {
                break;
            }
            let far = |height: f64| {
                let cosine = horizon_rad.min(std::f64::consts::PI).cos();
                eye.length_squared() + height * (height - 2.0 * eye.length() * cosine)
            };
            // Along the column it is farthest at an end.
            let reach = far(occluder).max(far(highest)).max(0.0).sqrt();
            farthest_m = farthest_m.min(reach * radii_m.max_element());
        }
        found
    }

    /// Whether every line of sight through a top cap over `bounds` has no surface before it.
    ///
    /// Along a line heights are convex. Where it descends through a cap, which is no lower than any
    /// surface, all before was higher. With foot point p and eye e in coordinates divided by the radii, a
    /// line to height h above p descends there if e · p ≥ 1 + h / b, b being the shortest radius.
    pub(crate) fn tops_hide_surface(&self, bounds: &Bounds) -> bool {
        let radii_m = self.ellipsoid.radii_m();
        let farthest_m = self.eye_ecef_m.length() + self.ellipsoid.a_m;
        let highest = 1.0 + self.extrusion.top_at_m(farthest_m) / radii_m.min_element();
        let (eye, least) = if self.parallel {
            let axis = self.clip_from_relative.transpose().z_axis.xyz();
            ((-axis / radii_m).normalize(), 0.0)
        } else {
            (self.eye_ecef_m / radii_m, highest)
        };
        let farthest_rad = eye.angle_between(bounds.axis) + bounds.radius_rad;
        farthest_rad < std::f64::consts::FRAC_PI_2
            && eye.length() * farthest_rad.cos() > least + 1e-9
    }

    /// In coordinates divided by the radii: where the eye is, and the angle from there about the centre to
    /// the horizon of a sphere. None if it is inside. Parallel lines come from infinitely far away, unless
    /// the near plane cuts the sphere.
    fn horizon_of(&self, occluder: f64) -> Option<(DVec3, f64)> {
        let radii_m = self.ellipsoid.radii_m();
        if self.parallel {
            let axis = self.clip_from_relative.transpose().z_axis.xyz();
            let nearest_m = -axis.dot(self.eye_ecef_m) - occluder * (axis * radii_m).length();
            let whole = self.near_m < nearest_m;
            return whole.then_some((-axis / radii_m, std::f64::consts::FRAC_PI_2));
        }
        let eye = self.eye_ecef_m / radii_m;
        let eye_distance = eye.length();
        (eye_distance > occluder).then(|| (eye, (occluder / eye_distance).acos()))
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
        let height_m = self.surface_m.1.max(0.0) + SLACK_M;
        let radius_m = self.ellipsoid.a_m.max(self.ellipsoid.b_m) + height_m;
        let window = Window::of_sphere(&self.clip_from_relative, -self.eye_ecef_m, radius_m);
        // In coordinates divided by the radii all surface is within a sphere, which an eye above it sees in a
        // cone, wherever it looks.
        let radii_m = self.ellipsoid.radii_m();
        let eye = self.eye_ecef_m / radii_m;
        let highest = 1.0 + height_m / radii_m.min_element();
        let sine = highest / eye.length();
        if self.parallel || sine >= 1.0 {
            return window;
        }
        let from_ndc = DMat3::from_diagonal(radii_m.recip()) * self.rays_from_ndc();
        let below = Window::of_cone(&from_ndc, -eye.normalize(), (1.0 - sine * sine).sqrt());
        window.common(below)
    }

    /// From points x, y, 1 of a perspective's picture to lines of sight, of which the view axis has length one.
    pub(crate) fn rays_from_ndc(&self) -> DMat3 {
        let rows = self.clip_from_relative.transpose();
        let rows = [rows.x_axis, rows.y_axis, rows.w_axis].map(|row| row.xyz().to_array());
        DMat3::from_cols_array_2d(&rows).transpose().inverse()
    }

    /// Lower bound, metres, of the distance from the eye to visible surface in `bounds`.
    pub(crate) fn distance_to_m(&self, bounds: &Bounds) -> f64 {
        let (middle_m, radius_m) = self.sphere(bounds);
        (middle_m.length() - radius_m).max(self.nearest_m())
    }

    fn nearest_m(&self) -> f64 {
        self.near_m.max(0.0)
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
        (nearest.length() - sag_m).max(self.nearest_m())
    }

    /// Displacement, metres at distance `distance_m`, that the pixel budget allows.
    pub(crate) fn tolerance_m(&self, distance_m: f64) -> f64 {
        (self.pixel_error * self.pixel.at_m(distance_m)).max(FINEST_TOLERANCE_M)
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
