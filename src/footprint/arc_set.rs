//! Parts of a closed curve.

use std::f64::consts::TAU;

use super::{bracketed_root::bracketed_root, trig_series::sign_changes};

/// Parts of a closed curve over an angle, radians, 0 … 2π.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ArcSet {
    /// Whether the angle 0 belongs to it.
    pub holds_start: bool,
    /// Where it ends and begins, in turn, ascending: an even number.
    pub ends_rad: Vec<f64>,
}

impl ArcSet {
    /// Where `value` is positive; it must be monotone between `breaks_rad`, and is no sure sign within
    /// `rounding` of 0.
    pub(super) fn where_positive(
        breaks_rad: &[f64],
        rounding: f64,
        value: impl Fn(f64) -> f64,
    ) -> Self {
        let changes = sign_changes(breaks_rad, rounding, &value);
        let Some((first, _)) = changes.first() else {
            let values = breaks_rad.iter().map(|&angle_rad| value(angle_rad));
            let surest = values.max_by(|one, other| one.abs().total_cmp(&other.abs()));
            return Self {
                holds_start: surest.is_some_and(|value| value > 0.0),
                ends_rad: Vec::new(),
            };
        };
        let roots_rad = changes
            .iter()
            .map(|&(from, to)| bracketed_root(from, to, &value));
        // The last may lie beyond a turn: between there and the first break the sign is another.
        let (beyond, mut ends_rad): (Vec<_>, Vec<_>) =
            roots_rad.partition(|&angle_rad| angle_rad >= TAU);
        let holds_start = (first.1 > 0.0) != (beyond.len() % 2 == 1);
        ends_rad.splice(0..0, beyond.iter().map(|angle_rad| angle_rad - TAU));
        Self {
            holds_start,
            ends_rad,
        }
    }

    /// What lies in all of `sets`.
    pub(super) fn common(sets: &[Self]) -> Self {
        let mut ends: Vec<_> = sets
            .iter()
            .enumerate()
            .flat_map(|(set, arcs)| arcs.ends_rad.iter().map(move |&angle_rad| (angle_rad, set)))
            .collect();
        ends.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut inside: Vec<_> = sets.iter().map(|arcs| arcs.holds_start).collect();
        let mut missing = inside.iter().filter(|inside| !**inside).count();
        let holds_start = missing == 0;
        let mut ends_rad = Vec::new();
        for (angle_rad, set) in ends {
            let was_inside = missing == 0;
            inside[set] = !inside[set];
            if inside[set] {
                missing -= 1;
            } else {
                missing += 1;
            }
            if was_inside != (missing == 0) {
                ends_rad.push(angle_rad);
            }
        }
        Self {
            holds_start,
            ends_rad,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn common_parts_of_arcs() {
        let set = |holds_start, ends: &[f64]| ArcSet {
            holds_start,
            ends_rad: ends.to_vec(),
        };
        let all = set(true, &[]);
        let none = set(false, &[]);
        let front = set(true, &[1.0, 5.0]);
        let band = set(false, &[0.5, 5.5]);
        assert_eq!(ArcSet::common(&[all.clone(), front.clone()]), front);
        assert_eq!(ArcSet::common(&[front.clone(), none.clone()]), none);
        assert_eq!(
            ArcSet::common(&[front, all, band]),
            set(false, &[0.5, 1.0, 5.0, 5.5])
        );
    }
}
