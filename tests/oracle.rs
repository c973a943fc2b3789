//! The oracle against known answers: it judges the crate, so it is judged first.

mod common;

use common::{
    edge::TrueEdge,
    figure::Figure,
    oracle::{Oracle, Scratch},
};
use geographiclib_rs::{DirectGeodesic, Geodesic, InverseGeodesic};
use glam::DVec3;
use globefill::{EdgeKind, Ellipsoid, Inside, LonLat, Polygon, Region, countries::Dataset};

fn ring(points: &[(f64, f64)]) -> Vec<LonLat> {
    points.iter().map(|&(x, y)| LonLat::new(x, y)).collect()
}

fn region(edges: EdgeKind, inside: Inside, shell: Vec<LonLat>, holes: Vec<Vec<LonLat>>) -> Region {
    Region {
        polygons: vec![Polygon { shell, holes }],
        edges,
        inside,
        zones: Vec::new(),
    }
}

fn straight(points: &[(f64, f64)]) -> Region {
    region(EdgeKind::Straight, Inside::Smaller, ring(points), vec![])
}

fn oracle_of(region: &Region) -> Oracle {
    Oracle::new(std::slice::from_ref(region), Ellipsoid::WGS84)
}

fn assert_inside(region: &Region, inside: &[(f64, f64)], outside: &[(f64, f64)]) {
    let oracle = oracle_of(region);
    let holds = |&(x, y): &(f64, f64)| {
        !oracle
            .containing(LonLat::new(x, y), &mut Scratch::default())
            .is_empty()
    };
    for p in inside {
        assert!(holds(p), "{p:?} must be inside");
    }
    for p in outside {
        assert!(!holds(p), "{p:?} must be outside");
    }
}

/// Points between −1 and 1, the same on every machine.
fn pseudo_random(count: usize) -> Vec<(f64, f64)> {
    let fraction = |k: usize, ratio: f64| (k as f64 * ratio).fract() * 2.0 - 1.0;
    (1..=count)
        .map(|k| {
            (
                fraction(k, 0.754_877_666_246_693),
                fraction(k, 0.569_840_290_998_053),
            )
        })
        .collect()
}

#[test]
fn geodetic_coordinates_return() {
    for ellipsoid in [Ellipsoid::WGS84, Ellipsoid::MARS, Ellipsoid::MOON] {
        let figure = Figure::new(ellipsoid);
        let mut positions: Vec<LonLat> = pseudo_random(2000)
            .iter()
            .map(|&(x, y)| LonLat::new(180.0 * x, 90.0 * y))
            .collect();
        positions.extend(
            [-90.0, 90.0, 0.0, 1e-9, 89.999_999_9].map(|lat_deg| LonLat::new(30.0, lat_deg)),
        );
        for p in positions {
            for height_m in [-11_000.0, 0.0, 1e-3, 9_000.0, 4e8] {
                let (foot, height) = figure.geodetic(figure.ecef(p, height_m));
                let error_m = (figure.ecef(foot, 0.0) - figure.ecef(p, 0.0)).length();
                assert!(error_m < 2e-8, "{p:?} {height_m}: {error_m} m");
                assert!((height - height_m).abs() < 3e-8f64.max(1e-15 * height_m));
            }
        }
    }
}

#[test]
fn the_foot_point_is_where_the_normal_leaves() {
    let figure = Figure::new(Ellipsoid::WGS84);
    for (x, y) in pseudo_random(500) {
        let p = LonLat::new(180.0 * x, 89.9 * y);
        let surface = figure.ecef(p, 0.0);
        // The gradient of x²/a² + y²/a² + z²/b², which is the normal by definition.
        let squares = DVec3::new(figure.a_m, figure.a_m, figure.b_m).powf(2.0);
        let gradient = (surface / squares).normalize();
        assert!((gradient - figure.normal(p)).length() < 1e-15 * 8.0);
        assert!(((surface * surface / squares).element_sum() - 1.0).abs() < 1e-15 * 4.0);
    }
}

#[test]
fn straight_edges_on_49_north_are_the_parallel() {
    let box_49 = straight(&[(-120.0, 40.0), (-90.0, 40.0), (-90.0, 49.0), (-120.0, 49.0)]);
    let nano = 1e-9;
    assert_inside(
        &box_49,
        &[
            (-105.0, 49.0 - nano),
            (-119.999, 48.999),
            (-90.0 - nano, 45.0),
        ],
        &[
            (-105.0, 49.0 + nano),
            (-90.0 + nano, 45.0),
            (75.0, 45.0),
            (0.0, 90.0),
            (0.0, -90.0),
        ],
    );
    let mut geodesic = box_49.clone();
    geodesic.edges = EdgeKind::Geodesic;
    // The geodesic arches over the parallel: its middle is on the middle meridian by symmetry.
    let earth = Geodesic::wgs84();
    let (length, azimuth, _, _): (f64, f64, f64, f64) = earth.inverse(49.0, -120.0, 49.0, -90.0);
    let (top_deg, lon_deg): (f64, f64) = earth.direct(49.0, -120.0, azimuth, length / 2.0);
    assert!((lon_deg + 105.0).abs() < 1e-12 && top_deg > 49.8);
    assert_inside(
        &geodesic,
        &[(-105.0, top_deg - nano), (-105.0, 49.5)],
        &[(-105.0, top_deg + nano)],
    );
}

#[test]
fn the_antimeridian_is_an_ordinary_meridian() {
    for (west, east) in [
        (170.0, -170.0),
        (170.0, 190.0),
        (-190.0, -170.0),
        (530.0, 550.0),
    ] {
        for kind in [EdgeKind::Straight, EdgeKind::Rhumb, EdgeKind::Geodesic] {
            let mut r = straight(&[(west, -10.0), (east, -10.0), (east, 10.0), (west, 10.0)]);
            r.edges = kind;
            assert_inside(
                &r,
                &[
                    (180.0, 0.0),
                    (-180.0, 5.0),
                    (175.0, 0.0),
                    (-175.0, 0.0),
                    (540.0, 1.0),
                ],
                &[
                    (165.0, 0.0),
                    (-165.0, 0.0),
                    (0.0, 0.0),
                    (180.0, 15.0),
                    (0.0, 90.0),
                ],
            );
        }
    }
}

#[test]
fn poles_are_ordinary_points() {
    let around = [(0.0, 80.0), (90.0, 80.0), (180.0, 80.0), (-90.0, 80.0)];
    let south = around.map(|(x, y)| (x, -y));
    for kind in [EdgeKind::Straight, EdgeKind::Rhumb, EdgeKind::Geodesic] {
        let mut cap = straight(&around);
        cap.edges = kind;
        assert_inside(
            &cap,
            &[(0.0, 90.0), (123.0, 86.0)],
            &[(123.0, 70.0), (0.0, -90.0)],
        );
        let mut cap = straight(&south);
        cap.edges = kind;
        assert_inside(
            &cap,
            &[(0.0, -90.0), (9.0, -86.0)],
            &[(123.0, -70.0), (0.0, 90.0)],
        );
        // A vertex at the pole: straight edges keep its written longitude, others need none.
        let tops: &[&[f64]] = if kind == EdgeKind::Straight {
            &[&[90.0, 0.0]]
        } else {
            &[&[0.0], &[45.0], &[-100.0], &[90.0, 0.0]]
        };
        for (top, sign) in tops.iter().flat_map(|&top| [(top, 1.0), (top, -1.0)]) {
            let mut points = vec![(0.0, 60.0 * sign), (90.0, 60.0 * sign)];
            points.extend(top.iter().map(|&lon_deg| (lon_deg, 90.0 * sign)));
            let mut wedge = straight(&points);
            wedge.edges = kind;
            assert_inside(
                &wedge,
                &[(45.0, 80.0), (1.0, 89.9), (89.0, 61.5), (45.0, 89.999_999)]
                    .map(|(x, y)| (x, y * sign)),
                &[
                    (-1.0, 89.9),
                    (91.0, 80.0),
                    (180.0, 89.0),
                    (-135.0, 60.0),
                    (45.0, 30.0),
                ]
                .map(|(x, y)| (x, y * sign)),
            );
        }
    }
    assert_inside(
        &straight(&[(0.0, 60.0), (90.0, 60.0), (45.0, 90.0)]),
        &[(45.0, 89.0), (20.0, 70.0), (70.0, 70.0)],
        &[(10.0, 70.0), (80.0, 70.0), (44.0, 89.9), (-90.0, 89.9)],
    );
    // Antarctica as flat maps close it, and the whole parallel that a difference of 360° is.
    let flat = [
        (-180.0, -80.0),
        (0.0, -75.0),
        (180.0, -80.0),
        (180.0, -90.0),
        (-180.0, -90.0),
    ];
    assert_inside(
        &straight(&flat),
        &[(0.0, -90.0), (180.0, -85.0), (0.0, -76.0), (-180.0, -80.1)],
        &[(0.0, -74.0), (180.0, -79.9), (0.0, 90.0)],
    );
    let zone = [
        (-180.0, -30.0),
        (180.0, -30.0),
        (180.0, 20.0),
        (-180.0, 20.0),
    ];
    assert_inside(
        &straight(&zone),
        &[(0.0, 0.0), (180.0, 0.0), (90.0, 19.9), (-180.0, -29.9)],
        &[(0.0, 20.1), (180.0, -30.1), (0.0, 90.0), (0.0, -90.0)],
    );
    // Geodesics over a pole.
    for sign in [1.0, -1.0] {
        let mut over = straight(&[
            (0.0, 50.0 * sign),
            (180.0, 60.0 * sign),
            (90.0, 50.0 * sign),
        ]);
        over.edges = EdgeKind::Geodesic;
        assert_inside(
            &over,
            &[
                (90.0, 80.0 * sign),
                (1.0, 89.0 * sign),
                (179.0, 80.0 * sign),
            ],
            &[
                (-90.0, 80.0 * sign),
                (-1.0, 89.0 * sign),
                (90.0, 40.0 * sign),
                (0.0, -90.0 * sign),
            ],
        );
    }
}

#[test]
fn discs_hold_what_is_nearer_than_their_radius() {
    let earth = Geodesic::wgs84();
    for (lat_deg, lon_deg) in [
        (0.0, 0.0),
        (52.0, 13.0),
        (-89.0, 40.0),
        (10.0, 180.0),
        (90.0, 0.0),
    ] {
        for radius_m in [1e3, 5e5, 5e6, 9e6, 1.5e7] {
            let mut shell: Vec<LonLat> = (0..720)
                .map(|k| {
                    let (lat, lon): (f64, f64) =
                        earth.direct(lat_deg, lon_deg, -0.5 * f64::from(k), radius_m);
                    LonLat::new(lon, lat)
                })
                .collect();
            let disc = region(
                EdgeKind::Geodesic,
                Inside::LeftOfRing,
                shell.clone(),
                vec![],
            );
            let smaller = region(EdgeKind::Geodesic, Inside::Smaller, shell.clone(), vec![]);
            shell.reverse();
            let outside = region(EdgeKind::Geodesic, Inside::LeftOfRing, shell, vec![]);
            let oracle = Oracle::new(&[disc, smaller, outside], Ellipsoid::WGS84);
            let mut scratch = Scratch::default();
            for (x, y) in pseudo_random(300) {
                let (lat, lon): (f64, f64) =
                    earth.direct(lat_deg, lon_deg, 180.0 * x, radius_m * (1.0 + y));
                let s12: f64 = earth.inverse(lat_deg, lon_deg, lat, lon);
                // The polygon's edges cut the disc by up to 1 − cos 0.25°.
                if (s12 / radius_m - 1.0).abs() < 2e-5 {
                    continue;
                }
                let inside = s12 < radius_m;
                let expected = match (inside, radius_m < 1e7) {
                    (true, true) => vec![0, 1],
                    (true, false) => vec![0],
                    (false, true) => vec![2],
                    (false, false) => vec![1, 2],
                };
                assert_eq!(
                    oracle.containing(LonLat::new(lon, lat), &mut scratch),
                    expected
                );
            }
        }
    }
}

#[test]
fn holes_remove_the_side_away_from_the_shell() {
    let shell = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)];
    let hole = [(5.0, 5.0), (10.0, 5.0), (10.0, 10.0), (5.0, 10.0)];
    for reversed in [false, true] {
        let mut hole = ring(&hole);
        if reversed {
            hole.reverse();
        }
        let r = region(
            EdgeKind::Straight,
            Inside::Smaller,
            ring(&shell),
            vec![hole],
        );
        assert_inside(
            &r,
            &[(1.0, 1.0), (15.0, 15.0), (4.99, 7.0)],
            &[(7.0, 7.0), (-1.0, 7.0)],
        );
    }
    // A globe minus a hole: more than a hemisphere.
    let globe = region(
        EdgeKind::Straight,
        Inside::LeftOfRing,
        ring(&[(0.0, 0.0), (0.0, 20.0), (20.0, 20.0), (20.0, 0.0)]),
        vec![ring(&[(100.0, 50.0), (110.0, 50.0), (110.0, 60.0)])],
    );
    assert_inside(
        &globe,
        &[(-10.0, 0.0), (0.0, 90.0), (0.0, -90.0), (180.0, 0.0)],
        &[(10.0, 10.0), (109.0, 55.0)],
    );
}

#[test]
fn a_ring_that_crosses_itself_is_even_odd() {
    let bow = straight(&[(0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0)]);
    assert_inside(
        &bow,
        &[(1.0, 5.0), (9.0, 5.0)],
        &[(5.0, 8.0), (5.0, 2.0), (20.0, 5.0)],
    );
    let star: Vec<(f64, f64)> = (0..5)
        .map(|k| (f64::from(k) * 144.0f64).to_radians())
        .map(|a| (10.0 * a.cos(), 10.0 * a.sin()))
        .collect();
    assert_inside(&straight(&star), &[(8.0, 0.0)], &[(0.0, 0.0), (-9.0, 0.0)]);
}

#[test]
fn geodesics_cross_meridians_where_dense_samples_say() {
    let figure = Figure::new(Ellipsoid::WGS84);
    let earth = Geodesic::wgs84();
    let ends = pseudo_random(200);
    for pair in ends.windows(2) {
        let at = |p: (f64, f64)| LonLat::new(180.0 * p.0, 89.0 * p.1);
        let (from, to) = (at(pair[0]), at(pair[1]));
        let (length, azimuth, _, _): (f64, f64, f64, f64) =
            earth.inverse(from.lat_deg, from.lon_deg, to.lat_deg, to.lon_deg);
        let edges = TrueEdge::between(&figure, EdgeKind::Geodesic, from, to);
        assert_eq!(edges.len(), 1);
        for k in 1..100 {
            let distance_m = length * f64::from(k) / 100.0;
            let (lat, lon): (f64, f64) =
                earth.direct(from.lat_deg, from.lon_deg, azimuth, distance_m);
            let found_deg = edges[0].latitude_at(&figure, lon);
            // A steep geodesic turns a rounding of the longitude into latitude.
            let (ahead, _): (f64, f64) =
                earth.direct(from.lat_deg, from.lon_deg, azimuth, distance_m + 1e-6);
            let error_deg = (found_deg - lat).abs();
            assert!(
                error_deg < 1e-12 + 100.0 * (ahead - lat).abs(),
                "{error_deg}"
            );
            let foot_m = figure.ecef(LonLat::new(lon, lat), 0.0);
            let (off_m, _) = edges[0].nearest(&figure, foot_m);
            assert!(off_m < 1e-7, "{from:?} {to:?}: {off_m}");
        }
    }
}

#[test]
fn rhumb_lines_keep_their_azimuth() {
    let figure = Figure::new(Ellipsoid::WGS84);
    for pair in pseudo_random(100).windows(2) {
        let at = |p: (f64, f64)| LonLat::new(60.0 * p.0, 80.0 * p.1);
        let (from, to) = (at(pair[0]), at(pair[1]));
        let edge = &TrueEdge::between(&figure, EdgeKind::Rhumb, from, to)[0];
        let azimuth = |t: f64| {
            let (here, ahead) = (edge.point(&figure, t), edge.point(&figure, t + 1e-6));
            let step = figure.ecef(ahead, 0.0) - figure.ecef(here, 0.0);
            let normal = figure.normal(here);
            let east = DVec3::Z.cross(normal).normalize();
            step.dot(east).atan2(step.dot(normal.cross(east)))
        };
        for k in 1..9 {
            assert!((azimuth(0.1 * f64::from(k)) - azimuth(0.0)).abs() < 1e-5);
        }
        assert!((edge.latitude_at(&figure, to.lon_deg) - to.lat_deg).abs() < 1e-12);
    }
}

/// A millimetre to either side of any edge the answers differ: no gap, no slip, in any direction.
#[test]
fn answers_change_exactly_at_the_edge() {
    let outline: Vec<LonLat> = pseudo_random(40)
        .iter()
        .enumerate()
        .map(|(k, &(x, y))| {
            let turn = (f64::from(k as u32) * 9.0).to_radians();
            let radius = 12.0 + 6.0 * x + 2.0 * y;
            LonLat::new(radius * turn.cos(), radius * turn.sin())
        })
        .collect();
    for kind in [EdgeKind::Straight, EdgeKind::Rhumb, EdgeKind::Geodesic] {
        for (lon_deg, lat_deg) in [(10.0, 50.0), (180.0, -40.0), (0.0, 72.0)] {
            let moved = outline
                .iter()
                .map(|p| LonLat::new(lon_deg + p.lon_deg, lat_deg + 0.9 * p.lat_deg))
                .collect();
            let oracle = oracle_of(&region(kind, Inside::Smaller, moved, vec![]));
            let figure = oracle.figure;
            let mut scratch = Scratch::default();
            for edge in oracle.boundary(0) {
                for k in 1..20 {
                    let t = f64::from(k) / 20.0;
                    let at = |t: f64| figure.ecef(edge.point(&figure, t), 0.0);
                    let up = figure.normal(edge.point(&figure, t));
                    let left = up.cross(at(t + 1e-6) - at(t - 1e-6)).normalize();
                    let mut inside_at = |offset_m: f64| {
                        let p = at(t) + left * offset_m;
                        !oracle
                            .containing(figure.geodetic(p).0, &mut scratch)
                            .is_empty()
                    };
                    for offset_m in [1e-7, 1e-3, 0.1] {
                        assert_ne!(inside_at(offset_m), inside_at(-offset_m), "{kind:?} {t}");
                        let (off_m, _) = edge.nearest(&figure, at(t) + left * offset_m);
                        assert!((off_m - offset_m).abs() < 1e-8 + 1e-6 * offset_m);
                    }
                }
            }
        }
    }
}

#[test]
fn seams_are_not_boundary() {
    let flat = [
        (-180.0, -80.0),
        (0.0, -75.0),
        (180.0, -80.0),
        (180.0, -90.0),
        (-180.0, -90.0),
    ];
    let oracle = oracle_of(&straight(&flat));
    assert_eq!(oracle.boundary(0).count(), 2);
    let halves = Region {
        polygons: [0.0, 10.0]
            .map(|x| Polygon {
                shell: ring(&[(x, 0.0), (x + 10.0, 0.0), (x + 10.0, 10.0), (x, 10.0)]),
                holes: vec![],
            })
            .to_vec(),
        edges: EdgeKind::Straight,
        inside: Inside::Smaller,
        zones: Vec::new(),
    };
    assert_eq!(oracle_of(&halves).boundary(0).count(), 6);
}

/// Cities, seas and poles: what any atlas says of Natural Earth's countries.
#[test]
fn places_are_where_the_atlas_has_them() {
    for dataset in [Dataset::Countries110m, Dataset::Countries50m] {
        let countries = dataset.countries();
        let regions: Vec<Region> = countries.iter().map(|c| c.region.clone()).collect();
        let oracle = Oracle::new(&regions, Ellipsoid::WGS84);
        let mut scratch = Scratch::default();
        for (code, lon_deg, lat_deg) in [
            ("DEU", 10.45, 51.16),
            ("FRA", 2.35, 48.85),
            ("USA", -104.0, 48.99),
            ("CAN", -104.0, 49.01),
            ("USA", -150.0, 65.0),
            ("RUS", 179.9, 68.0),
            ("RUS", -175.0, 67.0),
            ("FJI", 177.9, -17.8),
            // Not −90°: the 50m source leaves a hole of 120 m about the pole.
            ("ATA", 0.0, -89.99),
            ("ATA", 180.0, -85.0),
            ("ATA", -180.0, -88.0),
            ("AUS", 133.0, -25.0),
            ("ZAF", 25.0, -31.0),
            ("LSO", 28.2, -29.5),
            ("BRA", -55.0, -10.0),
            ("JPN", 138.5, 36.2),
            ("NZL", 171.5, -43.0),
            ("ISL", -18.5, 64.9),
        ] {
            let found = oracle.containing(LonLat::new(lon_deg, lat_deg), &mut scratch);
            let codes: Vec<&str> = found
                .iter()
                .map(|&k| countries[k as usize].long_code)
                .collect();
            assert_eq!(codes, [code], "{dataset:?} at {lon_deg}, {lat_deg}");
        }
        for (lon_deg, lat_deg) in [(0.0, 90.0), (-30.0, 0.0), (-140.0, -40.0), (180.0, 0.0)] {
            let found = oracle.containing(LonLat::new(lon_deg, lat_deg), &mut scratch);
            assert!(
                found.is_empty(),
                "{dataset:?} at {lon_deg}, {lat_deg}: {found:?}"
            );
        }
    }
}
