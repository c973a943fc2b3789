//! How far a curve may lie beside the wall drawn for a piece of it.

use super::{Course, Curve, CurveOn};
use crate::ellipsoid::Ellipsoid;

/// Bounds are not sharpened below this, metres.
const COARSE_M: f64 = 0.02;

impl CurveOn {
    /// Upper bound, metres, on the distance along the surface between the true curve on
    /// `t0` … `t1` and the wall drawn for it, the ruled surface through the chord whose ruling at
    /// either end is the geodetic normal there.
    ///
    /// Infinite where a piece is too long to say: more than 90° of longitude or arc. Proven for
    /// flattenings up to 1/50. Seldom more than twice the true deviation plus 0.02 m; the latter
    /// falls with the cube of the piece's length below 0.3°.
    ///
    /// *Proof.* Let f be the distance from the plane through the chord that holds the mean normal,
    /// and p the quartic through f at 0, ¼, ½, ¾, 1 of the piece. As f vanishes at both ends,
    /// p = x(1−x)·q with q quadratic, so |p| ≤ ¼·max|Bernstein coefficients of q|; and |f − p| ≤
    /// max|f⁽⁵⁾|/5!·0.00355, the last factor being the maximum of |x(x−¼)(x−½)(x−¾)(x−1)|. Short
    /// pieces make do with the parabola through f at 0, ½, 1 and max|f‴|/3!·0.0482. The
    /// derivatives are bounded per kind in `derivative_bound`. To this the twist of the ruled
    /// surface out of that plane is added, up to the height where it meets the ellipsoid.
    pub fn deviation_bound_m(&self, t0: f64, t1: f64) -> f64 {
        let (start, end) = (self.ecef(t0), self.ecef(t1));
        let start_normal = self.ellipsoid.normal_at_surface(start);
        let end_normal = self.ellipsoid.normal_at_surface(end);
        let chord = end - start;
        let across = chord.cross(start_normal + end_normal);
        let share = t1 - t0;
        let too_long =
            self.curve.turn_deg.abs() * share > 90.0 || start_normal.dot(end_normal) < 0.0;
        if too_long || across.length_squared() == 0.0 {
            return f64::INFINITY;
        }
        let across = across.normalize();

        let distance_at = |x: f64| (self.ecef(t0 + x * share) - start).dot(across);
        let middle_m = distance_at(0.5);
        let cubic_m = self.derivative_bound(share, 3) * (0.048_2 / 6.0);
        let beside_plane_m = if cubic_m < COARSE_M {
            middle_m.abs() + cubic_m
        } else {
            let q = [
                distance_at(0.25) / 0.1875,
                middle_m / 0.25,
                distance_at(0.75) / 0.1875,
            ];
            let (first, last) = (
                3.0 * q[0] - 3.0 * q[1] + q[2],
                q[0] - 3.0 * q[1] + 3.0 * q[2],
            );
            let middle = 2.0 * q[1] - 0.5 * (first + last);
            let quartic_m = 0.25 * first.abs().max(middle.abs()).max(last.abs());
            quartic_m + self.derivative_bound(share, 5) * (0.003_55 / 120.0)
        };

        let sag_m = self.ellipsoid.chord_sag_m(chord.length());
        let twist_m = 0.5 * (end_normal - start_normal).dot(across).abs() * sag_m;
        // Rounding of positions, amplified by the extrapolation to the ends.
        let rounding_m = self.end_rounding_m();
        let tilt = start_normal
            .dot(across)
            .abs()
            .max(end_normal.dot(across).abs());
        (beside_plane_m + twist_m + rounding_m) * 1.001 / (1.0 - tilt * tilt).sqrt()
    }

    /// How far, metres, the ends may lie beside the curve.
    pub(crate) fn end_rounding_m(&self) -> f64 {
        match &self.course {
            // By as much as vertices are rounded.
            Course::Circle(_) | Course::Beside(_) => 4e-13 * self.ellipsoid.a_m,
            _ => 1e-14 * self.ellipsoid.a_m,
        }
    }

    /// Bound, metres, on the length of the position's third or fifth derivative by x, which runs
    /// from 0 to 1 over a `share` of the curve.
    pub(crate) fn derivative_bound(&self, share: f64, order: i32) -> f64 {
        let Curve {
            from, to, turn_deg, ..
        } = self.curve;
        let a_m = self.ellipsoid.a_m.max(self.ellipsoid.b_m);
        let turn = (turn_deg * share).to_radians().abs();
        match &self.course {
            // On the unit sphere the components are sums of sines and cosines of λ ± φ: each
            // derivative brings at most one factor |Δλ| + |Δφ|, and the three components together
            // √2. The ellipsoid adds e²/8·3⁵ at the third harmonic; 3 covers both up to f = 1/50.
            Course::Linear => {
                let rise = ((to.lat_deg - from.lat_deg) * share).to_radians().abs();
                3.0 * a_m * (turn + rise).powi(order)
            }
            // (sech ψ cos λ, sech ψ sin λ, tanh ψ) is analytic in |Im ψ| < π/2. On the circle of
            // radius 1/(|Δλ| + |Δψ|) about x it stays below 4.1 (|sech|, |tanh| ≤ 1/cos 1 = 1.85,
            // √(|cos|² + |sin|²) ≤ 1.94), on the ellipsoid below 8; Cauchy's inequality does the rest.
            Course::Rhumb(rhumb) => {
                let climb = (rhumb.difference * share).abs();
                let factorial = if order == 3 { 6.0 } else { 120.0 };
                factorial * 8.0 * a_m * (turn + climb).powi(order)
            }
            // On the sphere (s/R)ⁿ; what the ellipsoid adds is of the order e².
            Course::Geodesic(geodesic) => {
                let b_m = self.ellipsoid.a_m.min(self.ellipsoid.b_m);
                3.0 * a_m * (geodesic.length_m * share / b_m).powi(order)
            }
            Course::Circle(circle) => {
                circle_derivative_m(&self.ellipsoid, circle.radius_m(), order)
                    * (circle.sweep_deg * share).to_radians().abs().powi(order)
            }
            // On the sphere a circle of radius R·cos(h/R) about the geodesic's poles, R·(s/R)ⁿ at
            // most; for distances h up to 0.3 R the ellipsoid adds what it adds to geodesics.
            Course::Beside(beside) => {
                let b_m = self.ellipsoid.a_m.min(self.ellipsoid.b_m);
                3.0 * a_m * (beside.length_m * share / b_m).abs().powi(order)
            }
        }
    }
}

/// Bound, metres, on the length of the third or fifth derivative of a circle's position by azimuth.
///
/// On the sphere R·sin(r/R). In the tangent plane, that is to the first order in σ = r/b, a circle
/// of the ellipsoid is a circle too; what the ellipsoid adds is of the order e²σ², and analytic in
/// the azimuth: on circles of radius 1 about it, where |sin|, |cos| ≤ cosh 1, it stays below
/// e²·a·σ²/2, and Cauchy's inequality brings n! for its derivatives. (That constant is not derived
/// but found, with a margin of two or more for large radii; a test holds the
/// whole bound against Fourier series of circles of all sizes up to a flattening of 1/50.)
fn circle_derivative_m(ellipsoid: &Ellipsoid, radius_m: f64, order: i32) -> f64 {
    let a_m = ellipsoid.a_m.max(ellipsoid.b_m);
    let arc = radius_m / ellipsoid.a_m.min(ellipsoid.b_m);
    let factorial = if order == 3 { 6.0 } else { 120.0 };
    let added = 0.5 * factorial * ellipsoid.eccentricity_squared().abs() * arc * arc;
    1.01 * a_m * (arc.sin().max(0.0) + added)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::{prelude::*, test_runner::RngSeed};

    use super::*;
    use crate::{
        curve::{
            Beside, Circle, CurveKind,
            beside::{arrive, geodesics},
        },
        geodetic::LonLat,
        region::EdgeKind,
        zone::{WIDEST_HALF, greatest_range_m},
    };

    const KINDS: [EdgeKind; 3] = [EdgeKind::Geodesic, EdgeKind::Rhumb, EdgeKind::Straight];

    /// Distance along the surface from `point` to the ruled wall, found by search: the level line
    /// of the wall at the height of `point`'s horizon is scanned for its nearest point.
    fn distance_to_wall_m(ellipsoid: &Ellipsoid, start: DVec3, end: DVec3, point: DVec3) -> f64 {
        let [n0, n1, up] = [start, end, point].map(|p| ellipsoid.normal_at_surface(p));
        let distance = |u: f64| {
            let foot = start.lerp(end, u);
            let ruling = n0.lerp(n1, u);
            let on_wall = foot + ruling * ((point - foot).dot(up) / ruling.dot(up));
            (on_wall - point).length()
        };
        let (mut low, mut high) = (-0.1, 1.1);
        for _ in 0..90 {
            let (left, right) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if distance(left) < distance(right) {
                high = right
            } else {
                low = left
            }
        }
        distance(0.5 * (low + high))
    }

    fn check_deviation_bound(ellipsoid: &Ellipsoid, curve: Curve, t0: f64, t1: f64) {
        let on = curve.on(ellipsoid);
        let bound_m = on.deviation_bound_m(t0, t1);
        if bound_m.is_infinite() {
            return;
        }
        let (start, end) = (on.ecef(t0), on.ecef(t1));
        let mut worst_m = 0.0_f64;
        for step in 1..64 {
            let point = on.ecef(t0 + (t1 - t0) * f64::from(step) / 64.0);
            worst_m = worst_m.max(distance_to_wall_m(ellipsoid, start, end, point));
        }
        assert!(
            worst_m <= bound_m + 2e-8,
            "{curve:?} {t0} {t1}: {worst_m} > {bound_m}"
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

        #[test]
        fn deviation_stays_below_its_bound(
            kind in 0_usize..3,
            mars in any::<bool>(),
            from in (-180.0..180.0_f64, -1.0..1.0_f64),
            way in (-1.0..1.0_f64, -1.0..1.0_f64),
            shrink in 0.0..5.0_f64,
            polar in any::<bool>(),
            t in (0.0..1.0_f64, 0.0..1.0_f64),
        ) {
            let ellipsoid = if mars { Ellipsoid::MARS } else { Ellipsoid::WGS84 };
            let reach_deg = 30.0 * 10_f64.powf(-shrink);
            let lat_deg = if polar {
                90.0_f64.copysign(from.1) * (1.0 - 10_f64.powf(-6.0 * from.1.abs()))
            } else {
                80.0 * from.1
            };
            let turn_deg = if polar { 80.0 * way.0 } else { reach_deg * way.0 };
            let rise_deg = if polar { (90.0 - lat_deg.abs()) * 0.9 * way.1 } else { reach_deg * way.1 };
            let curve = Curve::between(
                KINDS[kind],
                LonLat::new(from.0, lat_deg),
                LonLat::new(from.0 + turn_deg, (lat_deg + rise_deg).clamp(-90.0, 90.0)),
            );
            check_deviation_bound(&ellipsoid, curve, 0.0, 1.0);
            check_deviation_bound(&ellipsoid, curve, t.0.min(t.1), t.0.max(t.1));
        }

    }

    const OBLATE: Ellipsoid = Ellipsoid {
        a_m: 6.0e6,
        b_m: 5.88e6,
    };
    const PROLATE: Ellipsoid = Ellipsoid {
        a_m: 5.88e6,
        b_m: 6.0e6,
    };
    const FIGURES: [Ellipsoid; 4] = [Ellipsoid::WGS84, Ellipsoid::MARS, OBLATE, PROLATE];

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

        /// The derivatives by azimuth, from the Fourier series of the whole circle.
        #[test]
        fn derivatives_of_circles_stay_below_their_bound(
            figure in 0_usize..4,
            sin_lat in -1.0..1.0_f64,
            share in 0.0..1.0_f64,
            shrink in 0.0..7.0_f64,
        ) {
            const COUNT: usize = 48;
            let ellipsoid = FIGURES[figure];
            let centre = LonLat::new(20.0, sin_lat.asin().to_degrees());
            let least = if shrink < 1.0 { share } else { 10_f64.powf(-shrink) };
            let radius_m = greatest_range_m(&ellipsoid) * least;
            let geodesic = geodesics(&ellipsoid);
            let points: Vec<DVec3> = (0..COUNT)
                .map(|k| 360.0 * k as f64 / COUNT as f64)
                .map(|azimuth| arrive(&geodesic, centre, azimuth, radius_m))
                .map(|arrival| ellipsoid.ecef(arrival.position, 0.0))
                .collect();
            for order in [3, 5] {
                let bound_m = circle_derivative_m(&ellipsoid, radius_m, order);
                // Harmonics up to 9: what is beyond is rounding.
                let mut harmonics = Vec::new();
                for n in 1..10_usize {
                    let (mut even, mut odd) = (DVec3::ZERO, DVec3::ZERO);
                    for (k, point) in points.iter().enumerate() {
                        let angle = std::f64::consts::TAU * (n * k) as f64 / COUNT as f64;
                        even += *point * angle.cos() * (2.0 / COUNT as f64);
                        odd += *point * angle.sin() * (2.0 / COUNT as f64);
                    }
                    harmonics.push((n as f64, even, odd));
                }
                for step in 0..180 {
                    let azimuth = f64::from(2 * step).to_radians();
                    // Odd derivatives of sine and cosine, up to a common sign.
                    let derivative: DVec3 = harmonics
                        .iter()
                        .map(|&(n, even, odd)| {
                            let (sin, cos) = (n * azimuth).sin_cos();
                            (odd * cos - even * sin) * n.powi(order)
                        })
                        .sum();
                    let rounding_m = 2e-4;
                    prop_assert!(derivative.length() <= bound_m + rounding_m, "{} > {bound_m} at {radius_m}", derivative.length());
                }
            }
        }

        /// The derivatives along, from differences over a tenth of a radian.
        #[test]
        fn derivatives_beside_geodesics_stay_below_their_bound(
            figure in 0_usize..4,
            sin_lat in -1.0..1.0_f64,
            azimuth_deg in 0.0..360.0_f64,
            aside in -1.0..1.0_f64,
        ) {
            let ellipsoid = FIGURES[figure];
            let start = LonLat::new(20.0, sin_lat.asin().to_degrees());
            let geodesic = geodesics(&ellipsoid);
            let arrive = |from, azimuth_deg, m| arrive(&geodesic, from, azimuth_deg, m);
            let b_m = ellipsoid.a_m.min(ellipsoid.b_m);
            let right_m = WIDEST_HALF * b_m * aside;
            let at = |arc: f64| {
                let foot = arrive(start, azimuth_deg, arc * b_m);
                let point = arrive(foot.position, foot.azimuth_deg + 90.0, right_m);
                ellipsoid.ecef(point.position, 0.0)
            };
            let h = 0.05;
            let p: Vec<DVec3> = (-3..=3).map(|k| at(h * f64::from(k))).collect();
            let third = (p[5] - p[1] - 2.0 * (p[4] - p[2])) / (2.0 * h.powi(3));
            let fifth = (p[6] - p[0] - 4.0 * (p[5] - p[1]) + 5.0 * (p[4] - p[2])) / (2.0 * h.powi(5));
            let a_m = ellipsoid.a_m.max(ellipsoid.b_m);
            // Differences are means of derivatives near by, less sharp by a percent.
            prop_assert!(third.length() * 1.02 < 3.0 * a_m, "{}", third.length() / a_m);
            prop_assert!(fifth.length() * 1.05 < 3.0 * a_m, "{}", fifth.length() / a_m);
        }

        #[test]
        fn deviation_of_zone_edges_stays_below_its_bound(
            figure in 0_usize..4,
            sin_lat in -1.0..1.0_f64,
            azimuth_deg in 0.0..360.0_f64,
            range in 0.0..1.0_f64,
            shrink in 0.0..7.0_f64,
            sweep_deg in 0.1..90.0_f64,
            aside in -1.0..1.0_f64,
            t in (0.0..1.0_f64, 0.0..1.0_f64),
        ) {
            let ellipsoid = FIGURES[figure];
            let centre = LonLat::new(20.0, sin_lat.asin().to_degrees());
            let geodesic = geodesics(&ellipsoid);
            let arrive = |from, azimuth_deg, m| arrive(&geodesic, from, azimuth_deg, m);
            let share = if shrink < 2.0 { range } else { 10_f64.powf(-shrink) };
            let radius_m = greatest_range_m(&ellipsoid) * share.max(1e-8);
            let ends = [azimuth_deg, azimuth_deg + sweep_deg].map(|a| arrive(centre, a, radius_m));
            let circle = Circle { centre, radius_m };
            let kind = CurveKind::Circle(circle);
            let arc = Curve::between(kind, ends[0].position, ends[1].position);
            // A turn of longitude below a half turn, as in zones.
            prop_assume!(arc.turn_deg.abs() < 170.0);
            check_deviation_bound(&ellipsoid, arc, 0.0, 1.0);
            check_deviation_bound(&ellipsoid, arc, t.0.min(t.1), t.0.max(t.1));

            let right_m = WIDEST_HALF * ellipsoid.b_m.min(ellipsoid.a_m) * aside * share;
            let beside = Beside { start: centre, azimuth_deg, right_m };
            let ends = [0.0, 0.7 * radius_m].map(|along_m| {
                let foot = arrive(centre, azimuth_deg, along_m);
                arrive(foot.position, foot.azimuth_deg + 90.0, right_m).position
            });
            let side = Curve::between(CurveKind::Beside(beside), ends[0], ends[1]);
            prop_assume!(side.turn_deg.abs() < 170.0);
            check_deviation_bound(&ellipsoid, side, 0.0, 1.0);
            check_deviation_bound(&ellipsoid, side, t.0.min(t.1), t.0.max(t.1));
        }
    }

    #[test]
    fn bound_is_close_to_the_truth_for_ordinary_edges() {
        // 3° of the 49th parallel lie 1.08 km beside the great ellipse.
        let on = Curve::between(
            EdgeKind::Straight,
            LonLat::new(-100.0, 49.0),
            LonLat::new(-97.0, 49.0),
        )
        .on(&Ellipsoid::WGS84);
        let bound_m = on.deviation_bound_m(0.0, 1.0);
        assert!((1_070.0..1_120.0).contains(&bound_m), "{bound_m}");
        // 1° of geodesic at 45°: 0.8 m at most, from the skew of the end normals.
        let geodesic = Curve::between(
            EdgeKind::Geodesic,
            LonLat::new(0.0, 45.0),
            LonLat::new(1.0, 45.7),
        );
        let bound_m = geodesic.on(&Ellipsoid::WGS84).deviation_bound_m(0.0, 1.0);
        assert!(bound_m < 0.8, "{bound_m}");
    }
}
