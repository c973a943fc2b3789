//! Pieces of two curves that run side by side: how far apart, as a polynomial and a bound on the rest.
//!
//! Hulls of such pieces part only when they are as short as √(8·radius·distance), a metre for
//! micrometres; points at the same share of both bend alike, and what is between them is smooth.

use glam::DVec3;

use crate::{boundary::curved_meeting::Hull, curve::CurveOn};

/// Shorter pieces, metres, are left to bisection, which needs some thousand steps for a kilometre; it knows
/// what touches, and splits what is small where the lattice can follow.
const SHORT_M: f64 = 1e3;

/// Pieces that end this far before each other, metres, have nothing in common.
const GAP_M: f64 = 1e-6;

/// Cosine of the largest angle between chords of pieces that are compared.
const ALONG: f64 = 0.999;

/// Share of a piece's length by which its direction may differ from its chord's.
const MOST_BEND: f64 = 0.1;

/// Crossings are placed no further, metres, beside either curve.
const CROSSING_M: f64 = 4e-6;

/// How pieces lie that run side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Alongside {
    /// They have nothing in common.
    Apart,
    /// They cross once, at this parameter of the first curve; on these ranges of the curves there is
    /// nothing else.
    Crossing(f64, [[f64; 2]; 2]),
    /// On these ranges, a kilometre long or more, they are no further apart than positions are rounded.
    Together([[f64; 2]; 2]),
}

/// How two pieces lie, if it can be told.
///
/// Curves that cross at less than 10⁻⁹ are as close as positions are rounded for hundreds of
/// kilometres: there longer pieces than those asked for tell that they cross.
pub(super) fn alongside(curves: [&CurveOn; 2], pieces: [&Hull; 2]) -> Option<Alongside> {
    let blurred = match compared(curves, pieces) {
        Compared::Told(told) => return Some(told),
        Compared::Not => return None,
        Compared::Blurred(ranges) => ranges,
    };
    let widened = |curve: &CurveOn, piece: &Hull, times: f64| {
        let more = 0.5 * (times - 1.0) * (piece.t1 - piece.t0);
        Hull::of(
            curve,
            (piece.t0 - more).max(0.0),
            (piece.t1 + more).min(1.0),
        )
    };
    let told = [1.5, 2.0, 3.0, 5.0, 9.0].into_iter().find_map(|times| {
        let wide = [0, 1].map(|which| widened(curves[which], pieces[which], times));
        match compared(curves, [&wide[0], &wide[1]]) {
            Compared::Told(told) => Some(told),
            _ => None,
        }
    });
    told.or(Some(Alongside::Together(blurred)))
}

/// What a comparison of pieces says.
enum Compared {
    Told(Alongside),
    /// On these ranges they are so close that rounding hides how they lie.
    Blurred([[f64; 2]; 2]),
    /// They do not run side by side, or are too long.
    Not,
}

/// Compares two pieces as far as they run side by side.
///
/// *Proof.* Let u be the direction of the first chord and w that across it, and P, Q the pieces as far
/// as they lie beside each other along u, by a parameter x that runs from 0 to 1 on either. Both
/// advance along u at every x by nine tenths of their length at least (`is_nearly_straight`), so
/// points that P and Q have in common lie there, and at parameters that differ by max|(P−Q)·u|/0.8L at
/// most. f = (P−Q)·w is, up to `rest_m`, the quartic through five of its values (see
/// `CurveOn::deviation_bound_m`), and a quartic is within its Bernstein coefficients. So P(x) = Q(x')
/// asks for |f(x)| ≤ |x−x'|·max|(Q·w)'|; where coefficients say more than that there is no such point.
fn compared(curves: [&CurveOn; 2], pieces: [&Hull; 2]) -> Compared {
    compare(curves, pieces).unwrap_or(Compared::Not)
}

fn compare(curves: [&CurveOn; 2], pieces: [&Hull; 2]) -> Option<Compared> {
    let [first, second] = pieces;
    if first.length_m().min(second.length_m()) < SHORT_M {
        return None;
    }
    if !curves
        .iter()
        .zip(pieces)
        .all(|(curve, piece)| is_nearly_straight(curve, piece))
    {
        return None;
    }
    let chords = pieces.map(|piece| piece.end - piece.start);
    let (along, across) = (chords[0].normalize(), first.across);
    if chords[1].dot(along).abs() < ALONG * chords[1].length() {
        return None;
    }
    let place_m = |point: DVec3| (point - first.start).dot(along);
    let span = |piece: &Hull| {
        let ends = [piece.start, piece.end].map(place_m);
        [ends[0].min(ends[1]), ends[0].max(ends[1])]
    };
    let spans = [span(first), span(second)];
    let (from_m, to_m) = (spans[0][0].max(spans[1][0]), spans[0][1].min(spans[1][1]));
    let length_m = to_m - from_m;
    if length_m < -GAP_M {
        return Some(Compared::Told(Alongside::Apart));
    }
    let is_short = length_m < SHORT_M;
    let parameters = |curve: &CurveOn, piece: &Hull| -> Option<[f64; 2]> {
        Some([
            parameter_at(curve, piece, place_m, from_m)?,
            parameter_at(curve, piece, place_m, to_m)?,
        ])
    };
    let ranges = [
        parameters(curves[0], first)?,
        parameters(curves[1], second)?,
    ];
    let shares = ranges.map(|[t0, t1]| (t1 - t0).abs());
    let fifth_m = |which: usize| curves[which].derivative_bound(shares[which], 5);
    let rest_m = (fifth_m(0) + fifth_m(1)) * (0.003_55 / 120.0);
    let rounding_m = rounding_m(curves[0], ranges[0]) + rounding_m(curves[1], ranges[1]);
    let ends_apart_m = [0, 1].map(|end| {
        let [p, q] = [0, 1].map(|which: usize| curves[which].ecef(ranges[which][end]));
        (p - q).dot(across).abs()
    });
    // Too long to be told apart: no use in looking closer.
    if rest_m > 0.5 * ends_apart_m[0].max(ends_apart_m[1]).max(rounding_m) {
        return None;
    }
    let at = |which: usize, share: f64| {
        let [t0, t1] = ranges[which];
        let t = if share == 1.0 {
            t1
        } else {
            t0 + share * (t1 - t0)
        };
        curves[which].ecef(t)
    };
    let points = [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| [at(0, share), at(1, share)]);
    let aside_m = points.map(|[p, q]| (p - q).dot(across));
    let ahead_m = Bernstein::through(points.map(|[p, q]| (p - q).dot(along)));
    // Of an interpolation's error the derivative is the fifth over 4! at most.
    let drift = Bernstein::through(points.map(|[_, q]| (q - second.start).dot(across)));
    let drift_m = drift.most_slope() + fifth_m(1) / 24.0;
    let shift = (ahead_m.most() + rest_m + rounding_m) / (0.8 * length_m);
    let margin_m = rest_m + rounding_m + shift * drift_m;
    let aside = Bernstein::through(aside_m);
    if aside.least() > margin_m {
        return Some(Compared::Told(Alongside::Apart));
    }
    if is_short {
        return None;
    }
    let clear = [aside_m[0], aside_m[4]].map(|aside| aside.abs() > margin_m);
    if margin_m < CROSSING_M && clear == [true; 2] && aside.crosses_once() {
        let [t0, t1] = ranges[0];
        let t = t0 + aside.root() * (t1 - t0);
        let ranges = ranges.map(ascending);
        return Some(Compared::Told(Alongside::Crossing(t, ranges)));
    }
    let most_m = aside_m
        .iter()
        .fold(0.0_f64, |most, aside| most.max(aside.abs()));
    let blur_m = 2.0 * LEBESGUE * 2.0 * POSITION * curves[0].ellipsoid().a_m;
    let is_blurred = most_m <= blur_m && rest_m <= 0.5 * blur_m;
    is_blurred.then(|| Compared::Blurred(ranges.map(ascending)))
}

fn ascending([a, b]: [f64; 2]) -> [f64; 2] {
    [a.min(b), a.max(b)]
}

/// Whether a piece advances everywhere along its chord by nine tenths of its speed at least.
fn is_nearly_straight(curve: &CurveOn, piece: &Hull) -> bool {
    // The second derivative is eight times what lies beside the chord, up to the third.
    let bend_m = 4.0 * piece.radius_m + curve.derivative_bound(piece.t1 - piece.t0, 3);
    bend_m < MOST_BEND * piece.length_m()
}

/// Rounding, metres, of the quartic through five positions on a range of a curve.
fn rounding_m(curve: &CurveOn, range: [f64; 2]) -> f64 {
    let has_end = range.iter().any(|&t| t == 0.0 || t == 1.0);
    let position_m = match has_end {
        true => curve.end_rounding_m().max(POSITION * curve.ellipsoid().a_m),
        false => POSITION * curve.ellipsoid().a_m,
    };
    LEBESGUE * position_m
}

/// The sum of the absolute values of the five Lagrange polynomials is no more.
const LEBESGUE: f64 = 2.21;

/// Rounding of positions on curves, as a share of the radius: 25 nm on Earth.
const POSITION: f64 = 4e-15;

/// The parameter at which a piece is as far along as `wanted_m`.
fn parameter_at(
    curve: &CurveOn,
    piece: &Hull,
    place_m: impl Fn(DVec3) -> f64,
    wanted_m: f64,
) -> Option<f64> {
    let ends = [
        (piece.t0, place_m(piece.start)),
        (piece.t1, place_m(piece.end)),
    ];
    if let Some((t, _)) = ends.into_iter().find(|&(_, end_m)| end_m == wanted_m) {
        return Some(t);
    }
    let pace_m = (ends[1].1 - ends[0].1) / (piece.t1 - piece.t0);
    let mut t = piece.t0 + (wanted_m - ends[0].1) / pace_m;
    for _ in 0..12 {
        let behind_m = wanted_m - place_m(curve.ecef(t));
        if behind_m.abs() < 1e-7 {
            return Some(t);
        }
        t = (t + behind_m / pace_m).clamp(piece.t0, piece.t1);
    }
    None
}

/// A quartic on 0 … 1 by its Bernstein coefficients.
#[derive(Clone, Copy, Debug)]
struct Bernstein([f64; 5]);

impl Bernstein {
    /// Through values at 0, ¼, ½, ¾, 1.
    fn through(values: [f64; 5]) -> Self {
        let [f0, f1, f2, f3, f4] = values;
        let quarter = 256.0 * f1 - 81.0 * f0 - f4;
        let half = 16.0 * f2 - f0 - f4;
        let three_quarters = 256.0 * f3 - f0 - 81.0 * f4;
        let middle = (30.0 * half - quarter - three_quarters) / 72.0;
        let sum = (half - 6.0 * middle) / 4.0;
        let difference = (quarter - three_quarters) / 96.0;
        Self([
            f0,
            0.5 * (sum + difference),
            middle,
            0.5 * (sum - difference),
            f4,
        ])
    }

    /// Bound on the absolute value from below, 0 if there may be a sign change.
    fn least(&self) -> f64 {
        let low = self.0.into_iter().fold(f64::INFINITY, f64::min);
        let high = self.0.into_iter().fold(f64::NEG_INFINITY, f64::max);
        low.max(-high).max(0.0)
    }

    /// Bound on the absolute value from above.
    fn most(&self) -> f64 {
        self.0.iter().fold(0.0, |most, b| most.max(b.abs()))
    }

    /// Bound on the absolute value of the derivative.
    fn most_slope(&self) -> f64 {
        let steps = self
            .0
            .windows(2)
            .map(|pair| 4.0 * (pair[1] - pair[0]).abs());
        steps.fold(0.0, f64::max)
    }

    /// Whether there is one root and no more: coefficients change sign once (Descartes).
    fn crosses_once(&self) -> bool {
        let changes = self
            .0
            .windows(2)
            .filter(|pair| (pair[0] < 0.0) != (pair[1] < 0.0));
        changes.count() == 1
    }

    fn at(&self, x: f64) -> f64 {
        let mut b = self.0;
        for rest in (1..b.len()).rev() {
            for k in 0..rest {
                b[k] += x * (b[k + 1] - b[k]);
            }
        }
        b[0]
    }

    /// The root between ends of different signs.
    fn root(&self) -> f64 {
        let starts_below = self.0[0] < 0.0;
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if (self.at(middle) < 0.0) == starts_below {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartics_are_told_by_their_coefficients() {
        let polynomial = |x: f64| 3.0 - 2.0 * x + 5.0 * x * x - 7.0 * x.powi(3) + 0.5 * x.powi(4);
        let quartic = Bernstein::through([0.0, 0.25, 0.5, 0.75, 1.0].map(polynomial));
        for step in 0..=20 {
            let x = f64::from(step) / 20.0;
            assert!((quartic.at(x) - polynomial(x)).abs() < 1e-13);
            assert!(polynomial(x).abs() <= quartic.most());
        }
        assert!(quartic.crosses_once() && quartic.least() == 0.0);
        assert!(polynomial(quartic.root()).abs() < 1e-13);
        let line = Bernstein::through([2.0, 1.75, 1.5, 1.25, 1.0]);
        assert_eq!(
            (line.least(), line.most(), line.most_slope()),
            (1.0, 2.0, 1.0)
        );
        assert!(!line.crosses_once());
    }
}
