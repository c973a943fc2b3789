//! What the host tells the renderer: once, and every frame.

use glam::{DMat3, DMat4, DVec3, UVec2};

/// Which way the host's depth buffer runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum DepthConvention {
    /// Nearer is greater: 1 at the near plane, 0 at infinity or at the far plane.
    #[default]
    Reversed,
    /// Nearer is less: 0 at the near plane, 1 at the far plane.
    Standard,
}

/// How covered surface points are counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum CountTechnique {
    /// Packed winding accumulation: every volume face once, added into a float target.
    #[default]
    Winding,
    /// One two-sided stencil pass a fill: the reference.
    Stencil,
}

/// Fixed properties of the host's frame and of the technique.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct RendererOptions {
    /// Format of the colour attachment of the pass given to [`resolve`](crate::Renderer::resolve).
    pub color_format: wgpu::TextureFormat,
    /// Format of the host's depth texture, of 24 bits or more. Its usage must include
    /// `RENDER_ATTACHMENT`, and `TEXTURE_BINDING` for sensors, for patterns, fades, strokes and smooth
    /// edges, for logarithmic depths, and where the stencil counts: if asked for, and on devices without
    /// `FLOAT32_BLENDABLE`. A format with stencil must have a single layer and level.
    pub depth_format: wgpu::TextureFormat,
    /// Which way the depth buffer runs, in frames whose depths are not logarithmic
    /// ([`Frame::log_depth`]).
    pub depth: DepthConvention,
    /// Samples a pixel of the host's depth texture and of the resolve pass: 1 or 4.
    pub sample_count: u32,
    /// How covered surface points are counted.
    pub count: CountTechnique,
    /// Whether boundaries of fills are blended by the share of the pixel that lies on either side. For
    /// hosts with one sample a pixel: several samples smooth boundaries themselves. Costs a pass that
    /// draws all boundaries once more, and needs `TEXTURE_BINDING` on the depth.
    pub smooth_edges: bool,
}

impl Default for RendererOptions {
    fn default() -> Self {
        Self {
            color_format: wgpu::TextureFormat::Rgba8UnormSrgb,
            depth_format: wgpu::TextureFormat::Depth32Float,
            depth: DepthConvention::Reversed,
            sample_count: 1,
            count: CountTechnique::Winding,
            smooth_edges: false,
        }
    }
}

/// The camera of one view, in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Camera {
    /// Position of the eye, ECEF metres.
    pub eye_ecef_m: DVec3,
    /// Rotation from ECEF axes to view axes (x right, y up, looking along −z). Orthonormal.
    pub view_from_ecef: DMat3,
    /// The host's projection, as used for its depth buffer: clip = `clip_from_view` · view.
    ///
    /// Either a perspective along −z (w = −z), or orthographic (w = 1), each of any width, off its middle or
    /// mirrored, with or without a far plane. Where lines of sight are parallel the eye may be anywhere on
    /// the view axis, and the near plane behind it; only [`Fade::distance_m`](crate::Fade) asks how far away
    /// it is. What is sheared or has an oblique near plane is refused
    /// ([`RendererError::Unsupported`](crate::RendererError)).
    ///
    /// A far plane needs `DEPTH_CLIP_CONTROL`, and in a perspective `CLIP_DISTANCES` too:
    /// [`Renderer::wanted_features`](crate::Renderer::wanted_features).
    pub clip_from_view: DMat4,
}

/// Heights above the ellipsoid, metres, between which the host's surface lies.
///
/// What lies outside is no surface: fills do not reach it, and sensors leave out what lies more than
/// 1 km and a hundredth of the distance beyond, such as satellites and sky domes in the depth buffer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct HeightRange {
    /// No visible surface point lies lower.
    pub min_m: f64,
    /// No visible surface point lies higher.
    pub max_m: f64,
}

/// Depths in proportion to a logarithm of the distance w along the view axis, as hosts write them that see
/// from centimetres to other planets:
///
/// depth = log₂(1 + `per_m` · (w − `from_m`)) / log₂(1 + `per_m` · (`far_m` − `from_m`))
///
/// The sky is 1: it runs that way whatever [`RendererOptions::depth`] is, and one that runs the other way is not
/// served. A host writes that for each fragment. Where it does so for each vertex, depths between are others,
/// and what is drawn is off by as much, unless its triangles are so small that it does not show.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct LogDepth {
    /// Nothing nearer is drawn, metres.
    pub near_m: f64,
    /// Where depth is 1, metres.
    pub far_m: f64,
    /// Where depth is 0, metres.
    #[cfg_attr(feature = "serde", serde(default))]
    pub from_m: f64,
    /// By how much the logarithm's argument grows per metre: distances below its inverse are told apart in
    /// equal steps, those beyond in proportion.
    #[cfg_attr(feature = "serde", serde(default = "one_per_m"))]
    pub per_m: f64,
}

fn one_per_m() -> f64 {
    1.0
}

impl LogDepth {
    /// log₂(1 + w) / log₂(1 + far), which is what three.js writes.
    pub fn new(near_m: f64, far_m: f64) -> Self {
        Self {
            near_m,
            far_m,
            from_m: 0.0,
            per_m: one_per_m(),
        }
    }

    /// log₂(1 + w − near) / log₂(1 + far − near), which is what CesiumJS writes.
    pub fn from_near(near_m: f64, far_m: f64) -> Self {
        Self {
            from_m: near_m,
            ..Self::new(near_m, far_m)
        }
    }
}

/// What a view looks at in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Frame {
    /// The camera the host drew its globe with.
    pub camera: Camera,
    /// Size of the host's depth texture, pixels.
    pub size_px: UVec2,
    /// Between which heights the host's surface lies. Both 0: the bare ellipsoid. What stands higher, such as
    /// a model, may be filled like the surface below it.
    #[cfg_attr(feature = "serde", serde(default))]
    pub terrain: HeightRange,
    /// How far, pixels, a drawn boundary may lie from the true one; 0 asks for the best there is.
    #[cfg_attr(feature = "serde", serde(default = "quarter_px"))]
    pub pixel_error: f64,
    /// How far, pixels, the host's surface may lie below the given heights because its mesh is
    /// coarse when far.
    #[cfg_attr(feature = "serde", serde(default = "one_px"))]
    pub host_pixel_error: f64,
    /// How depths follow from distances, if logarithmically: in perspectives, whose row of depth is then
    /// not asked. The depth needs `TEXTURE_BINDING`; counting starts with a pass that copies it. None: as
    /// [`Camera::clip_from_view`] and [`RendererOptions::depth`] say.
    #[cfg_attr(feature = "serde", serde(default))]
    pub log_depth: Option<LogDepth>,
}

fn quarter_px() -> f64 {
    0.25
}

fn one_px() -> f64 {
    1.0
}

impl Frame {
    /// A frame over the bare ellipsoid with a budget of 1/4 px, for a host whose surface mesh is
    /// within one pixel of the true heights.
    pub fn new(camera: Camera, size_px: UVec2) -> Self {
        Self {
            camera,
            size_px,
            terrain: HeightRange::default(),
            pixel_error: quarter_px(),
            host_pixel_error: one_px(),
            log_depth: None,
        }
    }
}
