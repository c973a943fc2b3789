//! What the caps cover, and whether the curves are true; without a GPU.

use glam::DVec3;
use globefill::{EdgeKind, Ellipsoid, FillMesh, MeshOptions, Region, Zone};
use proptest::{prelude::*, test_runner::RngSeed};
use rayon::prelude::*;

use crate::{
    common::{figure::Figure, zone_oracle::ZoneOracle},
    subjects::{at, subjects},
};

/// Numbers between 0 and 1, always the same.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// How often cap triangles cover a direction, those seen from behind counted negative.
fn covered(mesh: &FillMesh, normal: DVec3) -> i32 {
    let towards = mesh.ellipsoid.surface_with_normal(normal);
    let mut count = 0;
    for corners in &mesh.cap_triangles {
        let [a, b, c] = corners.map(|corner| mesh.vertices[corner as usize]);
        if (a + b + c).dot(towards) < 0.0 {
            continue;
        }
        // Relative to the point, so that small triangles keep their digits.
        let [a, b, c] = [a, b, c].map(|corner| corner - towards);
        let sides = [a.cross(b), b.cross(c), c.cross(a)].map(|side| side.dot(towards));
        if sides.iter().all(|side| *side > 0.0) {
            count += 1;
        } else if sides.iter().all(|side| *side < 0.0) {
            count -= 1;
        }
    }
    count
}

#[test]
fn what_lies_inside_is_covered_once_and_nothing_else() {
    let figure = Figure::new(Ellipsoid::WGS84);
    subjects().par_iter().for_each(|subject| {
        let tolerance_m = (0.01 * subject.least_m()).min(5.0);
        let mesh = subject.mesh(tolerance_m);
        assert_eq!(mesh.repairs, [], "{}", subject.name);
        assert_eq!(mesh.overlaps, [], "{}", subject.name);
        let oracle = ZoneOracle::new(&subject.zone, Ellipsoid::WGS84);
        let centre = mesh.pieces[0].bounds.axis * Ellipsoid::WGS84.radii_m();
        let centre = figure.geodetic(centre).0;
        let reach_m = 1.3 * mesh.pieces[0].bounds.radius_rad * 6.37e6;
        let mut random = Random(7);
        let mut judged = [0, 0];
        for index in 0..3000 {
            let point = match index % 3 {
                0 => {
                    let lat_deg = (2.0 * random.next() - 1.0).asin().to_degrees();
                    at(360.0 * random.next(), lat_deg)
                }
                1 => oracle.go(
                    centre,
                    360.0 * random.next(),
                    reach_m.min(2e7) * random.next().sqrt(),
                ),
                _ => {
                    // Beside the boundary.
                    let vertex = (random.next() * mesh.boundary.len() as f64) as usize;
                    let vertex = figure.geodetic(mesh.vertices[vertex]).0;
                    oracle.go(
                        vertex,
                        360.0 * random.next(),
                        20.0 * tolerance_m * random.next(),
                    )
                }
            };
            let outside_m = oracle.outside_m(point);
            if outside_m.abs() < 1.1 * tolerance_m {
                continue;
            }
            let inside = outside_m < 0.0;
            judged[usize::from(inside)] += 1;
            let found = covered(&mesh, figure.normal(point));
            assert_eq!(
                found,
                i32::from(inside),
                "{}: {point:?}, {outside_m} m",
                subject.name
            );
        }
        println!(
            "{}: {judged:?}, {} vertices",
            subject.name,
            mesh.vertices.len()
        );
        assert!(judged[0] > 100 && judged[1] > 100);
    });
}

/// Checks random points near a zone: covered once inside, not at all outside.
fn check_cover(zone: &Zone, mesh: &FillMesh, tolerance_m: f64, reach_m: f64, seed: u64) -> usize {
    let figure = Figure::new(Ellipsoid::WGS84);
    let oracle = ZoneOracle::new(zone, Ellipsoid::WGS84);
    let mut random = Random(seed);
    let mut judged = 0;
    for _ in 0..60 {
        let vertex = (random.next() * mesh.boundary.len() as f64) as usize;
        let vertex = figure.geodetic(mesh.vertices[vertex]).0;
        let point = oracle.go(
            vertex,
            360.0 * random.next(),
            reach_m * random.next().powi(2),
        );
        let outside_m = oracle.outside_m(point);
        if outside_m.abs() > 1.1 * tolerance_m {
            judged += 1;
            let found = covered(mesh, figure.normal(point));
            assert_eq!(
                found,
                i32::from(outside_m < 0.0),
                "{point:?}, {outside_m} m"
            );
        }
    }
    judged
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    /// Corridors that cross themselves every which way, wider than their legs are long or thin.
    #[test]
    fn corridors_are_unions(
        lon_deg in -180.0..180.0_f64,
        sin_lat in -1.0..1.0_f64,
        scale in 1.0..6.5_f64,
        thinness in 0.0..2.5_f64,
        steps in prop::collection::vec((0.0..360.0_f64, 0.0..1.0_f64), 1..9),
    ) {
        let reach_m = 10_f64.powf(scale);
        let start = at(lon_deg, sin_lat.asin().to_degrees());
        let width_m = (reach_m * 10_f64.powf(-thinness)).clamp(0.02, 3.8e6);
        let go = ZoneOracle::new(&Zone::circle(start, 1.0), Ellipsoid::WGS84);
        let mut points = vec![start];
        for &(azimuth_deg, length) in &steps {
            let next = go.go(points[points.len() - 1], azimuth_deg, reach_m * length);
            points.push(next);
        }
        let zone = Zone::corridor(points, width_m);
        let tolerance_m = (0.01 * width_m).clamp(1e-3, 5.0);
        let options = MeshOptions { tolerance_m, ..MeshOptions::default() };
        let mesh = FillMesh::build(&[zone.clone().into()], &options);
        prop_assert!(mesh.is_ok(), "{:?} {zone:?}", mesh.err());
        let mesh = mesh.unwrap();
        prop_assert!(mesh.overlaps.is_empty() && mesh.repairs.is_empty());
        check_cover(&zone, &mesh, tolerance_m, width_m, 5);
    }
}

/// Every point of the curves, at any parameter, lies on the boundary by its definition.
#[test]
fn curves_are_true() {
    subjects().par_iter().for_each(|subject| {
        let mesh = subject.mesh(5.0);
        let oracle = ZoneOracle::new(&subject.zone, Ellipsoid::WGS84);
        let mut worst_m = 0_f64;
        let mut random = Random(3);
        for curve in mesh.curves.iter().take(200) {
            let on = curve.on(&Ellipsoid::WGS84);
            for t in [0.0, random.next(), random.next(), 1.0] {
                worst_m = worst_m.max(oracle.outside_m(on.lon_lat(t)).abs());
            }
        }
        println!(
            "{}: {} curves, {worst_m:.1e} m off",
            subject.name,
            mesh.curves.len()
        );
        assert!(worst_m < 4e-6, "{}: {worst_m} m", subject.name);
    });
}

/// The sides of a ring of rhumbs keep their azimuths: along a parallel where geodesics would not.
#[test]
fn rings_of_rhumbs_follow_their_loxodromes() {
    let corners = vec![
        at(-30.0, 40.0),
        at(30.0, 40.0),
        at(20.0, 60.0),
        at(-20.0, 60.0),
    ];
    let share = |edges| {
        let region = Region::ring(corners.clone(), edges);
        let mesh = FillMesh::build(&[region], &MeshOptions::default()).expect("a good ring");
        let covers = |lon_deg: f64, lat_deg: f64| {
            covered(
                &mesh,
                Figure::new(Ellipsoid::WGS84).normal(at(lon_deg, lat_deg)),
            ) == 1
        };
        [
            covers(0.3, 40.01),
            covers(0.3, 39.99),
            covers(0.3, 59.99),
            covers(0.3, 60.01),
        ]
    };
    assert_eq!(share(EdgeKind::Rhumb), [true, false, true, false]);
    assert_eq!(share(EdgeKind::Geodesic), [false, false, true, true]);
}
