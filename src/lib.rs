//! Fills regions on a globe inside a host's wgpu frame.
//!
//! The host draws an ellipsoid or a terrain into a depth buffer; globefill colours the surface points
//! whose geodetic foot point lies inside a region. Regions become a [`FillMesh`] on the CPU, without a
//! GPU and on any thread; a [`Renderer`] uploads it and draws it for any number of [`View`]s.
//!
//! # Frame order
//!
//! 1. The host draws its surface.
//! 2. [`Renderer::prepare`] with the camera in double precision: culls, chooses levels of detail, refines the
//!    boundary near the eye, uploads what changed.
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
//! renderer.count(&mut view, encoder, depth_view);
//! let mut pass = encoder.begin_render_pass(&globefill::wgpu::RenderPassDescriptor {
//!     color_attachments: &[Some(color_attachment)],
//!     ..Default::default()
//! });
//! renderer.resolve(&view, &mut pass);
//! # Ok(())
//! # }
//! ```
//!
//! # Hosts
//!
//! Perspectives from telescopes to 150° and orthographic projections, which may take turns from frame to
//! frame; depth that runs either way, with or without a far plane, or logarithmically, in 32-bit floats or
//! 24 bits; the eye anywhere, below the surface too. See [`Camera::clip_from_view`],
//! [`RendererOptions::depth`] and [`Frame::log_depth`]. A renderer
//! draws any number of viewports in a frame, each with its [`View`]; a view follows the size of its window.
//!
//! When its device is lost, a host drops renderers and views and makes them again on a new one: from the same
//! meshes, of which it may keep copies. Until it notices nothing of globefill panics; what wgpu then reports
//! is for the host's handler of uncaptured errors.
//!
//! # Styles
//!
//! [`Renderer::set_style`] says how a fill looks: [`FillStyle`]. Plain colours, with opacity, highlight and
//! additive blending, need nothing but the counted sums. A pattern ([`Hatch`], [`ImageFill`]), a [`Fade`] or
//! a [`Stroke`] needs the surface point at each pixel, so the depth must have `TEXTURE_BINDING`; layers
//! whose fills have none are resolved as before, which [`FrameStats::styled_layers`] shows. Strokes and
//! [`RendererOptions::smooth_edges`] add a pass that measures how far pixels are from boundaries
//! ([`FrameStats::edge_passes`]).
//!
//! Texture coordinates follow from the surface point. The alternative, coordinates at the vertices of the
//! mesh and barycentric interpolation, would tie them to triangles that are up to hundreds of kilometres
//! wide and lie kilometres below the surface they stand for, and each pixel would have to find its triangle;
//! differences from the eye's foot point are as precise without either.
//!
//! # Sensors
//!
//! Footprints of sensors are not meshed. [`Renderer::sensors_mut`] is a [`SensorSet`]: put
//! [`Sensor`]s in, move them with [`SensorSet::set_pose`] as often as every frame, and the next
//! `prepare` uploads the records that changed, 128 bytes each. `count` sorts sensors into tiles of the
//! picture, `resolve` asks at each pixel the few whose edge is near: the frame shows this frame's
//! footprints, any number of them, over each other in any order.
//!
//! ```
//! use globefill::{
//!     CoverageColors, Ellipsoid, FieldOfView, LonLat, Pose, Sensor, SensorDisplay, SensorSet,
//!     SensorStyle,
//! };
//!
//! # fn main() -> Result<(), globefill::SensorError> {
//! let wgs84 = Ellipsoid::WGS84;
//! let pose = |lon_deg| Pose::nadir(&wgs84, wgs84.ecef(LonLat::new(lon_deg, 52.0), 550e3));
//! let mut sensors = SensorSet::new(wgs84);                  // a renderer has one: sensors_mut()
//! let cone = FieldOfView::conic(45_f64.to_radians())?;
//! let id = sensors.insert(Sensor::new(pose(13.0), cone), SensorStyle::default())?;
//! sensors.set_pose(id, pose(13.1))?;                        // every frame
//!
//! // How many sensors see each point, instead of footprints:
//! let ramp = CoverageColors::ramp([0.8, 0.1, 0.1, 0.6], &[[0.2, 0.2, 0.6, 0.4], [1.0; 4]], 10)?;
//! sensors.set_display(SensorDisplay::Coverage(ramp));
//!
//! // And the exact answer on the CPU:
//! assert_eq!(sensors.covering(LonLat::new(13.0, 52.0), 0.0).next(), Some(id));
//! # Ok(())
//! # }
//! ```
//!
//! A footprint means one of two things, see [`Extrusion`]: what the sensor sees of the bare ellipsoid,
//! carried up along the normal as on a map; or what it sees from its apex, mountains included.
//!
//! Fills keep order and identity: the greater [`FillStyle::z_index`] is on top. Sensors are above all
//! fills and commute: see [`SensorDisplay`] for what their colours mean.
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
//!
//! Footprints are not subject to the budget: they are tested at each pixel, from positions that are off
//! by a few single-precision roundings of the distance to the eye, and lie within 1/32 px plus one unit
//! of the host's depth. That is tested for an apex from 5 km above the ellipsoid, least elevations up to 29°
//! and cameras that see 1.5° or more; edges hang on ever smaller differences beyond. From the apex, ground
//! that rises by less than a millionth of the distance to the eye, or by decimetres, is hard to tell from
//! the ellipsoid: there the limb may be off by a quarter of a pixel.
//!
//! `docs/accuracy.md` in the repository lists the bound of every stage, and the test that measures it.
//!
//! # Answers
//!
//! What the pixels show can be asked for exactly, in double precision, from the true boundaries:
//! [`Locator`] tells which fills contain a point, [`FillMesh::measures`] and
//! [`FillMesh::bounding_cap`] tell area, centroid and extent, [`Outline`] the same of other curves.
//!
//! What lies under the pointer can be asked of the picture itself, terrain and all:
//! [`Renderer::read_fills`] tells which fills are at a pixel, [`Renderer::read_coverage`] how many
//! sensors see what is there.

#[cfg(feature = "countries")]
pub mod countries;
pub mod coverage;
pub mod curve;
pub mod ellipsoid;
pub mod error;
pub mod extents;
pub mod field_of_view;
pub mod fill_mesh;
pub mod footprint;
pub mod frame_stats;
#[cfg(feature = "geojson")]
pub mod geo_json;
pub mod geodetic;
pub mod guide;
pub mod hatch;
pub mod image;
pub mod image_fill;
pub mod length;
pub mod limits;
pub mod locator;
pub mod options;
pub mod outline;
pub mod pick;
pub mod region;
pub mod renderer;
pub mod repair;
pub mod sensor;
pub mod sensor_set;
#[doc(hidden)]
pub mod shaders;
pub mod stroke;
pub mod style;
pub mod view;
pub mod zone;

// For the integration tests' common parts, which tests of inner passes use as well.
#[cfg(test)]
extern crate self as globefill;
#[cfg(test)]
#[path = "../tests/common/mod.rs"]
mod common;

mod boundary;
mod frame;
mod gpu;
mod mesh;

pub use {glam, wgpu};

pub use crate::{
    coverage::CoverageColors,
    curve::{Curve, CurveKind, CurveOn},
    ellipsoid::Ellipsoid,
    error::{ImageError, RegionError, RendererError, SensorError, StyleError, ZoneError},
    extents::Extents,
    field_of_view::FieldOfView,
    fill_mesh::{FillMesh, MeshOptions},
    footprint::{Footprint, FootprintBound, FootprintEdge, FootprintLoop},
    frame_stats::FrameStats,
    geodetic::LonLat,
    hatch::{Hatch, HatchKind},
    image::{Image, ImageId},
    image_fill::{ImageFill, Placement, Wrap},
    length::Length,
    limits::{Excess, Limits, Quantity},
    locator::Locator,
    options::{
        Camera, CountTechnique, DepthConvention, Frame, HeightRange, LogDepth, RendererOptions,
    },
    outline::{Cap, Measures, Outline, Stretch},
    pick::{Pick, PickedFill},
    region::{EdgeKind, Inside, Polygon, Region, Ring},
    renderer::{MeshId, Renderer},
    repair::{Place, Repair, RepairKind},
    sensor::{Extrusion, Pose, Sensor},
    sensor_set::{SensorDisplay, SensorId, SensorSet, SensorStyle},
    stroke::{Align, Dash, Stroke},
    style::{Blend, Fade, FillStyle, Pattern, Ramp},
    view::View,
    zone::Zone,
};
