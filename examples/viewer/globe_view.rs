//! The host's part of a frame: targets of the window's size, and the globe drawn into them.

use glam::UVec2;
use globefill::{DepthConvention, Ellipsoid, wgpu};

use crate::host::{
    camera::{Eye, Shot, Viewpoint},
    gpu::Gpu,
    ground::{Ground, GroundPipelines, TargetFormat},
    host_view::Specialisation,
    targets::Targets,
};

/// Vertical field of view.
pub const FOV_DEG: f64 = 50.0;

/// The globe, as large as the window.
pub struct GlobeView {
    pub targets: Targets,
    pub eye: Eye,
    format: TargetFormat,
    ground: Ground,
    /// Made when a camera first needs them.
    pipelines: Vec<(Specialisation, GroundPipelines)>,
}

impl GlobeView {
    pub fn new(
        gpu: &Gpu,
        color: wgpu::TextureFormat,
        size_px: UVec2,
        viewpoint: &Viewpoint,
    ) -> Result<Self, String> {
        let format = TargetFormat {
            color,
            depth: wgpu::TextureFormat::Depth32Float,
            convention: DepthConvention::Reversed,
            sample_count: 1,
        };
        let eye = eye(size_px, viewpoint);
        Ok(Self {
            targets: Targets::new(gpu, size_px, format, eye.clear_depth())?,
            ground: Ground::new(gpu, &Ellipsoid::WGS84, None, &eye)?,
            pipelines: Vec::new(),
            format,
            eye,
        })
    }

    /// Another size of the window.
    pub fn resize(&mut self, gpu: &Gpu, size_px: UVec2) -> Result<(), String> {
        self.targets = Targets::new(gpu, size_px, self.format, self.eye.clear_depth())?;
        Ok(())
    }

    /// Another camera.
    pub fn look(&mut self, gpu: &Gpu, size_px: UVec2, viewpoint: &Viewpoint) {
        self.eye = eye(size_px, viewpoint);
        self.ground.look(gpu, &Ellipsoid::WGS84, &self.eye);
        let needed = self.ground.specialisation();
        if self.pipelines.iter().all(|(made, _)| *made != needed) {
            let pipelines = self.ground.pipelines(gpu, &self.format);
            self.pipelines.push((needed, pipelines));
        }
    }

    /// Records the globe.
    pub fn draw(&self, encoder: &mut wgpu::CommandEncoder) {
        let needed = self.ground.specialisation();
        let made = self.pipelines.iter().find(|(made, _)| *made == needed);
        if let Some((_, pipelines)) = made {
            self.targets
                .draw_ground(encoder, &self.ground, pipelines, false);
        }
    }
}

fn eye(size_px: UVec2, viewpoint: &Viewpoint) -> Eye {
    let shot = Shot {
        fov_deg: FOV_DEG,
        size_px,
        depth: DepthConvention::Reversed,
    };
    Eye::above(&Ellipsoid::WGS84, None, viewpoint, shot)
}
