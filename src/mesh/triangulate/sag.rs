//! How far flat triangles lie below the ellipsoid.

use glam::DVec3;

use crate::ellipsoid::Ellipsoid;

/// Angular circumradius up to which a triangle need not be refined: that of an equilateral triangle
/// with sides of 2° (and 10⁻⁴ more, so that chords of exactly 2° never ask for the impossible).
pub(super) const SAG_LIMIT_RAD: f64 = 0.020_155;

/// The sag, on the unit sphere, of a triangle of that circumradius.
pub(super) fn limit() -> f64 {
    1.0 - SAG_LIMIT_RAD.cos()
}

/// Upper bound in metres of a sag on the unit sphere.
///
/// A point r < 1 from the centre of the scaled sphere lies (1 − r) of its own radius below the
/// ellipsoid along that radius, and no radius is longer than the larger semi-axis. The small factor
/// and term cover rounding of vertices and sag.
pub(super) fn metres(ellipsoid: Ellipsoid, sag: f64) -> f64 {
    let largest_m = ellipsoid.a_m.max(ellipsoid.b_m);
    sag * largest_m * (1.0 + 1e-9) + 1e-15 * largest_m
}

/// Depth, below the unit sphere, of the middle of the chord between two of its points.
pub(super) fn of_chord(a: DVec3, b: DVec3) -> f64 {
    depth(0.25 * a.distance_squared(b))
}

/// Depth, below the unit sphere, of the deepest point of the flat triangle between three of its points.
///
/// The point of the triangle's plane nearest to the centre is its circumcentre. If that lies outside
/// (an obtuse triangle), the nearest point of the triangle is the middle of the longest side.
pub(super) fn of_triangle([a, b, c]: [DVec3; 3]) -> f64 {
    let sides = [
        b.distance_squared(c),
        c.distance_squared(a),
        a.distance_squared(b),
    ];
    let longest = sides[0].max(sides[1]).max(sides[2]);
    let sum = sides[0] + sides[1] + sides[2];
    if 2.0 * longest >= sum {
        return depth(0.25 * longest);
    }
    // 16 area² in Kahan's order is not needed: an acute triangle is never a needle at its apex.
    let sixteen_area_squared = 4.0 * (b - a).cross(c - a).length_squared();
    let circumradius_squared = sides[0] * sides[1] * sides[2] / sixteen_area_squared;
    // Rounding of a needle with two right angles must not undercut its side.
    depth(circumradius_squared.max(0.25 * longest))
}

/// The deeper of `deepest` and a triangle; quick where the triangle is small.
pub(super) fn deeper(deepest: f64, corners: [DVec3; 3]) -> f64 {
    if bound(corners) <= deepest {
        return deepest;
    }
    deepest.max(of_triangle(corners))
}

/// An upper bound of a triangle's sag. With a given longest side the equilateral one sags deepest.
fn bound([a, b, c]: [DVec3; 3]) -> f64 {
    let longest = a.distance_squared(b).max(b.distance_squared(c));
    depth(longest.max(c.distance_squared(a)) / 3.0 * (1.0 + 1e-9))
}

/// 1 − √(1 − x) without cancellation.
fn depth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x / (1.0 + (1.0 - x).sqrt())
}
