//! Bounds on what an input may ask for.

use std::fmt;

/// How much an input may ask for before it is refused.
///
/// Counts, not seconds or bytes, so that the same input is refused everywhere. The defaults let pass
/// what data of a country or a planet has (the largest single polygon of OpenStreetMap has some
/// million vertices) and keep what does not within some gigabytes; who reads what strangers send
/// sets less.
///
/// Beside these, inputs whose edges lie on top of each other more often than any map's are refused as
/// [`Tangled`](crate::RegionError::Tangled).
///
/// ```
/// use globefill::{FillMesh, Limits, MeshOptions, Zone, Region, LonLat};
///
/// let limits = Limits { vertices: 100_000, mesh_vertices: 1_000_000, ..Limits::default() };
/// let options = MeshOptions { limits, ..MeshOptions::default() };
/// let mesh = FillMesh::build(&[Zone::circle(LonLat::new(0.0, 0.0), 1e5).into()], &options)?;
/// # Ok::<(), globefill::RegionError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Limits {
    /// Most bytes of a GeoJSON text. Default: 2³⁰.
    pub text_bytes: usize,
    /// Most values in a GeoJSON text: its commas, arrays and objects, some three for a position. Each
    /// takes up to a hundred bytes while the text is read. Default: 50 million.
    pub json_values: usize,
    /// Most vertices of all rings and corridors, and zones of other kinds, together; 2²⁸ are the most
    /// whatever is set. Each takes some two hundred bytes. Default: 20 million.
    pub vertices: usize,
    /// Most rings and zones together. Default: 5 million.
    pub rings: usize,
    /// Most meetings of edges elsewhere than at a vertex of both: crossings, and vertices on edges;
    /// some may count twice. 2²⁸ are the most whatever is set. Default: 5 million.
    pub crossings: usize,
    /// Most pairs of parts that may overlap. Default: 5 million.
    pub overlaps: usize,
    /// Most vertices of a mesh, on boundaries and inside; 2³¹ are the most whatever is set. Each takes
    /// some two hundred bytes while the mesh is made. Default: 50 million.
    pub mesh_vertices: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            text_bytes: 1 << 30,
            json_values: 50_000_000,
            vertices: 20_000_000,
            rings: 5_000_000,
            crossings: 5_000_000,
            overlaps: 5_000_000,
            mesh_vertices: 50_000_000,
        }
    }
}

/// What there was too much of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Quantity {
    /// [`Limits::text_bytes`].
    TextBytes,
    /// [`Limits::json_values`].
    JsonValues,
    /// [`Limits::vertices`].
    Vertices,
    /// [`Limits::rings`].
    Rings,
    /// [`Limits::crossings`].
    Crossings,
    /// [`Limits::overlaps`].
    Overlaps,
    /// [`Limits::mesh_vertices`].
    MeshVertices,
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TextBytes => "bytes of text",
            Self::JsonValues => "values in the text",
            Self::Vertices => "vertices",
            Self::Rings => "rings and zones",
            Self::Crossings => "crossings of edges",
            Self::Overlaps => "pairs of overlapping parts",
            Self::MeshVertices => "vertices of the mesh",
        })
    }
}

/// An input asks for more than one of the [`Limits`] allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("more than {most} {what}, the limit that is set")]
pub struct Excess {
    /// What there is too much of.
    pub what: Quantity,
    /// The limit.
    pub most: usize,
}

impl Limits {
    /// Holds `count` against a limit.
    pub(crate) fn check(&self, what: Quantity, count: usize) -> Result<(), Excess> {
        let most = self.most(what);
        if count > most {
            Err(Excess { what, most })
        } else {
            Ok(())
        }
    }

    /// The limit, and no more than indices can tell apart.
    pub(crate) fn most(&self, what: Quantity) -> usize {
        match what {
            Quantity::TextBytes => self.text_bytes,
            Quantity::JsonValues => self.json_values,
            // Edges, two or three to a vertex and two more to a crossing, are counted twice in a u32.
            Quantity::Vertices => self.vertices.min(1 << 28),
            Quantity::Crossings => self.crossings.min(1 << 28),
            Quantity::Rings => self.rings,
            Quantity::Overlaps => self.overlaps,
            Quantity::MeshVertices => self.mesh_vertices.min(1 << 31),
        }
    }
}
