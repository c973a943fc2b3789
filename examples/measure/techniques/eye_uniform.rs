//! What the yardsticks' shaders know of the camera.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec3};
use globefill::wgpu::{self, util::DeviceExt};

use crate::{host::gpu::Gpu, stage::Stage};

/// `Eye` of eye.wgsl, which explains the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct EyeUniform {
    clip_from_relative: [[f32; 4]; 4],
    from_eye: [f32; 4],
    origin: [f32; 4],
    normal_scale: [f32; 4],
    heights: [f32; 4],
    depth: [f32; 4],
}

/// Common declarations of the yardsticks' shaders.
pub const SOURCE: &str = include_str!("eye.wgsl");

/// Metres from which positions are counted: the place below the camera.
pub fn origin_m(stage: &Stage) -> DVec3 {
    stage.ellipsoid.ecef(stage.scene.viewpoint.foot, 0.0)
}

/// How high tops stand over the ellipsoid, metres.
pub fn top_m(stage: &Stage) -> f64 {
    stage.frame.terrain.max_m + stage.mesh.sag_m
}

impl EyeUniform {
    pub fn new(stage: &Stage) -> Self {
        let camera = &stage.eye.camera;
        let (a_m, b_m) = (stage.ellipsoid.a_m, stage.ellipsoid.b_m);
        let origin_m = origin_m(stage);
        let clip_from_relative = camera.clip_from_view * DMat4::from_mat3(camera.view_from_ecef);
        let (depth_scale, depth_offset) = stage.eye.depth_coefficients();
        // A line of sight that grazes the ellipsoid is so long within the sag.
        let pull_m = 2.0 * (2.0 * a_m * stage.mesh.sag_m.max(1.0)).sqrt();
        let push = stage.eye.pixel_size() * stage.frame.host_pixel_error;
        let row = |x: f64, y: f64, z: f64, w: f64| [x as f32, y as f32, z as f32, w as f32];
        let vector = |v: DVec3| row(v.x, v.y, v.z, 0.0);
        Self {
            clip_from_relative: clip_from_relative.as_mat4().to_cols_array_2d(),
            from_eye: vector(origin_m - camera.eye_ecef_m),
            origin: vector(origin_m),
            normal_scale: row(1.0, 1.0, (a_m / b_m).powi(2), 0.0),
            heights: row(top_m(stage), stage.frame.terrain.min_m, push, b_m / 20.0),
            depth: row(depth_scale, depth_offset, pull_m, 0.0),
        }
    }

    pub fn buffer(&self, gpu: &Gpu) -> wgpu::Buffer {
        gpu.device
            .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("eye"),
                contents: bytemuck::bytes_of(self),
                usage: wgpu::BufferUsages::UNIFORM,
            })
    }
}
