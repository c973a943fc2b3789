//! The targets that winding sums are kept in.

use crate::frame::code::Mantissa;

/// Which planes a layer has, and in which float format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Planes {
    pub count: u32,
    pub half: bool,
    /// Whether weights of a mixture are summed, not codes.
    pub weights: bool,
    /// Bits of a check that is summed in one plane with its id; 0 for planes of their own.
    pub joined: u32,
}

impl Planes {
    pub(crate) fn new(count: u32, mantissa: Mantissa) -> Self {
        Self {
            count,
            half: mantissa == Mantissa::Half,
            weights: false,
            joined: 0,
        }
    }

    /// The same with so many bits of the check in the plane of the id.
    pub(crate) fn joined(self, joined: u32) -> Self {
        let count = if joined > 0 { 1 } else { self.count };
        Self {
            count,
            joined,
            ..self
        }
    }

    /// Those of a mixture: three colours and all light.
    pub(crate) fn of_weights(mantissa: Mantissa) -> Self {
        Self {
            weights: true,
            ..Self::new(4, mantissa)
        }
    }

    /// The overrides of extrude.wgsl.
    pub(crate) fn constants(self) -> [(&'static str, f64); 2] {
        [
            ("WEIGHTS", u8::from(self.weights).into()),
            ("JOINED", self.joined.into()),
        ]
    }

    /// Formats of the targets: one with all planes, or one each where samples are many (32-bit
    /// formats with several channels cannot be multisampled).
    pub(crate) fn formats(self, sample_count: u32) -> Vec<wgpu::TextureFormat> {
        use wgpu::TextureFormat as F;
        let (one, two, four) = if self.half {
            (F::R16Float, F::Rg16Float, F::Rgba16Float)
        } else {
            (F::R32Float, F::Rg32Float, F::Rgba32Float)
        };
        match (sample_count, self.count) {
            (1, 1) => vec![one],
            (1, 2) => vec![two],
            (1, _) => vec![four],
            (_, count) => vec![one; count as usize],
        }
    }
}
