//! Areas on the ellipsoid beside the true edges.

use std::f64::consts::TAU;

use geographiclib_rs::{Geodesic, geodesic_capability as capability};

use crate::{
    boundary::boundary_graph::{BoundaryGraph, DirectedEdge, Edge},
    boundary::lattice::{LatticePoint, POLE, TURN},
    curve::isometric::IsometricLatitude,
    curve::{CurveKind, CurveOn},
    ellipsoid::Ellipsoid,
    geodetic::LonLat,
};

/// Nodes and weights of Gauss–Legendre quadrature on −1 … 1, exact to degree 5.
const GAUSS: [(f64, f64); 3] = [
    (-0.774_596_669_241_483_4, 5.0 / 18.0),
    (0.0, 4.0 / 9.0),
    (0.774_596_669_241_483_4, 5.0 / 18.0),
];

/// Rounding of an edge's share, relative to it, and of the sum.
const SUM_ROUNDING: f64 = 8.0 * f64::EPSILON;
/// Rounding of the series for areas beside geodesics, relative to a quarter of the globe over π/2.
const SERIES_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Areas on one ellipsoid: q(φ) m² a radian of longitude lie between the equator and latitude φ.
pub(crate) struct Authalic {
    ellipsoid: Ellipsoid,
    geodesic: Geodesic,
    /// q at the north pole: a quarter of the globe's area over π/2.
    at_pole: f64,
}

/// What directed edges enclose on the cylinder −180° … 180°: sums over the edges can be added.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Enclosed {
    /// −∮ q dλ, m².
    cylinder_m2: f64,
    /// By how much rounding may have spoiled that, m².
    rounding_m2: f64,
    /// −2∮ φ dλ between the vertices, square lattice steps, exactly: decides what rounding cannot.
    plane: i128,
    /// Turns round the axis, lattice steps.
    turn: i64,
}

impl Enclosed {
    pub(crate) fn reversed(self) -> Self {
        Self {
            cylinder_m2: -self.cylinder_m2,
            rounding_m2: self.rounding_m2,
            plane: -self.plane,
            turn: -self.turn,
        }
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            cylinder_m2: self.cylinder_m2 + other.cylinder_m2,
            rounding_m2: self.rounding_m2 + other.rounding_m2,
            plane: self.plane + other.plane,
            turn: self.turn + other.turn,
        }
    }

    /// Twice the area to the left on the plane, square lattice steps, between plus and minus the
    /// whole plane. Of slivers so thin that rounding would turn them inside out its sign knows which
    /// side is left: loops have the same sense on both charts.
    fn left_on_plane(self) -> i128 {
        let whole = 4 * i128::from(TURN) * i128::from(POLE);
        let left = (self.plane + 2 * i128::from(self.turn) * i128::from(POLE)).rem_euclid(whole);
        if 2 * left > whole { left - whole } else { left }
    }

    /// Whether the point at the north pole, on the meridian just beyond 180°, lies inside.
    pub(crate) fn has_north_pole(self) -> bool {
        if self.turn == 0 && self.cylinder_m2.abs() <= self.rounding_m2 {
            return self.plane < 0;
        }
        self.turn > 0 || self.turn == 0 && self.cylinder_m2 < 0.0
    }
}

impl Authalic {
    pub(crate) fn new(ellipsoid: Ellipsoid) -> Self {
        let mut authalic = Self {
            ellipsoid,
            geodesic: Geodesic::new(ellipsoid.a_m, ellipsoid.flattening()),
            at_pole: 0.0,
        };
        authalic.at_pole = authalic.q(1.0);
        authalic
    }

    /// Area of the whole ellipsoid, m².
    pub(crate) fn globe_m2(&self) -> f64 {
        2.0 * TAU * self.at_pole
    }

    /// Area to the left of closed directed edges, m², 0 … the globe's.
    pub(crate) fn left_m2(&self, enclosed: Enclosed) -> f64 {
        let half_turns = (enclosed.turn / (TURN / 2)) as f64 * 0.5;
        let left_m2 = enclosed.cylinder_m2 + TAU * self.at_pole * half_turns;
        let left_m2 = left_m2.rem_euclid(self.globe_m2());
        let is_sliver = left_m2.min(self.globe_m2() - left_m2) <= enclosed.rounding_m2;
        match enclosed.left_on_plane().signum() {
            1 if is_sliver => 0.0,
            -1 if is_sliver => self.globe_m2(),
            _ => left_m2,
        }
    }

    /// The share of the globe to the left of closed directed edges, 0 … 1.
    pub(crate) fn left_share(&self, enclosed: Enclosed) -> f64 {
        self.left_m2(enclosed) / self.globe_m2()
    }

    /// What closed directed edges enclose; they may pass the poles.
    pub(crate) fn enclosed(&self, graph: &BoundaryGraph, edges: &[DirectedEdge]) -> Enclosed {
        let mut sum = Enclosed::default();
        for &edge in edges {
            sum = sum.plus(self.beside(&graph.walk(edge)));
        }
        sum
    }

    /// The edge's share, with the jumps in longitude at its ends where those are poles.
    pub(crate) fn beside(&self, edge: &Edge) -> Enclosed {
        let under_m2 = self.under_m2(edge);
        let series_m2 = match edge.kind {
            CurveKind::Geodesic if !is_short(edge) => SERIES_ROUNDING * self.at_pole,
            _ => 0.0,
        };
        let mut share = Enclosed {
            cylinder_m2: -under_m2,
            rounding_m2: SUM_ROUNDING * under_m2.abs() + series_m2,
            plane: -i128::from(edge.turn()) * i128::from(edge.start.lat + edge.end.lat),
            turn: edge.turn(),
        };
        // A walk through a pole jumps from the meridian it came on to the one it leaves on.
        let end = LatticePoint::new(crate::boundary::lattice::wrap(edge.end.lon), edge.end.lat);
        for (point, sign) in [(edge.start, 1), (end, -1)] {
            if point.is_pole() {
                let jump = sign * point.lon;
                let under_m2 = self.at_pole * (point.lat.signum() as f64) * radians(jump);
                share.turn += jump;
                share.cylinder_m2 -= under_m2;
                share.rounding_m2 += SUM_ROUNDING * under_m2.abs();
                share.plane -= 2 * i128::from(jump) * i128::from(point.lat);
            }
        }
        share
    }

    /// ∫ q dλ along the edge, m².
    fn under_m2(&self, edge: &Edge) -> f64 {
        if edge.turn() == 0 {
            return 0.0;
        }
        let (from, to) = (edge.start.lon_lat(), edge.end.lon_lat());
        match edge.kind {
            CurveKind::Geodesic if is_short(edge) => self.under_short_geodesic_m2(edge),
            CurveKind::Geodesic => {
                let area = capability::AREA;
                let inverse = |mask| {
                    self.geodesic._gen_inverse(
                        from.lat_deg,
                        from.lon_deg,
                        to.lat_deg,
                        to.lon_deg,
                        mask,
                    )
                };
                inverse(area).9
            }
            CurveKind::Rhumb if edge.start.lat != edge.end.lat => {
                let isometric = IsometricLatitude::new(&self.ellipsoid);
                let first = isometric.at(from.lat_deg.to_radians());
                let climb =
                    isometric.difference(from.lat_deg.to_radians(), to.lat_deg.to_radians());
                let sin = |t: f64| isometric.latitude(first + t * climb).sin();
                radians(edge.turn()) * self.mean_q(climb.abs(), sin)
            }
            CurveKind::Rhumb | CurveKind::Straight => self.under_straight_m2(edge),
            CurveKind::Circle(_) | CurveKind::Beside(_) => {
                let curve = edge.curve().on(&self.ellipsoid);
                let end = curve.lon_lat(1.0);
                self.under_run_m2(&curve, (0.0, from), (1.0, end), 0)
            }
        }
    }

    /// ∫ q dλ below the straight line between the edge's ends on the lon/lat plane, m².
    fn under_straight_m2(&self, edge: &Edge) -> f64 {
        let first = edge.start.lon_lat().lat_deg.to_radians();
        let rise = radians(edge.end.lat - edge.start.lat);
        radians(edge.turn()) * self.mean_q(rise.abs(), |t| (first + t * rise).sin())
    }

    /// The same below a geodesic of some metres: the general solution knows it to some square
    /// millimetres only, more than many a sliver has.
    ///
    /// A geodesic's latitude obeys φ″ = −sin φ cos φ − 2 tan φ φ′² by longitude, up to the flattening,
    /// which puts it above the straight line by −φ″Δλ²/12 on average.
    fn under_short_geodesic_m2(&self, edge: &Edge) -> f64 {
        let [turn, rise] = [edge.turn(), edge.end.lat - edge.start.lat].map(radians);
        let middle = 0.5 * (edge.start.lon_lat().lat_deg + edge.end.lon_lat().lat_deg);
        let (sin, cos) = middle.to_radians().sin_cos();
        let bulge = sin * turn * ((cos * turn).powi(2) + 2.0 * rise * rise) / 12.0;
        self.under_straight_m2(edge) + self.ellipsoid.b_m * self.ellipsoid.b_m * bulge
    }

    /// ∫ q dλ along a part of a curve, each end given by its parameter and place, m²: by Simpson's
    /// rule over runs so short that λ and q are quadratic.
    fn under_run_m2(
        &self,
        curve: &CurveOn,
        start: (f64, LonLat),
        end: (f64, LonLat),
        depth: u32,
    ) -> f64 {
        let middle_t = 0.5 * (start.0 + end.0);
        let middle = (middle_t, curve.lon_lat(middle_t));
        let turn_deg = end.1.lon_deg - start.1.lon_deg;
        if depth < 4 || turn_deg.abs() > 3.0 && depth < 40 {
            return self.under_run_m2(curve, start, middle, depth + 1)
                + self.under_run_m2(curve, middle, end, depth + 1);
        }
        let [q0, q1, q2] =
            [start, middle, end].map(|(_, place)| self.q(place.lat_deg.to_radians().sin()));
        let [first, second] = [
            middle.1.lon_deg - start.1.lon_deg,
            end.1.lon_deg - middle.1.lon_deg,
        ];
        // Against the middle's q: what the turn itself carries is exact then.
        let beside = (q0 - q1) * (3.0 * first - second) + (q2 - q1) * (3.0 * second - first);
        (q1 * turn_deg + beside / 6.0).to_radians()
    }

    /// Mean of q over a run of latitudes of about `length` radians, given by their sines.
    fn mean_q(&self, length: f64, sin: impl Fn(f64) -> f64) -> f64 {
        // A tenth of a radian leaves 10⁻⁹ of the part that bends.
        let parts = (length / 0.1).ceil().clamp(1.0, 1e3);
        let mut sum = 0.0;
        for part in 0..parts as u32 {
            for (node, weight) in GAUSS {
                sum += weight * self.q(sin((f64::from(part) + 0.5 + 0.5 * node) / parts));
            }
        }
        sum / parts
    }

    /// q at the latitude with the given sine, m²: b²/2·(s/(1 − e²s²) + atanh(e·s)/e), as a series.
    fn q(&self, sin: f64) -> f64 {
        let x = self.ellipsoid.eccentricity_squared() * sin * sin;
        // Σ (k+1)/(2k+1)·xᵏ; x ≤ 0.04 for the flattenings up to 1/50 that the crate promises.
        let mut sum = 0.0;
        for k in (0..12).rev() {
            let k = f64::from(k);
            sum = sum * x + (k + 1.0) / (2.0 * k + 1.0);
        }
        self.ellipsoid.b_m * self.ellipsoid.b_m * sin * sum
    }
}

/// Whether an edge spans less than 10⁻⁴°, 11 m on Earth, in longitude and latitude.
fn is_short(edge: &Edge) -> bool {
    const SHORT: u64 = TURN as u64 / 3_600_000;
    edge.turn().unsigned_abs() < SHORT && edge.start.lat.abs_diff(edge.end.lat) < SHORT
}

fn radians(lattice_steps: i64) -> f64 {
    LatticePoint::new(lattice_steps, 0)
        .lon_lat()
        .lon_deg
        .to_radians()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{curve::Curve, region::EdgeKind};

    fn left_share(kind: EdgeKind, ring: &[(f64, f64)]) -> f64 {
        let mut graph = BoundaryGraph::default();
        let edges: Vec<_> = (0..ring.len())
            .filter_map(|i| {
                let [a, b] =
                    [ring[i], ring[(i + 1) % ring.len()]].map(|(lon, lat)| LonLat::new(lon, lat));
                graph.insert_curve(&Curve::between(kind, a, b))
            })
            .collect();
        let authalic = Authalic::new(Ellipsoid::WGS84);
        authalic.left_m2(authalic.enclosed(&graph, &edges)) / authalic.globe_m2()
    }

    #[test]
    fn globe_has_the_known_area() {
        let area_m2 = Authalic::new(Ellipsoid::WGS84).globe_m2();
        assert!((area_m2 - 510_065_621_724_088.44).abs() < 1.0, "{area_m2}");
        let moon_m2 = Authalic::new(Ellipsoid::MOON).globe_m2();
        assert!((moon_m2 - 2.0 * TAU * 1_737_400.0_f64.powi(2)).abs() < 1.0);
    }

    #[test]
    fn octants_are_eighths_whatever_they_contain() {
        for kind in [EdgeKind::Geodesic, EdgeKind::Rhumb, EdgeKind::Straight] {
            // The last two edges of the octant are meridians: the pole is written on both.
            let octant = [(20.0, 0.0), (110.0, 0.0), (110.0, 90.0), (20.0, 90.0)];
            let share = left_share(kind, &octant);
            assert!((share - 0.125).abs() < 1e-9, "{kind:?} {share}");
            let reversed: Vec<_> = octant.iter().rev().copied().collect();
            assert!((left_share(kind, &reversed) - 0.875).abs() < 1e-9);
            let equator = [(0.0, 0.0), (120.0, 0.0), (-120.0, 0.0)];
            assert!((left_share(kind, &equator) - 0.5).abs() < 1e-9);
            let south = [(20.0, 0.0), (20.0, -90.0), (110.0, -90.0), (110.0, 0.0)];
            assert!((left_share(kind, &south) - 0.125).abs() < 1e-9);
        }
    }

    #[test]
    fn kinds_agree_where_they_are_close() {
        let ring: Vec<_> = (0..360)
            .map(|k| f64::from(k).to_radians().sin_cos())
            .map(|(s, c)| (179.0 + 3.0 * c, 60.0 + 2.0 * s))
            .collect();
        let geodesic = left_share(EdgeKind::Geodesic, &ring);
        assert!(geodesic < 0.001);
        for kind in [EdgeKind::Rhumb, EdgeKind::Straight] {
            assert!((left_share(kind, &ring) / geodesic - 1.0).abs() < 1e-4);
        }
    }

    /// Edges, one each, of some metres, all over the globe.
    fn short_geodesics() -> impl Iterator<Item = Edge> {
        (0..2000_i64).map(|k| {
            let lat = (k * 7_919 % 1_700 - 850) << 36;
            let start = LatticePoint::new(((k * 104_729) % 360 - 180) << 36, lat / 10 + 12_345 * k);
            let (turn, rise) = (k * 1_299_709 % 6_800_000, k * 15_485_863 % 6_800_000);
            let end = LatticePoint::new(start.lon + turn, start.lat + rise - 3_400_000);
            Edge {
                from: 0,
                to: 1,
                start,
                end,
                kind: CurveKind::Geodesic,
            }
        })
    }

    #[test]
    fn short_geodesics_have_the_area_of_long_ones() {
        for ellipsoid in [Ellipsoid::WGS84, Ellipsoid::MARS, Ellipsoid::MOON] {
            let authalic = Authalic::new(ellipsoid);
            for edge in short_geodesics() {
                let [from, to] = [edge.start, edge.end].map(LatticePoint::lon_lat);
                let general = authalic.geodesic._gen_inverse(
                    from.lat_deg,
                    from.lon_deg,
                    to.lat_deg,
                    to.lon_deg,
                    capability::AREA,
                );
                let short_m2 = authalic.under_short_geodesic_m2(&edge);
                // On a sphere the general solution is as good.
                let known_m2 = if ellipsoid.flattening() == 0.0 {
                    1e-15 * short_m2.abs()
                } else {
                    SERIES_ROUNDING * authalic.at_pole
                };
                assert!((short_m2 - general.9).abs() <= known_m2, "{edge:?}");
            }
        }
    }
}
