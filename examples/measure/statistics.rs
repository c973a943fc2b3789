//! What a list of times says.

/// The value that a share of all do not exceed: the nearest rank; NaN of none.
pub fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let rank = (share * values.len() as f64).ceil() as usize;
    match values.len() {
        0 => f64::NAN,
        count => values[rank.clamp(1, count) - 1],
    }
}

/// The median of the differences between two lists, pair by pair: what slows both for a while cancels.
pub fn median_difference(of: &[f64], from: &[f64]) -> f64 {
    let pairs = of.iter().zip(from);
    crate::host::times::median(pairs.map(|(of, from)| of - from).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_values_of_the_list() {
        let values: Vec<f64> = (1..=20).rev().map(f64::from).collect();
        assert_eq!(quantile(values.clone(), 0.95), 19.0);
        assert_eq!(quantile(values.clone(), 1.0), 20.0);
        assert_eq!(quantile(values, 0.0), 1.0);
        assert_eq!(quantile(vec![7.0], 0.95), 7.0);
        assert!(quantile(Vec::new(), 0.5).is_nan());
    }

    #[test]
    fn a_common_burden_cancels() {
        let burden = [0.0, 90.0, 3.0, 1000.0, 0.0];
        let floor: Vec<f64> = burden.iter().map(|burden| 10.0 + burden).collect();
        let fills: Vec<f64> = burden.iter().map(|burden| 14.0 + burden).collect();
        assert_eq!(median_difference(&fills, &floor), 4.0);
    }
}
