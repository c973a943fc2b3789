//! Fewer vertices for arcs that are seen from afar.
//!
//! The way of Douglas and Peucker, which keeps the vertex farthest from a chord, with the condition of
//! Saalfeld (1999, *Topologically consistent line simplification with the Douglas-Peucker algorithm*): a
//! chord may not pass a vertex of other boundary on another side than the polyline it stands for. If no
//! vertex lies between any chord and its polyline, then no two chords cross, whichever arcs they belong
//! to. So each arc is simplified by itself, and neighbours agree.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use crate::{
    ellipsoid::Ellipsoid,
    fill_mesh::{Arc, FillMesh},
    mesh::densify::MAX_CHORD,
    mesh::vertex_tree::VertexTree,
};

/// Recursions that split at the farthest vertex; further ones split in the middle, so that the time stays
/// bounded whatever the shape.
const MAX_FARTHEST_SPLITS: u32 = 40;

/// So many vertices of other boundary are looked at for a chord, more for a short polyline.
const MOST_NEAR: usize = 64;
const MOST_LOOKS: usize = 4096;

/// The vertices of an arc that are kept.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct KeptVertices {
    /// Indices into the vertices of the mesh that is simplified.
    pub(crate) vertices: Vec<u32>,
    /// For each but the last: how far, metres, the chord to the next may lie beside the true edges.
    pub(crate) deviations_m: Vec<f32>,
}

/// Simplifies the arcs of a mesh.
pub(crate) struct Simplifier<'a> {
    mesh: &'a FillMesh,
    /// The mesh of which `mesh` may be a simplification, and for each boundary vertex which it is there:
    /// deviations are measured from the finest, so that they do not add up from level to level.
    finest: &'a FillMesh,
    origins: &'a [u32],
    tree: VertexTree<'a>,
}

/// A run of an arc's vertices and what a chord in its place would be.
struct Section {
    first: u32,
    last: u32,
    splits: u32,
}

impl<'a> Simplifier<'a> {
    pub(crate) fn new(mesh: &'a FillMesh, finest: &'a FillMesh, origins: &'a [u32]) -> Self {
        Self {
            mesh,
            finest,
            origins,
            tree: VertexTree::new(&mesh.vertices[..mesh.boundary.len()]),
        }
    }

    /// What is kept of each arc, always its ends, where chords may lie `tolerance_m` beside the true edges.
    pub(crate) fn kept(&self, tolerance_m: f64) -> Vec<KeptVertices> {
        let arcs = self.mesh.arcs.par_iter();
        arcs.map(|arc| self.kept_of(arc, tolerance_m)).collect()
    }

    fn kept_of(&self, arc: &Arc, tolerance_m: f64) -> KeptVertices {
        let mut kept = KeptVertices::default();
        let last = arc.first_vertex + arc.vertex_count - 1;
        // Sections still to be drawn, the first on top.
        let mut open = vec![Section {
            first: arc.first_vertex,
            last,
            splits: 0,
        }];
        while let Some(section) = open.pop() {
            match self.split(&section, tolerance_m) {
                Ok(deviation_m) => {
                    kept.vertices.push(section.first);
                    kept.deviations_m.push(deviation_m);
                }
                Err(farthest) => {
                    let Section {
                        first,
                        last,
                        splits,
                    } = section;
                    let middle = if splits < MAX_FARTHEST_SPLITS {
                        farthest
                    } else {
                        first + (last - first) / 2
                    };
                    let half = |first, last| Section {
                        first,
                        last,
                        splits: splits + 1,
                    };
                    open.extend([half(middle, last), half(first, middle)]);
                }
            }
        }
        kept.vertices.push(last);
        kept
    }

    /// The deviation of a chord in the section's place, or the vertex to split it at.
    fn split(&self, section: &Section, tolerance_m: f64) -> Result<f32, u32> {
        let &Section { first, last, .. } = section;
        if last == first + 1 {
            return Ok(self.mesh.boundary[first as usize].deviation_m);
        }
        let position = |vertex: u32| self.mesh.vertices[vertex as usize];
        let chord = Chord::new(&self.mesh.ellipsoid, position(first), position(last));
        let (farthest, _) = (first + 1..last)
            .map(|vertex| (vertex, chord.distance_beside_m(position(vertex))))
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or((first + 1, 0.0));
        let finest = self.origins[first as usize] as usize..self.origins[last as usize] as usize;
        let stored_m = self.finest.boundary[finest.clone()]
            .iter()
            .fold(0.0, |most: f32, vertex| most.max(vertex.deviation_m));
        let beside_m = self.finest.vertices[finest]
            .iter()
            .fold(0.0, |most: f64, &point_m| {
                most.max(chord.distance_beside_m(point_m))
            });
        let deviation_m = f64::from(stored_m) + beside_m;
        let max_chord_m = MAX_CHORD * self.mesh.ellipsoid.a_m;
        let too_coarse = deviation_m > tolerance_m || chord.length_m > max_chord_m;
        if too_coarse || self.is_blocked(section, &chord, beside_m) {
            return Err(farthest);
        }
        // Rounded up, so that it stays a bound.
        Ok((deviation_m as f32).next_up())
    }

    /// Whether a vertex of other boundary, or of the arc elsewhere, lies between chord and polyline.
    fn is_blocked(&self, section: &Section, chord: &Chord, beside_m: f64) -> bool {
        let ellipsoid = &self.mesh.ellipsoid;
        let own = section.first..=section.last;
        let own_m = &self.mesh.vertices[section.first as usize..=section.last as usize];
        let chart = Gnomonic::new(ellipsoid, 0.5 * (chord.a_m + chord.b_m));
        let polygon: Vec<DVec2> = own_m.iter().map(|&point_m| chart.of(point_m)).collect();
        // Where more is near than this, it is not looked at: the time stays bounded whatever the shape.
        let mut left = MOST_NEAR + MOST_LOOKS / polygon.len();
        // Everything between is within `beside_m` of the chord, but for the bulge of the ellipsoid.
        let reach_m = beside_m + ellipsoid.chord_sag_m(chord.length_m) + 1e-3;
        self.tree
            .any_near([chord.a_m, chord.b_m], reach_m, |vertex, point_m| {
                if own.contains(&vertex) {
                    return false;
                }
                left = left.saturating_sub(1);
                left == 0 || is_inside(chart.of(point_m), &polygon) && !own_m.contains(&point_m)
            })
    }
}

/// A straight chord and the plane that its wall stands in.
struct Chord {
    a_m: DVec3,
    b_m: DVec3,
    length_m: f64,
    along: DVec3,
    across: DVec3,
}

impl Chord {
    fn new(ellipsoid: &Ellipsoid, a_m: DVec3, b_m: DVec3) -> Self {
        let up = ellipsoid.normal_at_surface(a_m) + ellipsoid.normal_at_surface(b_m);
        let along = (b_m - a_m).normalize_or_zero();
        Self {
            a_m,
            b_m,
            length_m: a_m.distance(b_m),
            along,
            across: along.cross(up).normalize_or_zero(),
        }
    }

    /// How far, metres, a surface point lies beside the wall, or beyond its ends. Between two such points
    /// a chord lies no farther: distance from a plane is linear, that from a strip of it convex.
    fn distance_beside_m(&self, point_m: DVec3) -> f64 {
        let from_a = point_m - self.a_m;
        if self.along == DVec3::ZERO {
            return from_a.length();
        }
        let along_m = from_a.dot(self.along);
        let beyond_m = (-along_m).max(along_m - self.length_m).max(0.0);
        from_a.dot(self.across).hypot(beyond_m)
    }
}

/// Central projection on to a plane, which keeps great arcs straight, from the sphere that the ellipsoid
/// becomes when divided by its radii.
struct Gnomonic {
    inverse_radii: DVec3,
    middle: DVec3,
    east: DVec3,
    north: DVec3,
}

impl Gnomonic {
    fn new(ellipsoid: &Ellipsoid, middle_m: DVec3) -> Self {
        let inverse_radii = ellipsoid.radii_m().recip();
        let middle = (middle_m * inverse_radii).normalize_or(DVec3::Z);
        let (east, north) = middle.any_orthonormal_pair();
        Self {
            inverse_radii,
            middle,
            east,
            north,
        }
    }

    fn of(&self, point_m: DVec3) -> DVec2 {
        let point = point_m * self.inverse_radii;
        DVec2::new(point.dot(self.east), point.dot(self.north)) / point.dot(self.middle)
    }
}

/// Whether a point is inside a polygon by the even-odd rule.
fn is_inside(point: DVec2, polygon: &[DVec2]) -> bool {
    let mut inside = false;
    for (index, &b) in polygon.iter().enumerate() {
        let a = polygon[(index + polygon.len() - 1) % polygon.len()];
        if (a.y > point.y) != (b.y > point.y) {
            let x = a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x);
            inside ^= point.x < x;
        }
    }
    inside
}
