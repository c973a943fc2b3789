//! Edges that share an end: most pairs of them meet nowhere else.

use rustc_hash::FxHashMap;

use crate::{boundary::boundary_graph::Edge, curve::CurveKind};

/// Edges divided into those that leave one node, grouped by what may meet again, and all others.
///
/// Where thousands of edges meet in a point no division of the plane takes them apart. It need not: of
/// two straight edges that start at one point only those have more in common that start the same way.
/// Two geodesics or rhumb lines from one node part for good, unless they end at one node, too.
pub(crate) struct EdgeStar {
    /// The edges of the star, those that may have more in common side by side.
    star: Vec<u32>,
    /// Ends of the runs of these in `star`.
    ends: Vec<usize>,
    others: Vec<u32>,
}

impl EdgeStar {
    /// Looks for a star in `members` if they are more than `most`, and for one that is worth it.
    pub(crate) fn of(edges: &[Edge], members: &[u32], most: usize) -> Self {
        let none = || Self {
            star: Vec::new(),
            ends: Vec::new(),
            others: members.to_vec(),
        };
        if members.len() <= most {
            return none();
        }
        let Some((middle, kind)) = middle_of(edges, members) else {
            return none();
        };
        let (mut star, others): (Vec<u32>, Vec<u32>) = members
            .iter()
            .partition(|&&member| is_of_star(&edges[member as usize], middle, kind));
        let key = |&member: &u32| parting(&edges[member as usize], middle);
        star.sort_by_cached_key(|member| (key(member), *member));
        let runs = star.chunk_by(|a, b| key(a) == key(b));
        let ends = runs.scan(0, |end, run| {
            *end += run.len();
            Some(*end)
        });
        Self {
            ends: ends.collect(),
            star,
            others,
        }
    }

    /// How many pairs there are that may have anything in common besides the middle.
    pub(crate) fn pair_count(&self) -> u64 {
        let pairs = |count: u64| count * count.saturating_sub(1) / 2;
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        let runs = starts
            .zip(&self.ends)
            .map(|(start, end)| (end - start) as u64);
        let (star, others) = (self.star.len() as u64, self.others.len() as u64);
        runs.map(pairs).sum::<u64>() + star * others + pairs(others)
    }

    /// Calls `visit` with these pairs, smaller first.
    pub(crate) fn for_each_pair(&self, mut visit: impl FnMut(u32, u32)) {
        let mut ordered = |a: u32, b: u32| visit(a.min(b), a.max(b));
        let mut start = 0;
        for &end in &self.ends {
            for_each_pair_of(&self.star[start..end], &mut ordered);
            start = end;
        }
        for &other in &self.others {
            self.star.iter().for_each(|&member| ordered(member, other));
        }
        for_each_pair_of(&self.others, &mut ordered);
    }
}

fn for_each_pair_of(members: &[u32], visit: &mut impl FnMut(u32, u32)) {
    for (index, &first) in members.iter().enumerate() {
        members[index + 1..]
            .iter()
            .for_each(|&second| visit(first, second));
    }
}

/// The node and the kind that more than half of the edges have, if there is one. Poles are no points of
/// the plane, and curves of zones may meet again.
fn middle_of(edges: &[Edge], members: &[u32]) -> Option<(u32, CurveKind)> {
    let mut counts: FxHashMap<u32, usize> = FxHashMap::default();
    for &member in members {
        let edge = &edges[member as usize];
        for node in [edge.from, edge.to] {
            *counts.entry(node).or_default() += 1;
        }
    }
    let (&middle, &count) = counts.iter().max_by_key(|&(node, count)| (count, node))?;
    if 2 * count <= members.len() {
        return None;
    }
    let mut at_middle = members.iter().map(|&member| &edges[member as usize]);
    let edge = at_middle.find(|edge| edge.from == middle || edge.to == middle)?;
    (!edge.kind.is_of_zones()).then_some((middle, edge.kind))
}

fn is_of_star(edge: &Edge, middle: u32, kind: CurveKind) -> bool {
    let point = match edge.from == middle {
        true => edge.start,
        false => edge.end,
    };
    let is_there = edge.from == middle || edge.to == middle;
    is_there && edge.kind == kind && !point.is_pole()
}

/// What two edges of a star share if they have more in common than its middle: for straight edges the
/// direction, in lowest terms, for others the node at the other end.
fn parting(edge: &Edge, middle: u32) -> (i64, i64) {
    let (sign, other) = match edge.from == middle {
        true => (1, edge.to),
        false => (-1, edge.from),
    };
    if edge.kind != CurveKind::Straight {
        return (i64::from(other), 0);
    }
    let (turn, rise) = (sign * edge.turn(), sign * (edge.end.lat - edge.start.lat));
    let divisor = greatest_common_divisor(turn.abs(), rise.abs()).max(1);
    (turn / divisor, rise / divisor)
}

fn greatest_common_divisor(mut a: i64, mut b: i64) -> i64 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::boundary::{
        boundary_graph::BoundaryGraph,
        lattice::{LatticePoint, TURN},
        meeting::meetings,
    };

    /// What visits pairs of edges.
    type Pairs<'a> = &'a mut dyn FnMut(&mut dyn FnMut(u32, u32));

    #[test]
    fn only_pairs_that_meet_nowhere_else_are_left_out() {
        let mut graph = BoundaryGraph::default();
        let middle = LatticePoint::new(TURN / 2 - 3, 7 << 30);
        let tip = |x: i64, y: i64| LatticePoint::new(middle.lon + x, middle.lat + y);
        for k in 1..200_i64 {
            let (x, y) = ((k * 7_919 % 41 - 20) << 30, (k * 104_729 % 37 - 18) << 30);
            // Some start the same way, some end on others, and a few lie across all.
            graph.insert(
                CurveKind::Straight,
                middle,
                tip(x * (k % 3 + 1), y * (k % 3 + 1)),
            );
        }
        for k in 0..9 {
            let y = (2 * k - 9) << 32;
            graph.insert(
                CurveKind::Straight,
                tip(-(9 << 32), y),
                tip(9 << 32, -y + 5),
            );
        }
        let members: Vec<u32> = (0..graph.edges.len() as u32).collect();
        let found = |pairs: Pairs<'_>| {
            let mut found = Vec::new();
            pairs(&mut |a, b| {
                let both = [a, b].map(|index| &graph.edges[index as usize]);
                let untraced = || panic!("straight edges need no traces");
                meetings(both, untraced, |meeting| found.push((a, b, meeting)));
            });
            found.sort_unstable();
            found
        };
        let star = EdgeStar::of(&graph.edges, &members, 96);
        let all = found(&mut |visit| for_each_pair_of(&members, &mut |a, b| visit(a, b)));
        let few = found(&mut |visit| star.for_each_pair(visit));
        assert!(all.len() > 500, "{}", all.len());
        assert_eq!(few, all);
        let mut visits = 0;
        star.for_each_pair(|_, _| visits += 1);
        assert_eq!(visits, star.pair_count());
        assert!(star.pair_count() < (members.len() * members.len() / 4) as u64);
    }
}
