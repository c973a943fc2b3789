//! True edges of a ring, evaluated exactly: latitude at a longitude, and nearest point.

use geographiclib_rs::{Geodesic, GeodesicLine, InverseGeodesic, capability};
use glam::DVec3;
use globefill::{EdgeKind, LonLat};

use super::figure::Figure;

/// Spacing of the samples kept of a geodesic.
const SAMPLE_M: f64 = 50_000.0;

/// One edge, monotone in longitude.
pub struct TrueEdge {
    pub from: LonLat,
    pub to: LonLat,
    /// Signed change of longitude along the edge, degrees; 0 for a meridian.
    span_deg: f64,
    lat_min_deg: f64,
    lat_max_deg: f64,
    shape: Shape,
    /// A sphere that holds the edge, ECEF.
    pub middle_m: DVec3,
    pub radius_m: f64,
}

enum Shape {
    Meridian,
    Straight,
    Rhumb {
        from_rad: f64,
        to_rad: f64,
    },
    Geodesic {
        line: Box<GeodesicLine>,
        length_m: f64,
        /// (longitude from the start, latitude), degrees, at equal distances.
        samples: Vec<(f64, f64)>,
    },
    /// The ring passes the north pole, turning from one meridian into another.
    NorthPole,
}

/// Longitude in (−180, 180], exact.
pub fn canonical_lon_deg(lon_deg: f64) -> f64 {
    let turned = lon_deg % 360.0;
    let turned = if turned > 180.0 {
        turned - 360.0
    } else if turned <= -180.0 {
        turned + 360.0
    } else {
        turned
    };
    turned + 0.0
}

/// The point with its one name: poles have longitude 0.
pub fn canonical(p: LonLat) -> LonLat {
    if p.lat_deg.abs() == 90.0 {
        LonLat::new(0.0, p.lat_deg)
    } else {
        LonLat::new(canonical_lon_deg(p.lon_deg), p.lat_deg + 0.0)
    }
}

impl TrueEdge {
    /// The edges that join two vertices as written in the input: none for a repeated vertex, two
    /// for a geodesic over a pole.
    pub fn between(figure: &Figure, kind: EdgeKind, from: LonLat, to: LonLat) -> Vec<Self> {
        let (start, end) = (canonical(from), canonical(to));
        let written_deg = to.lon_deg - from.lon_deg;
        if kind == EdgeKind::Straight {
            return Self::straight(figure, from, to).into_iter().collect();
        }
        if start == end {
            return Vec::new();
        }
        // Geodesics and rhumb lines reach a pole along the other end's meridian.
        if start.lat_deg.abs() == 90.0 {
            let start = LonLat::new(end.lon_deg, start.lat_deg);
            return vec![Self::meridian(figure, start, end)];
        }
        if end.lat_deg.abs() == 90.0 {
            let end = LonLat::new(start.lon_deg, end.lat_deg);
            return vec![Self::meridian(figure, start, end)];
        }
        if start.lon_deg == end.lon_deg {
            return vec![Self::meridian(figure, start, end)];
        }
        let span_deg = shorter_deg(written_deg);
        match kind {
            EdgeKind::Straight => unreachable!("handled above"),
            EdgeKind::Rhumb => {
                let shape = Shape::Rhumb {
                    from_rad: figure.isometric_rad(start.lat_deg),
                    to_rad: figure.isometric_rad(end.lat_deg),
                };
                vec![Self::new(figure, start, end, span_deg, shape)]
            }
            EdgeKind::Geodesic if span_deg.abs() == 180.0 => {
                let pole = 90f64.copysign(start.lat_deg + end.lat_deg);
                vec![
                    Self::meridian(figure, start, LonLat::new(start.lon_deg, pole)),
                    Self::meridian(figure, LonLat::new(end.lon_deg, pole), end),
                ]
            }
            EdgeKind::Geodesic => vec![Self::geodesic(figure, start, end, span_deg)],
        }
    }

    /// Linear in longitude and latitude as written, at the poles too; a difference of 360° goes
    /// once round.
    fn straight(figure: &Figure, from: LonLat, to: LonLat) -> Option<Self> {
        let written_deg = to.lon_deg - from.lon_deg;
        if from.lat_deg == to.lat_deg && from.lat_deg.abs() == 90.0 {
            return None;
        }
        let span_deg = if written_deg.abs() == 360.0 {
            written_deg
        } else {
            shorter_deg(written_deg)
        };
        let (start, end) = [from, to]
            .map(|p| LonLat::new(canonical_lon_deg(p.lon_deg), p.lat_deg + 0.0))
            .into();
        if span_deg == 0.0 {
            return (start != end).then(|| Self::meridian(figure, start, end));
        }
        Some(Self::new(figure, start, end, span_deg, Shape::Straight))
    }

    /// The turn at the north pole from meridian `in_deg` to `out_deg`.
    pub fn north_pole(figure: &Figure, in_deg: f64, out_deg: f64) -> Option<Self> {
        let span_deg = canonical_lon_deg(out_deg - in_deg);
        let (from, to) = (LonLat::new(in_deg, 90.0), LonLat::new(out_deg, 90.0));
        (in_deg != out_deg).then(|| Self::new(figure, from, to, span_deg, Shape::NorthPole))
    }

    fn meridian(figure: &Figure, from: LonLat, to: LonLat) -> Self {
        Self::new(figure, from, to, 0.0, Shape::Meridian)
    }

    fn geodesic(figure: &Figure, from: LonLat, to: LonLat, span_deg: f64) -> Self {
        let geodesic = Geodesic::new(figure.a_m, (figure.a_m - figure.b_m) / figure.a_m);
        let (length_m, azimuth_deg, _, _): (f64, f64, f64, f64) =
            geodesic.inverse(from.lat_deg, from.lon_deg, to.lat_deg, to.lon_deg);
        let caps = capability::LATITUDE | capability::LONGITUDE | capability::DISTANCE_IN;
        let line = GeodesicLine::new(
            &geodesic,
            from.lat_deg,
            from.lon_deg,
            azimuth_deg,
            Some(caps),
            None,
            None,
        );
        let steps = (length_m / SAMPLE_M).ceil().clamp(1.0, 2000.0) as usize;
        let samples = (0..=steps)
            .map(|k| match k {
                0 => (0.0, from.lat_deg),
                k if k == steps => (span_deg, to.lat_deg),
                k => along(&line, from, length_m * k as f64 / steps as f64),
            })
            .collect();
        let shape = Shape::Geodesic {
            line: Box::new(line),
            length_m,
            samples,
        };
        Self::new(figure, from, to, span_deg, shape)
    }

    fn new(figure: &Figure, from: LonLat, to: LonLat, span_deg: f64, shape: Shape) -> Self {
        let mut edge = Self {
            from,
            to,
            span_deg,
            lat_min_deg: from.lat_deg.min(to.lat_deg),
            lat_max_deg: from.lat_deg.max(to.lat_deg),
            shape,
            middle_m: DVec3::ZERO,
            radius_m: 0.0,
        };
        if let Shape::Geodesic { samples, .. } = &edge.shape {
            let bulge_deg = bulge_deg(figure, samples);
            for &(_, lat_deg) in samples {
                edge.lat_min_deg = edge.lat_min_deg.min(lat_deg - bulge_deg);
                edge.lat_max_deg = edge.lat_max_deg.max(lat_deg + bulge_deg);
            }
        }
        let points: Vec<DVec3> = (0..=16)
            .map(|k| figure.ecef(edge.point(figure, f64::from(k) / 16.0), 0.0))
            .collect();
        edge.middle_m = points[8];
        // Between two samples the edge is nowhere farther from both than their distance.
        let step_m = points
            .windows(2)
            .map(|w| (w[1] - w[0]).length())
            .fold(0.0, f64::max);
        edge.radius_m = step_m
            + points
                .iter()
                .map(|&p| (p - edge.middle_m).length())
                .fold(0.0, f64::max);
        edge
    }

    /// Signed change of longitude along the edge, degrees.
    pub fn span_deg(&self) -> f64 {
        self.span_deg
    }

    /// Whether the ring only turns here, at the north pole.
    pub fn is_pole_turn(&self) -> bool {
        matches!(self.shape, Shape::NorthPole)
    }

    /// Western and eastern end, canonical longitudes; the eastern one is not part of it. None for a
    /// meridian; the whole circle has equal ends.
    pub fn extent_deg(&self) -> Option<(f64, f64)> {
        let (from, to) = (self.from.lon_deg, self.to.lon_deg);
        if self.span_deg == 0.0 {
            None
        } else if self.span_deg > 0.0 {
            Some((from, to))
        } else {
            Some((to, from))
        }
    }

    fn holds_longitude(&self, lon_deg: f64) -> bool {
        match self.extent_deg() {
            None => false,
            Some((west, east)) if west < east => west <= lon_deg && lon_deg < east,
            Some((west, east)) => lon_deg >= west || lon_deg < east,
        }
    }

    /// Whether the edge crosses the meridian of `p` (canonical) north of `p`.
    pub fn crosses_north_of(&self, figure: &Figure, p: LonLat) -> bool {
        if p.lat_deg >= self.lat_max_deg && !self.is_pole_turn() || !self.holds_longitude(p.lon_deg)
        {
            return false;
        }
        p.lat_deg < self.lat_min_deg || self.latitude_exceeds(figure, p)
    }

    fn latitude_exceeds(&self, figure: &Figure, p: LonLat) -> bool {
        if let Shape::Geodesic { samples, .. } = &self.shape {
            let (k, _) = self.bracket(p.lon_deg);
            let (low, high) = (samples[k].1, samples[k + 1].1);
            let bulge_deg = bulge_deg(figure, &samples[k..=k + 1]);
            if p.lat_deg < low.min(high) - bulge_deg {
                return true;
            }
            if p.lat_deg > low.max(high) + bulge_deg {
                return false;
            }
        }
        self.latitude_at(figure, p.lon_deg) > p.lat_deg
    }

    /// Longitude from the start, in the direction of the edge, degrees.
    fn offset_deg(&self, lon_deg: f64) -> f64 {
        let offset = lon_deg - self.from.lon_deg;
        if self.span_deg > 0.0 && offset < 0.0 {
            offset + 360.0
        } else if self.span_deg < 0.0 && offset > 0.0 {
            offset - 360.0
        } else {
            offset
        }
    }

    /// Index of the sample interval that holds a longitude, and the longitude from the start.
    fn bracket(&self, lon_deg: f64) -> (usize, f64) {
        let Shape::Geodesic { samples, .. } = &self.shape else {
            unreachable!("only geodesics are sampled");
        };
        let offset_deg = self.offset_deg(lon_deg);
        let past = samples.partition_point(|s| s.0.abs() <= offset_deg.abs());
        (past.clamp(1, samples.len() - 1) - 1, offset_deg)
    }

    /// Latitude, degrees, at which the edge crosses a longitude that it holds.
    pub fn latitude_at(&self, figure: &Figure, lon_deg: f64) -> f64 {
        match &self.shape {
            Shape::NorthPole => 90.0,
            Shape::Meridian => unreachable!("a meridian has no longitude to cross"),
            Shape::Straight => {
                let t = self.offset_deg(lon_deg) / self.span_deg;
                self.from.lat_deg + (self.to.lat_deg - self.from.lat_deg) * t
            }
            Shape::Rhumb { from_rad, to_rad } => {
                let t = self.offset_deg(lon_deg) / self.span_deg;
                figure.latitude_deg(from_rad + (to_rad - from_rad) * t)
            }
            Shape::Geodesic {
                line,
                length_m,
                samples,
            } => {
                let (k, offset_deg) = self.bracket(lon_deg);
                let step_m = length_m / (samples.len() - 1) as f64;
                let range_m = (step_m * k as f64, step_m * (k + 1) as f64);
                latitude_where(figure, line, self.from, range_m, offset_deg)
            }
        }
    }

    /// The point at parameter t, 0 … 1.
    pub fn point(&self, figure: &Figure, t: f64) -> LonLat {
        let lon_deg = self.from.lon_deg + self.span_deg * t;
        match &self.shape {
            Shape::NorthPole => self.from,
            Shape::Meridian | Shape::Straight => LonLat::new(
                lon_deg,
                self.from.lat_deg + (self.to.lat_deg - self.from.lat_deg) * t,
            ),
            Shape::Rhumb { from_rad, to_rad } => LonLat::new(
                lon_deg,
                figure.latitude_deg(from_rad + (to_rad - from_rad) * t),
            ),
            Shape::Geodesic { line, length_m, .. } => {
                let (offset_deg, lat_deg) = along(line, self.from, length_m * t);
                LonLat::new(self.from.lon_deg + offset_deg, lat_deg)
            }
        }
    }

    /// Distance, metres, and parameter of the point of the edge nearest to `foot_m`.
    pub fn nearest(&self, figure: &Figure, foot_m: DVec3) -> (f64, f64) {
        let distance_m = |t: f64| (figure.ecef(self.point(figure, t), 0.0) - foot_m).length();
        let steps = (self.radius_m / 10_000.0).clamp(8.0, 4000.0) as u32;
        let (_, best) = (0..=steps)
            .map(|k| f64::from(k) / f64::from(steps))
            .map(|t| (distance_m(t), t))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .expect("there are samples");
        let step = 1.0 / f64::from(steps);
        let (mut low, mut high) = ((best - step).max(0.0), (best + step).min(1.0));
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let (mut a, mut b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        let (mut at_a, mut at_b) = (distance_m(a), distance_m(b));
        for _ in 0..90 {
            if at_a < at_b {
                (high, b, at_b) = (b, a, at_a);
                a = high - GOLDEN * (high - low);
                at_a = distance_m(a);
            } else {
                (low, a, at_a) = (a, b, at_b);
                b = low + GOLDEN * (high - low);
                at_b = distance_m(b);
            }
        }
        [0.0, 1.0, 0.5 * (low + high)]
            .into_iter()
            .map(|t| (distance_m(t), t))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .expect("three candidates")
    }
}

fn shorter_deg(mut span_deg: f64) -> f64 {
    while span_deg.abs() > 180.0 {
        span_deg -= 360.0 * span_deg.signum();
    }
    span_deg
}

/// (longitude from the start, latitude), degrees, at a distance along a geodesic.
fn along(line: &GeodesicLine, from: LonLat, distance_m: f64) -> (f64, f64) {
    let mask = capability::LATITUDE | capability::LONGITUDE | capability::LONG_UNROLL;
    let (_, lat_deg, lon_deg, ..) = line._gen_position(false, distance_m, mask);
    (lon_deg - from.lon_deg, lat_deg)
}

/// Latitude, degrees, at which a geodesic reaches a longitude, between two distances from its start:
/// Newton's method, and bisection where that would leave the range.
fn latitude_where(
    figure: &Figure,
    line: &GeodesicLine,
    from: LonLat,
    (mut low_m, mut high_m): (f64, f64),
    offset_deg: f64,
) -> f64 {
    let mask = capability::LATITUDE
        | capability::LONGITUDE
        | capability::AZIMUTH
        | capability::LONG_UNROLL;
    let mut at_m = 0.5 * (low_m + high_m);
    loop {
        let (_, lat_deg, lon_deg, azimuth_deg, ..) = line._gen_position(false, at_m, mask);
        let missing_deg = offset_deg.abs() - (lon_deg - from.lon_deg).abs();
        if missing_deg > 0.0 {
            low_m = at_m;
        } else {
            high_m = at_m;
        }
        let parallel_m = figure.ecef(LonLat::new(0.0, lat_deg), 0.0).x;
        let step_m = missing_deg.to_radians() * parallel_m / azimuth_deg.to_radians().sin().abs();
        let next_m = if at_m + step_m > low_m && at_m + step_m < high_m {
            at_m + step_m
        } else {
            0.5 * (low_m + high_m)
        };
        if (next_m - at_m).abs() < 1e-10 || step_m.abs() < 1e-10 {
            return lat_deg;
        }
        at_m = next_m;
    }
}

/// How far, degrees, a geodesic's latitude may leave the range of its samples: between two of them
/// it is a great circle's arch, of height s²·tan φ / 8R, doubled for the ellipsoid's sake; near a
/// pole no more than the spacing.
fn bulge_deg(figure: &Figure, samples: &[(f64, f64)]) -> f64 {
    let angle = SAMPLE_M / figure.b_m;
    let highest_deg = samples.iter().map(|s| s.1.abs()).fold(0.0, f64::max);
    if highest_deg > 85.0 {
        return angle.to_degrees();
    }
    (angle * angle / 4.0 * highest_deg.to_radians().tan()).to_degrees() + 1e-12
}
