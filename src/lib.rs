//! Fills regions on a globe.

mod arcs;
mod authalic;
mod boundary_graph;
mod bounds;
mod code;
mod count;
#[cfg(feature = "countries")]
pub mod countries;
pub mod curve;
mod densify;
mod edge_grid;
pub mod ellipsoid;
pub mod error;
pub mod fill_mesh;
mod fixed_point;
pub mod frame_stats;
#[cfg(feature = "geojson")]
pub mod geo_json;
pub mod geodetic;
mod gpu_mesh;
mod headings;
mod inside;
mod isometric;
mod lattice;
mod layer_tables;
mod layers;
mod meeting;
mod meridian_index;
mod mesh_build;
mod noding;
pub mod options;
mod overlaps;
mod pipelines;
mod refine;
pub mod region;
pub mod renderer;
pub mod repair;
mod rings;
mod select;
#[doc(hidden)]
pub mod shaders;
mod sight;
mod simple_loops;
mod stream_buffer;
mod targets;
mod triangulate;
mod vertex_runs;
pub mod view;
mod volumes;

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
