//! The true edge between two vertices, as a curve that can be evaluated anywhere.

pub(crate) mod beside;
mod deviation;
pub(crate) mod isometric;
mod kind;

use geographiclib_rs::{Geodesic, GeodesicLine, geodesic_capability as capability};
use glam::DVec3;

pub use beside::{Beside, Circle};
pub use kind::CurveKind;

use crate::{
    curve::beside::{Arrival, BesideCourse, CircleCourse},
    curve::isometric::IsometricLatitude,
    ellipsoid::Ellipsoid,
    geodetic::{LonLat, wrap_deg},
};

/// One edge of a ring: the true curve from one vertex to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// How the ends are joined.
    pub kind: CurveKind,
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
    /// `Rhumb` edge follows the other end's meridian. Arcs of circles and curves beside geodesics
    /// keep the meridian that was written.
    ///
    /// **Circles, and curves beside geodesics**: the ends must lie on the curve (to a few
    /// micrometres; what is between them does exactly), and their longitude must not turn back
    /// between them. Of a circle the arc of less than 180° of azimuth is meant.
    pub fn between(kind: impl Into<CurveKind>, from: LonLat, to: LonLat) -> Self {
        let kind = kind.into();
        let written_deg = to.lon_deg - from.lon_deg;
        let (mut from, mut to) = (in_turn(from), in_turn(to));
        match kind {
            CurveKind::Geodesic => (from, to) = (from.canonical(), to.canonical()),
            CurveKind::Rhumb if from.is_pole() => from.lon_deg = to.lon_deg,
            CurveKind::Rhumb if to.is_pole() => to.lon_deg = from.lon_deg,
            _ => {}
        }
        let mut turn_deg = wrap_deg(to.lon_deg - from.lon_deg);
        if turn_deg.abs() == 180.0 {
            turn_deg = turn_deg.copysign(wrap_deg(written_deg));
        }
        match kind {
            CurveKind::Straight if written_deg.abs() == 360.0 => turn_deg = written_deg,
            CurveKind::Geodesic if from.is_pole() || to.is_pole() => turn_deg = 0.0,
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
    /// solved here, once), some for circles and tens for curves beside geodesics.
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
            CurveKind::Geodesic => Course::Geodesic(GeodesicCourse::new(ellipsoid, self)),
            // Along meridians and parallels both are the same curve, and poles have no isometric latitude.
            CurveKind::Rhumb if !follows_grid => {
                Course::Rhumb(RhumbCourse::new(ellipsoid, self.from, self.to))
            }
            CurveKind::Rhumb | CurveKind::Straight => Course::Linear,
            CurveKind::Circle(circle) => {
                Course::Circle(CircleCourse::new(ellipsoid, circle, self.from, self.to))
            }
            CurveKind::Beside(beside) => {
                Course::Beside(BesideCourse::new(ellipsoid, beside, self.from, self.to))
            }
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

/// The longitude brought to (−180°, 180°], kept at the poles, no negative zero.
pub(crate) fn in_turn(position: LonLat) -> LonLat {
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
    /// Azimuth from the centre linear in t.
    Circle(CircleCourse),
    /// Distance along the geodesic linear in t.
    Beside(BesideCourse),
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
    /// Algorithms for geodesics, J. Geod. 87, 2013), and so are circles and curves beside geodesics
    /// between their ends.
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
            Course::Circle(circle) => self.continued(circle.at(t)),
            Course::Beside(beside) => self.continued(beside.at(t)),
        }
    }

    /// The position with its longitude in the turn in which the curve runs.
    fn continued(&self, arrival: Arrival) -> LonLat {
        let LonLat { lon_deg, lat_deg } = arrival.position;
        let middle_deg = self.curve.from.lon_deg + 0.5 * self.curve.turn_deg;
        LonLat::new(middle_deg + wrap_deg(lon_deg - middle_deg), lat_deg)
    }

    /// The parameter at which an arc of a circle, extended, passes nearest to `position`; none for
    /// other kinds.
    pub(crate) fn parameter_on_circle(&self, position: LonLat) -> Option<f64> {
        match &self.course {
            Course::Circle(circle) => Some(circle.parameter_of(position)),
            _ => None,
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
}

#[cfg(test)]
mod tests {
    use proptest::{prelude::*, test_runner::RngSeed};

    use super::*;
    use crate::region::EdgeKind;

    const KINDS: [EdgeKind; 3] = [EdgeKind::Geodesic, EdgeKind::Rhumb, EdgeKind::Straight];

    fn straight(from: (f64, f64), to: (f64, f64)) -> Curve {
        let [from, to] = [from, to].map(|(lon, lat)| LonLat::new(lon, lat));
        Curve::between(EdgeKind::Straight, from, to)
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

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
