//! Which fills contain a point: exact answers from the true edges, beside the pixels.

use crate::{
    boundary::{
        authalic::{Authalic, Enclosed},
        boundary_graph::{BoundaryGraph, DirectedEdge},
        lattice::{LatticePoint, POLE, TURN},
        meridian_index::MeridianIndex,
    },
    ellipsoid::Ellipsoid,
    fill_mesh::FillMesh,
    geodetic::LonLat,
};

/// Locates points among the fills of a [`FillMesh`]: point location in f64, against the true edges
/// and not the chords drawn for them.
///
/// It keeps what it needs, so the mesh may be given to a renderer. Points are rounded to the lattice
/// of the mesh's vertices, 2⁻³⁶° (1.6 µm on Earth). From there on straight edges, and all meridians,
/// parallels and the equator, are decided in exact arithmetic; geodesics and rhumb lines to 15 nm.
/// A point on an edge counts as lying just north of it, on a meridian just east: where fills share
/// a border it belongs to one of them.
#[derive(Debug)]
pub struct Locator {
    ellipsoid: Ellipsoid,
    graph: BoundaryGraph,
    index: MeridianIndex,
    /// The fill of each piece.
    fill_of_piece: Vec<u32>,
    /// Which pieces have the north pole inside, just beyond the meridian of 180°.
    has_pole: Vec<bool>,
    /// Those pieces.
    polar: Vec<u32>,
}

impl Locator {
    /// Indexes the true edges of a mesh; about 50 ms for the countries at 1:50 million.
    pub fn new(mesh: &FillMesh) -> Self {
        Self::of_pieces(mesh, |_| true)
    }

    /// A locator that knows one fill only.
    pub(crate) fn of_fill(mesh: &FillMesh, fill: u32) -> Self {
        let fill_of = |piece: u32| mesh.pieces.get(piece as usize).map(|piece| piece.fill);
        Self::of_pieces(mesh, |piece| fill_of(piece) == Some(fill))
    }

    fn of_pieces(mesh: &FillMesh, is_known: impl Fn(u32) -> bool) -> Self {
        let mut graph = BoundaryGraph::default();
        let labelled = labelled_edges(mesh, &mut graph, &is_known);
        let authalic = Authalic::new(mesh.ellipsoid);
        let mut enclosed = vec![None; mesh.pieces.len()];
        for &(edge, piece) in &labelled {
            let beside = authalic.beside(&graph.walk(edge));
            let sum: &mut Option<Enclosed> = &mut enclosed[piece as usize];
            *sum = Some(sum.unwrap_or_default().plus(beside));
        }
        // A piece without edges is everything.
        let has_pole: Vec<bool> = (0..)
            .zip(enclosed)
            .map(|(piece, enclosed)| {
                is_known(piece) && enclosed.is_none_or(Enclosed::has_north_pole)
            })
            .collect();
        let polar = (0..mesh.pieces.len() as u32).filter(|&piece| has_pole[piece as usize]);
        Self {
            ellipsoid: mesh.ellipsoid,
            index: MeridianIndex::new(&mesh.ellipsoid, &graph, labelled.into_iter()),
            graph: graph.finished(),
            fill_of_piece: mesh.pieces.iter().map(|piece| piece.fill).collect(),
            polar: polar.collect(),
            has_pole,
        }
    }

    /// Whether a fill contains a point. False for a fill that is not there and for a position that
    /// is none.
    pub fn contains(&self, fill: u32, position: LonLat) -> bool {
        let pieces = self.pieces_at(position);
        pieces
            .iter()
            .any(|&piece| self.fill_of_piece[piece as usize] == fill)
    }

    /// All fills that contain a point, ascending.
    pub fn fills_at(&self, position: LonLat) -> Vec<u32> {
        let mut fills = self.pieces_at(position);
        for piece in &mut fills {
            *piece = self.fill_of_piece[*piece as usize];
        }
        fills.sort_unstable();
        fills.dedup();
        fills
    }

    /// Pieces that contain a point.
    fn pieces_at(&self, position: LonLat) -> Vec<u32> {
        if !position.is_valid() {
            return Vec::new();
        }
        let mut point = LatticePoint::nearest(position).canonical();
        if point.lat == POLE {
            return self.polar.clone();
        }
        if point.lat == -POLE {
            // The walk starts northward on one meridian; by this name the pole is no node, whose
            // edges would be passed by.
            point.lon = TURN / 2;
        }
        let separating = self
            .index
            .separating(&self.ellipsoid, &self.graph, point, |_| {});
        let around_pole = self.polar.iter().copied();
        let around_pole = around_pole.filter(|piece| separating.binary_search(piece).is_err());
        let away = separating.iter().copied();
        let away = away.filter(|&piece| !self.has_pole[piece as usize]);
        away.chain(around_pole).collect()
    }
}

/// The true edges of a mesh, each with a known piece to its left.
fn labelled_edges(
    mesh: &FillMesh,
    graph: &mut BoundaryGraph,
    is_known: impl Fn(u32) -> bool,
) -> Vec<(DirectedEdge, u32)> {
    let mut labelled = Vec::new();
    for arc in &mesh.arcs {
        let [left, right] = [arc.left, arc.right].map(|side| side.filter(|&piece| is_known(piece)));
        if left.is_none() && right.is_none() {
            continue;
        }
        for curve in mesh.curves_along(arc) {
            let Some(edge) = graph.insert_curve(curve) else {
                continue;
            };
            labelled.extend(left.map(|piece| (edge, piece)));
            labelled.extend(right.map(|piece| (edge.reversed(), piece)));
        }
    }
    labelled
}
