//! Areas on the ellipsoid beside the true edges.

use std::f64::consts::TAU;

use geographiclib_rs::{Geodesic, geodesic_capability as capability};

use crate::{
    boundary::boundary_graph::{BoundaryGraph, DirectedEdge, Edge},
    boundary::lattice::{LatticePoint, TURN},
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
    /// Turns round the axis, lattice steps.
    turn: i64,
}

impl Enclosed {
    pub(crate) fn reversed(self) -> Self {
        Self {
            cylinder_m2: -self.cylinder_m2,
            turn: -self.turn,
        }
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            cylinder_m2: self.cylinder_m2 + other.cylinder_m2,
            turn: self.turn + other.turn,
        }
    }

    /// Whether the point at the north pole, on the meridian just beyond 180°, lies inside.
    pub(crate) fn has_north_pole(self) -> bool {
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
        left_m2.rem_euclid(self.globe_m2())
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
        let mut share = Enclosed {
            cylinder_m2: -self.under_m2(edge),
            turn: edge.turn(),
        };
        // A walk through a pole jumps from the meridian it came on to the one it leaves on.
        let end = LatticePoint::new(crate::boundary::lattice::wrap(edge.end.lon), edge.end.lat);
        for (point, sign) in [(edge.start, 1), (end, -1)] {
            if point.is_pole() {
                let jump = sign * point.lon;
                share.turn += jump;
                share.cylinder_m2 -= self.at_pole * (point.lat.signum() as f64) * radians(jump);
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
            CurveKind::Rhumb | CurveKind::Straight => {
                let (first, rise) = (
                    from.lat_deg.to_radians(),
                    (to.lat_deg - from.lat_deg).to_radians(),
                );
                radians(edge.turn()) * self.mean_q(rise.abs(), |t| (first + t * rise).sin())
            }
            CurveKind::Circle(_) | CurveKind::Beside(_) => {
                let curve = edge.curve().on(&self.ellipsoid);
                let end = curve.lon_lat(1.0);
                self.under_run_m2(&curve, (0.0, from), (1.0, end), 0)
            }
        }
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
}
