//! Caps that hold a region.

use std::{cmp::Ordering, collections::BinaryHeap, f64::consts::PI};

use glam::DVec3;

use crate::{
    ellipsoid::Ellipsoid,
    geodetic::LonLat,
    outline::{
        GLOBE_SR, Measures, Outline, Stretch, authalic_chart::AuthalicChart, swept_area::SweptArea,
    },
};

/// All points of an ellipsoid whose geodetic normal is within an angle of that at a centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cap {
    /// The centre.
    pub centre: LonLat,
    /// Largest angle between the normals, radians, 0 … π.
    pub radius_rad: f64,
}

impl Cap {
    /// Whether the cap holds a point.
    pub fn contains(&self, position: LonLat) -> bool {
        position.is_valid() && angle_rad(normal(self.centre), normal(position)) <= self.radius_rad
    }
}

/// Excess aimed at, of the radius.
const RELATIVE_EXCESS: f64 = 1e-5;
/// And in radians: rounding of positions.
const LEAST_EXCESS_RAD: f64 = 1e-13;
/// Outlines nearer to the centre's antipode have a cap of everything.
const ANTIPODE_RAD: f64 = 1e-3;
/// No more intervals are looked at; what is left over then makes the cap larger.
const MOST_INTERVALS: usize = 200_000;

impl<S: Stretch> Outline<S> {
    /// A cap that holds the region, about its centroid, or about the north pole where it has none;
    /// none if there is no outline.
    ///
    /// Its radius is at most 10⁻⁵ of itself plus 10⁻¹³ rad larger than the least about that centre,
    /// or π where that one is within 10⁻³ rad of π. The proof rests on [`Stretch::stray_m`].
    pub fn bounding_cap(&self) -> Option<Cap> {
        let measures = self.measures();
        let centre = centre_of(&measures);
        Some(Cap {
            centre,
            radius_rad: self.radius_about(centre, &measures)?,
        })
    }

    /// Radius of a cap about `centre` that holds the region.
    pub(crate) fn radius_about(&self, centre: LonLat, measures: &Measures) -> Option<f64> {
        let axis = normal(centre);
        // The farthest point of a region lies on its outline, unless the antipode is inside.
        let outline_rad = self.outline_radius_rad(axis)?;
        if outline_rad > PI - ANTIPODE_RAD || self.holds_antipode(axis, measures) {
            return Some(PI);
        }
        Some(outline_rad)
    }

    /// Whether the region holds the antipode, from which its outline stays away, of a point given
    /// by its normal: then the area in the point's own chart is the whole sphere too small.
    fn holds_antipode(&self, axis: DVec3, measures: &Measures) -> bool {
        let chart = AuthalicChart::new(&self.ellipsoid, DVec3::Z);
        let chart = AuthalicChart::new(&self.ellipsoid, chart.authalic(axis));
        let swept = SweptArea::of(&chart, &self.stretches, 1e-3);
        let missing_sr = measures.area_m2 / chart.square_radius_m2() - swept.chart_sr;
        missing_sr > 0.5 * GLOBE_SR
    }

    /// Upper bound on the angle between `axis` and the normals on the outline, by branch and bound.
    fn outline_radius_rad(&self, axis: DVec3) -> Option<f64> {
        let direction = |stretch: usize, t: f64| {
            let ecef_m = self.stretches[stretch].ecef_m(t);
            self.ellipsoid.normal_at_surface(ecef_m)
        };
        let bounded = |stretch: usize, t0: f64, t1: f64| {
            let [start, end] = [t0, t1].map(|t| direction(stretch, t));
            let stray_rad = stray_rad(&self.ellipsoid, self.stretches[stretch].stray_m(t0, t1));
            Interval {
                stretch,
                t0,
                t1,
                most_rad: (farthest_on_arc(axis, start, end) + stray_rad).min(PI),
            }
        };
        let mut least_rad = 0.0_f64;
        let mut open = BinaryHeap::with_capacity(self.stretches.len());
        for stretch in 0..self.stretches.len() {
            least_rad = least_rad.max(angle_rad(axis, direction(stretch, 0.0)));
            open.push(bounded(stretch, 0.0, 1.0));
        }
        for _ in 0..MOST_INTERVALS {
            let widest = open.peek()?;
            let excess_rad = widest.most_rad - least_rad;
            if excess_rad <= RELATIVE_EXCESS * least_rad + LEAST_EXCESS_RAD {
                break;
            }
            let Interval {
                stretch, t0, t1, ..
            } = open.pop()?;
            let middle = 0.5 * (t0 + t1);
            least_rad = least_rad.max(angle_rad(axis, direction(stretch, middle)));
            open.push(bounded(stretch, t0, middle));
            open.push(bounded(stretch, middle, t1));
        }
        // Rounding of a position turns its normal by 2·10⁻¹⁶, that of angles adds as much.
        open.peek().map(|widest| widest.most_rad + 1e-15)
    }
}

/// The centre of a region's cap.
pub(crate) fn centre_of(measures: &Measures) -> LonLat {
    measures.centroid().unwrap_or(LonLat::new(0.0, 90.0))
}

/// Part of a stretch, and the largest angle that its normals may have from the axis.
struct Interval {
    stretch: usize,
    t0: f64,
    t1: f64,
    most_rad: f64,
}

impl Ord for Interval {
    fn cmp(&self, other: &Self) -> Ordering {
        self.most_rad.total_cmp(&other.most_rad)
    }
}

impl PartialOrd for Interval {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Interval {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Interval {}

/// The normal at a point, on any ellipsoid.
fn normal(position: LonLat) -> DVec3 {
    Ellipsoid::WGS84.normal(position)
}

/// The angle between unit vectors, also where it is tiny or nearly π.
fn angle_rad(a: DVec3, b: DVec3) -> f64 {
    2.0 * (a - b).length().atan2((a + b).length())
}

/// The largest angle from `axis` on the shorter great arc between two unit vectors. The normals'
/// directions along a chord are such an arc, as they are linear in the position.
fn farthest_on_arc(axis: DVec3, start: DVec3, end: DVec3) -> f64 {
    let at_ends = angle_rad(axis, start).max(angle_rad(axis, end));
    let across = start.cross(end);
    // The arc's circle is farthest from the axis where it passes the antipode's foot point on it.
    let beyond = start.cross(axis).dot(across) < 0.0 && axis.cross(end).dot(across) < 0.0;
    if !beyond {
        return at_ends;
    }
    let sin_off = axis.dot(across.normalize_or_zero()).abs().min(1.0);
    at_ends.max(PI - sin_off.asin())
}

/// How far normals may turn over a distance from a chord.
fn stray_rad(ellipsoid: &Ellipsoid, stray_m: f64) -> f64 {
    // Directions are those of (x, y, z·a²/b²): distances grow by no more than the larger factor.
    let ratio = (ellipsoid.a_m / ellipsoid.b_m).powi(2);
    let least_m = ellipsoid.a_m.min(ellipsoid.b_m * ratio);
    let sin = stray_m * ratio.max(1.0) / least_m;
    if sin < 1.0 { sin.asin() } else { PI }
}
