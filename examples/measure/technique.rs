//! Ways of filling regions, as the program runs them.

use std::fmt;

use clap::ValueEnum;
use globefill::CountTechnique;

use crate::{
    canvas::Paint,
    host::gpu::Gpu,
    invocations::InvocationQueries,
    stage::Stage,
    techniques::{
        crate_fills::CrateFills, doubled::Doubled, globe::BareGlobe, moving_sensors::MovingSensors,
        records::Records, surface::Surface,
    },
};

/// What a technique is called on the command line and in the rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum TechniqueName {
    /// The globe alone: what all others start from.
    Globe,
    /// The crate, counting fill by fill.
    Stencil,
    /// The crate, summing all fills at once.
    Winding,
    /// Volumes from one stream of triples, expanded as a geometry shader would.
    Records,
    /// Volumes from a vertex buffer that holds every vertex twice.
    Doubled,
    /// The caps alone, lying on the ellipsoid: right over no terrain.
    Surface,
    /// The crate's sensors.
    Sensors,
}

impl fmt::Display for TechniqueName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Globe => "globe",
            Self::Stencil => "stencil",
            Self::Winding => "winding",
            Self::Records => "records",
            Self::Doubled => "doubled",
            Self::Surface => "surface",
            Self::Sensors => "sensors",
        })
    }
}

/// What a frame took beside time; the ground is not counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    pub draws: u32,
    pub passes: u32,
    pub upload_bytes: u64,
    /// Buffers that hold the fills.
    pub gpu_bytes: u64,
    /// How the crate counted, which may be another way than asked for.
    pub count: Option<CountTechnique>,
}

/// A way of filling, ready to draw one stage.
pub trait Technique {
    /// Draws ground and fills and waits for them. `queries`, if any, take the statistics of the fills'
    /// passes, of which there are [`Technique::queries`].
    fn draw(
        &mut self,
        gpu: &Gpu,
        stage: &Stage,
        queries: Option<&InvocationQueries>,
    ) -> Result<Cost, String>;

    /// Passes whose statistics are taken, once a frame was drawn.
    fn queries(&self) -> u32;

    /// What it draws into.
    fn color(&self) -> &globefill::wgpu::Texture;
}

impl TechniqueName {
    /// The technique for a stage, or why it cannot draw it.
    pub fn make(
        self,
        gpu: &Gpu,
        stage: &Stage,
        paint: Paint,
    ) -> Result<Box<dyn Technique>, String> {
        Ok(match self {
            Self::Globe => Box::new(BareGlobe::new(gpu, stage, paint)?),
            Self::Stencil | Self::Winding => {
                Box::new(CrateFills::new(gpu, stage, paint, self == Self::Stencil)?)
            }
            Self::Records => Box::new(Records::new(gpu, stage, paint)?),
            Self::Doubled => Box::new(Doubled::new(gpu, stage, paint)?),
            Self::Surface => Box::new(Surface::new(gpu, stage, paint)?),
            Self::Sensors => Box::new(MovingSensors::new(gpu, stage, paint)?),
        })
    }
}
