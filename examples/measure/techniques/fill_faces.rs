//! The mesh of each fill by itself: what techniques draw that know no shared borders.

use std::collections::HashMap;

use glam::DVec3;
use globefill::FillMesh;

/// One fill: its caps, and its boundary with the fill on the left.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FillFaces {
    /// On the ellipsoid, ECEF metres; no two are equal.
    pub vertices_m: Vec<DVec3>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    pub edges: Vec<[u32; 2]>,
}

/// A list in which equal positions are one vertex.
#[derive(Default)]
struct Builder {
    faces: FillFaces,
    places: HashMap<[u64; 3], u32>,
}

impl Builder {
    fn vertex(&mut self, position_m: DVec3) -> u32 {
        // `+ 0.0` turns −0 into +0.
        let key = position_m.to_array().map(|x| (x + 0.0).to_bits());
        *self.places.entry(key).or_insert_with(|| {
            self.faces.vertices_m.push(position_m);
            self.faces.vertices_m.len() as u32 - 1
        })
    }
}

/// The faces of every fill, in order.
pub fn all(mesh: &FillMesh) -> Vec<FillFaces> {
    let mut builders: Vec<Builder> = mesh.fills.iter().map(|_| Builder::default()).collect();
    for piece in &mesh.pieces {
        let builder = &mut builders[piece.fill as usize];
        let first = piece.first_triangle as usize;
        for corners in &mesh.cap_triangles[first..first + piece.triangle_count as usize] {
            let corners = corners.map(|corner| builder.vertex(mesh.vertices[corner as usize]));
            builder.faces.triangles.push(corners);
        }
    }
    for arc in &mesh.arcs {
        let first = arc.first_vertex as usize;
        let vertices_m = &mesh.vertices[first..first + arc.vertex_count as usize];
        for (piece, forward) in [(arc.left, true), (arc.right, false)] {
            let Some(piece) = piece else { continue };
            let builder = &mut builders[mesh.pieces[piece as usize].fill as usize];
            for pair in vertices_m.windows(2) {
                let [a, b] = [pair[0], pair[1]].map(|position_m| builder.vertex(position_m));
                builder
                    .faces
                    .edges
                    .push(if forward { [a, b] } else { [b, a] });
            }
        }
    }
    builders.into_iter().map(|builder| builder.faces).collect()
}

#[cfg(test)]
mod tests {
    use globefill::{MeshOptions, countries::Dataset};

    use super::*;

    /// The boundary of the caps is the edges: each edge of a triangle that no other walks back is one.
    #[test]
    fn edges_bound_the_caps() {
        let regions: Vec<_> = Dataset::Countries110m
            .countries()
            .into_iter()
            .map(|country| country.region)
            .collect();
        let mesh = FillMesh::build(&regions, &MeshOptions::default()).unwrap();
        let faces = all(&mesh);
        assert_eq!(faces.len(), mesh.fills.len());
        for fill in faces {
            let mut walks: HashMap<(u32, u32), i32> = HashMap::new();
            let mut walk = |from: u32, to: u32, sign: i32| {
                let sign = if from < to { sign } else { -sign };
                *walks.entry((from.min(to), from.max(to))).or_default() += sign;
            };
            for [a, b, c] in &fill.triangles {
                walk(*a, *b, 1);
                walk(*b, *c, 1);
                walk(*c, *a, 1);
            }
            assert!(!fill.edges.is_empty());
            for [a, b] in &fill.edges {
                walk(*a, *b, -1);
            }
            assert!(walks.values().all(|&sum| sum == 0));
        }
    }
}
