//! What edge.wgsl reads besides the camera.

use glam::{DVec3, Vec4Swizzles as _};

use crate::{
    frame::code::Code,
    frame::reference::Reference,
    frame::sight::Sight,
    frame::sight_uniform::{SightUniform, padded},
    gpu::fixed_point::FixedEye,
};

/// `EdgeSight` of edge.wgsl; see there.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct EdgeUniform {
    pub foot: [i32; 4],
    pub foot_fraction: [i32; 4],
    pub foot_remainder: [f32; 4],
    pub axis: [f32; 4],
    pub surface: [f32; 4],
    pub code: [u32; 4],
}

impl EdgeUniform {
    pub(crate) fn new(
        sight: &Sight,
        reference: &Reference,
        rays: &SightUniform,
        code: &Code,
    ) -> Self {
        let foot = FixedEye::new(reference.foot_ecef_m);
        let with_zero = |[x, y, z]: [i32; 3]| [x, y, z, 0];
        let axis = sight.clip_from_relative.transpose().z_axis.xyz();
        let spans = [rays.right, rays.down]
            .map(|[x, y, z, _]| DVec3::new(f64::from(x), f64::from(y), f64::from(z)).length());
        let (lowest_m, highest_m) = sight.surface_m;
        Self {
            foot: with_zero(foot.steps),
            foot_fraction: with_zero(foot.fractions),
            foot_remainder: padded(foot.remainder_m, 0.0),
            axis: padded(axis, spans[0].max(spans[1])),
            surface: [lowest_m as f32, highest_m as f32, 0.0, 0.0],
            code: [code.base, code.digits, 0, 0],
        }
    }
}
