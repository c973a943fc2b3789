//! What the yardsticks' shaders know of the camera.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec3};
use globefill::wgpu::{self, util::DeviceExt};

use super::stored_vertex;
use crate::{
    host::gpu::Gpu,
    settings::{Encoding, Normals},
    stage::Stage,
};

/// `Eye` of eye.wgsl, which explains the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct EyeUniform {
    clip_from_relative: [[f32; 4]; 4],
    from_eye: [f32; 4],
    origin: [f32; 4],
    high: [f32; 4],
    low: [f32; 4],
    steps: [i32; 4],
    fraction: [i32; 4],
    remainder: [f32; 4],
    normal_scale: [f32; 4],
    heights: [f32; 4],
    depth: [f32; 4],
}

/// Common declarations of the yardsticks' shaders.
pub const SOURCE: &str = include_str!("eye.wgsl");

/// No coordinate of the eye lies farther in whole steps; the rest is a remainder.
const FARTHEST_M: f64 = 1e7;

/// What positions in single precision are relative to.
pub fn origin_m(stage: &Stage) -> DVec3 {
    match stage.settings.yardstick.encoding {
        Encoding::Plain => DVec3::ZERO,
        _ => stage.ellipsoid.ecef(stage.scene.origin, 0.0),
    }
}

/// How high tops stand over the ellipsoid, metres.
pub fn top_m(stage: &Stage) -> f64 {
    stage.frame.terrain.max_m + stage.mesh.sag_m
}

/// A position on the ellipsoid times this is along the normal that columns stand on.
pub fn normal_scale(stage: &Stage) -> DVec3 {
    match stage.settings.yardstick.normals {
        Normals::Geodetic => {
            let squashed = stage.ellipsoid.a_m / stage.ellipsoid.b_m;
            DVec3::new(1.0, 1.0, squashed * squashed)
        }
        Normals::Geocentric => DVec3::ONE,
    }
}

impl EyeUniform {
    pub fn new(stage: &Stage) -> Self {
        let camera = &stage.eye.camera;
        let ellipsoid = &stage.ellipsoid;
        let (eye_m, origin_m) = (camera.eye_ecef_m, origin_m(stage));
        let clip_from_relative = camera.clip_from_view * DMat4::from_mat3(camera.view_from_ecef);
        let (depth_scale, depth_offset) = stage.eye.depth_coefficients();
        // A line of sight that grazes the ellipsoid is so long within the sag.
        let pull_m = 2.0 * (2.0 * ellipsoid.a_m * stage.mesh.sag_m.max(1.0)).sqrt();
        let push = stage.eye.pixel_size() * stage.frame.host_pixel_error;
        let (high, low) = stored_vertex::high_low(eye_m);
        let near_m = eye_m.clamp(DVec3::splat(-FARTHEST_M), DVec3::splat(FARTHEST_M));
        let (steps, fraction) = stored_vertex::fixed(near_m);
        let in_steps_m = DVec3::from_array(steps.map(f64::from)) / 128.0
            + DVec3::from_array(fraction.map(f64::from)) / 131_072.0;
        Self {
            clip_from_relative: clip_from_relative.as_mat4().to_cols_array_2d(),
            from_eye: row(origin_m - eye_m, 0.0),
            origin: row(origin_m, 0.0),
            high: padded(high),
            low: padded(low),
            steps: padded(steps),
            fraction: padded(fraction),
            remainder: row(in_steps_m - eye_m, 0.0),
            normal_scale: row(normal_scale(stage), 0.0),
            heights: row(
                DVec3::new(top_m(stage), stage.frame.terrain.min_m, push),
                ellipsoid.b_m / 20.0,
            ),
            depth: row(DVec3::new(depth_scale, depth_offset, pull_m), 0.0),
        }
    }
}

/// The uniform on the GPU.
pub struct EyeBuffer {
    pub buffer: wgpu::Buffer,
    held: EyeUniform,
}

impl EyeBuffer {
    pub fn new(gpu: &Gpu, stage: &Stage) -> Self {
        let held = EyeUniform::new(stage);
        let buffer = gpu
            .device
            .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("eye"),
                contents: bytemuck::bytes_of(&held),
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            });
        Self { buffer, held }
    }

    /// Uploads what a new camera has changed, and tells how many bytes.
    pub fn update(&mut self, gpu: &Gpu, stage: &Stage) -> u64 {
        let next = EyeUniform::new(stage);
        let bytes: &[u8] = bytemuck::bytes_of(&next);
        if bytes == bytemuck::bytes_of(&self.held) {
            return 0;
        }
        gpu.queue.write_buffer(&self.buffer, 0, bytes);
        self.held = next;
        size_of::<EyeUniform>() as u64
    }
}

fn row(xyz: DVec3, w: f64) -> [f32; 4] {
    xyz.extend(w).as_vec4().to_array()
}

fn padded<T: Default>([x, y, z]: [T; 3]) -> [T; 4] {
    [x, y, z, T::default()]
}
