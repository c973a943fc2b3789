//! A nearly uniform lattice of points on the unit sphere.

use std::sync::LazyLock;

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::sag;

/// Parts into which an edge of the icosahedron is cut; the smallest for which no triangle exceeds
/// the sag limit.
const FREQUENCY: u32 = 38;

/// The icosahedron with its faces cut into small triangles.
pub(super) struct Lattice {
    /// Unit vectors, neighbours mostly in sequence.
    pub points: Vec<DVec3>,
    /// Counter-clockwise seen from outside; together they cover the sphere once.
    pub triangles: Vec<[u32; 3]>,
}

/// 14 442 points, 1.4° to 2° apart.
pub(super) static LATTICE: LazyLock<Lattice> = LazyLock::new(Lattice::new);

impl Lattice {
    fn new() -> Self {
        let (corners, faces) = icosahedron();
        let mut lattice = Self {
            points: Vec::new(),
            triangles: Vec::new(),
        };
        let mut known = FxHashMap::default();
        for face in faces {
            let mut index = |i: u32, j: u32| {
                let weights = [FREQUENCY - i - j, i, j];
                let mut name: Vec<_> = face.into_iter().zip(weights).filter(|n| n.1 > 0).collect();
                // Faces that share an edge must name, and compute, its points in the same order.
                name.sort_unstable();
                let sum: DVec3 = name.iter().map(|&(c, w)| corners[c] * f64::from(w)).sum();
                *known.entry(name).or_insert_with(|| {
                    lattice.points.push(sum.normalize());
                    lattice.points.len() as u32 - 1
                })
            };
            for i in 0..FREQUENCY {
                for j in 0..FREQUENCY - i {
                    let (a, b, c) = (index(i, j), index(i + 1, j), index(i, j + 1));
                    lattice.triangles.push([a, b, c]);
                    if i + j + 1 < FREQUENCY {
                        lattice.triangles.push([b, index(i + 1, j + 1), c]);
                    }
                }
            }
        }
        lattice
    }

    /// The sag of the deepest triangle, on the unit sphere.
    pub(super) fn sag(&self) -> f64 {
        let corners = self
            .triangles
            .iter()
            .map(|t| t.map(|i| self.points[i as usize]));
        corners.fold(0.0, sag::deeper)
    }
}

/// The lattice point nearest to a unit vector.
pub(super) fn nearest(point: DVec3) -> DVec3 {
    let closer = |a: DVec3, b: DVec3| if a.dot(point) < b.dot(point) { b } else { a };
    LATTICE.points.iter().copied().fold(-point, closer)
}

/// Corners, and faces counter-clockwise seen from outside.
fn icosahedron() -> ([DVec3; 12], Vec<[usize; 3]>) {
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let mut corners = [DVec3::ZERO; 12];
    for (k, corner) in corners.iter_mut().enumerate() {
        let one = if k & 1 == 0 { 1.0 } else { -1.0 };
        let long = if k & 2 == 0 { golden } else { -golden };
        *corner = match k / 4 {
            0 => DVec3::new(0.0, one, long),
            1 => DVec3::new(one, long, 0.0),
            _ => DVec3::new(long, 0.0, one),
        };
    }
    let mut faces = Vec::with_capacity(20);
    for a in 0..12 {
        for b in a + 1..12 {
            for c in a + 1..12 {
                let near = |i: usize, j: usize| corners[i].distance_squared(corners[j]) < 4.1;
                let outward = corners[a].dot(corners[b].cross(corners[c])) > 0.0;
                if b != c && near(a, b) && near(b, c) && near(c, a) && outward {
                    faces.push([a, b, c]);
                }
            }
        }
    }
    (corners, faces)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn covers_the_sphere_within_the_sag_limit() {
        assert_eq!(LATTICE.points.len(), 10 * 38 * 38 + 2);
        assert_eq!(LATTICE.triangles.len(), 20 * 38 * 38);
        assert!(LATTICE.sag() < sag::limit());
    }
}
