//! Short Fourier series, to find where a function on a closed curve can change its sign.

use std::f64::consts::TAU;

use super::bracketed_root::bracketed_root;

/// Σ aₖ cos kφ + bₖ sin kφ.
#[derive(Clone, Debug)]
pub(super) struct TrigSeries {
    /// (aₖ, bₖ) from k = 0.
    coefficients: Vec<(f64, f64)>,
}

impl TrigSeries {
    /// The series up to `degree` of a function sampled evenly from φ = 0; exact if the function is one
    /// and there are more than twice as many samples.
    pub(super) fn fit(samples: &[f64], degree: usize) -> Self {
        let step_rad = TAU / samples.len() as f64;
        let coefficients = (0..=degree)
            .map(|k| {
                let weight = if k == 0 { 1.0 } else { 2.0 } / samples.len() as f64;
                let add = |(cos_sum, sin_sum): (f64, f64), (j, sample): (usize, &f64)| {
                    // Whole turns are left out as integers, so that angles stay exact.
                    let (sin, cos) = ((j * k % samples.len()) as f64 * step_rad).sin_cos();
                    (cos_sum + sample * cos, sin_sum + sample * sin)
                };
                let (cos_sum, sin_sum) = samples.iter().enumerate().fold((0.0, 0.0), add);
                (weight * cos_sum, weight * sin_sum)
            })
            .collect();
        Self { coefficients }
    }

    /// Its value at φ, radians.
    fn value(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = angle_rad.sin_cos();
        // Clenshaw's sums for the cosines and sines at once.
        let (mut one, mut two) = ((0.0, 0.0), (0.0, 0.0));
        for &(a, b) in self.coefficients.iter().skip(1).rev() {
            let next = (a + 2.0 * cos * one.0 - two.0, b + 2.0 * cos * one.1 - two.1);
            (two, one) = (one, next);
        }
        self.coefficients[0].0 + cos * one.0 - two.0 + sin * one.1
    }

    fn derivative(&self) -> Self {
        let differentiate = |(k, &(a, b)): (usize, &(f64, f64))| (k as f64 * b, -(k as f64) * a);
        Self {
            coefficients: self
                .coefficients
                .iter()
                .enumerate()
                .map(differentiate)
                .collect(),
        }
    }

    /// Angles, radians, in 0 … 2π, between which the series is monotone: its extremes, and 0 first.
    pub(super) fn monotone_pieces(&self) -> Vec<f64> {
        let mut breaks_rad = self.derivative().roots(DEPTH);
        breaks_rad.insert(0, 0.0);
        breaks_rad
    }

    /// Roots in order. Between extremes there is at most one, and extremes are the roots of the
    /// derivative; each derivative weighs the highest harmonic more, and the last, nearly pure, can be
    /// searched evenly.
    fn roots(&self, depth: usize) -> Vec<f64> {
        let breaks_rad = if depth == 0 {
            let count = 8 * self.coefficients.len();
            (0..count)
                .map(|step| TAU * step as f64 / count as f64)
                .collect()
        } else {
            let mut extremes_rad = self.derivative().roots(depth - 1);
            extremes_rad.insert(0, 0.0);
            extremes_rad
        };
        let value = |angle_rad: f64| self.value(angle_rad);
        let mut roots_rad: Vec<_> = sign_changes(&breaks_rad, 0.0, value)
            .into_iter()
            .map(|(from, to)| bracketed_root(from, to, value).rem_euclid(TAU))
            .collect();
        roots_rad.sort_by(f64::total_cmp);
        roots_rad
    }
}

/// Derivatives taken before searching evenly.
const DEPTH: usize = 5;

/// Neighbouring angles of `breaks_rad`, ascending from 0, and once round, with their values, where
/// `value` changes its sign: an even number, as a closed curve must have. Breaks where it is not more
/// than `rounding` from 0 have no say.
pub(super) fn sign_changes(
    breaks_rad: &[f64],
    rounding: f64,
    value: impl Fn(f64) -> f64,
) -> Vec<((f64, f64), (f64, f64))> {
    let mut stations: Vec<_> = breaks_rad
        .iter()
        .map(|&angle_rad| (angle_rad, value(angle_rad)))
        .filter(|(_, value)| value.abs() > rounding)
        .collect();
    let Some(&(first_rad, value)) = stations.first() else {
        return Vec::new();
    };
    stations.push((first_rad + TAU, value));
    stations
        .windows(2)
        .map(|pair| (pair[0], pair[1]))
        .filter(|(from, to)| (from.1 > 0.0) != (to.1 > 0.0))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_roots_of_a_series_are_found() {
        // Products of sines of half angles: all four roots are known, some pairs close together.
        for roots in [
            [0.3, 0.9, 2.0, 5.0],
            [0.3, 0.3001, 0.3002, 4.0],
            [1.0, 1.000_001, 6.279, 6.281],
        ] {
            let value = |angle: f64| -> f64 {
                roots
                    .iter()
                    .map(|root| (0.5 * (angle - root)).sin())
                    .product()
            };
            let samples: Vec<_> = (0..16).map(|j| value(TAU * j as f64 / 16.0)).collect();
            let breaks_rad = TrigSeries::fit(&samples, 2).monotone_pieces();
            let found: Vec<_> = sign_changes(&breaks_rad, 0.0, value)
                .into_iter()
                .map(|(from, to)| bracketed_root(from, to, value))
                .collect();
            assert_eq!(found.len(), 4, "{roots:?}: {found:?}");
            for (found, root) in found.iter().zip(roots) {
                assert!((found - root).abs() < 1e-12);
            }
        }
    }
}
