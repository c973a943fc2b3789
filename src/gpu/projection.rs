//! How volumes are projected, and what the device must be able to do for that.

use crate::{frame::lens::LensKind, frame::sight::Sight};

/// What it takes to draw into depth with a far plane, which must not clip the volumes.
pub(crate) const FAR_PLANE_FEATURES: wgpu::Features =
    wgpu::Features::DEPTH_CLIP_CONTROL.union(wgpu::Features::CLIP_DISTANCES);

/// How volumes are projected and clipped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) enum Projection {
    /// A perspective without a far plane: clipped at the near plane as usual.
    #[default]
    Infinite,
    /// A perspective with a far plane, which must not clip.
    FarPlane,
    /// Parallel lines of sight, where neither plane need clip.
    Parallel,
    /// Into a copy of logarithmic depths that are made reversed ones without a far plane.
    Logarithmic,
}

impl Projection {
    pub(crate) fn of(sight: &Sight) -> Self {
        match sight.kind {
            LensKind::Parallel => Self::Parallel,
            LensKind::Logarithmic => Self::Logarithmic,
            LensKind::Perspective if sight.far_plane => Self::FarPlane,
            LensKind::Perspective => Self::Infinite,
        }
    }

    /// What the device must be able to do.
    pub(crate) fn features(self) -> wgpu::Features {
        match self {
            Self::Infinite | Self::Logarithmic => wgpu::Features::empty(),
            Self::FarPlane => FAR_PLANE_FEATURES,
            Self::Parallel => wgpu::Features::DEPTH_CLIP_CONTROL,
        }
    }

    /// Whether both planes of depth would clip, and must not.
    pub(crate) fn unclipped(self) -> bool {
        matches!(self, Self::FarPlane | Self::Parallel)
    }

    /// The overrides of host.wgsl that volumes are drawn with.
    pub(crate) fn constants(self) -> [(&'static str, f64); 2] {
        let kind = match self {
            Self::Parallel => LensKind::Parallel,
            Self::Infinite | Self::FarPlane | Self::Logarithmic => LensKind::Perspective,
        };
        kind.constants()
    }
}
