//! Columns of longitude.

use crate::boundary::lattice::{TURN, wrap};

/// Columns of longitude in which about equally many edges begin, however unevenly they lie.
#[derive(Debug)]
pub(super) struct Columns {
    /// Where columns begin, ascending; the last one ends where the first begins.
    starts: Vec<i64>,
}

/// So many edges at least begin in a column.
const LEAST_BEGINS: usize = 8;

impl Columns {
    /// Columns for edges that span these longitudes, west to east.
    pub(super) fn new(spans: &[(i64, i64)]) -> Self {
        let mut begins: Vec<i64> = spans.iter().map(|&(west, _)| west).collect();
        begins.sort_unstable();
        let marks: Vec<i64> = begins.into_iter().step_by(LEAST_BEGINS).collect();
        let before = |lon: i64| marks.partition_point(|&mark| mark <= lon);
        let passed = |&(west, east): &(i64, i64)| match east > TURN / 2 {
            true => marks.len() - before(west) + before(wrap(east)),
            false => before(east) - before(west),
        };
        // Long edges lie in many columns: these are so wide that all lie in two, on average.
        let all_passed: usize = spans.iter().map(passed).sum();
        let per_column = (all_passed / spans.len().max(1)).max(1);
        let mut starts: Vec<i64> = marks.into_iter().step_by(per_column).collect();
        starts.dedup();
        Self { starts }
    }

    pub(super) fn count(&self) -> usize {
        self.starts.len().max(1)
    }

    /// Where a column begins.
    pub(super) fn start(&self, column: usize) -> i64 {
        self.starts.get(column).copied().unwrap_or(0)
    }

    /// The column of a longitude in (−180°, 180°].
    pub(super) fn of(&self, lon: i64) -> usize {
        let begun = self.starts.partition_point(|&start| start <= lon);
        if begun == 0 {
            self.count() - 1
        } else {
            begun - 1
        }
    }

    /// Which spans touch each column: for each column the end of its run, and the runs.
    pub(super) fn sorted_into(&self, spans: &[(i64, i64)]) -> (Vec<u32>, Vec<u32>) {
        let mut ends = vec![0_u32; self.count()];
        for &span in spans {
            self.touched(span).for_each(|column| ends[column] += 1);
        }
        let mut total = 0;
        for end in &mut ends {
            total += *end;
            *end = total - *end;
        }
        let mut members = vec![0; total as usize];
        for (index, &span) in (0_u32..).zip(spans) {
            for column in self.touched(span) {
                members[ends[column] as usize] = index;
                ends[column] += 1;
            }
        }
        (ends, members)
    }

    fn touched_count(&self, (west, east): (i64, i64)) -> usize {
        let (first, last) = (self.of(west), self.of(wrap(east)));
        let more = if east - west >= TURN {
            self.count() - 1
        } else if last < first || last == first && wrap(east) < west {
            last + self.count() - first
        } else {
            last - first
        };
        more.min(self.count() - 1) + 1
    }

    fn touched(&self, span: (i64, i64)) -> impl Iterator<Item = usize> + use<> {
        let (first, count) = (self.of(span.0), self.count());
        (first..first + self.touched_count(span)).map(move |column| column % count)
    }
}
