//! Typed errors.

use std::path::PathBuf;

use crate::{
    image::{MOST_PER_SIDE, MOST_TEXELS},
    limits::Excess,
    repair::Place,
};

/// Why a region could not be meshed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RegionError {
    /// A longitude or latitude is NaN or infinite, or a latitude is beyond ±90°.
    #[error("{place}: ({lon_deg}, {lat_deg}) is not a longitude and latitude in degrees")]
    InvalidVertex {
        /// The vertex.
        place: Place,
        /// Its longitude, degrees.
        lon_deg: f64,
        /// Its latitude, degrees.
        lat_deg: f64,
    },
    /// A ring has fewer than three distinct vertices.
    #[error("{place}: the ring has {distinct} distinct vertices, a ring needs three")]
    ShortRing {
        /// The ring (vertex 0).
        place: Place,
        /// Distinct vertices found.
        distinct: usize,
    },
    /// The ends of an edge are nearly antipodal: no unique shortest path joins them.
    #[error("{place}: the edge to the next vertex joins nearly antipodal points")]
    AntipodalEdge {
        /// The vertex where the edge starts.
        place: Place,
    },
    /// A zone contradicts itself.
    #[error("{place}: {error}")]
    Zone {
        /// The zone, counted as a polygon after the region's polygons.
        place: Place,
        /// What is wrong with it.
        error: ZoneError,
    },
    /// The ellipsoid's radii are not numbers from 1 m to 6 700 km, up to which positions can be
    /// encoded, or its flattening is beyond 1/50, up to which the error bounds are proven.
    #[error("no fills on an ellipsoid with radii of {a_m} m and {b_m} m")]
    InvalidEllipsoid {
        /// Equatorial radius, metres.
        a_m: f64,
        /// Polar radius, metres.
        b_m: f64,
    },
    /// The regions ask for more than [`Limits`](crate::Limits) allow.
    #[error(transparent)]
    Limit(#[from] Excess),
    /// So many edges lie on top of each other that finding their crossings would take unbounded
    /// time and memory.
    #[error("the boundaries are a tangle: too many of their {edges} edges lie across each other")]
    Tangled {
        /// Number of edges of all regions.
        edges: usize,
    },
}

/// Why a zone cannot be.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ZoneError {
    /// A longitude or latitude is NaN or infinite, or a latitude is beyond ±90°.
    #[error("point {point}, ({lon_deg}, {lat_deg}), is not a longitude and latitude in degrees")]
    Position {
        /// Which point of the line; 0 for centres.
        point: usize,
        /// Its longitude, degrees.
        lon_deg: f64,
        /// Its latitude, degrees.
        lat_deg: f64,
    },
    /// A radius, range or width is NaN, negative, too small or too large for the ellipsoid.
    #[error(
        "a zone cannot have the range or width {range_m} m: {least_m} … {most_m} m are allowed"
    )]
    Range {
        /// The length, metres.
        range_m: f64,
        /// The least length that is allowed, metres.
        least_m: f64,
        /// The greatest, metres.
        most_m: f64,
    },
    /// The least range is not below the greatest by 1 cm at least.
    #[error("nothing lies between the ranges {min_m} m and {max_m} m")]
    EmptyRange {
        /// The least range, metres.
        min_m: f64,
        /// The greatest, metres.
        max_m: f64,
    },
    /// An azimuth is NaN or beyond ±10⁶ degrees, or the two are less than 1 cm apart at the
    /// greatest range, one way or the other.
    #[error("the azimuths {from_deg}° and {to_deg}° bound no sector")]
    Azimuths {
        /// Where the sector was to begin, degrees.
        from_deg: f64,
        /// Where it was to end, degrees.
        to_deg: f64,
    },
    /// A corridor's line has no points.
    #[error("a corridor needs a line, which has no points")]
    NoPoints,
    /// The ends of a leg of a corridor are nearly antipodal: no unique shortest path joins them.
    #[error("leg {leg} of the corridor joins nearly antipodal points")]
    AntipodalLeg {
        /// Index of the leg's first point.
        leg: usize,
    },
}

/// Why a sensor cannot be.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SensorError {
    /// The apex is NaN, infinite, or farther than 10¹⁰ m.
    #[error("the sensor's apex is not a position")]
    Apex,
    /// The ellipsoid's radii are not finite and positive, larger than 6 700 km, or its flattening is
    /// beyond 1/50, up to which error bounds are proven.
    #[error("no sensors above such an ellipsoid")]
    Ellipsoid,
    /// The apex does not lie above the ellipsoid.
    #[error("the sensor's apex lies on or below the ellipsoid")]
    ApexBelowSurface,
    /// The boresight is no direction.
    #[error("the sensor's boresight is not a direction")]
    Boresight,
    /// The up vector is no direction, or is along the boresight.
    #[error("the sensor's up vector does not fix its turn about the boresight")]
    Up,
    /// An angle of a field of view, radians, is out of its range.
    #[error("a field of view cannot have the angle {0} rad")]
    HalfAngle(f64),
    /// A field of view has too few or too many corners.
    #[error("a field of view cannot have {0} corners")]
    Corners(usize),
    /// A corner of a field of view, by its index, is no direction or makes it not convex.
    #[error("corner {0} is not a direction, or the field of view is not convex there")]
    Corner(usize),
    /// The least elevation, radians, is NaN or beyond ±π/2.
    #[error("{0} rad is not an elevation")]
    MinElevation(f64),
    /// A part of a colour is not within 0 … 1.
    #[error("{0:?} is not a colour")]
    Color([f32; 4]),
    /// Too few or too many colours.
    #[error("a coverage cannot have {0} colours")]
    Colors(usize),
    /// The identifier was not given out by this set, or its sensor was removed.
    #[error("no such sensor in this set")]
    NoSuchSensor,
}

/// Why a style cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum StyleError {
    /// A number of the style, by the path of its field, is NaN, infinite or out of its range.
    #[error("{0} is not finite or out of range")]
    OutOfRange(&'static str),
    /// The identifier was not given out by this renderer, or its image was removed.
    #[error("no such image in this renderer")]
    NoSuchImage,
    /// [`Blend::Unordered`](crate::Blend::Unordered) goes with no pattern, stroke or fade.
    #[error("fills that blend in no order have no pattern, stroke or fade")]
    UnorderedIsPlain,
}

/// Why an image cannot be.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// The file cannot be read.
    #[error("cannot read {}: {message}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        message: String,
    },
    /// The bytes are neither a PNG nor a JPEG, or one that is broken or cut short. What the decoder
    /// says: one line of at most 200 characters.
    #[error("not a PNG or JPEG, or a corrupt one: {0}")]
    Undecodable(String),
    /// The image has no texels.
    #[error("an image of {width} × {height} texels shows nothing")]
    Empty {
        /// Texels across.
        width: u32,
        /// Texels down.
        height: u32,
    },
    /// A side is longer than [`MOST_PER_SIDE`], or the texels are more than [`MOST_TEXELS`].
    #[error(
        "{width} × {height} texels are too many: {MOST_PER_SIDE} a side and {MOST_TEXELS} in all are \
         allowed"
    )]
    TooLarge {
        /// Texels across.
        width: u32,
        /// Texels down.
        height: u32,
    },
    /// The slice does not hold four bytes for each texel.
    #[error("{width} × {height} texels are not {bytes} bytes long")]
    WrongLength {
        /// Texels across.
        width: u32,
        /// Texels down.
        height: u32,
        /// Bytes given.
        bytes: usize,
    },
}

/// Why a renderer could not be made or a frame not prepared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RendererError {
    /// The device lacks a feature that the options need.
    #[error("the device lacks {0:?}, which these options need")]
    MissingFeature(wgpu::Features),
    /// The options contradict each other or name something that is not supported.
    #[error("{0}")]
    Unsupported(&'static str),
    /// A number of the frame is NaN, infinite or out of its range.
    #[error("frame.{0} is not finite or out of range")]
    InvalidFrame(&'static str),
    /// The identifier was not given out by this renderer, or its mesh was removed.
    #[error("no such mesh in this renderer")]
    NoSuchMesh,
    /// The mesh has no fill with this index.
    #[error("the mesh has {fills} fills, there is no fill {fill}")]
    NoSuchFill {
        /// The index asked for.
        fill: u32,
        /// The number of fills in the mesh.
        fills: u32,
    },
    /// A style cannot be drawn.
    #[error("the style of fill {fill}: {error}")]
    InvalidStyle {
        /// The fill.
        fill: u32,
        /// What is wrong.
        error: StyleError,
    },
    /// The identifier was not given out by this renderer, or its image was removed.
    #[error("no such image in this renderer")]
    NoSuchImage,
    /// A style still shows the image.
    #[error("a style shows this image")]
    ImageInUse,
    /// The device's textures cannot be as large as the image.
    #[error(
        "an image of {width}x{height} texels; the device's textures have at most {most} a side"
    )]
    ImageTooLarge {
        /// Its width, texels.
        width: u32,
        /// Its height, texels.
        height: u32,
        /// Most texels a side.
        most: u32,
    },
    /// Fills overlap deeper than there are layers.
    #[error("overlapping fills need {needed} layers, the renderer has {most}")]
    TooManyLayers {
        /// Layers needed.
        needed: usize,
        /// Layers there are.
        most: usize,
    },
    /// More sensors than the device's buffers can hold.
    #[error("{sensors} sensors are more than the {most} that this device has room for")]
    TooManySensors {
        /// Sensors in the set.
        sensors: usize,
        /// Sensors there is room for.
        most: usize,
    },
    /// The pixel lies outside the frame that was counted last, or none was.
    #[error("there is no pixel {0} in this view")]
    NoSuchPixel(glam::UVec2),
    /// More fills in one layer than codes.
    #[error("{fills} fills in one layer are more than its codes can tell apart")]
    TooManyFills {
        /// Fills in the layer.
        fills: usize,
    },
}
