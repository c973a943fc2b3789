//! Caps: triangles that fill closed loops on the ellipsoid.
//!
//! Everything happens on the unit sphere that the ellipsoid becomes when divided by its radii, in
//! one stereographic [`Chart`] per piece whose projection point, the pole, is far from all loops.
//! Stereographic circles are circles, so a Delaunay triangulation of the chart is one of the sphere. A
//! pole inside the piece becomes a vertex: the chart's outer face is then a fan around it.
//!
//! Caps are *signed chains*: what must be right is their signed boundary, and it is right by
//! construction, whatever crosses. Every loop edge is walked along edges of the triangulation, every
//! triangle counts as often as the walks wind around it, and signed ears close the difference
//! between an edge and its walk.

mod chart;
mod constrained;
mod ear_clip;
mod interior;
mod lattice;
mod sag;
mod sleeve;
#[cfg(test)]
mod tests;

use std::f64::consts::TAU;

use glam::DVec3;

use crate::ellipsoid::Ellipsoid;
use chart::Chart;
use constrained::Constrained;
use ear_clip::ear_clip;
use interior::refine;
use lattice::LATTICE;
use sag::SAG_LIMIT_RAD;

/// Single loops of at most this many vertices that cannot sag are clipped ear by ear, which is
/// quadratic but has no overhead.
const EAR_CLIP_MAX: usize = 64;

/// The triangles that fill a piece.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Caps {
    /// New vertices inside, ECEF metres at height 0, indexed from the end of the shared array on.
    pub interior: Vec<DVec3>,
    /// Indices of triangles; counter-clockwise seen from outside counts +1, clockwise −1.
    pub triangles: Vec<[u32; 3]>,
    /// Upper bound, metres, of how far these triangles and the loops' chords lie below the ellipsoid.
    pub sag_m: f64,
}

/// Triangulates the inside of closed loops on the ellipsoid: the interior is on the left of every loop.
///
/// `loops` index `vertices` (ECEF metres at height 0) and do not repeat their first vertex. They
/// bound one piece; no loops at all stand for the whole globe. New interior vertices get indices from
/// `vertices.len()` on. `inside_sr` is the inside's area on the unit sphere, by which a sliver is told
/// from everything but a sliver; it may be wrong by some steradians.
///
/// The signed boundary of the triangles, equal positions being one vertex, is exactly the directed
/// edges of the loops, whether or not chords cross. No triangle sags more than
/// [`SAG_LIMIT_RAD`] allows (1.3 km on Earth) if no chord is longer than 2° of arc.
pub(crate) fn triangulate(
    ellipsoid: Ellipsoid,
    vertices: &[DVec3],
    loops: &[Vec<u32>],
    inside_sr: f64,
) -> Caps {
    if loops.is_empty() {
        return globe(ellipsoid, vertices.len());
    }
    let outline = Outline::new(ellipsoid, vertices, loops, inside_sr);
    if outline.points.len() < 3 {
        return outline.flat(Vec::new());
    }
    let (centre, radius_rad) = outline.bounding_cap();
    if loops.len() == 1
        && outline.points.len() <= EAR_CLIP_MAX
        && radius_rad < SAG_LIMIT_RAD
        && !outline.contains_antipode(centre)
    {
        return outline.caps(ear_clip(&Chart::new(-centre), &outline.points), Vec::new());
    }
    let (chart, winding_of_pole) = outline.chart(centre, radius_rad);
    outline.triangulate_in(chart, winding_of_pole)
}

/// The whole ellipsoid.
fn globe(ellipsoid: Ellipsoid, first: usize) -> Caps {
    let interior = LATTICE.points.iter().map(|&p| p * ellipsoid.radii_m());
    let triangles = LATTICE.triangles.iter();
    Caps {
        interior: interior.collect(),
        triangles: triangles.map(|t| t.map(|i| i + first as u32)).collect(),
        sag_m: sag::metres(ellipsoid, LATTICE.sag()),
    }
}

/// The loops of one piece on the unit sphere, loop after loop.
struct Outline<'a> {
    ellipsoid: Ellipsoid,
    /// Length of the shared vertex array.
    first_interior: usize,
    /// Points of the loops on the unit sphere.
    points: Vec<DVec3>,
    /// For each point its index in the shared array.
    shared: Vec<u32>,
    /// For each loop the range of its points.
    ranges: Vec<std::ops::Range<usize>>,
    vertices: &'a [DVec3],
    /// Area of the inside, steradians, roughly.
    inside_sr: f64,
}

impl<'a> Outline<'a> {
    fn new(
        ellipsoid: Ellipsoid,
        vertices: &'a [DVec3],
        loops: &[Vec<u32>],
        inside_sr: f64,
    ) -> Self {
        let shared: Vec<u32> = loops.iter().flatten().copied().collect();
        let radii_m = ellipsoid.radii_m();
        let mut end = 0;
        let ranges = loops.iter().map(|vertices| {
            let start = end;
            end += vertices.len();
            start..end
        });
        Self {
            ellipsoid,
            first_interior: vertices.len(),
            ranges: ranges.collect(),
            points: shared
                .iter()
                .map(|&i| (vertices[i as usize] / radii_m).normalize())
                .collect(),
            shared,
            vertices,
            inside_sr,
        }
    }

    /// The directed edges of all loops, as indices of points.
    fn edges(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.ranges.iter().flat_map(|range| {
            let last = range.end.wrapping_sub(1);
            let before = std::iter::once(last).chain(range.start..last);
            before.zip(range.clone()).map(|(a, b)| [a, b])
        })
    }

    /// A cap that holds all points: a unit vector and an angular radius. Not the smallest.
    fn bounding_cap(&self) -> (DVec3, f64) {
        let sum: DVec3 = self.points.iter().sum();
        let centre = sum.try_normalize().unwrap_or(DVec3::Z);
        let farthest = self.points.iter().map(|p| p.distance_squared(centre));
        let chord = farthest.fold(0.0, f64::max).sqrt();
        (centre, 2.0 * (0.5 * chord).min(1.0).asin())
    }

    /// Whether the inside holds the antipode of `centre`.
    ///
    /// The signed areas swept from `centre` sum to the inside's area, less the sphere's if the
    /// antipode is inside. Of the two the nearer to what is known to be inside is meant: chords may
    /// lie a few metres beside the true loop and so turn a sliver inside out.
    fn contains_antipode(&self, centre: DVec3) -> bool {
        let swept = |[a, b]: [usize; 2]| swept_area(centre, self.points[a], self.points[b]);
        self.edges().map(swept).sum::<f64>() < self.inside_sr - TAU
    }

    /// A chart whose pole is well away from the loops, and how often they wind around the pole.
    ///
    /// Near the pole straight lines of the chart are not at all great circles: it never moves into a
    /// hole, which may be narrower than its chords are long.
    fn chart(&self, centre: DVec3, radius_rad: f64) -> (Chart, i32) {
        /// Wide enough that the chart's scale varies by less than a factor of 4.
        const WIDE_RAD: f64 = 2.1;
        let pole = if radius_rad < WIDE_RAD {
            -centre
        } else {
            self.farthest_candidate(-centre)
        };
        if self.contains_antipode(-pole) {
            (Chart::new(lattice::nearest(pole)), 1)
        } else {
            (Chart::new(pole), 0)
        }
    }

    /// Of `first` and some points all over the sphere, the one farthest from every loop vertex.
    fn farthest_candidate(&self, first: DVec3) -> DVec3 {
        const STRIDE: usize = 227;
        let candidates =
            std::iter::once(first).chain(LATTICE.points.iter().step_by(STRIDE).copied());
        let clearance = |candidate: &DVec3| {
            let distances = self.points.iter().map(|p| p.distance_squared(*candidate));
            distances.fold(f64::INFINITY, f64::min)
        };
        candidates
            .max_by(|a, b| clearance(a).total_cmp(&clearance(b)))
            .unwrap_or(first)
    }

    fn triangulate_in(&self, chart: Chart, winding_of_pole: i32) -> Caps {
        let Some(mut constrained) = Constrained::new(chart, winding_of_pole, self) else {
            return self.flat(self.fans());
        };
        refine(&mut constrained);
        let triangles = constrained.triangles(self.points.len());
        self.caps(triangles, constrained.into_interior())
    }

    /// Each loop as a fan: the answer when the whole piece is one line of the chart.
    fn fans(&self) -> Vec<[u32; 3]> {
        let fan = |range: &std::ops::Range<usize>| {
            let first = range.start as u32;
            (first + 1..(range.end as u32).saturating_sub(1)).map(move |i| [first, i, i + 1])
        };
        self.ranges.iter().flat_map(fan).collect()
    }

    /// The caps of loops that enclose nothing, or everything but nothing: then the whole ellipsoid is
    /// added, which has no boundary.
    fn flat(&self, triangles: Vec<[u32; 3]>) -> Caps {
        let mut caps = self.caps(triangles, Vec::new());
        if self.inside_sr > TAU {
            let globe = globe(self.ellipsoid, self.first_interior);
            caps.triangles.extend(globe.triangles);
            caps.interior = globe.interior;
            caps.sag_m = caps.sag_m.max(globe.sag_m);
        }
        caps
    }

    /// Turns triangles of points, and of `interior` points after them, into triangles of the shared array.
    fn caps(&self, mut triangles: Vec<[u32; 3]>, interior: Vec<DVec3>) -> Caps {
        let boundary = self.points.len();
        let position = |point: u32| match self.shared.get(point as usize) {
            Some(&shared) => self.vertices[shared as usize],
            None => interior[point as usize - boundary] * self.ellipsoid.radii_m(),
        };
        // A triangle with two equal corners has no boundary.
        triangles.retain(|&[a, b, c]| {
            let [a, b, c] = [a, b, c].map(position);
            a != b && b != c && c != a
        });
        let sphere = |point: u32| match self.points.get(point as usize) {
            Some(&point) => point,
            None => interior[point as usize - boundary],
        };
        let mut sag = 0.0_f64;
        for triangle in &mut triangles {
            sag = sag::deeper(sag, triangle.map(sphere));
            *triangle = triangle.map(|point| match self.shared.get(point as usize) {
                Some(&shared) => shared,
                None => (self.first_interior + point as usize - boundary) as u32,
            });
        }
        for [a, b] in self.edges() {
            sag = sag.max(sag::of_chord(self.points[a], self.points[b]));
        }
        Caps {
            sag_m: sag::metres(self.ellipsoid, sag),
            interior: interior
                .iter()
                .map(|&p| p * self.ellipsoid.radii_m())
                .collect(),
            triangles,
        }
    }
}

/// Signed area of the triangle (`centre`, `a`, `b`) on the unit sphere.
fn swept_area(centre: DVec3, a: DVec3, b: DVec3) -> f64 {
    // Relative to the centre the determinant keeps its digits when all three are close.
    let volume = centre.dot((a - centre).cross(b - centre));
    let cosines = 1.0 + a.dot(b) + centre.dot(a) + centre.dot(b);
    if volume.abs() < 1e-5 * cosines {
        return 2.0 * volume / cosines;
    }
    2.0 * volume.atan2(cosines)
}
