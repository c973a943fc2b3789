//! Sets of longitudes: what is covered, and the gaps between.

/// Intervals of longitude on the circle.
#[derive(Clone, Debug, Default)]
pub(crate) struct Longitudes {
    /// From west to east, degrees, within −180 … 180; those that cross the antimeridian are cut there.
    spans: Vec<(f64, f64)>,
}

impl Longitudes {
    /// Adds what is swept from a longitude within ±180° by a turn of up to ±360°, degrees.
    pub(crate) fn sweep(&mut self, from_deg: f64, turn_deg: f64) {
        let west_deg = from_deg + turn_deg.min(0.0);
        let west_deg = if west_deg < -180.0 {
            west_deg + 360.0
        } else if west_deg >= 180.0 {
            west_deg - 360.0
        } else {
            west_deg
        };
        let east_deg = west_deg + turn_deg.abs();
        self.spans.push((west_deg, east_deg.min(180.0)));
        if east_deg > 180.0 {
            self.spans.push((-180.0, east_deg - 360.0));
        }
    }

    /// West, in −180 … 180, and east, above it by 360 at most, of the shortest interval that holds all
    /// but gaps that are filled, of which one longitude is asked for. None if nothing remains open.
    pub(crate) fn shortest(mut self, is_filled: impl Fn(f64) -> bool) -> Option<(f64, f64)> {
        let mut gaps = self.gaps();
        let width_deg = |gap: &(f64, f64)| gap.1 - gap.0;
        gaps.sort_by(|one, other| width_deg(other).total_cmp(&width_deg(one)));
        let is_open = |gap: &&(f64, f64)| {
            let middle_deg = 0.5 * (gap.0 + gap.1);
            !is_filled(middle_deg)
        };
        let &(east_deg, west_deg) = gaps.iter().find(is_open)?;
        let west_deg = if west_deg >= 180.0 {
            west_deg - 360.0
        } else {
            west_deg
        };
        let turns_deg = if east_deg > west_deg { 0.0 } else { 360.0 };
        Some((west_deg, east_deg + turns_deg))
    }

    /// Where nothing is, from west to east; one ends beyond 180 if it crosses the antimeridian.
    fn gaps(&mut self) -> Vec<(f64, f64)> {
        self.spans.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut gaps = Vec::new();
        let Some(&(first_deg, mut covered_deg)) = self.spans.first() else {
            return gaps;
        };
        for &(west_deg, east_deg) in &self.spans {
            if west_deg > covered_deg {
                gaps.push((covered_deg, west_deg));
            }
            covered_deg = covered_deg.max(east_deg);
        }
        if covered_deg < first_deg + 360.0 {
            gaps.push((covered_deg, first_deg + 360.0));
        }
        gaps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shortest(sweeps: &[(f64, f64)]) -> Option<(f64, f64)> {
        let mut longitudes = Longitudes::default();
        for &(from_deg, turn_deg) in sweeps {
            longitudes.sweep(from_deg, turn_deg);
        }
        longitudes.shortest(|_| false)
    }

    #[test]
    fn the_largest_gap_is_left_out() {
        assert_eq!(shortest(&[(10.0, 5.0), (15.0, -10.0)]), Some((5.0, 15.0)));
        assert_eq!(
            shortest(&[(170.0, 15.0), (-175.0, -5.0)]),
            Some((170.0, 185.0))
        );
        assert_eq!(shortest(&[(-175.0, -15.0)]), Some((170.0, 185.0)));
        assert_eq!(
            shortest(&[(180.0, -3.0), (180.0, 0.0)]),
            Some((177.0, 180.0))
        );
        assert_eq!(shortest(&[(180.0, 3.0)]), Some((-180.0, -177.0)));
        // Two that are far apart: the shorter way from one to the other.
        assert_eq!(
            shortest(&[(-120.0, 1.0), (120.0, 1.0)]),
            Some((120.0, 241.0))
        );
        assert_eq!(shortest(&[(-50.0, 1.0), (50.0, 1.0)]), Some((-50.0, 51.0)));
        // Three steps round, and one all round.
        assert_eq!(
            shortest(&[(0.0, 120.0), (120.0, 120.0), (-120.0, 120.0)]),
            None
        );
        assert_eq!(shortest(&[(40.0, -360.0)]), None);
        assert_eq!(shortest(&[(-180.0, 360.0)]), None);
        // Only a degree is missing.
        assert_eq!(shortest(&[(40.0, -359.0)]), Some((-319.0 + 360.0, 400.0)));
    }

    #[test]
    fn filled_gaps_are_held() {
        let mut lune = Longitudes::default();
        lune.sweep(-90.0, 0.0);
        lune.sweep(30.0, 0.0);
        let east = |lon_deg: f64| (-90.0..30.0).contains(&lon_deg);
        assert_eq!(lune.clone().shortest(east), Some((-90.0, 30.0)));
        let west = |lon_deg: f64| !east(lon_deg);
        assert_eq!(lune.clone().shortest(west), Some((30.0, 270.0)));
        assert_eq!(lune.shortest(|_| true), None);
    }
}
