//! Ear clipping for small single loops.

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};

use super::chart::Chart;

/// Triangles, as indices of `points`, whose signed boundary is the loop through `points`.
///
/// Quadratic for ordinary loops. Any corner may be cut off without harm to the boundary, so where a
/// loop crosses itself and no proper ear is left, one is cut anyway.
pub(super) fn ear_clip(chart: &Chart, points: &[DVec3]) -> Vec<[u32; 3]> {
    let plane: Vec<DVec2> = points.iter().map(|&p| chart.project(p)).collect();
    let mut left: Vec<u32> = (0..points.len() as u32).collect();
    let mut triangles = Vec::with_capacity(points.len());
    let mut at = 0;
    while left.len() > 3 {
        let ear = (0..left.len())
            .map(|k| (at + k) % left.len())
            .find(|&corner| is_ear(&plane, &left, corner));
        let corner = ear.unwrap_or(at % left.len());
        triangles.push(corners(&left, corner));
        left.remove(corner);
        // Going on behind the next corner avoids fans of needles.
        at = (corner + 1) % left.len();
    }
    if let &[a, b, c] = left.as_slice() {
        triangles.push([a, b, c]);
    }
    triangles
}

/// A corner between its neighbours.
fn corners(left: &[u32], corner: usize) -> [u32; 3] {
    let before = left[(corner + left.len() - 1) % left.len()];
    let after = left[(corner + 1) % left.len()];
    [before, left[corner], after]
}

/// Whether the corner is convex and no other vertex lies in its triangle.
fn is_ear(plane: &[DVec2], left: &[u32], corner: usize) -> bool {
    let [a, b, c] = corners(left, corner).map(|i| plane[i as usize]);
    let low = a.min(b).min(c);
    let high = a.max(b).max(c);
    turn(a, b, c) > 0.0
        && left.iter().map(|&i| plane[i as usize]).all(|p| {
            p.cmplt(low).any()
                || p.cmpgt(high).any()
                || (p == a || p == b || p == c)
                || turn(a, b, p) < 0.0
                || turn(b, c, p) < 0.0
                || turn(c, a, p) < 0.0
        })
}

/// Positive where a → b → c turns left, exactly.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}
