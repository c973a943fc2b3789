//! Fills regions on a globe.

pub mod curve;
pub mod ellipsoid;
pub mod error;
pub mod fill_mesh;
pub mod frame_stats;
pub mod geodetic;
pub mod options;
pub mod region;
pub mod renderer;
pub mod repair;
#[cfg_attr(not(test), expect(dead_code, reason = "used by the mesh build"))]
mod triangulate;

pub use wgpu;

pub use crate::{
    curve::Curve,
    ellipsoid::Ellipsoid,
    error::{RegionError, RendererError},
    fill_mesh::FillMesh,
    frame_stats::FrameStats,
    geodetic::LonLat,
    options::{
        Camera, CountTechnique, DepthConvention, FillStyle, Frame, HeightRange, RendererOptions,
    },
    region::{EdgeKind, Inside, Polygon, Region, Ring},
    renderer::{MeshId, Renderer, View},
    repair::{Place, Repair, RepairKind},
};
