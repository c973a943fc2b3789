//! The caps of a mesh: every piece triangulated, and where it lies.

use glam::DVec3;
use rayon::prelude::*;

use crate::{
    ellipsoid::Ellipsoid,
    fill_mesh::{BoundaryVertex, Bounds, CapChunk, FillMesh},
    limits::{Excess, Limits},
    mesh::chunks::{Chunk, chunk},
    mesh::triangulate::{Caps, triangulate},
    mesh::vertex_room::VertexRoom,
};

impl FillMesh {
    /// Says where arcs lie.
    pub(super) fn bound_arcs(&mut self) {
        let (ellipsoid, vertices, boundary) = (self.ellipsoid, &self.vertices, &self.boundary);
        self.arcs.par_iter_mut().for_each(|arc| {
            let run = arc.first_vertex as usize..(arc.first_vertex + arc.vertex_count) as usize;
            let margin_m =
                edge_margin_m(&ellipsoid, &vertices[run.clone()], &boundary[run.clone()]);
            arc.bounds = Bounds::around(&ellipsoid, vertices[run].iter().copied(), margin_m);
        });
    }

    /// Adds the triangles of every piece and its interior vertices. `loops_of` a piece index the boundary
    /// vertices, the inside to their left; `inside_sr` is the area of that on the unit sphere.
    pub(super) fn add_caps(
        &mut self,
        loops_of: impl Fn(usize) -> Vec<Vec<u32>> + Sync,
        inside_sr: &[f64],
        limits: &Limits,
    ) -> Result<(), Excess> {
        let ellipsoid = self.ellipsoid;
        let boundary_vertices = &self.vertices[..];
        let margin_m = self.arcs_margin_m();
        let room = VertexRoom::new(*limits);
        room.take(self.vertices.len());
        let caps: Vec<(Caps, Bounds, Vec<Chunk>)> = inside_sr
            .par_iter()
            .enumerate()
            .map(|(piece, &inside_sr)| {
                if room.is_full() {
                    return Default::default();
                }
                let loops = loops_of(piece);
                let mut caps = triangulate(ellipsoid, boundary_vertices, &loops, inside_sr);
                room.take(caps.interior.len());
                let bounds = if loops.is_empty() {
                    Bounds::globe()
                } else {
                    let rim = loops
                        .iter()
                        .flatten()
                        .map(|&vertex| boundary_vertices[vertex as usize]);
                    let all = rim.chain(caps.interior.iter().copied());
                    Bounds::around(&ellipsoid, all, margin_m)
                };
                let interior = &caps.interior;
                let position = |vertex: u32| match boundary_vertices.get(vertex as usize) {
                    Some(&boundary) => boundary,
                    None => interior[vertex as usize - boundary_vertices.len()],
                };
                let chunks = chunk(&ellipsoid, &mut caps.triangles, position, margin_m);
                (caps, bounds, chunks)
            })
            .collect();
        room.check()?;
        let boundary_count = self.vertices.len() as u32;
        for (index, (piece, (caps, bounds, chunks))) in (0..).zip(self.pieces.iter_mut().zip(caps))
        {
            piece.bounds = bounds;
            piece.first_triangle = self.cap_triangles.len() as u32;
            piece.triangle_count = caps.triangles.len() as u32;
            self.sag_m = self.sag_m.max(caps.sag_m);
            let mut first_triangle = piece.first_triangle;
            for chunk in chunks {
                self.cap_chunks.push(CapChunk {
                    piece: index,
                    first_triangle,
                    triangle_count: chunk.triangle_count,
                    bounds: chunk.bounds,
                });
                first_triangle += chunk.triangle_count;
            }
            let shift = self.vertices.len() as u32 - boundary_count;
            let place = |vertex: u32| {
                if vertex < boundary_count {
                    vertex
                } else {
                    vertex + shift
                }
            };
            self.cap_triangles
                .extend(caps.triangles.iter().map(|corners| corners.map(place)));
            self.vertices.extend(caps.interior);
        }
        Ok(())
    }

    /// [`edge_margin_m`] of all arcs together.
    fn arcs_margin_m(&self) -> f64 {
        let deviation_m = self
            .boundary
            .iter()
            .map(|vertex| vertex.deviation_m)
            .fold(0.0, f32::max);
        f64::from(deviation_m) + skew_m(&self.ellipsoid, self.sag_m)
    }
}

/// How far true edges may lie beside the great arcs of the scaled sphere between their vertices.
fn edge_margin_m(ellipsoid: &Ellipsoid, vertices: &[DVec3], boundary: &[BoundaryVertex]) -> f64 {
    let deviation_m = boundary
        .iter()
        .map(|vertex| vertex.deviation_m)
        .fold(0.0, f32::max);
    let chord_m = vertices
        .windows(2)
        .map(|pair| pair[0].distance(pair[1]))
        .fold(0.0, f64::max);
    f64::from(deviation_m) + skew_m(ellipsoid, ellipsoid.chord_sag_m(chord_m))
}

/// How far a wall along geodetic normals and one through the centre part, over the height `sag_m`
/// from the chord to the surface: their directions differ by the flattening at most, taken twice.
fn skew_m(ellipsoid: &Ellipsoid, sag_m: f64) -> f64 {
    2.0 * ellipsoid.flattening().abs() * sag_m
}
