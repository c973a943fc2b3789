//! The true edge between two vertices, as a curve that can be evaluated anywhere.

use geographiclib_rs::{Geodesic, GeodesicLine, geodesic_capability as capability};
use glam::DVec3;

use crate::{
    ellipsoid::Ellipsoid,
    geodetic::{LonLat, wrap_deg},
    isometric::IsometricLatitude,
    region::EdgeKind,
};

/// One edge of a ring: the true curve from one vertex to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// How the ends are joined.
    pub kind: EdgeKind,
    /// Where the curve starts (t = 0), its longitude in (−180°, 180°]. At a pole the longitude is
    /// the meridian along which the curve leaves (0 for geodesics, where it says nothing).
    pub from: LonLat,
    /// Where it ends (t = 1), in the same form.
    pub to: LonLat,
    /// Signed difference in longitude from `from` to `to` along the curve, degrees; positive
    /// eastward, −360 … 360. 0 for geodesics with an end at a pole.
    pub turn_deg: f64,
}

impl Curve {
    /// The edge of `kind` between two vertices as the caller wrote them.
    ///
    /// Longitudes may be given in any turn; equal points give bit-equal curves, and swapping the
    /// ends gives [`reversed`](Self::reversed), so neighbours can find their common edges by
    /// comparison. Differences in longitude are taken the shorter way round; of exactly 180° the
    /// way the caller wrote. A `Straight` edge written with a difference of exactly 360° goes
    /// once round.
    ///
    /// **Ends at a pole.** A `Straight` edge keeps the longitude that was written for the pole:
    /// (10, 80) → (50, 90) is linear on the lon/lat plane and arrives on the meridian of 50°. A
    /// `Rhumb` edge follows the other end's meridian.
    pub fn between(kind: EdgeKind, from: LonLat, to: LonLat) -> Self {
        let written_deg = to.lon_deg - from.lon_deg;
        let (mut from, mut to) = (in_turn(from), in_turn(to));
        match kind {
            EdgeKind::Geodesic => (from, to) = (from.canonical(), to.canonical()),
            EdgeKind::Rhumb if from.is_pole() => from.lon_deg = to.lon_deg,
            EdgeKind::Rhumb if to.is_pole() => to.lon_deg = from.lon_deg,
            EdgeKind::Rhumb | EdgeKind::Straight => {}
        }
        let mut turn_deg = wrap_deg(to.lon_deg - from.lon_deg);
        if turn_deg.abs() == 180.0 {
            turn_deg = turn_deg.copysign(wrap_deg(written_deg));
        }
        match kind {
            EdgeKind::Straight if written_deg.abs() == 360.0 => turn_deg = written_deg,
            EdgeKind::Geodesic if from.is_pole() || to.is_pole() => turn_deg = 0.0,
            _ => {}
        }
        Self {
            kind,
            from,
            to,
            // `+ 0.0` turns −0 into +0, so that equal curves have equal bits.
            turn_deg: turn_deg + 0.0,
        }
    }

    /// The same curve walked from `to` to `from`.
    pub fn reversed(self) -> Self {
        Self {
            from: self.to,
            to: self.from,
            turn_deg: -self.turn_deg + 0.0,
            ..self
        }
    }

    /// The curve prepared for evaluation on `ellipsoid`.
    ///
    /// Costs nothing for `Straight` edges, two microseconds for geodesics (the inverse problem is
    /// solved here, once).
    pub fn on(&self, ellipsoid: &Ellipsoid) -> CurveOn {
        let [start, end] = [self.from, self.to].map(|end| ellipsoid.ecef(end.canonical(), 0.0));
        self.on_between(ellipsoid, start, end)
    }

    /// [`Self::on`] for who knows the positions of the ends already.
    pub(crate) fn on_between(
        &self,
        ellipsoid: &Ellipsoid,
        start_ecef_m: DVec3,
        end_ecef_m: DVec3,
    ) -> CurveOn {
        let follows_grid = self.turn_deg == 0.0 || self.from.lat_deg == self.to.lat_deg;
        let course = match self.kind {
            EdgeKind::Geodesic => Course::Geodesic(GeodesicCourse::new(ellipsoid, self)),
            // Along meridians and parallels both are the same curve, and poles have no isometric latitude.
            EdgeKind::Rhumb if !follows_grid => {
                Course::Rhumb(RhumbCourse::new(ellipsoid, self.from, self.to))
            }
            EdgeKind::Rhumb | EdgeKind::Straight => Course::Linear,
        };
        CurveOn {
            curve: *self,
            ellipsoid: *ellipsoid,
            start_ecef_m,
            end_ecef_m,
            course,
        }
    }
}

/// Bounds are not sharpened below this, metres.
const COARSE_M: f64 = 0.02;

/// The longitude brought to (−180°, 180°], kept at the poles, no negative zero.
fn in_turn(position: LonLat) -> LonLat {
    let turned_deg = wrap_deg(position.lon_deg);
    let lon_deg = if turned_deg == -180.0 {
        180.0
    } else {
        turned_deg
    };
    LonLat::new(lon_deg + 0.0, position.lat_deg + 0.0)
}

/// A [`Curve`] on an ellipsoid, ready to be evaluated. Made by [`Curve::on`].
#[derive(Clone, Debug)]
pub struct CurveOn {
    curve: Curve,
    ellipsoid: Ellipsoid,
    start_ecef_m: DVec3,
    end_ecef_m: DVec3,
    course: Course,
}

#[derive(Clone, Debug)]
enum Course {
    /// Longitude and latitude linear in t.
    Linear,
    /// Longitude and isometric latitude linear in t.
    Rhumb(RhumbCourse),
    /// Distance linear in t.
    Geodesic(GeodesicCourse),
}

#[derive(Clone, Debug)]
struct RhumbCourse {
    isometric: IsometricLatitude,
    from: f64,
    difference: f64,
}

impl RhumbCourse {
    fn new(ellipsoid: &Ellipsoid, from: LonLat, to: LonLat) -> Self {
        let isometric = IsometricLatitude::new(ellipsoid);
        Self {
            from: isometric.at(from.lat_deg.to_radians()),
            difference: isometric.difference(from.lat_deg.to_radians(), to.lat_deg.to_radians()),
            isometric,
        }
    }
}

#[derive(Clone, Debug)]
struct GeodesicCourse {
    /// Boxed: Karney's series coefficients take half a kilobyte, which the other kinds need not carry.
    line: Box<GeodesicLine>,
    length_m: f64,
}

impl GeodesicCourse {
    fn new(ellipsoid: &Ellipsoid, curve: &Curve) -> Self {
        let geodesic = Geodesic::new(ellipsoid.a_m, ellipsoid.flattening());
        let (_, length_m, sin_azimuth, cos_azimuth, ..) = geodesic._gen_inverse(
            curve.from.lat_deg,
            curve.from.lon_deg,
            curve.to.lat_deg,
            curve.to.lon_deg,
            capability::DISTANCE | capability::AZIMUTH,
        );
        let line = GeodesicLine::new(
            &geodesic,
            curve.from.lat_deg,
            curve.from.lon_deg,
            f64::NAN,
            Some(capability::LATITUDE | capability::LONGITUDE | capability::DISTANCE_IN),
            Some(sin_azimuth),
            Some(cos_azimuth),
        );
        Self {
            line: Box::new(line),
            length_m,
        }
    }
}

impl CurveOn {
    /// The curve itself.
    pub fn curve(&self) -> &Curve {
        &self.curve
    }

    /// The ellipsoid it lies on.
    pub fn ellipsoid(&self) -> &Ellipsoid {
        &self.ellipsoid
    }

    /// Longitude and latitude at parameter `t`, 0 … 1; the longitude continues that of `from`, so
    /// it may lie outside ±180°. Geodesics are within 15 nm of the truth (Karney, C. F. F.:
    /// Algorithms for geodesics, J. Geod. 87, 2013).
    pub fn lon_lat(&self, t: f64) -> LonLat {
        let Curve {
            from, to, turn_deg, ..
        } = self.curve;
        if t == 0.0 {
            return from;
        }
        let lon_deg = from.lon_deg + t * turn_deg;
        if t == 1.0 {
            return LonLat::new(lon_deg, to.lat_deg);
        }
        match &self.course {
            Course::Linear => LonLat::new(lon_deg, from.lat_deg + t * (to.lat_deg - from.lat_deg)),
            Course::Rhumb(rhumb) => {
                let isometric = rhumb.from + t * rhumb.difference;
                LonLat::new(lon_deg, rhumb.isometric.latitude(isometric).to_degrees())
            }
            Course::Geodesic(geodesic) => {
                let mask = capability::LATITUDE | capability::LONGITUDE | capability::LONG_UNROLL;
                let (_, lat_deg, lon_deg, ..) =
                    geodesic
                        .line
                        ._gen_position(false, t * geodesic.length_m, mask);
                LonLat::new(lon_deg, lat_deg)
            }
        }
    }

    /// ECEF position, metres, at height 0. At t = 0 and t = 1 it is bit for bit the position of the
    /// vertex, whichever curve the vertex is taken from.
    pub fn ecef(&self, t: f64) -> DVec3 {
        if t == 0.0 {
            self.start_ecef_m
        } else if t == 1.0 {
            self.end_ecef_m
        } else {
            self.ellipsoid.ecef(self.lon_lat(t), 0.0)
        }
    }

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
    /// derivatives are bounded per kind in [`Self::derivative_bound`]. To this the twist of the ruled
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
        let rounding_m = 1e-14 * self.ellipsoid.a_m;
        let tilt = start_normal
            .dot(across)
            .abs()
            .max(end_normal.dot(across).abs());
        (beside_plane_m + twist_m + rounding_m) * 1.001 / (1.0 - tilt * tilt).sqrt()
    }

    /// Bound, metres, on the length of the position's third or fifth derivative by x, which runs
    /// from 0 to 1 over a `share` of the curve.
    fn derivative_bound(&self, share: f64, order: i32) -> f64 {
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
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const KINDS: [EdgeKind; 3] = [EdgeKind::Geodesic, EdgeKind::Rhumb, EdgeKind::Straight];

    fn straight(from: (f64, f64), to: (f64, f64)) -> Curve {
        let [from, to] = [from, to].map(|(lon, lat)| LonLat::new(lon, lat));
        Curve::between(EdgeKind::Straight, from, to)
    }

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
        #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

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

        #[test]
        fn swapping_the_ends_reverses_the_curve(
            kind in 0_usize..3,
            from in (-540.0..540.0_f64, -90.0..90.0_f64),
            to in (-540.0..540.0_f64, -90.0..90.0_f64),
        ) {
            let (from, to) = (LonLat::new(from.0, from.1), LonLat::new(to.0, to.1));
            let curve = Curve::between(KINDS[kind], from, to);
            prop_assert_eq!(curve.reversed(), Curve::between(KINDS[kind], to, from));
            prop_assert_eq!(curve.from, from.canonical());
            prop_assert!(curve.turn_deg.abs() <= 180.0);
        }

        #[test]
        fn rhumbs_keep_their_azimuth(
            from in (-180.0..180.0_f64, -85.0..85.0_f64),
            turn_deg in -170.0..170.0_f64,
            to_lat_deg in -85.0..85.0_f64,
        ) {
            let to = LonLat::new(from.0 + turn_deg, to_lat_deg);
            let curve = Curve::between(EdgeKind::Rhumb, LonLat::new(from.0, from.1), to);
            let on = curve.on(&Ellipsoid::WGS84);
            let tangent_of_azimuth = |t: f64| {
                let step = (on.ecef(t + 1e-5) - on.ecef(t - 1e-5)).normalize();
                let (sin, cos) = on.lon_lat(t).lon_deg.to_radians().sin_cos();
                let east = DVec3::new(-sin, cos, 0.0);
                let north = Ellipsoid::WGS84.normal_at_surface(on.ecef(t)).cross(east);
                step.dot(east).atan2(step.dot(north))
            };
            let azimuth = tangent_of_azimuth(0.1);
            for t in [0.3, 0.5, 0.9] {
                let turn = tangent_of_azimuth(t) - azimuth;
                prop_assert!(turn.sin().abs() < 1e-4 && turn.cos() > 0.0, "{curve:?} {turn}");
            }
        }
    }

    #[test]
    fn bound_is_close_to_the_truth_for_ordinary_edges() {
        // 3° of the 49th parallel lie 1.08 km beside the great ellipse.
        let on = straight((-100.0, 49.0), (-97.0, 49.0)).on(&Ellipsoid::WGS84);
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

    #[test]
    fn ends_are_the_vertices_bit_for_bit() {
        let vertex = LonLat::new(-179.999_999_9, -16.067_132_663_642_447);
        let expected = Ellipsoid::WGS84.ecef(vertex.canonical(), 0.0);
        for kind in KINDS {
            for other in [LonLat::new(179.3, -16.5), LonLat::new(-178.0, 3.0)] {
                let turned = LonLat::new(vertex.lon_deg + 0.0, vertex.lat_deg);
                assert_eq!(
                    Curve::between(kind, turned, other)
                        .on(&Ellipsoid::WGS84)
                        .ecef(0.0),
                    expected
                );
                assert_eq!(
                    Curve::between(kind, other, turned)
                        .on(&Ellipsoid::WGS84)
                        .ecef(1.0),
                    expected
                );
            }
        }
        assert_eq!(
            LonLat::new(12.0, 90.0).canonical(),
            straight((12.0, 90.0), (12.0, 80.0)).from.canonical()
        );
    }

    #[test]
    fn straight_edges_take_the_shorter_way_or_the_whole_parallel() {
        assert_eq!(straight((170.0, 1.0), (-170.0, 2.0)).turn_deg, 20.0);
        assert_eq!(straight((170.0, 1.0), (190.0, 2.0)).turn_deg, 20.0);
        assert_eq!(straight((-180.0, 1.0), (180.0, 1.0)).turn_deg, 360.0);
        assert_eq!(straight((180.0, 1.0), (-180.0, 1.0)).turn_deg, -360.0);
        assert_eq!(straight((-180.0, 1.0), (0.0, 1.0)).turn_deg, 180.0);
        assert_eq!(straight((180.0, 1.0), (0.0, 1.0)).turn_deg, -180.0);
        assert_eq!(straight((-90.0, 1.0), (90.0, 1.0)).turn_deg, 180.0);
        let middle = straight((-180.0, 60.0), (180.0, 60.0))
            .on(&Ellipsoid::WGS84)
            .lon_lat(0.25);
        assert_eq!(
            (middle.lon_deg.rem_euclid(360.0), middle.lat_deg),
            (270.0, 60.0)
        );
    }

    #[test]
    fn curves_reach_the_poles() {
        let to_pole = straight((10.0, 80.0), (50.0, 90.0)).on(&Ellipsoid::WGS84);
        assert_eq!(to_pole.lon_lat(0.5), LonLat::new(30.0, 85.0));
        assert_eq!(
            to_pole.ecef(1.0),
            DVec3::new(0.0, 0.0, Ellipsoid::WGS84.b_m)
        );
        let rhumb = Curve::between(
            EdgeKind::Rhumb,
            LonLat::new(10.0, 80.0),
            LonLat::new(50.0, 90.0),
        );
        assert_eq!(
            rhumb.on(&Ellipsoid::WGS84).lon_lat(0.5),
            LonLat::new(10.0, 85.0)
        );
        let over = Curve::between(
            EdgeKind::Geodesic,
            LonLat::new(10.0, 80.0),
            LonLat::new(190.0, 80.0),
        );
        assert!(over.on(&Ellipsoid::WGS84).ecef(0.5).truncate().length() < 1e-6);
    }
}
