//! Roots of functions of one variable between two signs.

/// The place where `value` changes its sign between `low` and `high`, given with their values, to
/// rounding.
///
/// Chandrupatla's method (Adv. Eng. Softw. 28, 1997): inverse quadratic steps where they can be
/// trusted, else bisection, so that it ends whatever the function.
pub(super) fn bracketed_root(low: (f64, f64), high: (f64, f64), value: impl Fn(f64) -> f64) -> f64 {
    let ((mut a, mut at_a), (mut b, mut at_b)) = (low, high);
    let mut fraction = 0.5;
    for _ in 0..128 {
        let x = a + fraction * (b - a);
        let at_x = value(x);
        let (c, at_c);
        if (at_x >= 0.0) == (at_a >= 0.0) {
            (c, at_c) = (a, at_a);
        } else {
            (c, at_c) = (b, at_b);
            (b, at_b) = (a, at_a);
        }
        (a, at_a) = (x, at_x);
        let nearest = if at_a.abs() < at_b.abs() { a } else { b };
        let least = (2.0 * f64::EPSILON * nearest.abs() + f64::MIN_POSITIVE) / (b - a).abs();
        if at_a == 0.0 || least.is_nan() || least > 0.5 {
            return if at_a == 0.0 { a } else { nearest };
        }
        let xi = (a - b) / (c - b);
        let phi = (at_a - at_b) / (at_c - at_b);
        fraction = if 1.0 - (1.0 - xi).sqrt() < phi && phi < xi.sqrt() {
            at_a / (at_b - at_a) * (at_c / (at_b - at_c))
                + (c - a) / (b - a) * (at_a / (at_c - at_a)) * (at_b / (at_c - at_b))
        } else {
            0.5
        };
        fraction = fraction.clamp(least, 1.0 - least);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_exact_to_rounding_however_flat() {
        let cube = |x: f64| x * x * x - 2.0;
        let root = bracketed_root((0.0, cube(0.0)), (2.0, cube(2.0)), cube);
        assert!((root - 2_f64.cbrt()).abs() < 1e-15);
        let steep = |x: f64| (x - 1e-9).signum() * (x - 1e-9).abs().powf(0.2);
        let root = bracketed_root((-1.0, steep(-1.0)), (3.0, steep(3.0)), steep);
        assert!((root - 1e-9).abs() < 1e-24);
        let jump = |x: f64| if x < 0.3 { -1.0 } else { 1.0 };
        let root = bracketed_root((0.0, -1.0), (1.0, 1.0), jump);
        assert!((root - 0.3).abs() < 1e-15);
        let undefined = bracketed_root((0.0, -1.0), (1.0, 1.0), |_| f64::NAN);
        assert!(undefined.is_finite());
    }
}
