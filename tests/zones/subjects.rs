//! The zones that are judged.

use globefill::{Ellipsoid, FillMesh, LonLat, MeshOptions, Zone};

use crate::common::zone_oracle::ZoneOracle;

pub fn at(lon_deg: f64, lat_deg: f64) -> LonLat {
    LonLat::new(lon_deg, lat_deg)
}

/// A named zone and a point of its boundary.
pub struct Subject {
    pub name: &'static str,
    pub zone: Zone,
    pub on_boundary: LonLat,
}

impl Subject {
    pub fn new(name: &'static str, zone: Zone) -> Self {
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

    pub fn mesh(&self, tolerance_m: f64) -> FillMesh {
        let options = MeshOptions {
            tolerance_m,
            ..MeshOptions::default()
        };
        FillMesh::build(&[self.zone.clone().into()], &options).unwrap_or_else(|error| {
            panic!("{}: {error}", self.name);
        })
    }

    /// Half of the smallest extent.
    pub fn least_m(&self) -> f64 {
        match self.zone {
            Zone::Circle { radius_m, .. } => radius_m,
            Zone::Annulus { min_m, max_m, .. } => 0.5 * (max_m - min_m),
            Zone::Sector { min_m, max_m, .. } => 0.5 * (max_m - min_m),
            Zone::Corridor { width_m, .. } => 0.5 * width_m,
        }
    }
}

pub fn subjects() -> Vec<Subject> {
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
