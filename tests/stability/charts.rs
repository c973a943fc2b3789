//! The oracle is judged too: on a sphere geodesics are straight in the gnomonic chart about a shape's
//! middle, where the even-odd rule is school geometry. No GPU.

use glam::{DVec2, DVec3};
use globefill::{EdgeKind, Ellipsoid, Inside};
use rayon::prelude::*;

use crate::{
    common::oracle::{Oracle, Scratch},
    placement::{PLACEMENTS, lon_lat},
    shape::{Rings, Shape, local},
    shapes,
};

/// Whether a region holds a direction of the shape's own sphere.
fn holds(shape: &Shape, polygons: &[Rings], point: DVec3) -> bool {
    polygons.iter().any(|rings| {
        let in_shell = match shape.inside {
            // What is enclosed in the chart is less than half of the sphere.
            Inside::Smaller => encloses(&rings.shell, point),
            Inside::LeftOfRing => encloses(&rings.shell, point) == winds_left(&rings.shell),
        };
        in_shell && !rings.holes.iter().any(|hole| encloses(hole, point))
    })
}

/// The side of X or −X on which all of a ring lies.
fn axis(ring: &[DVec3]) -> DVec3 {
    DVec3::X * ring[0].x.signum()
}

/// The gnomonic chart seen from outside; None for the other half of the sphere.
fn chart(axis: DVec3, point: DVec3) -> Option<DVec2> {
    let ahead = point.dot(axis);
    (ahead > 0.0).then(|| DVec2::new(point.y * axis.x, point.z) / ahead)
}

fn corners(ring: &[DVec3]) -> Vec<(DVec2, DVec2)> {
    let chart = |k: usize| chart(axis(ring), ring[k % ring.len()]).expect("rings have one half");
    (0..ring.len()).map(|k| (chart(k), chart(k + 1))).collect()
}

/// Even-odd in the chart.
fn encloses(ring: &[DVec3], point: DVec3) -> bool {
    let Some(p) = chart(axis(ring), point) else {
        return false;
    };
    let crosses = |&(a, b): &(DVec2, DVec2)| {
        (a.y > p.y) != (b.y > p.y) && a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y) > p.x
    };
    corners(ring).iter().filter(|edge| crosses(edge)).count() % 2 == 1
}

fn winds_left(ring: &[DVec3]) -> bool {
    corners(ring)
        .iter()
        .map(|(a, b)| a.perp_dot(*b))
        .sum::<f64>()
        > 0.0
}

#[test]
fn the_oracle_follows_the_documented_rules() {
    let sphere = Ellipsoid::sphere(6_371_000.0);
    let shapes = [
        shapes::great(),
        shapes::crossing(),
        shapes::thin(),
        shapes::holes(),
        shapes::many(),
    ];
    let shapes: Vec<Shape> = shapes.into_iter().flatten().collect();
    shapes.par_iter().for_each(|shape| {
        let radius_deg = shape.radius_rad().to_degrees();
        for placement in &PLACEMENTS {
            let turn = placement.globe_from_shape(shape);
            let regions = shape.placed(turn, EdgeKind::Geodesic);
            let oracle = Oracle::new(&regions, sphere);
            let mut scratch = Scratch::default();
            let mut judged = [0, 0];
            for k in 0..400 {
                // Spirals: one as large as the shape, one over the whole sphere.
                let share = (f64::from(k) + 0.5) / 400.0;
                let point = if k % 2 == 0 {
                    crate::shape::polar(137.508 * f64::from(k), 1.1 * radius_deg * share.sqrt())
                } else {
                    local(
                        137.508 * f64::from(k),
                        (2.0 * share - 1.0).asin().to_degrees(),
                    )
                };
                let found = oracle.containing(lon_lat(turn * point), &mut scratch);
                for (index, polygons) in shape.regions.iter().enumerate() {
                    let expected = holds(shape, polygons, point);
                    judged[usize::from(expected)] += 1;
                    assert_eq!(
                        found.contains(&(index as u32)),
                        expected,
                        "{} {}: region {index} at {point}",
                        shape.name,
                        placement.name
                    );
                }
            }
            assert!(judged[0] > 0, "{}: {judged:?}", shape.name);
        }
    });
}

/// A pentagram's tips are inside, its middle is not; of a bow-tie both ends are.
#[test]
fn crossing_rings_are_filled_even_odd() {
    for shape in shapes::crossing() {
        let polygons = &shape.regions[0];
        let ring = &polygons[0].shell;
        if shape.name.starts_with("pentagram") {
            assert!(!holds(&shape, polygons, DVec3::X));
            for tip in ring {
                assert!(holds(
                    &shape,
                    polygons,
                    (tip * 0.8 + DVec3::X * 0.2).normalize()
                ));
            }
        } else if shape.name.starts_with("bow-tie") {
            let middle = |a: usize, b: usize| (ring[a] + ring[b] + DVec3::X).normalize();
            assert!(holds(&shape, polygons, middle(0, 3)));
            assert!(holds(&shape, polygons, middle(1, 2)));
            assert!(!holds(&shape, polygons, middle(0, 2)));
        }
    }
}
