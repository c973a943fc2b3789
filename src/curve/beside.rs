//! Curves at a fixed geodesic distance: from a point (circles) and beside a geodesic.

use std::hash::{Hash, Hasher};

use geographiclib_rs::{Geodesic, GeodesicLine, geodesic_capability as capability};

use crate::{
    ellipsoid::Ellipsoid,
    geodetic::{LonLat, wrap_deg},
};

/// The points at geodesic distance `radius_m` from `centre`.
///
/// Two are equal if all their numbers have equal bits.
#[derive(Clone, Copy, Debug)]
pub struct Circle {
    /// The centre; at a pole its longitude counts azimuths.
    pub centre: LonLat,
    /// The radius along the surface, metres.
    pub radius_m: f64,
}

/// The points at geodesic distance |`right_m`| on one side of a geodesic line.
///
/// Two are equal if all their numbers have equal bits.
#[derive(Clone, Copy, Debug)]
pub struct Beside {
    /// A point of the geodesic line.
    pub start: LonLat,
    /// Azimuth of the line there, degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Distance to the right of the line, metres; negative to the left.
    pub right_m: f64,
}

impl Circle {
    fn bits(&self) -> [u64; 3] {
        [self.centre.lon_deg, self.centre.lat_deg, self.radius_m].map(f64::to_bits)
    }
}

impl Beside {
    fn bits(&self) -> [u64; 4] {
        let Self {
            start,
            azimuth_deg,
            right_m,
        } = self;
        [start.lon_deg, start.lat_deg, *azimuth_deg, *right_m].map(f64::to_bits)
    }
}

impl PartialEq for Circle {
    fn eq(&self, other: &Self) -> bool {
        self.bits() == other.bits()
    }
}

impl Eq for Circle {}

impl Hash for Circle {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.bits().hash(state);
    }
}

impl PartialEq for Beside {
    fn eq(&self, other: &Self) -> bool {
        self.bits() == other.bits()
    }
}

impl Eq for Beside {}

impl Hash for Beside {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.bits().hash(state);
    }
}

/// A point of such a curve, and the azimuth, degrees, with which the shortest path from the centre
/// or from the line arrives there: the curve runs at right angles to it (Gauss's lemma).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival {
    pub(crate) position: LonLat,
    pub(crate) azimuth_deg: f64,
}

/// Karney's geodesics on an ellipsoid. Boxed: the series' coefficients take half a kilobyte.
pub(crate) fn geodesics(ellipsoid: &Ellipsoid) -> Box<Geodesic> {
    Box::new(Geodesic::new(ellipsoid.a_m, ellipsoid.flattening()))
}

/// Where one arrives from `from` after `distance_m` along `azimuth_deg`.
pub(crate) fn arrive(
    geodesic: &Geodesic,
    from: LonLat,
    azimuth_deg: f64,
    distance_m: f64,
) -> Arrival {
    let mask = capability::LATITUDE | capability::LONGITUDE | capability::AZIMUTH;
    let (_, lat_deg, lon_deg, azimuth_deg, ..) = geodesic._gen_direct(
        from.lat_deg,
        from.lon_deg,
        azimuth_deg,
        false,
        distance_m,
        mask,
    );
    Arrival {
        position: LonLat::new(lon_deg, lat_deg),
        azimuth_deg,
    }
}

/// A shortest path: its length, metres, and its azimuths at both ends, degrees.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Path {
    pub(crate) length_m: f64,
    pub(crate) start_azimuth_deg: f64,
    pub(crate) end_azimuth_deg: f64,
}

pub(crate) fn shortest_path(geodesic: &Geodesic, from: LonLat, to: LonLat) -> Path {
    let (_, length_m, sin_start, cos_start, sin_end, cos_end, ..) = geodesic._gen_inverse(
        from.lat_deg,
        from.lon_deg,
        to.lat_deg,
        to.lon_deg,
        capability::DISTANCE | capability::AZIMUTH,
    );
    Path {
        length_m,
        start_azimuth_deg: sin_start.atan2(cos_start).to_degrees(),
        end_azimuth_deg: sin_end.atan2(cos_end).to_degrees(),
    }
}

/// An arc of a circle, its azimuth linear in t.
#[derive(Clone, Debug)]
pub(crate) struct CircleCourse {
    geodesic: Box<Geodesic>,
    circle: Circle,
    from_deg: f64,
    /// Turn of the azimuth, degrees, −180 … 180.
    pub(crate) sweep_deg: f64,
}

impl CircleCourse {
    pub(crate) fn new(ellipsoid: &Ellipsoid, circle: Circle, from: LonLat, to: LonLat) -> Self {
        let geodesic = geodesics(ellipsoid);
        let [from_deg, to_deg] =
            [from, to].map(|end| shortest_path(&geodesic, circle.centre, end).start_azimuth_deg);
        Self {
            geodesic,
            circle,
            from_deg,
            sweep_deg: wrap_deg(to_deg - from_deg),
        }
    }

    pub(crate) fn at(&self, t: f64) -> Arrival {
        let azimuth_deg = self.from_deg + t * self.sweep_deg;
        arrive(
            &self.geodesic,
            self.circle.centre,
            azimuth_deg,
            self.circle.radius_m,
        )
    }

    /// The parameter at which the arc, extended, passes the point of the circle nearest to `position`.
    pub(crate) fn parameter_of(&self, position: LonLat) -> f64 {
        let path = shortest_path(&self.geodesic, self.circle.centre, position);
        let middle_deg = self.from_deg + 0.5 * self.sweep_deg;
        0.5 + wrap_deg(path.start_azimuth_deg - middle_deg) / self.sweep_deg
    }

    pub(crate) fn radius_m(&self) -> f64 {
        self.circle.radius_m
    }
}

/// A run of a curve beside a geodesic, its distance along that linear in t.
#[derive(Clone, Debug)]
pub(crate) struct BesideCourse {
    geodesic: Box<Geodesic>,
    line: Box<GeodesicLine>,
    right_m: f64,
    from_m: f64,
    /// Distance along the geodesic, metres.
    pub(crate) length_m: f64,
}

impl BesideCourse {
    pub(crate) fn new(ellipsoid: &Ellipsoid, beside: Beside, from: LonLat, to: LonLat) -> Self {
        let geodesic = geodesics(ellipsoid);
        let caps = capability::LATITUDE
            | capability::LONGITUDE
            | capability::AZIMUTH
            | capability::DISTANCE_IN;
        let line = GeodesicLine::new(
            &geodesic,
            beside.start.lat_deg,
            beside.start.lon_deg,
            beside.azimuth_deg,
            Some(caps),
            None,
            None,
        );
        let mut course = Self {
            geodesic,
            line: Box::new(line),
            right_m: beside.right_m,
            from_m: 0.0,
            length_m: 0.0,
        };
        let start = Arrival {
            position: beside.start,
            azimuth_deg: beside.azimuth_deg,
        };
        let [from_m, to_m] = [from, to].map(|end| course.foot_m(ellipsoid, start, end));
        (course.from_m, course.length_m) = (from_m, to_m - from_m);
        course
    }

    pub(crate) fn at(&self, t: f64) -> Arrival {
        self.beside(self.from_m + t * self.length_m)
    }

    /// The point beside that of the line at distance `along_m` from its start.
    fn beside(&self, along_m: f64) -> Arrival {
        let foot = self.on_line(along_m);
        arrive(
            &self.geodesic,
            foot.position,
            foot.azimuth_deg + 90.0,
            self.right_m,
        )
    }

    fn on_line(&self, along_m: f64) -> Arrival {
        let mask = capability::LATITUDE | capability::LONGITUDE | capability::AZIMUTH;
        let (_, lat_deg, lon_deg, azimuth_deg, ..) = self.line._gen_position(false, along_m, mask);
        Arrival {
            position: LonLat::new(lon_deg, lat_deg),
            azimuth_deg,
        }
    }

    /// Distance, metres, along the line to the foot of the perpendicular from `position`.
    ///
    /// Each step solves the right-angled triangle on a sphere; what the ellipsoid differs makes the
    /// rest smaller by its flattening every time.
    fn foot_m(&self, ellipsoid: &Ellipsoid, start: Arrival, position: LonLat) -> f64 {
        let radius_m = 0.5 * (ellipsoid.a_m + ellipsoid.b_m);
        let (mut along_m, mut near) = (0.0, start);
        for _ in 0..12 {
            let path = shortest_path(&self.geodesic, near.position, position);
            let angle = (path.start_azimuth_deg - near.azimuth_deg).to_radians();
            let arc = path.length_m / radius_m;
            let step_m = radius_m * (arc.sin() * angle.cos()).atan2(arc.cos());
            along_m += step_m;
            near = self.on_line(along_m);
            if step_m.abs() < 1e-8 {
                break;
            }
        }
        along_m
    }
}
