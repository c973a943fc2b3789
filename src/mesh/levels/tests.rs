//! Laws of levels of detail.

use std::collections::HashMap;

use glam::DVec3;

use super::*;
use crate::{EdgeKind, Ellipsoid, LonLat, MeshOptions, Polygon, Region, countries::Dataset};

fn countries(dataset: Dataset) -> FillMesh {
    let countries = dataset.countries().into_iter();
    let regions: Vec<Region> = countries.map(|country| country.region).collect();
    FillMesh::build(&regions, &MeshOptions::default()).expect("embedded data is sound")
}

fn bits(point: DVec3) -> [u64; 3] {
    point.to_array().map(f64::to_bits)
}

/// The vertices of an arc.
fn run<'a>(mesh: &'a FillMesh, arc: &Arc) -> &'a [DVec3] {
    let first = arc.first_vertex as usize;
    &mesh.vertices[first..first + arc.vertex_count as usize]
}

#[test]
fn levels_have_the_same_pieces_and_arcs_and_fewer_vertices() {
    let mesh = countries(Dataset::Countries50m);
    assert!(mesh.coarser.len() >= 2);
    let mut finer = &mesh;
    for level in &mesh.coarser {
        assert_eq!(level.fills, mesh.fills);
        assert_eq!(
            level.boundary.len() + level.interior_count(),
            level.vertices.len()
        );
        assert!(level.boundary.len() as f64 <= SHARE * finer.boundary.len() as f64);
        assert_eq!(level.pieces.len(), mesh.pieces.len());
        assert_eq!(level.arcs.len(), mesh.arcs.len());
        for (arc, stored) in level.arcs.iter().zip(&mesh.arcs) {
            assert_eq!((arc.left, arc.right), (stored.left, stored.right));
            let [own, whole] = [run(level, arc), run(&mesh, stored)];
            assert_eq!(
                (own[0], own[own.len() - 1]),
                (whole[0], whole[whole.len() - 1])
            );
        }
        finer = level;
    }
}

impl FillMesh {
    fn interior_count(&self) -> usize {
        let corners = self.cap_triangles.iter().flatten().copied();
        let boundary = self.boundary.len() as u32;
        let interior = corners.filter(|&vertex| vertex >= boundary);
        interior.collect::<std::collections::HashSet<_>>().len()
    }
}

/// Bit for bit: the triangles of a piece have its arcs for a boundary.
#[test]
fn caps_of_every_level_are_bounded_by_its_arcs() {
    let mesh = countries(Dataset::Countries110m);
    for level in &mesh.coarser {
        let mut boundaries: Vec<HashMap<_, i64>> = vec![HashMap::new(); level.pieces.len()];
        let mut add = |piece: u32, a: DVec3, b: DVec3, weight: i64| {
            let (a, b) = (bits(a), bits(b));
            let (key, weight) = if a < b {
                ((a, b), weight)
            } else {
                ((b, a), -weight)
            };
            *boundaries[piece as usize].entry(key).or_default() += weight;
        };
        for (index, piece) in (0..).zip(&level.pieces) {
            let first = piece.first_triangle as usize;
            for corners in &level.cap_triangles[first..first + piece.triangle_count as usize] {
                let corners = corners.map(|vertex| level.vertices[vertex as usize]);
                for side in 0..3 {
                    add(index, corners[side], corners[(side + 1) % 3], 1);
                }
            }
        }
        for arc in &level.arcs {
            for ends in run(level, arc).windows(2) {
                for (side, weight) in [(arc.left, -1), (arc.right, 1)] {
                    if let Some(piece) = side {
                        add(piece, ends[0], ends[1], weight);
                    }
                }
            }
        }
        for (piece, boundary) in boundaries.iter().enumerate() {
            let open = boundary.values().filter(|&&weight| weight != 0).count();
            assert_eq!(open, 0, "piece {piece}");
        }
    }
}

/// Every vertex of the finest level lies as near its chord's wall as the chord says.
#[test]
fn deviations_hold_all_that_is_left_out() {
    let mesh = countries(Dataset::Countries50m);
    let ellipsoid = mesh.ellipsoid;
    for level in &mesh.coarser {
        let mut greatest = 0.0_f64;
        for (arc, stored) in level.arcs.iter().zip(&mesh.arcs) {
            let mut left = run(&mesh, stored).iter().peekable();
            let first = arc.first_vertex as usize;
            for (own, ends) in run(level, arc).windows(2).enumerate() {
                let bound_m = f64::from(level.boundary[first + own].deviation_m);
                let up =
                    ellipsoid.normal_at_surface(ends[0]) + ellipsoid.normal_at_surface(ends[1]);
                let along = ends[1] - ends[0];
                let across = along.cross(up).normalize_or_zero();
                while let Some(&point) = left.next_if(|&&point| bits(point) != bits(ends[1])) {
                    // A ring of one chord there and one back has no plane.
                    let t = ((point - ends[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0);
                    let beyond =
                        (point - ends[0]).dot(along.normalize_or_zero()) - t * along.length();
                    let beside_m = (point - ends[0]).dot(across).hypot(beyond);
                    assert!(beside_m <= bound_m, "{beside_m} m of {bound_m}");
                    greatest = greatest.max(beside_m);
                }
            }
        }
        println!("at most {greatest:.1} m");
        assert!(
            greatest
                > 0.2
                    * f64::from(
                        level
                            .boundary
                            .iter()
                            .fold(0.0, |most: f32, vertex| most.max(vertex.deviation_m))
                    )
        );
    }
}

/// Chords of one level cross nowhere but where those of the finest do, edges being within its tolerance.
#[test]
fn chords_do_not_cross() {
    let mesh = countries(Dataset::Countries110m);
    let finest = crossings(&mesh);
    for level in &mesh.coarser {
        assert!(
            crossings(level) <= finest,
            "{} of {finest}",
            crossings(level)
        );
    }
}

fn crossings(level: &FillMesh) -> usize {
    let arcs = level.arcs.iter();
    let mut chords: Vec<[DVec3; 2]> = arcs
        .flat_map(|arc| run(level, arc).windows(2).map(|ends| [ends[0], ends[1]]))
        .collect();
    let middle = |[a, b]: [DVec3; 2]| 0.5 * (a + b);
    chords.sort_by(|&a, &b| middle(a).x.total_cmp(&middle(b).x));
    let longest_m = level.longest_chord_m();
    let crossed = |(index, &own): (usize, &[DVec3; 2])| {
        let near = chords[..index].iter().rev();
        let near = near.take_while(move |&&other| middle(own).x - middle(other).x <= longest_m);
        near.filter(|&&other| cross(level.ellipsoid, own, other))
            .count()
    };
    chords.iter().enumerate().map(crossed).sum()
}

/// Whether two great arcs of the scaled sphere cross away from their ends.
fn cross(ellipsoid: Ellipsoid, [a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> bool {
    if a.distance(c) > a.distance(b) + c.distance(d) {
        return false;
    }
    let [a, b, c, d] = [a, b, c, d].map(|point| point / ellipsoid.radii_m());
    let side = |p: DVec3, q: DVec3, r: DVec3| p.cross(q).dot(r);
    let apart = |x: f64, y: f64| x * y < 0.0 && x.abs().min(y.abs()) > 1e-15;
    apart(side(a, b, c), side(a, b, d)) && apart(side(c, d, a), side(c, d, b))
}

/// Two coasts that zigzag together by kilometres, at first 22 m apart: each alone could be cut straight.
#[test]
fn neighbours_keep_their_sides() {
    let coast = |gap_deg: f64, base_deg: f64| {
        let zigzag = (0..600).map(|step| {
            let along = 0.01 * f64::from(step);
            let lat_deg =
                gap_deg * (1.0 + along.powi(4)) + 0.02 * (f64::from(step) * 0.618).fract();
            LonLat::new(along, lat_deg)
        });
        let base = [LonLat::new(6.0, base_deg), LonLat::new(0.0, base_deg)];
        let shell = zigzag.chain(base).collect();
        let polygon = Polygon {
            shell,
            holes: Vec::new(),
        };
        Region {
            polygons: vec![polygon],
            edges: EdgeKind::Straight,
            ..Region::default()
        }
    };
    let regions = [coast(0.0, -0.5), coast(2e-4, 0.5)];
    let mesh = FillMesh::build(&regions, &MeshOptions::default()).expect("coasts");
    let coarsest = mesh.coarser.last().expect("coarser levels");
    println!("{} of {}", coarsest.boundary.len(), mesh.boundary.len());
    for level in &mesh.coarser {
        assert_eq!(crossings(level), 0);
    }
}
