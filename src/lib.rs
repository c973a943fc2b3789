//! Fills regions on a globe.

mod code;
mod count;
#[cfg(feature = "countries")]
pub mod countries;
pub mod curve;
pub mod ellipsoid;
pub mod error;
pub mod fill_mesh;
mod fixed_point;
pub mod frame_stats;
#[cfg(feature = "geojson")]
pub mod geo_json;
pub mod geodetic;
mod gpu_mesh;
mod isometric;
mod layer_tables;
mod layers;
pub mod options;
mod pipelines;
mod refine;
pub mod region;
pub mod renderer;
pub mod repair;
mod select;
#[doc(hidden)]
pub mod shaders;
mod sight;
mod stream_buffer;
mod targets;
pub mod view;
mod volumes;

pub use {glam, wgpu};

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
    renderer::{MeshId, Renderer},
    repair::{Place, Repair, RepairKind},
    view::View,
};
