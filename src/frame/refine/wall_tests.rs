//! How far drawn walls lie beside the true edge, in f64: what refinement leaves.

use glam::{DMat3, DMat4, DVec3, DVec4, UVec2};

use crate::{
    ellipsoid::Ellipsoid,
    fill_mesh::{FillMesh, MeshOptions},
    frame::refine::{BOTTOM, Patch, TOP},
    frame::sight::Sight,
    geodetic::LonLat,
    gpu::fixed_point::{FixedVertex, encode},
    options::{Camera, Frame, HeightRange, RendererOptions},
    region::{EdgeKind, Polygon, Region},
};

/// Pixels across 60° of view.
const SIZE_PX: u32 = 720;
/// Rounding of a vertex, metres: 3.8 µm an axis.
const VERTEX_M: f64 = 6.7e-6;
/// Finest displacement that refinement works towards, pixels.
const FINEST_PX: f64 = 1.0 / 64.0;

/// A triangle whose first edge is about 130 km long.
fn triangle(kind: EdgeKind, lat_deg: f64) -> FillMesh {
    let wide = 1.0 / lat_deg.to_radians().cos();
    let at = |east: f64, north: f64| LonLat::new(10.0 + wide * east, lat_deg + north);
    let region = Region {
        polygons: vec![Polygon {
            shell: vec![at(-0.5, -0.3), at(0.5, 0.3), at(-0.4, 0.9)],
            holes: vec![],
        }],
        edges: kind,
        ..Default::default()
    };
    FillMesh::build(&[region], &MeshOptions::default()).expect("a sound triangle")
}

/// From `height_m` above the highest surface over the middle of the first edge.
fn looking_down(mesh: &FillMesh, height_m: f64, terrain: HeightRange, pixel_error: f64) -> Sight {
    let middle_m = mesh.curves[0].on(&mesh.ellipsoid).ecef(0.5);
    let normal = mesh.ellipsoid.normal_at_surface(middle_m);
    let right = normal.any_orthonormal_vector();
    let scale = 1.0 / 30f64.to_radians().tan();
    let frame = Frame {
        camera: Camera {
            eye_ecef_m: middle_m + normal * (terrain.max_m + height_m),
            view_from_ecef: DMat3::from_cols(right, normal.cross(right), normal).transpose(),
            clip_from_view: DMat4::from_cols(
                DVec4::new(scale, 0.0, 0.0, 0.0),
                DVec4::new(0.0, scale, 0.0, 0.0),
                DVec4::new(0.0, 0.0, 0.0, -1.0),
                DVec4::new(0.0, 0.0, 0.1 * height_m, 0.0),
            ),
        },
        size_px: UVec2::splat(SIZE_PX),
        terrain,
        pixel_error,
        host_pixel_error: 1.0,
        log_depth: None,
    };
    Sight::new(
        mesh.ellipsoid,
        mesh.sag_m,
        &frame,
        &RendererOptions::default(),
    )
    .expect("valid")
}

/// A corner as extrude.wgsl places it, in f64.
fn corner_m(vertex: FixedVertex, drawn: u32, sight: &Sight) -> DVec3 {
    let component = |axis: usize| {
        let fraction = vertex[3] >> (10 * axis) & 1023;
        f64::from(vertex[axis]) / 128.0 + f64::from(fraction) / 131_072.0
    };
    let base_m = DVec3::new(component(0), component(1), component(2));
    let distance_m = base_m.distance(sight.eye_ecef_m);
    let height_m = match drawn {
        BOTTOM => sight.extrusion.bottom_at_m(distance_m),
        TOP => sight.extrusion.top_at_m(distance_m),
        _ => 0.0,
    };
    base_m + sight.ellipsoid.normal_at_surface(base_m) * height_m
}

/// What is drawn along the first arc: patches, and walls of two triangles where there is none.
fn drawn(mesh: &FillMesh, patch: &Patch, sight: &Sight) -> Vec<[DVec3; 3]> {
    let placed = |index: &u32| corner_m(patch.vertices[(index / 4) as usize], index % 4, sight);
    let corners: Vec<DVec3> = patch.indices.iter().map(placed).collect();
    let mut triangles = corners.as_chunks::<3>().0.to_vec();
    let arc = &mesh.arcs[0];
    for vertex in arc.first_vertex..arc.first_vertex + arc.vertex_count - 1 {
        if patch.chords.iter().any(|chord| chord.vertex == vertex) {
            continue;
        }
        let [a, b] = [vertex, vertex + 1].map(|end| encode(mesh.vertices[end as usize]));
        let at = |vertex, drawn| corner_m(vertex, drawn, sight);
        triangles.push([at(a, TOP), at(a, BOTTOM), at(b, TOP)]);
        triangles.push([at(a, BOTTOM), at(b, BOTTOM), at(b, TOP)]);
    }
    triangles
}

/// How far from `point_m`, metres either way along the unit vector `across`, a triangle is met.
fn met_m([a, b, c]: [DVec3; 3], point_m: DVec3, across: DVec3) -> Option<f64> {
    let (ab, ac, from_a) = (b - a, c - a, point_m - a);
    let (p, q) = (across.cross(ac), from_a.cross(ab));
    let volume = ab.dot(p);
    let (u, v) = (from_a.dot(p) / volume, across.dot(q) / volume);
    let inside = u >= -1e-6 && v >= -1e-6 && u + v <= 1.0 + 1e-6;
    inside.then(|| (ac.dot(q) / volume).abs())
}

/// The greatest distance of the first edge from what is drawn for it, pixels from the eye, at the
/// lowest, the highest and the nearest height, at places from below the eye to the edge's ends.
fn worst_px(mesh: &FillMesh, sight: &Sight, patch: &Patch, height_m: f64) -> (f64, f64) {
    let triangles = drawn(mesh, patch, sight);
    let on = mesh.curves[0].on(&mesh.ellipsoid);
    let length_m = on.ecef(0.0).distance(on.ecef(1.0));
    let (mut worst_px, mut beyond_px) = (0.0_f64, f64::NEG_INFINITY);
    let heights_m = [sight.surface_m.0, sight.surface_m.1];
    for step in 0..40 {
        let aside = 0.1 * height_m * 1.5_f64.powi(step) / length_m;
        for t in [0.5 - aside, 0.5 + aside] {
            if !(0.01..0.99).contains(&t) {
                continue;
            }
            let foot_m = on.ecef(t);
            let up = mesh.ellipsoid.normal_at_surface(foot_m);
            let along = on.ecef(t + 1e-4) - on.ecef(t - 1e-4);
            let across = along.cross(up).normalize();
            for surface_m in heights_m {
                let point_m = foot_m + up * surface_m;
                let off_m = triangles
                    .iter()
                    .filter_map(|&triangle| met_m(triangle, point_m, across))
                    .fold(f64::INFINITY, f64::min);
                let pixel_m = sight.pixel.at_m(point_m.distance(sight.eye_ecef_m));
                let off_px = off_m / pixel_m;
                worst_px = worst_px.max(off_px);
                beyond_px = beyond_px.max(off_px - VERTEX_M / pixel_m);
            }
        }
    }
    (worst_px, beyond_px)
}

/// The curve may lie aside by one tolerance, and the flat wall by one more where its ends are skew.
#[test]
fn refined_walls_stay_within_twice_the_tolerance() {
    for pixel_error in [0.0, 0.25] {
        let most_px = 2.0 * FINEST_PX.max(pixel_error);
        let mut all_px = 0.0_f64;
        for kind in [EdgeKind::Straight, EdgeKind::Rhumb, EdgeKind::Geodesic] {
            for lat_deg in [0.5, 47.0, 80.0] {
                let mesh = triangle(kind, lat_deg);
                assert_eq!(mesh.ellipsoid, Ellipsoid::WGS84);
                for (min_m, max_m) in [(0.0, 0.0), (4_000.0, 4_000.0), (-11_000.0, 9_000.0)] {
                    for height_m in [1.0, 10.0, 100.0, 1e4, 1e6] {
                        let terrain = HeightRange { min_m, max_m };
                        let sight = looking_down(&mesh, height_m, terrain, pixel_error);
                        let mut patch = Patch::default();
                        patch.refine_arc(&mesh, 0, &sight);
                        let (worst_px, beyond_px) = worst_px(&mesh, &sight, &patch, height_m);
                        all_px = all_px.max(worst_px);
                        assert!(
                            beyond_px <= most_px,
                            "{kind:?} at {lat_deg}, {terrain:?}, {height_m} m: {worst_px} px"
                        );
                    }
                }
            }
        }
        println!("budget {pixel_error} px: walls are up to {all_px:.4} px beside the true edge");
    }
}

/// The instrument tells: without patches, chords metres aside are seen as that.
#[test]
fn walls_that_are_not_refined_are_seen() {
    let mesh = triangle(EdgeKind::Straight, 47.0);
    let sight = looking_down(&mesh, 10.0, HeightRange::default(), 0.0);
    let (worst_px, _) = worst_px(&mesh, &sight, &Patch::default(), 10.0);
    println!("not refined: {worst_px:.4} px");
    // The eye is right above a stored vertex, where chords leave the edge slowly.
    assert!(worst_px > 6.0 * FINEST_PX, "{worst_px} px");
}
