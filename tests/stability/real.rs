//! Rings written down as longitudes and latitudes, and countries: they lie where they lie.

use globefill::{EdgeKind, Inside, LonLat, Polygon, Region, countries::Dataset};

use crate::{shape::ALL_EDGES, subject::Subject};

fn at(lon_deg: f64, lat_deg: f64) -> LonLat {
    LonLat::new(lon_deg, lat_deg)
}

fn ring(points: &[(f64, f64)]) -> Vec<LonLat> {
    points.iter().map(|&(lon, lat)| at(lon, lat)).collect()
}

fn region(edges: EdgeKind, shell: &[(f64, f64)], holes: &[&[(f64, f64)]]) -> Region {
    Region {
        polygons: vec![Polygon {
            shell: ring(shell),
            holes: holes.iter().map(|hole| ring(hole)).collect(),
        }],
        edges,
        ..Default::default()
    }
}

/// Longitudes and latitudes, degrees.
type Written<'a> = &'a [(f64, f64)];

/// Rings across the antimeridian: once (round a pole), twice, and five times.
pub fn over_the_antimeridian() -> Vec<Subject> {
    let once = [(-100.0, -70.0), (20.0, -72.0), (140.0, -70.0)];
    let twice = [
        (175.0, -20.0),
        (-175.0, -21.0),
        (-174.0, -10.0),
        (176.0, -11.0),
    ];
    // The same, as written on a map that goes on to the east.
    let beyond = [
        (175.0, -20.0),
        (185.0, -21.0),
        (186.0, -10.0),
        (176.0, -11.0),
    ];
    let five_times = [
        (90.0, 60.0),
        (170.0, 60.0),
        (-170.0, 62.0),
        (170.0, 64.0),
        (-170.0, 66.0),
        (172.0, 68.0),
        (-172.0, 70.0),
        (-90.0, 70.0),
        (0.0, 65.0),
    ];
    let rings: [(&str, Written<'_>, LonLat, LonLat); 4] = [
        (
            "ring over 180° once",
            &once,
            at(180.0, -71.0),
            at(0.0, -90.0),
        ),
        (
            "ring over 180° twice",
            &twice,
            at(180.0, -20.5),
            at(180.0, -15.0),
        ),
        (
            "ring over 180° twice, eastwards",
            &beyond,
            at(180.0, -10.5),
            at(180.0, -15.0),
        ),
        (
            "ring over 180° five times",
            &five_times,
            at(180.0, 65.0),
            at(150.0, 75.0),
        ),
    ];
    let mut subjects = Vec::new();
    for (name, shell, near, centre) in rings {
        for &edges in ALL_EDGES {
            subjects.push(Subject::fixed(
                &format!("{name} ({edges:?})"),
                ("as written", near),
                &[region(edges, shell, &[])],
                centre,
                2.5e6,
            ));
        }
    }
    subjects
}

/// What GeoJSON writes as boxes: edges along ±180° and the poles that are none.
pub fn boxes() -> Vec<Subject> {
    let world = [
        (-180.0, -90.0),
        (180.0, -90.0),
        (180.0, 90.0),
        (-180.0, 90.0),
    ];
    let hole = [(179.0, 50.0), (-178.0, 50.0), (-178.0, 52.0), (179.0, 52.0)];
    let cap = [(-180.0, 60.0), (180.0, 60.0), (180.0, 90.0), (-180.0, 90.0)];
    let cap_hole = [(-30.0, 85.0), (90.0, 85.0), (-150.0, 85.0)];
    let belt = [
        (-180.0, -10.0),
        (180.0, -10.0),
        (180.0, 20.0),
        (-180.0, 20.0),
    ];
    let straight =
        |shell: &[(f64, f64)], holes: &[&[(f64, f64)]]| [region(EdgeKind::Straight, shell, holes)];
    // A shell without a boundary is the whole globe, which the oracle only knows as what lies to the left
    // of the hole walked clockwise.
    let around = Region {
        inside: Inside::LeftOfRing,
        ..region(
            EdgeKind::Straight,
            &[hole[0], hole[3], hole[2], hole[1]],
            &[],
        )
    };
    vec![
        Subject::judged_as(
            "the world less a box",
            ("edge at 180°", at(180.0, 50.0)),
            &straight(&world, &[&hole]),
            &[around],
            at(180.0, 51.0),
            2e5,
        ),
        Subject::fixed(
            "box over the pole",
            ("edge at 180°", at(180.0, 60.0)),
            &straight(&cap, &[]),
            at(0.0, 90.0),
            3e6,
        ),
        Subject::fixed(
            "box over the pole less a hole at it",
            ("edge of the hole", at(30.0, 85.0)),
            &straight(&cap, &[&cap_hole]),
            at(0.0, 90.0),
            1e6,
        ),
        Subject::fixed(
            "belt",
            ("edge at 180°", at(180.0, -10.0)),
            &straight(&belt, &[]),
            at(180.0, 5.0),
            3e6,
        ),
    ]
}

/// Countries at the pole and across the antimeridian.
pub fn countries() -> Vec<Subject> {
    let views = [
        (
            "Antarctica",
            "at the pole",
            at(20.0, -89.998),
            at(0.0, -90.0),
            2e6,
        ),
        (
            "Antarctica",
            "coast at 180°",
            at(180.0, -84.0),
            at(0.0, -90.0),
            2e6,
        ),
        ("Fiji", "Taveuni", at(180.0, -16.8), at(179.0, -17.0), 3e5),
        (
            "Russia",
            "Chukotka",
            at(180.0, 68.9),
            at(100.0, 62.0),
            3.5e6,
        ),
        ("Russia", "Wrangel", at(180.0, 71.2), at(180.0, 71.2), 1e5),
    ];
    views
        .into_iter()
        .map(|(country, place, near, centre, radius_m)| {
            let found = Dataset::Countries50m.country(country).expect("it is there");
            Subject::fixed(country, (place, near), &[found.region], centre, radius_m)
        })
        .collect()
}
