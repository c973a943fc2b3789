//! The true edge between two vertices, as a curve that can be evaluated anywhere.

pub(crate) mod beside;
mod deviation;
pub(crate) mod isometric;
mod kind;
#[cfg(test)]
mod tests;

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
