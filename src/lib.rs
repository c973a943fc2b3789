//! Fills regions on a globe.

#[cfg(feature = "countries")]
pub mod countries;
pub mod curve;
pub mod ellipsoid;
pub mod error;
pub mod fill_mesh;
pub mod frame_stats;
#[cfg(feature = "geojson")]
pub mod geo_json;
pub mod geodetic;
pub mod options;
pub mod region;
pub mod renderer;
pub mod repair;
#[doc(hidden)]
pub mod shaders;
pub mod view;

mod boundary;
mod frame;
mod gpu;
mod mesh;

pub use {glam, wgpu};

pub use crate::{
    curve::{Curve, CurveOn},
    ellipsoid::Ellipsoid,
    error::{RegionError, RendererError},
    fill_mesh::{FillMesh, MeshOptions},
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
