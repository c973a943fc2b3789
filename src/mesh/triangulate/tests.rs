//! Laws that hold for every cap, tested on shapes at many places, and on random ones.

mod hostile;
mod random;
mod shapes;

use std::{collections::HashMap, f64::consts::PI, f64::consts::TAU};

use glam::{DQuat, DVec3};

use super::{Caps, Outline, sag, swept_area, triangulate};
use crate::Ellipsoid;

const ELLIPSOIDS: [Ellipsoid; 3] = [
    Ellipsoid::WGS84,
    Ellipsoid::MOON,
    Ellipsoid { a_m: 1.0, b_m: 1.2 },
];

/// Turns that bring the test shapes' middle, +x, over a pole, the antimeridian and elsewhere.
fn turns() -> Vec<DQuat> {
    vec![
        DQuat::IDENTITY,
        DQuat::from_rotation_y(-PI / 2.0),
        DQuat::from_rotation_y(PI / 2.0),
        DQuat::from_rotation_z(PI),
        DQuat::from_axis_angle(DVec3::new(0.36, 0.48, -0.8), 1.234),
    ]
}

/// The unit vector at a distance from +x, counter-clockwise from +y seen from outside.
fn polar(distance_rad: f64, azimuth_rad: f64) -> DVec3 {
    let (sin, cos) = distance_rad.sin_cos();
    let (east, north) = (azimuth_rad.cos(), azimuth_rad.sin());
    DVec3::new(cos, sin * east, sin * north)
}

/// A closed loop through `corners` with chords of at most 2°.
fn densified(corners: &[DVec3]) -> Vec<DVec3> {
    let mut points = Vec::new();
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let parts = (a.angle_between(b) / 2f64.to_radians()).ceil().max(1.0);
        let step = |k: f64| a.slerp(b, k / parts).normalize();
        points.extend((0..parts as u32).map(|k| if k == 0 { a } else { step(f64::from(k)) }));
    }
    points
}

fn circle(radius_rad: f64, corners: u32) -> Vec<DVec3> {
    let azimuth = |k| f64::from(k) * TAU / f64::from(corners);
    densified(
        &(0..corners)
            .map(|k| polar(radius_rad, azimuth(k)))
            .collect::<Vec<_>>(),
    )
}

fn reversed(mut points: Vec<DVec3>) -> Vec<DVec3> {
    points.reverse();
    points
}

fn moved(points: &[DVec3], to: DVec3) -> Vec<DVec3> {
    let turn = DQuat::from_rotation_arc(DVec3::X, to);
    points.iter().map(|&p| turn * p).collect()
}

/// Directions spread evenly over the sphere, none of them a vertex.
fn directions(count: u32) -> impl Iterator<Item = DVec3> {
    (0..count).map(move |k| {
        let sin = 1.0 - (2.0 * f64::from(k) + 1.017) / f64::from(count);
        polar(sin.acos(), 0.123_4 + f64::from(k) * 2.399_963_229_728_653)
    })
}

/// Loops on the unit sphere turned and laid on an ellipsoid, behind other vertices.
struct Case {
    ellipsoid: Ellipsoid,
    vertices: Vec<DVec3>,
    loops: Vec<Vec<u32>>,
}

impl Case {
    fn new(ellipsoid: Ellipsoid, turn: DQuat, shape: &[Vec<DVec3>]) -> Self {
        let mut vertices = vec![ellipsoid.radii_m() * DVec3::Z; 7];
        let mut loops = Vec::new();
        for points in shape {
            let first = vertices.len() as u32;
            vertices.extend(
                points
                    .iter()
                    .map(|&p| (turn * p).normalize() * ellipsoid.radii_m()),
            );
            loops.push((first..vertices.len() as u32).collect());
        }
        Self {
            ellipsoid,
            vertices,
            loops,
        }
    }

    fn caps(&self) -> Caps {
        triangulate(
            self.ellipsoid,
            &self.vertices,
            &self.loops,
            self.inside_sr(),
        )
    }

    /// Area of the inside, steradians; slivers are taken for slivers, whichever way they turn.
    fn inside_sr(&self) -> f64 {
        let outline = Outline::new(self.ellipsoid, &self.vertices, &self.loops, 0.0);
        let (centre, _) = outline.bounding_cap();
        let (mut area, mut uncertain) = (0.0, 0.0);
        for [a, b] in outline.edges() {
            let (a, b) = (outline.points[a], outline.points[b]);
            let length = a.distance(b);
            area += swept_area(centre, a, b);
            uncertain += length * f64::min(1e-6, length / 64.0);
        }
        if area < -uncertain {
            area + 2.0 * TAU
        } else {
            area
        }
    }

    /// Everything that must hold for any input: the signed boundary, the area, the reported sag.
    fn check_laws(&self) -> Caps {
        let caps = self.caps();
        self.check_boundary(&caps);
        self.check_area(&caps);
        let all = self.all_unit(&caps);
        let measured = caps
            .triangles
            .iter()
            .map(|&t| sampled_sag(t.map(|i| all[i as usize])));
        let measured = measured.fold(0.0, f64::max) * self.ellipsoid.a_m.max(self.ellipsoid.b_m);
        assert!(measured <= caps.sag_m, "{measured} {}", caps.sag_m);
        caps
    }

    /// As `check_laws`, for a proper shape: every triangle within the sag limit.
    fn check(&self) -> Caps {
        let caps = self.check_laws();
        let limit_m = sag::metres(self.ellipsoid, sag::limit());
        assert!(caps.sag_m <= limit_m, "{} of {limit_m}", caps.sag_m);
        caps
    }

    fn check_boundary(&self, caps: &Caps) {
        let mut all = self.vertices.clone();
        all.extend(&caps.interior);
        let mut sums: HashMap<[[u64; 3]; 2], i64> = HashMap::new();
        let mut add = |a: u32, b: u32, sign: i64| {
            let bits = |i: u32| all[i as usize].to_array().map(|x| (x + 0.0).to_bits());
            let (a, b) = (bits(a), bits(b));
            if a < b {
                *sums.entry([a, b]).or_default() += sign;
            } else if b < a {
                *sums.entry([b, a]).or_default() -= sign;
            }
        };
        for &[a, b, c] in &caps.triangles {
            add(a, b, 1);
            add(b, c, 1);
            add(c, a, 1);
        }
        for ring in &self.loops {
            for (k, &b) in ring.iter().enumerate() {
                add(ring[(k + ring.len() - 1) % ring.len()], b, -1);
            }
        }
        let open = sums.values().filter(|&&sum| sum != 0).count();
        assert_eq!(open, 0, "open edges");
    }

    fn all_unit(&self, caps: &Caps) -> Vec<DVec3> {
        let all = self.vertices.iter().chain(&caps.interior);
        all.map(|&p| (p / self.ellipsoid.radii_m()).normalize())
            .collect()
    }

    fn check_area(&self, caps: &Caps) {
        let all = self.all_unit(caps);
        let filled: f64 = caps
            .triangles
            .iter()
            .map(|&t| excess(t.map(|i| all[i as usize])))
            .sum();
        let ends = |ring: &Vec<u32>| {
            let previous = ring.iter().cycle().skip(ring.len().saturating_sub(1));
            let edges = previous
                .zip(ring)
                .map(|(&a, &b)| [all[a as usize], all[b as usize]]);
            edges.collect::<Vec<_>>()
        };
        let edges: Vec<_> = self.loops.iter().flat_map(ends).collect();
        let Some(&[reference, _]) = edges.first() else {
            return;
        };
        let enclosed: f64 = edges.iter().map(|&[a, b]| excess([reference, a, b])).sum();
        let turns = ((filled - enclosed) / (4.0 * PI)).round();
        let error = filled - enclosed - 4.0 * PI * turns;
        // Each term is rounded relative to its sides squared.
        let sides = |[a, b, c]: [DVec3; 3]| {
            a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a)
        };
        let corners = caps.triangles.iter().map(|t| t.map(|i| all[i as usize]));
        let swept = edges.iter().map(|&[a, b]| [reference, a, b]);
        let rounding = 1e-15 * corners.chain(swept).map(sides).sum::<f64>();
        assert!(
            error.abs() <= 1e-9 * filled.abs() + rounding,
            "{error} of {filled}"
        );
    }
}

/// Signed area of a triangle on the unit sphere.
fn excess([a, b, c]: [DVec3; 3]) -> f64 {
    let volume = a.dot((b - a).cross(c - a));
    2.0 * volume.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}

/// The depth of the deepest of many points of a flat triangle.
fn sampled_sag([a, b, c]: [DVec3; 3]) -> f64 {
    const N: u32 = 8;
    let mut deepest = 0.0_f64;
    for i in 0..=N {
        for j in 0..=N - i {
            let weights = [i, j, N - i - j].map(|k| f64::from(k) / f64::from(N));
            let point = a * weights[0] + b * weights[1] + c * weights[2];
            deepest = deepest.max(1.0 - point.length());
        }
    }
    // A corner's own rounding is no sag.
    deepest - 1e-15
}

fn for_all(shape: &[Vec<DVec3>], check: impl Fn(Case)) {
    for (turn, ellipsoid) in turns().into_iter().zip(ELLIPSOIDS.into_iter().cycle()) {
        check(Case::new(ellipsoid, turn, shape));
    }
}

/// As `for_all`, at one place only.
fn for_one(place: usize, shape: &[Vec<DVec3>], check: impl Fn(Case)) {
    let turns = turns();
    let ellipsoid = ELLIPSOIDS[place % ELLIPSOIDS.len()];
    check(Case::new(ellipsoid, turns[place % turns.len()], shape));
}

fn area_sr(case: &Case, caps: &Caps) -> f64 {
    let all = case.all_unit(caps);
    caps.triangles
        .iter()
        .map(|&t| excess(t.map(|i| all[i as usize])))
        .sum()
}
