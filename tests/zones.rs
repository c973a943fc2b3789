//! Zones against their definition: distances and azimuths by Karney's inverse problem.
//!
//! All pictures: `cargo test --release --test zones -- --ignored --nocapture`

mod common;

use common::{
    camera::Pose,
    draw::IdPainter,
    figure::Figure,
    headless::gpu,
    score::BAND_PX,
    surface::{Cast, DepthKind, Surface, Terrain},
    zone_oracle::ZoneOracle,
};
use glam::{DVec2, DVec3, UVec2};
use globefill::{
    CountTechnique, EdgeKind, Ellipsoid, FillMesh, LonLat, MeshOptions, Region, RegionError, View,
    Zone, ZoneError,
};
use proptest::{prelude::*, test_runner::RngSeed};
use rayon::prelude::*;

const SIZE_PX: UVec2 = UVec2::new(320, 180);

fn at(lon_deg: f64, lat_deg: f64) -> LonLat {
    LonLat::new(lon_deg, lat_deg)
}

/// A named zone and a point of its boundary.
struct Subject {
    name: &'static str,
    zone: Zone,
    on_boundary: LonLat,
}

impl Subject {
    fn new(name: &'static str, zone: Zone) -> Self {
        let oracle = ZoneOracle::new(&zone, Ellipsoid::WGS84);
        let on_boundary = match &zone {
            Zone::Circle { centre, radius_m } => oracle.go(*centre, 70.0, *radius_m),
            Zone::Annulus { centre, min_m, .. } => oracle.go(*centre, 250.0, *min_m),
            Zone::Sector {
                centre,
                max_m,
                from_deg,
                ..
            } => oracle.go(*centre, from_deg + 20.0, *max_m),
            Zone::Corridor { points, width_m } => {
                let (length_m, azimuth_deg) = oracle.path(points[0], points[1]);
                let middle = oracle.go(points[0], azimuth_deg, 0.4 * length_m);
                let (_, back_deg) = oracle.path(middle, points[0]);
                oracle.go(middle, back_deg + 90.0, 0.5 * width_m)
            }
        };
        let off_m = oracle.outside_m(on_boundary);
        assert!(off_m.abs() < 1e-4, "{name}: {off_m}");
        Self {
            name,
            zone,
            on_boundary,
        }
    }

    fn mesh(&self, tolerance_m: f64) -> FillMesh {
        let options = MeshOptions {
            tolerance_m,
            ..MeshOptions::default()
        };
        FillMesh::build(&[self.zone.clone().into()], &options).unwrap_or_else(|error| {
            panic!("{}: {error}", self.name);
        })
    }

    /// Half of the smallest extent.
    fn least_m(&self) -> f64 {
        match self.zone {
            Zone::Circle { radius_m, .. } => radius_m,
            Zone::Annulus { min_m, max_m, .. } => 0.5 * (max_m - min_m),
            Zone::Sector { min_m, max_m, .. } => 0.5 * (max_m - min_m),
            Zone::Corridor { width_m, .. } => 0.5 * width_m,
        }
    }
}

fn subjects() -> Vec<Subject> {
    let pole_m = ZoneOracle::new(&Zone::circle(at(30.0, 80.0), 1.0), Ellipsoid::WGS84)
        .path(at(30.0, 80.0), at(0.0, 90.0))
        .0;
    let crossing = vec![at(5.0, 45.0), at(8.0, 46.0), at(7.0, 47.5), at(6.3, 44.0)];
    let zigzag = vec![
        at(178.0, -17.0),
        at(-179.0, -16.0),
        at(178.5, -15.7),
        at(-178.0, -14.0),
    ];
    let over_the_pole = vec![at(10.0, 85.0), at(-160.0, 86.0), at(100.0, 80.0)];
    let triangle = vec![at(0.0, 0.0), at(3.0, 0.0), at(1.0, 2.0), at(0.0, 0.0)];
    let track = (0..40)
        .map(|k| f64::from(k) * 0.05)
        .map(|x| at(20.0 + x, 60.0 + 0.3 * (3.0 * x).sin()))
        .collect();
    let there_and_beyond = vec![at(-70.0, -30.0), at(60.0, 20.0), at(140.0, -50.0)];
    vec![
        Subject::new("circle", Zone::circle(at(11.0, 47.0), 1e5)),
        Subject::new("circle round the pole", Zone::circle(at(40.0, 89.7), 1e5)),
        Subject::new("circle about the pole", Zone::circle(at(40.0, -90.0), 7e5)),
        Subject::new(
            "circle through the pole",
            Zone::circle(at(30.0, 80.0), pole_m),
        ),
        Subject::new(
            "circle over the antimeridian",
            Zone::circle(at(180.0, -17.0), 3e5),
        ),
        Subject::new("hemisphere", Zone::circle(at(-60.0, 30.0), 1.0e7)),
        Subject::new("all but a cap", Zone::circle(at(120.0, -35.0), 1.9e7)),
        Subject::new("tiny circle", Zone::circle(at(-179.999_999_9, 51.5), 0.1)),
        Subject::new("annulus", Zone::annulus(at(24.0, 60.0), 5e4, 1.5e5)),
        Subject::new("great annulus", Zone::annulus(at(100.0, 5.0), 3e6, 1.4e7)),
        Subject::new("sector", Zone::sector(at(2.0, 49.0), 2e4, 2e5, 300.0, 45.0)),
        Subject::new("pie", Zone::sector(at(179.5, 66.0), 0.0, 8e5, 170.0, 100.0)),
        Subject::new(
            "great sector",
            Zone::sector(at(-70.0, -20.0), 0.0, 1.5e7, 10.0, 80.0),
        ),
        Subject::new(
            "leg",
            Zone::corridor(vec![at(8.0, 50.0), at(13.4, 52.5)], 2e4),
        ),
        Subject::new("crossing corridor", Zone::corridor(crossing, 3e4)),
        Subject::new("zigzag", Zone::corridor(zigzag, 4e4)),
        Subject::new("corridor over the pole", Zone::corridor(over_the_pole, 1e5)),
        Subject::new("closed corridor", Zone::corridor(triangle, 5e4)),
        Subject::new("wide track", Zone::corridor(track, 3e4)),
        Subject::new("long corridor", Zone::corridor(there_and_beyond, 2.5e6)),
    ]
}

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

/// Wrong pixels of one view: those whose answer differs from the definition's, though it is the same
/// all round the pixel's centre at 1/32 px and one unit of depth.
fn wrong_pixels(subject: &Subject, mesh: &FillMesh, pose: Pose, terrain: Terrain) -> usize {
    let Some(gpu) = gpu() else { return 0 };
    let figure = Figure::new(Ellipsoid::WGS84);
    let oracle = ZoneOracle::new(&subject.zone, Ellipsoid::WGS84);
    let cast = Cast::new(&figure, &pose, SIZE_PX, 1, terrain);
    let surface = Surface::new(&cast, DepthKind::Reversed);
    let mut painter = IdPainter::new(gpu, mesh.clone(), &surface, CountTechnique::Winding);
    let picture = painter.draw(gpu, &mut View::default(), &surface, 0.0);
    let lens = &surface.lens;
    let covers = |point_m: DVec3| oracle.contains(figure.geodetic(point_m).0);
    let verdicts: Vec<(bool, bool)> = (0..surface.pixel_count())
        .into_par_iter()
        .map(|pixel| {
            let drawn = picture.ids[pixel] != 0;
            let Some(point_m) = surface.points_m[pixel] else {
                return (false, drawn);
            };
            let expected = covers(point_m);
            if drawn == expected || surface.at_discontinuity(pixel) {
                return (expected, false);
            }
            let width = SIZE_PX.x as usize;
            let centre_px = DVec2::new((pixel % width) as f64, (pixel / width) as f64) + 0.5;
            let up = figure.normal(figure.geodetic(point_m).0);
            let band_px = BAND_PX + lens.depth_unit_px(centre_px, surface.depths[pixel], up);
            let differs = |k: u32| {
                let around = DVec2::from_angle(f64::from(k) * std::f64::consts::TAU / 32.0);
                let ray = lens.ray(centre_px + band_px * around);
                let hit = terrain.hit(&figure, lens.eye_m, ray);
                hit.is_some_and(|t| covers(lens.eye_m + ray * t) != expected)
            };
            (expected, !(0..32).any(differs))
        })
        .collect();
    let inside = verdicts.iter().filter(|verdict| verdict.0).count();
    let wrong: Vec<usize> = (0..verdicts.len()).filter(|&k| verdicts[k].1).collect();
    println!(
        "{} from {:.1} m, pitch {}, {terrain:?}: {inside} inside, {} wrong; {:?}",
        subject.name,
        pose.height_m,
        pose.pitch_deg,
        wrong.len(),
        picture.stats
    );
    for &pixel in wrong.iter().take(4) {
        let point = figure
            .geodetic(surface.points_m[pixel].unwrap_or_default())
            .0;
        println!(
            "  {}, {}: {} m outside",
            pixel % 320,
            pixel / 320,
            oracle.outside_m(point)
        );
    }
    wrong.len()
}

/// Azimuth of the boundary: square to where the distance grows.
fn along_boundary_deg(subject: &Subject) -> f64 {
    let oracle = ZoneOracle::new(&subject.zone, Ellipsoid::WGS84);
    let step_m = (0.01 * subject.least_m()).min(1e3);
    let outside_m = |deg| oracle.outside_m(oracle.go(subject.on_boundary, deg, step_m));
    let north = outside_m(0.0) - outside_m(180.0);
    let east = outside_m(90.0) - outside_m(270.0);
    east.atan2(north).to_degrees() + 90.0
}

fn check_pictures(subject: &Subject, heights_m: &[f64], terrains: &[Terrain]) {
    let mesh = subject.mesh(5.0);
    let mut wrong = 0;
    let over = subject.on_boundary;
    for &terrain in terrains {
        let ground_m = terrain.height_m(Figure::new(Ellipsoid::WGS84).normal(over));
        for &height_m in heights_m {
            let pose = Pose::nadir(over.lon_deg, over.lat_deg, ground_m + height_m);
            wrong += wrong_pixels(subject, &mesh, pose, terrain);
            if height_m < 1e6 {
                let heading_deg = along_boundary_deg(subject) + 15.0;
                wrong += wrong_pixels(subject, &mesh, pose.turned(heading_deg, -12.0), terrain);
            }
        }
    }
    assert_eq!(wrong, 0, "{}", subject.name);
}

const PLATEAU: Terrain = Terrain::Plateau { height_m: 4000.0 };
const HEIGHTS_M: [f64; 6] = [1.0, 100.0, 1e4, 1e6, 2e7, 4e8];

#[test]
fn nothing_is_wrong_over_a_circle() {
    let circle = Subject::new("circle", Zone::circle(at(11.0, 47.0), 1e5));
    check_pictures(&circle, &HEIGHTS_M, &[Terrain::Bare, PLATEAU]);
}

#[test]
fn nothing_is_wrong_over_a_corridor() {
    let line = vec![at(5.0, 45.0), at(8.0, 46.0), at(7.0, 47.5), at(6.3, 44.0)];
    let corridor = Subject::new("crossing corridor", Zone::corridor(line, 3e4));
    check_pictures(&corridor, &[1.0, 1e3, 8e5], &[Terrain::Bare]);
}

#[test]
fn nothing_is_wrong_over_a_tiny_circle() {
    let tiny = Subject::new("tiny circle", Zone::circle(at(-179.999_999_9, 51.5), 0.1));
    check_pictures(&tiny, &[0.5, 2.0, 100.0], &[Terrain::Bare]);
}

#[test]
#[ignore = "minutes; see the head of this file"]
fn nothing_is_wrong_over_any_zone() {
    for subject in subjects() {
        check_pictures(
            &subject,
            &HEIGHTS_M,
            &[Terrain::Bare, PLATEAU, Terrain::Rough],
        );
    }
}

fn refusal(zone: Zone) -> ZoneError {
    assert!(zone.check(&Ellipsoid::WGS84).is_err(), "{zone:?}");
    match FillMesh::build(&[zone.into()], &MeshOptions::default()) {
        Err(RegionError::Zone { error, .. }) => error,
        other => panic!("{:?}", other.map(|mesh| mesh.arcs.len())),
    }
}

#[test]
fn what_means_nothing_is_refused() {
    let here = at(10.0, 50.0);
    for radius_m in [f64::NAN, -1.0, 0.0, 1e-3, 1.99e7, f64::INFINITY] {
        assert!(matches!(
            refusal(Zone::circle(here, radius_m)),
            ZoneError::Range { .. }
        ));
        let width_m = 2.0 * radius_m;
        let line = vec![here, at(11.0, 50.0)];
        assert!(matches!(
            refusal(Zone::corridor(line, width_m)),
            ZoneError::Range { .. }
        ));
    }
    for position in [
        at(f64::NAN, 0.0),
        at(0.0, 91.0),
        at(0.0, f64::NAN),
        at(f64::INFINITY, 0.0),
    ] {
        assert!(matches!(
            refusal(Zone::circle(position, 1e3)),
            ZoneError::Position { .. }
        ));
        let line = vec![here, position];
        let error = refusal(Zone::corridor(line, 1e3));
        assert!(matches!(error, ZoneError::Position { point: 1, .. }));
    }
    let upside_down = Zone::annulus(here, 2e3, 1e3);
    assert!(matches!(refusal(upside_down), ZoneError::EmptyRange { .. }));
    assert!(matches!(
        refusal(Zone::annulus(here, -1.0, 1e3)),
        ZoneError::Range { .. }
    ));
    for (from_deg, to_deg) in [(f64::NAN, 1.0), (1.0, f64::INFINITY), (0.0, 1e-12)] {
        let sector = Zone::sector(here, 0.0, 1e3, from_deg, to_deg);
        assert!(matches!(refusal(sector), ZoneError::Azimuths { .. }));
    }
    assert_eq!(
        refusal(Zone::corridor(Vec::new(), 1e3)),
        ZoneError::NoPoints
    );
    let antipodal = vec![at(0.0, 10.0), at(90.0, 0.0), at(-90.1, 0.1)];
    assert_eq!(
        refusal(Zone::corridor(antipodal, 1e3)),
        ZoneError::AntipodalLeg { leg: 1 }
    );
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
