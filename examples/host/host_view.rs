//! The uniform that the host's shaders share.

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3, DVec4};
use globefill::Ellipsoid;

use super::{camera::Eye, picture::DETAIL_SIDE};

/// `HostView` of `host_view.wgsl`, where the fields are explained.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct HostView {
    ray_x: [f32; 4],
    ray_y: [f32; 4],
    ray_0: [f32; 4],
    moment_x: [f32; 4],
    moment_y: [f32; 4],
    moment_0: [f32; 4],
    eye: [f32; 4],
    clip_from_relative: [[f32; 4]; 4],
    sun: [f32; 4],
    east: [f32; 4],
    north: [f32; 4],
    detail_fine: [f32; 4],
    detail_coarse: [f32; 4],
    constants: [f32; 4],
    picture: [f32; 4],
}

/// What the shaders are specialised for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Specialisation {
    /// The world picture's texels are larger than the pixels.
    pub magnified: bool,
    /// The ground gets invented detail.
    pub detailed: bool,
}

impl HostView {
    /// `picture_px` is the width of the world picture.
    pub fn new(ellipsoid: &Ellipsoid, eye: &Eye, picture_px: u32) -> Self {
        let camera = &eye.camera;
        let scale = DVec3::ONE / ellipsoid.radii_m();
        let scaled_eye = camera.eye_ecef_m * scale;
        let ecef_from_view = camera.view_from_ecef.transpose();
        // In units of the equatorial radius along the ray, so that single precision has no tiny numbers.
        let ray = |view: DVec3| (ecef_from_view * view) * scale * ellipsoid.a_m;
        let ray_x = ray(DVec3::X * eye.half_extent.x);
        let ray_y = ray(DVec3::Y * eye.half_extent.y);
        let ray_0 = ray(DVec3::NEG_Z);
        let with_dot = |ray: DVec3| ray.extend(scaled_eye.dot(ray)).as_vec4().to_array();
        let moment = |ray: DVec3| scaled_eye.cross(ray).extend(0.0).as_vec4().to_array();

        let (foot, height_m) = ellipsoid.geodetic(camera.eye_ecef_m);
        let up = ellipsoid.normal(foot);
        let east = DVec3::Z.cross(up).try_normalize().unwrap_or(DVec3::Y);
        let north = up.cross(east);
        let sun = (up + 0.45 * north - 0.55 * east).normalize();
        let distance_m = height_m.abs().max(0.01);
        let pixel_m = distance_m * eye.pixel_size();
        let texel_m = std::f64::consts::TAU * ellipsoid.a_m / f64::from(picture_px);
        let detail_strength = 0.35 * (1.0 - (distance_m / 4e5)).clamp(0.0, 1.0).sqrt();
        let (z_scale, z_offset) = eye.depth_coefficients();
        let clip_from_relative =
            camera.clip_from_view * glam::DMat4::from_mat3(camera.view_from_ecef);
        let limb_pixel_m = pixel_m * 1.5;
        Self {
            ray_x: with_dot(ray_x),
            ray_y: with_dot(ray_y),
            ray_0: with_dot(ray_0),
            moment_x: moment(ray_x),
            moment_y: moment(ray_y),
            moment_0: moment(ray_0),
            eye: scaled_eye
                .extend(implicit(ellipsoid, camera.eye_ecef_m))
                .as_vec4()
                .to_array(),
            clip_from_relative: clip_from_relative.as_mat4().to_cols_array_2d(),
            sun: sun
                .extend((pixel_m / texel_m).log2().max(0.0))
                .as_vec4()
                .to_array(),
            east: east.extend(detail_strength).as_vec4().to_array(),
            north: north.extend(eye.pixel_size()).as_vec4().to_array(),
            detail_fine: detail_tile(ellipsoid, foot.lon_deg, foot.lat_deg, pixel_m * 2.0),
            detail_coarse: detail_tile(ellipsoid, foot.lon_deg, foot.lat_deg, pixel_m * 16.0),
            constants: DVec4::new(
                ellipsoid.a_m,
                ellipsoid.a_m / ellipsoid.b_m,
                z_scale,
                z_offset,
            )
            .as_vec4()
            .to_array(),
            picture: eye
                .lens
                .size_px
                .as_vec2()
                .extend(eye.clear_depth())
                .extend(limb_pixel_m.clamp(9e3, 6e4) as f32)
                .to_array(),
        }
    }
}

impl Specialisation {
    /// Values of the pipeline-overridable constants.
    pub fn constants(&self) -> [(&'static str, f64); 2] {
        [
            ("magnified", f64::from(u8::from(self.magnified))),
            ("detailed", f64::from(u8::from(self.detailed))),
        ]
    }
}

impl HostView {
    pub fn specialisation(&self) -> Specialisation {
        Specialisation {
            magnified: self.sun[3] == 0.0,
            detailed: self.east[3] > 0.0,
        }
    }
}

/// |scaled position|² − 1: zero on the ellipsoid. Written so that it keeps its relative accuracy
/// close to the surface, up to the rounding of the position itself.
fn implicit(ellipsoid: &Ellipsoid, ecef_m: DVec3) -> f64 {
    let radius = (ecef_m / ellipsoid.radii_m()).length();
    (radius - 1.0) * (radius + 1.0)
}

/// Offset and size of a noise tile with texels of about `texel_m`, a power of two, so that the
/// detail stays on the ground when the camera moves at one height.
fn detail_tile(ellipsoid: &Ellipsoid, lon_deg: f64, lat_deg: f64, texel_m: f64) -> [f32; 4] {
    let texel_m = texel_m.log2().round().exp2();
    let tile_m = texel_m * f64::from(DETAIL_SIDE);
    let radius_m = ellipsoid.a_m;
    let place = DVec2::new(
        lon_deg.to_radians() * lat_deg.to_radians().cos() * radius_m,
        lat_deg.to_radians() * radius_m,
    );
    let offset = place - (place / tile_m).floor() * tile_m;
    DVec4::new(offset.x, offset.y, tile_m, texel_m)
        .as_vec4()
        .to_array()
}
