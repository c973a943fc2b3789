//! Fills regions on a globe inside a host's wgpu frame.
//!
//! The host draws an ellipsoid or a terrain into a depth buffer; globefill colours the surface points
//! whose geodetic foot point lies inside a region. Regions become a [`FillMesh`] on the CPU, without a
//! GPU and on any thread; a [`Renderer`] uploads it and draws it for any number of [`View`]s.
//!
//! # Frame order
//!
//! 1. The host draws its surface.
//! 2. [`Renderer::prepare`] with the camera in double precision: culls, refines the boundary near the
//!    eye, uploads what changed.
//! 3. [`Renderer::count`], outside any pass, once the depth is final. The depth is attached read-only.
//! 4. [`Renderer::resolve`] in a pass of the host's that does not have that depth attached.
//! 5. The host draws what is to stay unfilled: models, labels.
//!
//! ```no_run
//! # fn frame(
//! #     device: &globefill::wgpu::Device,
//! #     queue: &globefill::wgpu::Queue,
//! #     encoder: &mut globefill::wgpu::CommandEncoder,
//! #     depth_view: &globefill::wgpu::TextureView,
//! #     color_attachment: globefill::wgpu::RenderPassColorAttachment<'_>,
//! #     camera: globefill::Camera,
//! #     size_px: globefill::glam::UVec2,
//! # ) -> Result<(), Box<dyn std::error::Error>> {
//! use globefill::{
//!     FillMesh, Frame, LonLat, MeshOptions, Polygon, Region, Renderer, RendererOptions, View,
//! };
//!
//! let shell = vec![LonLat::new(8.0, 46.0), LonLat::new(11.0, 46.0), LonLat::new(10.0, 48.0)];
//! let region = Region {
//!     polygons: vec![Polygon { shell, holes: Vec::new() }],
//!     ..Default::default()
//! };
//! let mesh = FillMesh::build(&[region], &MeshOptions::default())?;
//!
//! let mut renderer = Renderer::new(device, RendererOptions::default())?;
//! renderer.insert(mesh);
//! let mut view = View::default();
//!
//! renderer.prepare(queue, &mut view, &Frame::new(camera, size_px))?;
//! renderer.count(&view, encoder, depth_view);
//! let mut pass = encoder.begin_render_pass(&globefill::wgpu::RenderPassDescriptor {
//!     color_attachments: &[Some(color_attachment)],
//!     ..Default::default()
//! });
//! renderer.resolve(&view, &mut pass);
//! # Ok(())
//! # }
//! ```
//!
//! # What "inside" means
//!
//! A region's [`Inside`] says on which side of a shell its inside lies, its [`EdgeKind`] how vertices
//! are joined. Poles, the antimeridian and regions larger than a hemisphere are ordinary. Rings that
//! cross themselves are filled by the even-odd rule; [`FillMesh::repairs`] tells what was repaired.
//!
//! A [`Zone`] is a circle, annulus, sector or corridor measured along the surface, and a [`Region`]
//! like any other. Its boundary winds round what is inside at least once and is filled once,
//! however often it winds.
//!
//! # Accuracy
//!
//! [`Frame::pixel_error`] bounds how far a drawn boundary may lie from the true one, to about 1/32 px,
//! where rasterisation and single precision end. Stored boundaries are within
//! [`MeshOptions::tolerance_m`]; chords nearer to the eye than that allows are replaced by finer ones
//! for the frame.

#[cfg(feature = "countries")]
pub mod countries;
pub mod curve;
pub mod ellipsoid;
pub mod error;
pub mod field_of_view;
pub mod fill_mesh;
pub mod frame_stats;
#[cfg(feature = "geojson")]
pub mod geo_json;
pub mod geodetic;
pub mod options;
pub mod region;
pub mod renderer;
pub mod repair;
pub mod sensor;
#[doc(hidden)]
pub mod shaders;
pub mod view;
pub mod zone;

mod boundary;
mod frame;
mod gpu;
mod mesh;

pub use {glam, wgpu};

pub use crate::{
    curve::{Curve, CurveKind, CurveOn},
    ellipsoid::Ellipsoid,
    error::{RegionError, RendererError, SensorError, ZoneError},
    field_of_view::FieldOfView,
    fill_mesh::{FillMesh, MeshOptions},
    frame_stats::FrameStats,
    geodetic::LonLat,
    options::{
        Camera, CountTechnique, DepthConvention, FillStyle, Frame, HeightRange, RendererOptions,
    },
    region::{EdgeKind, Inside, Polygon, Region, Ring},
    renderer::{MeshId, Renderer},
    repair::{Place, Repair, RepairKind},
    sensor::{Extrusion, Pose, Sensor},
    view::View,
    zone::Zone,
};
