//! Zones by their definition: distances and azimuths of Karney's inverse problem, and for lines a
//! search for the nearest point. Nothing here knows a boundary curve.

use geographiclib_rs::{DirectGeodesic, Geodesic, InverseGeodesic};
use globefill::{Ellipsoid, LonLat, Zone, glam::DVec3};

use super::figure::Figure;

/// A zone that can be asked.
pub struct ZoneOracle {
    geodesic: Geodesic,
    figure: Figure,
    zone: Zone,
    legs: Vec<Leg>,
}

/// A leg of a corridor, with points on it: distance along, place, position.
struct Leg {
    from: LonLat,
    azimuth_deg: f64,
    length_m: f64,
    points: Vec<(f64, DVec3)>,
}

impl ZoneOracle {
    pub fn new(zone: &Zone, ellipsoid: Ellipsoid) -> Self {
        let mut oracle = Self {
            geodesic: Geodesic::new(ellipsoid.a_m, ellipsoid.flattening()),
            figure: Figure::new(ellipsoid),
            zone: zone.clone(),
            legs: Vec::new(),
        };
        if let Zone::Corridor { points, width_m } = zone {
            let legs = points.windows(2);
            oracle.legs = legs
                .map(|pair| oracle.leg(pair[0], pair[1], *width_m))
                .collect();
        }
        oracle
    }

    fn leg(&self, from: LonLat, to: LonLat, width_m: f64) -> Leg {
        let (length_m, azimuth_deg) = self.path(from, to);
        let count = (length_m / (0.02 * width_m)).ceil().clamp(8.0, 2000.0) as u32;
        let points = (0..=count)
            .map(|k| length_m * f64::from(k) / f64::from(count))
            .map(|along_m| {
                (
                    along_m,
                    self.figure.ecef(self.go(from, azimuth_deg, along_m), 0.0),
                )
            })
            .collect();
        Leg {
            from,
            azimuth_deg,
            length_m,
            points,
        }
    }

    /// Length and first azimuth of the shortest path.
    pub fn path(&self, from: LonLat, to: LonLat) -> (f64, f64) {
        let (length_m, azimuth_deg, _, _): (f64, f64, f64, f64) =
            self.geodesic
                .inverse(from.lat_deg, from.lon_deg, to.lat_deg, to.lon_deg);
        (length_m, azimuth_deg)
    }

    pub fn go(&self, from: LonLat, azimuth_deg: f64, distance_m: f64) -> LonLat {
        let (lat_deg, lon_deg): (f64, f64) =
            self.geodesic
                .direct(from.lat_deg, from.lon_deg, azimuth_deg, distance_m);
        LonLat::new(lon_deg, lat_deg)
    }

    /// How far a point lies outside, metres; negative inside. Beside a sector's straight sides the
    /// sign is right, the distance that on the circle.
    pub fn outside_m(&self, at: LonLat) -> f64 {
        match self.zone {
            Zone::Circle { centre, radius_m } => self.path(centre, at).0 - radius_m,
            Zone::Annulus {
                centre,
                min_m,
                max_m,
            } => {
                let (distance_m, _) = self.path(centre, at);
                (distance_m - max_m).max(min_m - distance_m)
            }
            Zone::Sector {
                centre,
                min_m,
                max_m,
                from_deg,
                to_deg,
            } => {
                let (distance_m, azimuth_deg) = self.path(centre, at);
                let wrap = |deg: f64| (deg + 180.0).rem_euclid(360.0) - 180.0;
                let sweep = (to_deg - from_deg).rem_euclid(360.0);
                let off_middle = wrap(azimuth_deg - from_deg - 0.5 * sweep).abs();
                let reach_m = 6.37e6 * (distance_m / 6.37e6).sin();
                let aside_m = (off_middle - 0.5 * sweep).to_radians() * reach_m;
                (distance_m - max_m).max(min_m - distance_m).max(aside_m)
            }
            Zone::Corridor {
                ref points,
                width_m,
            } => {
                let nearest_m = if points.len() == 1 {
                    self.path(points[0], at).0
                } else {
                    self.distance_to_line_m(at, 0.5 * width_m)
                };
                nearest_m - 0.5 * width_m
            }
        }
    }

    pub fn contains(&self, at: LonLat) -> bool {
        self.outside_m(at) <= 0.0
    }

    fn distance_to_line_m(&self, at: LonLat, half_m: f64) -> f64 {
        let position = self.figure.ecef(at, 0.0);
        let mut nearest_m = f64::INFINITY;
        for leg in &self.legs {
            let step_m = leg.points[1].0;
            let (index, chord_m) = leg
                .points
                .iter()
                .enumerate()
                .map(|(index, (_, point))| (index, point.distance(position)))
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .expect("a leg has points");
            // Clearly off: a chord is shorter than its path, and the next point no farther than a step.
            if chord_m - step_m > 1.1 * half_m.min(nearest_m) {
                nearest_m = nearest_m.min(chord_m);
                continue;
            }
            let around = leg.points[index].0;
            let distance =
                |along_m: f64| self.path(self.go(leg.from, leg.azimuth_deg, along_m), at).0;
            let (mut low, mut high) = (
                (around - 1.5 * step_m).max(0.0),
                (around + 1.5 * step_m).min(leg.length_m),
            );
            const GOLDEN: f64 = 0.618_033_988_749_894_9;
            let mut inner = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
            let mut values = inner.map(distance);
            // The distance is flat at its least: a thousandth along is a millionth across.
            while high - low > 1e-2_f64.min(1e-4 * half_m) {
                if values[0] < values[1] {
                    high = inner[1];
                    inner = [high - GOLDEN * (high - low), inner[0]];
                    values = [distance(inner[0]), values[0]];
                } else {
                    low = inner[0];
                    inner = [inner[1], low + GOLDEN * (high - low)];
                    values = [values[1], distance(inner[1])];
                }
            }
            let ends = [0.0, leg.length_m].map(distance);
            nearest_m = nearest_m
                .min(distance(0.5 * (low + high)))
                .min(ends[0])
                .min(ends[1]);
        }
        nearest_m
    }
}
