//! Measures of what a closed outline on an ellipsoid encloses: area, centroid, bounding cap.
//!
//! An outline is any number of closed curves with the region on their left, seen from outside, cut
//! into smooth stretches. Regions larger than a hemisphere, poles inside or on the outline and the
//! antimeridian are ordinary: everything is computed in three dimensions.

mod authalic_chart;
pub(crate) mod bounding_cap;
mod swept_area;

use glam::DVec3;

use crate::{
    curve::CurveOn,
    ellipsoid::Ellipsoid,
    geodetic::LonLat,
    outline::{authalic_chart::AuthalicChart, swept_area::SweptArea},
};

pub use self::bounding_cap::Cap;

/// A smooth part of an outline: ECEF positions on the ellipsoid, metres, for t from 0 to 1.
///
/// Closures `Fn(f64) -> DVec3` are stretches. The curve must be smooth inside; at its ends the
/// parameter may run like a square root, as it does where a footprint meets the limb.
pub trait Stretch {
    /// The point at `t`, 0 … 1, on the ellipsoid. A stretch ends where another (or itself) starts.
    fn ecef_m(&self, t: f64) -> DVec3;

    /// Upper bound, metres, on the distance of the points between `t0` and `t1` from the straight
    /// chord; infinite where there is none to give, but not however near `t0` and `t1` are.
    ///
    /// [`Outline::bounding_cap`] is as certain as this bound. By default it is an estimate: twice
    /// the largest distance of three points between.
    fn stray_m(&self, t0: f64, t1: f64) -> f64 {
        let (start, end) = (self.ecef_m(t0), self.ecef_m(t1));
        let chord = end - start;
        let scale = chord.length_squared().max(f64::MIN_POSITIVE).recip();
        let stray_m = [0.25, 0.5, 0.75].map(|share| {
            let offset = self.ecef_m(t0 + share * (t1 - t0)) - start;
            let along = (offset.dot(chord) * scale).clamp(0.0, 1.0);
            (offset - chord * along).length()
        });
        2.0 * stray_m.into_iter().fold(0.0, f64::max)
    }
}

impl<F: Fn(f64) -> DVec3> Stretch for F {
    fn ecef_m(&self, t: f64) -> DVec3 {
        self(t)
    }
}

impl Stretch for CurveOn {
    fn ecef_m(&self, t: f64) -> DVec3 {
        self.ecef(t)
    }

    /// Proven: see [`CurveOn::deviation_bound_m`].
    fn stray_m(&self, t0: f64, t1: f64) -> f64 {
        let chord_m = self.ecef(t0).distance(self.ecef(t1));
        // The wall's rulings lean a little: the sag along them is that much longer.
        self.deviation_bound_m(t0, t1) + 1.01 * self.ellipsoid().chord_sag_m(chord_m)
    }
}

/// A region on an ellipsoid by its outline: stretches that make up closed curves, in any order, with
/// the region to their left, seen from outside.
///
/// An outline without stretches encloses nothing. So does one whose area is lost in the rounding of
/// its positions (1 nm on Earth, times its length): it is never taken for the whole ellipsoid.
///
/// ```
/// use globefill::{Ellipsoid, LonLat, Outline};
///
/// let earth = Ellipsoid::WGS84;
/// let equator = |t: f64| earth.ecef(LonLat::new(360.0 * t, 0.0), 0.0);
/// let north = Outline::new(earth, vec![equator]).measures();
/// assert!((north.area_m2 / 255_032_810_862_044.2 - 1.0).abs() < 1e-12);
/// assert_eq!(north.centroid().map(|centroid| centroid.lat_deg.round()), Some(90.0));
/// ```
#[derive(Clone, Debug)]
pub struct Outline<S> {
    /// What the stretches lie on.
    pub ellipsoid: Ellipsoid,
    /// The parts of the outline.
    pub stretches: Vec<S>,
}

/// What a region measures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measures {
    /// Area on the ellipsoid, m².
    pub area_m2: f64,
    /// ∬ n dA over the region, m², n being the outward unit normal, in ECEF. By Stokes's theorem it
    /// is ½∮ r × dr, exactly, r being the position.
    pub vector_area_m2: DVec3,
    /// Estimated error of either, m²: seldom exceeded, mostly far too large. It stays below 10⁻¹⁰
    /// of the area or of its complement, whichever is smaller, unless rounding of the positions or
    /// a stretch that is not smooth prevents that.
    pub error_m2: f64,
}

impl Measures {
    /// The point whose geodetic normal points along the area-weighted mean of the region's normals;
    /// none where that mean vanishes, as it does for the whole ellipsoid and for belts along the
    /// equator.
    ///
    /// The position is uncertain by `error_m2 / |vector_area_m2|` radians: from rounding, by 1 mm
    /// for regions of 5 m, by 1 µm for those of 5 km.
    pub fn centroid(&self) -> Option<LonLat> {
        let is_certain = self.vector_area_m2.length() > self.error_m2;
        is_certain.then(|| lon_lat_of(self.vector_area_m2))
    }

    /// Of two regions together; what they have in common counts twice.
    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            area_m2: self.area_m2 + other.area_m2,
            vector_area_m2: self.vector_area_m2 + other.vector_area_m2,
            error_m2: self.error_m2 + other.error_m2,
        }
    }

    /// Of a whole ellipsoid.
    pub(crate) fn globe(ellipsoid: &Ellipsoid) -> Self {
        let area_m2 = AuthalicChart::new(ellipsoid, DVec3::Z).globe_m2();
        Self {
            area_m2,
            error_m2: 1e-15 * area_m2,
            ..Self::default()
        }
    }
}

/// Steradians of the whole sphere.
const GLOBE_SR: f64 = 4.0 * std::f64::consts::PI;

impl<S: Stretch> Outline<S> {
    /// The outline made up of `stretches` on `ellipsoid`.
    pub fn new(ellipsoid: Ellipsoid, stretches: Vec<S>) -> Self {
        Self {
            ellipsoid,
            stretches,
        }
    }

    /// Area on the ellipsoid, m². [`Self::measures`] tells how sure it is.
    pub fn area_m2(&self) -> f64 {
        self.measures().area_m2
    }

    /// [`Measures::centroid`] of the region.
    pub fn centroid(&self) -> Option<LonLat> {
        self.measures().centroid()
    }

    /// Area and mean normal.
    ///
    /// The surface is mapped to the sphere of equal area, and that to Lambert's equal-area chart
    /// about a point p whose antipode is far from the outline. The signed area in the chart is the
    /// region's, less the whole sphere if p's antipode lies inside. As a region that is neither empty nor
    /// everything has an area between 0 and the whole, the sign tells which.
    pub fn measures(&self) -> Measures {
        let pole = AuthalicChart::pole_for(&self.ellipsoid, &self.stretches);
        let chart = AuthalicChart::new(&self.ellipsoid, pole);
        let swept = SweptArea::of(&chart, &self.stretches, swept_area::RELATIVE_ERROR);
        let error_m2 = swept.error_sr * chart.square_radius_m2();
        Measures {
            area_m2: region_sr(&swept) * chart.square_radius_m2(),
            vector_area_m2: swept.vector_area_m2,
            error_m2,
        }
    }
}

/// Area of a region, steradians, from what its outline sweeps in a chart.
fn region_sr(swept: &SweptArea) -> f64 {
    if swept.chart_sr.abs() <= swept.error_sr {
        swept.chart_sr.max(0.0)
    } else {
        swept.chart_sr.rem_euclid(GLOBE_SR)
    }
}

/// The point whose geodetic normal points along a vector.
fn lon_lat_of(normal: DVec3) -> LonLat {
    let axis_distance = normal.x.hypot(normal.y);
    LonLat::new(
        normal.y.atan2(normal.x).to_degrees(),
        normal.z.atan2(axis_distance).to_degrees(),
    )
}
