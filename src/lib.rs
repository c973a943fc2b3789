//! Fills regions on a globe.

mod authalic;
mod boundary_graph;
pub mod curve;
mod edge_grid;
pub mod ellipsoid;
pub mod error;
pub mod fill_mesh;
pub mod frame_stats;
pub mod geodetic;
mod headings;
mod inside;
mod isometric;
mod lattice;
mod meeting;
mod meridian_index;
mod noding;
pub mod options;
pub mod region;
pub mod renderer;
pub mod repair;
mod rings;
mod simple_loops;

pub use wgpu;

pub use crate::{
    curve::{Curve, CurveOn},
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
