//! A scene with its camera, ground and mesh: what every technique draws.

use std::time::Instant;

use glam::UVec2;
use globefill::{DepthConvention, Ellipsoid, FillMesh, Frame, HeightRange, MeshOptions};

use crate::{
    host::{
        camera::{Eye, Shot},
        gpu::Gpu,
        ground::Ground,
        times::milliseconds_since,
    },
    scene::Scene,
    settings::Settings,
};

/// Earth's terrain: volumes that need not know the ground reach from the Dead Sea to above Everest.
const TERRAIN: HeightRange = HeightRange {
    min_m: -500.0,
    max_m: 9000.0,
};

/// How far east a camera moves from frame to frame: some tenth of a pixel.
const STEP_DEG_PER_M: f64 = 1e-9;

/// A scene, ready to be drawn.
pub struct Stage {
    pub scene: Scene,
    pub settings: Settings,
    /// What regions refer to.
    pub ellipsoid: Ellipsoid,
    pub eye: Eye,
    pub ground: Ground,
    pub mesh: FillMesh,
    pub frame: Frame,
    /// How long meshing took.
    pub build_ms: f64,
}

impl Stage {
    pub fn new(gpu: &Gpu, scene: &Scene, settings: Settings) -> Result<Self, String> {
        let Settings {
            size_px,
            pixel_error,
            ..
        } = settings;
        let ellipsoid = Ellipsoid::WGS84;
        let start = Instant::now();
        let options = MeshOptions {
            ellipsoid,
            tolerance_m: scene.tolerance_m,
            ..Default::default()
        };
        let mesh = FillMesh::build(&scene.regions, &options).map_err(|error| error.to_string())?;
        let build_ms = milliseconds_since(start);
        let eye = eye(scene, size_px, 0);
        Ok(Self {
            ground: Ground::new(gpu, &ground(&ellipsoid, scene), None, &eye)?,
            frame: Frame {
                terrain: TERRAIN,
                pixel_error,
                ..Frame::new(eye.camera, size_px)
            },
            scene: scene.clone(),
            settings,
            ellipsoid,
            eye,
            mesh,
            build_ms,
        })
    }
}

impl Stage {
    /// Moves the camera to where it is in a frame, counted from 0, if it moves.
    pub fn advance(&mut self, gpu: &Gpu, frame: u32) {
        if !self.settings.moving {
            return;
        }
        self.eye = eye(&self.scene, self.settings.size_px, frame);
        self.frame.camera = self.eye.camera;
        let ground = ground(&self.ellipsoid, &self.scene);
        self.ground.look(gpu, &ground, &self.eye);
    }
}

/// The camera of a frame.
fn eye(scene: &Scene, size_px: UVec2, frame: u32) -> Eye {
    let shot = Shot {
        fov_deg: scene.fov_deg(size_px),
        size_px,
        depth: DepthConvention::Reversed,
    };
    let mut viewpoint = scene.viewpoint;
    viewpoint.foot.lon_deg += STEP_DEG_PER_M * viewpoint.height_m * f64::from(frame);
    Eye::over_level(&Ellipsoid::WGS84, scene.ground_m, &viewpoint, shot)
}

/// The ellipsoid that is as high everywhere, within some millimetres a kilometre: half the flattening's
/// square, of it.
fn ground(ellipsoid: &Ellipsoid, scene: &Scene) -> Ellipsoid {
    Ellipsoid {
        a_m: ellipsoid.a_m + scene.ground_m,
        b_m: ellipsoid.b_m + scene.ground_m,
    }
}
