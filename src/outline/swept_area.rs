//! ½∮ x × dx along an outline, in a chart and in space, refined until it is known well enough.

use std::{cmp::Ordering, collections::BinaryHeap};

use glam::{DVec2, DVec3};

use crate::outline::{Stretch, authalic_chart::AuthalicChart};

/// Error aimed at, of the area swept.
pub(crate) const RELATIVE_ERROR: f64 = 1e-11;
/// No more intervals than so many more than there are stretches: some 0.1 s.
const MOST_INTERVALS: usize = 200_000;
/// Narrower intervals are not halved.
const LEAST_WIDTH: f64 = 1e-13;

/// Weights of xⱼ × xₖ in ½∫ x × dx along the quartic through five points at t = 0, ¼, ½, ¾, 1, the
/// first of which is 0. Symmetry lets the first term of its error vanish: it falls with the sixth power
/// of the intervals' width.
const QUARTIC: [(usize, usize, f64); 6] = [
    (1, 2, 352.0 / 315.0),
    (1, 3, -512.0 / 945.0),
    (1, 4, 64.0 / 315.0),
    (2, 3, 352.0 / 315.0),
    (2, 4, -134.0 / 315.0),
    (3, 4, 736.0 / 945.0),
];
/// The same for the parabola through the first, middle and last of them.
const PARABOLA: f64 = 2.0 / 3.0;

/// What an outline sweeps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SweptArea {
    /// Signed area in the chart, steradians.
    pub(crate) chart_sr: f64,
    /// ½∮ r × dr of the positions r, m².
    pub(crate) vector_area_m2: DVec3,
    /// Estimated error of either, that of the vector in steradians too, with rounding.
    pub(crate) error_sr: f64,
}

#[derive(Clone, Copy)]
struct Sample {
    place: DVec2,
    /// From a point of the outline, in authalic radii.
    offset: DVec3,
}

/// A part of a stretch with what it sweeps.
struct Interval {
    stretch: usize,
    t0: f64,
    t1: f64,
    samples: [Sample; 5],
    chart_sr: f64,
    vector_sr: DVec3,
    error_sr: f64,
    rounding_sr: f64,
    /// Whether the curve turns by more than 60° from half to half: then five points may miss how.
    turns: bool,
}

impl SweptArea {
    /// The area swept by `stretches`, to `relative_error` of itself if that can be had.
    pub(crate) fn of<S: Stretch>(
        chart: &AuthalicChart,
        stretches: &[S],
        relative_error: f64,
    ) -> Self {
        let origin_m = stretches
            .first()
            .map_or(DVec3::ZERO, |stretch| stretch.ecef_m(0.0));
        let radius_m = chart.square_radius_m2().sqrt();
        let sample = |stretch: usize, t: f64| {
            let ecef_m = stretches[stretch].ecef_m(t);
            Sample {
                place: chart.place(ecef_m),
                offset: (ecef_m - origin_m) / radius_m,
            }
        };
        let whole = |stretch| {
            let samples = [0.0, 0.25, 0.5, 0.75, 1.0].map(|t| sample(stretch, t));
            Interval::new(stretch, 0.0, 1.0, samples)
        };
        let mut open: BinaryHeap<Interval> = (0..stretches.len()).map(whole).collect();
        let mut settled = Vec::new();
        let most = open.len() + MOST_INTERVALS;
        let (mut sum_sr, mut error_sr, mut rounding_sr) = (0.0, 0.0, 0.0);
        for interval in &open {
            sum_sr += interval.chart_sr;
            error_sr += interval.error_sr;
            rounding_sr += interval.rounding_sr;
        }
        while error_sr > relative_error * sum_sr.abs() + rounding_sr
            && open.len() + settled.len() < most
            && let Some(widest) = open.pop()
        {
            if widest.t1 - widest.t0 < LEAST_WIDTH {
                settled.push(widest);
                continue;
            }
            sum_sr -= widest.chart_sr;
            error_sr -= widest.error_sr;
            rounding_sr -= widest.rounding_sr;
            for half in widest.halves(sample) {
                sum_sr += half.chart_sr;
                error_sr += half.error_sr;
                rounding_sr += half.rounding_sr;
                open.push(half);
            }
        }
        settled.extend(open);
        // Summed anew: what was added and taken away has left its rounding.
        let total = |part: fn(&Interval) -> f64| settled.iter().map(part).sum::<f64>();
        let vector_sr: DVec3 = settled.iter().map(|interval| interval.vector_sr).sum();
        Self {
            chart_sr: total(|interval| interval.chart_sr),
            vector_area_m2: vector_sr * chart.square_radius_m2(),
            error_sr: total(|interval| interval.error_sr + interval.rounding_sr),
        }
    }
}

impl Interval {
    fn new(stretch: usize, t0: f64, t1: f64, samples: [Sample; 5]) -> Self {
        let [first, _, middle, _, last] = samples;
        let place = samples.map(|sample| sample.place - first.place);
        let offset = samples.map(|sample| sample.offset - first.offset);
        let mut chart_sr = 0.0;
        let mut vector_sr = DVec3::ZERO;
        for (j, k, weight) in QUARTIC {
            chart_sr += weight * place[j].perp_dot(place[k]);
            vector_sr += weight * offset[j].cross(offset[k]);
        }
        let parabola_sr = PARABOLA * place[2].perp_dot(place[4]);
        let parabola_vector_sr = PARABOLA * offset[2].cross(offset[4]);
        let difference_sr = (parabola_sr - chart_sr)
            .abs()
            .max((parabola_vector_sr - vector_sr).length());
        let (there, on) = (middle.offset - first.offset, last.offset - middle.offset);
        let length = there.length() + on.length();
        let turns = there.dot(on) < 0.5 * there.length() * on.length();
        let spread = place
            .iter()
            .map(|place| place.length_squared())
            .sum::<f64>();
        let error_sr = difference_sr + if turns { spread } else { 0.0 };
        // The rest is a triangle with the origin.
        chart_sr += 0.5 * first.place.perp_dot(place[4]);
        vector_sr += 0.5 * first.offset.cross(offset[4]);
        Self {
            stretch,
            t0,
            t1,
            samples,
            chart_sr,
            vector_sr,
            error_sr,
            // Positions are off by an ulp or so, at right angles to the curve too.
            rounding_sr: 2.0 * f64::EPSILON * length,
            turns,
        }
    }

    fn halves(&self, sample: impl Fn(usize, f64) -> Sample) -> [Self; 2] {
        let [a, b, c, d, e] = self.samples;
        let width = self.t1 - self.t0;
        let at = |share: f64| sample(self.stretch, self.t0 + share * width);
        let middle = self.t0 + 0.5 * width;
        let first = [a, at(0.125), b, at(0.375), c];
        let last = [c, at(0.625), d, at(0.875), e];
        let mut halves = [
            Self::new(self.stretch, self.t0, middle, first),
            Self::new(self.stretch, middle, self.t1, last),
        ];
        // What the quartics change here was the whole's error, which theirs do not exceed: not even
        // next to a root. Where the curve turns much they may agree by chance.
        let [left, right] = &halves;
        let chart_sr = left.chart_sr + right.chart_sr - self.chart_sr;
        let vector_sr = left.vector_sr + right.vector_sr - self.vector_sr;
        let change_sr = chart_sr.abs().max(vector_sr.length());
        for half in halves.iter_mut().filter(|half| !half.turns) {
            half.error_sr = half.error_sr.min(change_sr);
        }
        halves
    }
}

impl Ord for Interval {
    fn cmp(&self, other: &Self) -> Ordering {
        self.error_sr.total_cmp(&other.error_sr)
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
