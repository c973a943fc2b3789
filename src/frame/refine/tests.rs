//! What patches must hold: closed whatever is cut, and of bounded size.

use std::collections::HashMap;

use glam::{DMat3, DMat4, DVec4, UVec2};

use super::*;
use crate::{
    fill_mesh::{BoundaryVertex, Bounds},
    frame::lens::Pixel,
    geodetic::LonLat,
    options::{Camera, Frame, HeightRange, RendererOptions},
    region::EdgeKind,
    {Curve, Ellipsoid},
};

/// One edge of about 100 km as a single arc of one chord.
fn one_edge(kind: EdgeKind, from: LonLat, to: LonLat) -> FillMesh {
    let ellipsoid = Ellipsoid::WGS84;
    let curve = Curve::between(kind, from, to);
    let on = curve.on(&ellipsoid);
    let (a, b) = (on.ecef(0.0), on.ecef(1.0));
    let deviation_m = on.deviation_bound_m(0.0, 1.0) as f32;
    let middle = (a + b) / ellipsoid.radii_m();
    FillMesh {
        ellipsoid,
        vertices: vec![a, b],
        boundary: vec![
            BoundaryVertex {
                curve: 0,
                deviation_m,
                t: 0.0,
            },
            BoundaryVertex {
                curve: 0,
                deviation_m: 0.0,
                t: 1.0,
            },
        ],
        curves: vec![curve],
        arcs: vec![Arc {
            first_vertex: 0,
            vertex_count: 2,
            left: Some(0),
            right: None,
            bounds: Bounds {
                axis: middle.normalize(),
                radius_rad: 0.01,
            },
        }],
        ..Default::default()
    }
}

fn looking_down(mesh: &FillMesh, height_m: f64, terrain: HeightRange) -> Sight {
    let curve = mesh.curves[0].on(&mesh.ellipsoid);
    let middle_m = curve.ecef(0.5);
    let normal = mesh.ellipsoid.normal_at_surface(middle_m);
    let right = normal.any_orthonormal_vector();
    let view_from_ecef = DMat3::from_cols(right, normal.cross(right), normal).transpose();
    let scale = 1.0 / 30f64.to_radians().tan();
    let clip_from_view = DMat4::from_cols(
        DVec4::new(scale, 0.0, 0.0, 0.0),
        DVec4::new(0.0, scale, 0.0, 0.0),
        DVec4::new(0.0, 0.0, 0.0, -1.0),
        DVec4::new(0.0, 0.0, 0.1 * height_m, 0.0),
    );
    let frame = Frame {
        camera: Camera {
            eye_ecef_m: middle_m + normal * (terrain.max_m + height_m),
            view_from_ecef,
            clip_from_view,
        },
        size_px: UVec2::new(720, 720),
        terrain,
        pixel_error: 0.0,
        host_pixel_error: 1.0,
        log_depth: None,
    };
    Sight::new(mesh.ellipsoid, 1_000.0, &frame, &RendererOptions::default()).expect("valid")
}

/// However narrow the field of view, refining ends where vertices are rounded.
#[test]
fn a_telescope_does_not_refine_without_end() {
    let mesh = one_edge(
        EdgeKind::Straight,
        LonLat::new(10.0, 47.0),
        LonLat::new(11.2, 47.3),
    );
    let mut sight = looking_down(&mesh, 100.0, HeightRange::default());
    sight.pixel = Pixel::Angle(1e-9);
    let mut patch = Patch::default();
    patch.refine_arc(&mesh, 0, &sight);
    assert!(patch.vertices.len() < 200_000, "{}", patch.vertices.len());
}

/// A corner by what it is: the stored vertex and how it is drawn.
type Corner = (FixedVertex, u32);

fn add_boundary(edges: &mut HashMap<(Corner, Corner), i32>, triangle: [Corner; 3], sign: i32) {
    for side in 0..3 {
        let (from, to) = (triangle[side], triangle[(side + 1) % 3]);
        if from < to {
            *edges.entry((from, to)).or_default() += sign;
        } else {
            *edges.entry((to, from)).or_default() -= sign;
        }
    }
}

/// Chords of 30 m under the eye between mountains and trenches: where one cuts a column, so does its
/// neighbour, and together they have the boundary of the walls they replace.
#[test]
fn neighbours_cut_their_column_alike() {
    let mesh = chain(200, 0.000_4);
    let range = HeightRange {
        min_m: -11_000.0,
        max_m: 9_000.0,
    };
    let sight = looking_down(&mesh, 1.0, range);
    let mut patch = Patch::default();
    patch.refine_arc(&mesh, 0, &sight);
    let refined = patch.chords.len();
    assert!((4..200).contains(&refined), "{refined}");
    assert!(patch.indices.iter().any(|index| index % 4 == AS_IS));
    let mut edges = HashMap::new();
    for triangle in patch.indices.as_chunks::<3>().0 {
        let corners = triangle.map(|index| (patch.vertices[(index / 4) as usize], index % 4));
        add_boundary(&mut edges, corners, 1);
    }
    for chord in &patch.chords {
        let [a, b] =
            [chord.vertex, chord.vertex + 1].map(|vertex| encode(mesh.vertices[vertex as usize]));
        let wall = [
            [(a, TOP), (a, BOTTOM), (b, TOP)],
            [(a, BOTTOM), (b, BOTTOM), (b, TOP)],
        ];
        for triangle in wall {
            add_boundary(&mut edges, triangle, -1);
        }
    }
    assert!(edges.values().all(|&sum| sum == 0));
}

/// A line of short edges along a parallel, as a single arc.
fn chain(edges: u32, step_deg: f64) -> FillMesh {
    let at = |k: u32| LonLat::new(10.0 + step_deg * f64::from(k), 47.0);
    let mut mesh = one_edge(EdgeKind::Straight, at(0), at(edges));
    mesh.curves = (0..edges)
        .map(|k| Curve::between(EdgeKind::Straight, at(k), at(k + 1)))
        .collect();
    mesh.vertices = (0..=edges)
        .map(|k| mesh.ellipsoid.ecef(at(k), 0.0))
        .collect();
    mesh.boundary = (0..=edges)
        .map(|k| BoundaryVertex {
            curve: k.min(edges - 1),
            deviation_m: 1e-3,
            t: if k == edges { 1.0 } else { 0.0 },
        })
        .collect();
    mesh.arcs[0].vertex_count = edges + 1;
    // The eye stands over the middle of the first curve: in the midst of the line.
    mesh.curves.rotate_left(edges as usize / 2);
    for vertex in &mut mesh.boundary {
        vertex.curve = (vertex.curve + edges - edges / 2) % edges;
    }
    mesh
}

#[test]
fn a_patch_has_the_boundary_of_the_wall_it_replaces() {
    let terrains = [(0.0, 0.0), (-11_000.0, 9_000.0), (4_000.0, 4_000.0)];
    let (from, to) = (LonLat::new(10.0, 47.0), LonLat::new(11.2, 47.3));
    for kind in [EdgeKind::Geodesic, EdgeKind::Rhumb, EdgeKind::Straight] {
        for (min_m, max_m) in terrains {
            for height_m in [0.5, 1.0, 10.0, 1e3, 1e4] {
                let mesh = one_edge(kind, from, to);
                let sight = looking_down(&mesh, height_m, HeightRange { min_m, max_m });
                let mut patch = Patch::default();
                patch.refine_arc(&mesh, 0, &sight);
                assert!(
                    height_m > 100.0 || patch.chords.len() == 1,
                    "{kind:?}, {height_m} m"
                );
                if patch.chords.is_empty() {
                    continue;
                }

                let mut edges = HashMap::new();
                for triangle in patch.indices.as_chunks::<3>().0 {
                    let corners =
                        triangle.map(|index| (patch.vertices[(index / 4) as usize], index % 4));
                    add_boundary(&mut edges, corners, 1);
                }
                let [a, b] = [0, 1].map(|vertex| encode(mesh.vertices[vertex]));
                let wall = [
                    [(a, TOP), (a, BOTTOM), (b, TOP)],
                    [(a, BOTTOM), (b, BOTTOM), (b, TOP)],
                ];
                for triangle in wall {
                    add_boundary(&mut edges, triangle, -1);
                }
                assert!(edges.values().all(|&sum| sum == 0));
                // Refining costs little: a logarithm of the edge's length over the height.
                assert!(patch.vertices.len() < 3_000, "{}", patch.vertices.len());
            }
        }
    }
}
