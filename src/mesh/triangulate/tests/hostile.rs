//! Regions of crossing rings, filled by the whole pipeline.

use super::*;
use crate::{EdgeKind, FillMesh, Inside, LonLat, MeshOptions, Polygon, Region};

/// How often a piece's triangles cover a direction, signed.
fn covering(mesh: &FillMesh, direction: DVec3) -> i32 {
    let covers = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| mesh.vertices[corner as usize]);
        let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| p.cross(q).dot(direction) > 0.0);
        let is_near = (a + b + c).dot(direction) > 0.0;
        match sides {
            _ if !is_near => 0,
            [true, true, true] => 1,
            [false, false, false] => -1,
            _ => 0,
        }
    };
    mesh.cap_triangles.iter().map(covers).sum()
}

#[test]
fn a_region_that_leaves_narrow_gaps_is_covered_once() {
    let rings: [&[(i32, i32)]; 3] = [
        &[
            (1, -2),
            (-2, 3),
            (0, 0),
            (1, 0),
            (1, -1),
            (2, 0),
            (-5, 3),
            (0, 1),
        ],
        &[(2, 0), (-6, -2), (1, 1), (-2, 3), (-1, 0), (-5, 0)],
        &[(0, 0), (0, 1), (-2, -1)],
    ];
    let place = |&(x, y): &(i32, i32)| LonLat::new(f64::from(150 + 30 * x), f64::from(30 * y));
    let mut rings = rings.iter().map(|ring| ring.iter().map(place).collect());
    let region = Region {
        polygons: vec![Polygon {
            shell: rings.next().unwrap(),
            holes: rings.collect(),
        }],
        edges: EdgeKind::Straight,
        inside: Inside::Smaller,
        zones: Vec::new(),
    };
    let mesh = FillMesh::build(&[region], &MeshOptions::default()).unwrap();
    assert_eq!(mesh.pieces.len(), 1);
    let mut counts = std::collections::BTreeMap::<i32, u32>::new();
    for direction in directions(2000) {
        *counts.entry(covering(&mesh, direction)).or_default() += 1;
    }
    assert!(
        counts.keys().all(|times| (0..=1).contains(times)),
        "{counts:?}"
    );
}
