//! The bare globe: the exact ellipsoid, intersected in every pixel.

use glam::{DMat3, DVec2, DVec3, UVec2};
use globefill::{Ellipsoid, wgpu};

use super::{
    camera::Eye,
    gpu::Gpu,
    ground::{GroundPipeline, TargetFormat},
};

const SOURCE: &str = concat!(include_str!("host_view.wgsl"), include_str!("globe.wgsl"));

/// The part of the picture that holds the globe.
pub struct Globe {
    first_px: UVec2,
    size_px: UVec2,
    whole_px: UVec2,
}

impl Globe {
    pub fn new(ellipsoid: &Ellipsoid, eye: &Eye) -> Self {
        let whole_px = eye.lens.size_px;
        let (low, high) = outline(ellipsoid, eye).unwrap_or((DVec2::NEG_ONE, DVec2::ONE));
        // Clip space to pixels, y turned over, a pixel to spare on every side.
        let to_px = |ndc: DVec2| (ndc * DVec2::new(0.5, -0.5) + 0.5) * whole_px.as_dvec2();
        let clamp = |px: DVec2| px.clamp(DVec2::ZERO, whole_px.as_dvec2()).as_uvec2();
        let first_px = clamp(to_px(DVec2::new(low.x, high.y)).floor() - 1.0);
        let last_px = clamp(to_px(DVec2::new(high.x, low.y)).ceil() + 1.0);
        Self {
            first_px,
            size_px: last_px - first_px,
            whole_px,
        }
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        if self.size_px.min_element() == 0 {
            return;
        }
        pass.set_scissor_rect(
            self.first_px.x,
            self.first_px.y,
            self.size_px.x,
            self.size_px.y,
        );
        pass.draw(0..3, 0..1);
        pass.set_scissor_rect(0, 0, self.whole_px.x, self.whole_px.y);
    }
}

/// Least and greatest clip coordinates of the globe's outline; `None` where it has no finite ones.
///
/// The outline is a conic whose dual is the projected dual of the ellipsoid (Hartley & Zisserman,
/// Multiple View Geometry, eq. 8.5).
fn outline(ellipsoid: &Ellipsoid, eye: &Eye) -> Option<(DVec2, DVec2)> {
    let radii = DMat3::from_diagonal(ellipsoid.radii_m());
    let clip_from_ecef = DMat3::from_diagonal(DVec3::new(
        1.0 / eye.half_extent.x,
        1.0 / eye.half_extent.y,
        -1.0,
    )) * eye.camera.view_from_ecef;
    let axes = clip_from_ecef * radii;
    let centre = -(clip_from_ecef * eye.camera.eye_ecef_m);
    let dual = |i: usize, j: usize| axes.row(i).dot(axes.row(j)) - centre[i] * centre[j];
    if dual(2, 2) >= 0.0 || centre.z <= 0.0 {
        return None;
    }
    let range = |i: usize| {
        let middle = dual(i, 2) / dual(2, 2);
        let half = (middle * middle - dual(i, i) / dual(2, 2)).max(0.0).sqrt();
        (middle - half, middle + half)
    };
    let ((left, right), (bottom, top)) = (range(0), range(1));
    Some((DVec2::new(left, bottom), DVec2::new(right, top)))
}

pub fn pipeline(
    gpu: &Gpu,
    shared: &wgpu::BindGroupLayout,
    format: &TargetFormat,
    constants: &[(&str, f64)],
) -> wgpu::RenderPipeline {
    GroundPipeline {
        label: "globe",
        source: SOURCE,
        vertex: "whole_picture",
        fragment: if format.sample_count > 1 {
            "globe_sample"
        } else {
            "globe_pixel"
        },
        buffers: &[],
        groups: &[Some(shared)],
        constants,
        depth_compare: wgpu::CompareFunction::Always,
    }
    .create(&gpu.device, format)
}
