//! The mesh that leaves the CPU: boundary arcs for walls, triangles for caps.

mod extents;
mod measures;

use glam::DVec3;

use crate::{
    curve::Curve, ellipsoid::Ellipsoid, error::RegionError, limits::Limits, mesh::mesh_build,
    region::Region, repair::Repair,
};

/// How regions are meshed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct MeshOptions {
    /// The ellipsoid that longitudes and latitudes refer to.
    pub ellipsoid: Ellipsoid,
    /// How far, metres, a stored boundary chord may lie beside the true edge. The renderer refines
    /// edges near the eye far below this; smaller values only cost memory, and none
    /// below 1 mm is met.
    pub tolerance_m: f64,
    /// How much the regions may ask for.
    pub limits: Limits,
}

impl Default for MeshOptions {
    fn default() -> Self {
        Self {
            ellipsoid: Ellipsoid::WGS84,
            tolerance_m: 5.0,
            limits: Limits::default(),
        }
    }
}

/// Regions ready for upload: everything the GPU draws from, and nothing that knows the GPU.
///
/// Boundary arcs are stored once, whichever pieces they bound. Vertices lie on the ellipsoid: first
/// the boundary vertices, arc after arc, then the interior vertices of the caps, piece after piece.
#[derive(Clone, Debug, Default)]
pub struct FillMesh {
    /// The ellipsoid that the vertices lie on.
    pub ellipsoid: Ellipsoid,
    /// ECEF positions, metres, at height 0.
    pub vertices: Vec<DVec3>,
    /// For each boundary vertex (the first `boundary.len()` of `vertices`): the true edge that
    /// leaves it along its arc. The last vertex of an arc repeats its predecessor's curve, with t = 1.
    pub boundary: Vec<BoundaryVertex>,
    /// True edges that `boundary` refers to.
    pub curves: Vec<Curve>,
    /// Boundary arcs, in the order of their vertices.
    pub arcs: Vec<Arc>,
    /// Cap triangles, counter-clockwise seen from outside, as indices into `vertices`: piece after piece, fill
    /// after fill. Their boundary vertices are of arcs that have the piece on a side.
    pub cap_triangles: Vec<[u32; 3]>,
    /// The same triangles in rows of neighbours, in the same order. None at all stand for a row a piece.
    pub cap_chunks: Vec<CapChunk>,
    /// Connected parts of fills, in fill order.
    pub pieces: Vec<Piece>,
    /// One per region, in input order.
    pub fills: Vec<Fill>,
    /// Pairs of pieces (indices into `pieces`, smaller first) whose interiors may overlap; all other
    /// pairs are disjoint.
    pub overlaps: Vec<(u32, u32)>,
    /// How far, metres, a drawn cap triangle or boundary chord may lie below the ellipsoid.
    pub sag_m: f64,
    /// What was repaired in the input.
    pub repairs: Vec<Repair>,
    /// Levels of detail for eyes far away, each coarser than the one before: the same fills, pieces and
    /// arcs, index for index, with fewer vertices. Of their boundary vertices only `deviation_m` means
    /// something; they have no curves, overlaps or repairs of their own.
    pub coarser: Vec<FillMesh>,
}

/// Where a boundary vertex lies on the true edge that starts or passes there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BoundaryVertex {
    /// Index into [`FillMesh::curves`].
    pub curve: u32,
    /// How far, metres, the drawn edge to the next vertex may lie beside the true edge, at height 0.
    /// Zero for the last vertex of an arc.
    pub deviation_m: f32,
    /// Parameter of this vertex on the curve, 0 … 1. The chord to the next vertex ends at the next
    /// vertex's `t` if that has the same curve, at 1 otherwise.
    pub t: f64,
}

/// A run of boundary between two junctions, or a closed ring, with what lies on either side.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Arc {
    /// Index of the first vertex in [`FillMesh::vertices`].
    pub first_vertex: u32,
    /// Number of vertices, at least two; a closed arc repeats its first vertex at the end.
    pub vertex_count: u32,
    /// Index of the piece to the left when walking along the arc, seen from outside.
    pub left: Option<u32>,
    /// Index of the piece to the right.
    pub right: Option<u32>,
    /// Where the arc lies.
    pub bounds: Bounds,
}

/// A connected part of a fill: its boundary is closed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Piece {
    /// Index of the fill it belongs to.
    pub fill: u32,
    /// Index of its first triangle in [`FillMesh::cap_triangles`].
    pub first_triangle: u32,
    /// Number of its triangles.
    pub triangle_count: u32,
    /// Where the piece lies.
    pub bounds: Bounds,
}

/// Triangles of one piece that lie together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CapChunk {
    /// Index of the piece.
    pub piece: u32,
    /// Index of the first triangle in [`FillMesh::cap_triangles`].
    pub first_triangle: u32,
    /// Number of triangles.
    pub triangle_count: u32,
    /// Where they lie.
    pub bounds: Bounds,
}

/// The pieces of one input region.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fill {
    /// Index of its first piece in [`FillMesh::pieces`].
    pub first_piece: u32,
    /// Number of its pieces; zero for a region that vanished in repair.
    pub piece_count: u32,
}

/// A cap of the unit sphere that holds points of the ellipsoid after dividing by its radii.
///
/// In that scaled frame the ellipsoid is the unit sphere, which makes horizon tests exact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    /// Unit vector to the middle of the cap, in ECEF divided by the radii.
    pub axis: DVec3,
    /// Angular radius of the cap, radians, 0 … π.
    pub radius_rad: f64,
}

impl Bounds {
    /// Whether the caps have a point in common; may answer yes for caps that just miss.
    pub(crate) fn intersects(&self, other: &Self) -> bool {
        self.axis.angle_between(other.axis) <= self.radius_rad + other.radius_rad + 1e-7
    }
}

impl FillMesh {
    /// The triangles of a piece.
    pub(crate) fn triangles_of(&self, piece: &Piece) -> &[[u32; 3]] {
        let first = piece.first_triangle as usize;
        &self.cap_triangles[first..first + piece.triangle_count as usize]
    }

    /// Makes each piece a row of triangles if there are no rows.
    pub(crate) fn chunk_by_piece(&mut self) {
        if self.cap_chunks.is_empty() {
            let chunk = |(index, piece): (u32, &Piece)| CapChunk {
                piece: index,
                first_triangle: piece.first_triangle,
                triangle_count: piece.triangle_count,
                bounds: piece.bounds,
            };
            self.cap_chunks = (0..).zip(&self.pieces).map(chunk).collect();
        }
    }

    /// Meshes regions: one fill each, every polygon a piece, common borders stored once.
    ///
    /// Vertices are rounded to multiples of 2⁻³⁶° (1.6 µm on Earth), by which neighbours that print
    /// a vertex differently in the last digits find each other. Defects are repaired and listed in
    /// [`repairs`](Self::repairs):
    /// - equal neighbouring vertices become one; open rings are closed;
    /// - a vertex that lies exactly on a straight edge splits it;
    /// - a polygon that crosses itself is split at the crossings and filled by the even-odd rule,
    ///   so edges that it walks twice vanish (the seams along ±180° and the poles that close
    ///   Antarctica on a flat map);
    /// - holes outside their shell, or inside another hole, remove nothing and are dropped.
    ///
    /// A polygon whose edges all cancel covers the whole globe if it was written round more than
    /// half of the lon/lat plane (the box from −180° to 180° and −90° to 90°), else nothing.
    ///
    /// # Errors
    /// The first vertex, ring or edge that means nothing on a globe, by its place in the input; the
    /// first of [`MeshOptions::limits`] that is exceeded.
    pub fn build(regions: &[Region], options: &MeshOptions) -> Result<Self, RegionError> {
        mesh_build::build(regions, options)
    }
}
