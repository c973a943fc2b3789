//! Which pieces may overlap: all other pairs are proven disjoint.
//!
//! Two pieces whose boundaries do not cross, whose sectors at common nodes are disjoint, and of
//! whose loops none starts inside the other, are disjoint: were a point common to both, then either
//! a loop of one would enter the inside of the other (it cannot cross its boundary, so it would lie
//! there wholly, or leave a common node into a sector of it), or the one would lie in the other, and
//! its loops with it.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use crate::{
    boundary::arcs::EdgeSides,
    boundary::boundary_graph::{BoundaryGraph, DirectedEdge},
    boundary::headings::sort_counter_clockwise,
    boundary::inside::{Boundary, point_on},
    boundary::lattice::LatticePoint,
    boundary::meridian_index::MeridianIndex,
    ellipsoid::Ellipsoid,
    error::RegionError,
    limits::{Limits, Quantity},
};

type Pair = (u32, u32);

/// Pairs looked at before the input counts as a tangle: a copied polygon meets every other copy at
/// every edge.
const MOST_VISITS: usize = 20_000_000;

/// Edges passed on meridians before the input counts as a tangle: parts by the million on one meridian
/// each have all others to the north.
const MOST_PASSED: u64 = 10_000_000_000;

/// Distinct pairs, and how often pairs were added.
struct Pairs {
    found: FxHashSet<Pair>,
    visits: usize,
    edges: usize,
}

impl Pairs {
    fn add(&mut self, a: u32, b: u32) -> Result<(), RegionError> {
        self.visits += 1;
        if self.visits > MOST_VISITS {
            return Err(RegionError::Tangled { edges: self.edges });
        }
        if a != b {
            self.found.insert(pair(a, b));
        }
        Ok(())
    }
}

fn pair(a: u32, b: u32) -> Pair {
    (a.min(b), a.max(b))
}

/// Sorted pairs of pieces that may overlap; `crossing` are those whose boundaries cross.
pub(crate) fn overlaps(
    ellipsoid: &Ellipsoid,
    graph: &BoundaryGraph,
    sides: &EdgeSides,
    pieces: &[Boundary],
    crossing: Vec<Pair>,
    limits: &Limits,
) -> Result<Vec<Pair>, RegionError> {
    let loops = pieces.iter().flat_map(|piece| &piece.loops);
    let mut pairs = Pairs {
        found: crossing.into_iter().collect(),
        visits: 0,
        edges: loops.map(Vec::len).sum(),
    };
    add_same_side(sides, &mut pairs)?;
    add_common_sectors(ellipsoid, graph, sides, pieces, &mut pairs)?;
    let found = pairs.found.len();
    let contained = contained(ellipsoid, graph, sides, pieces, limits, found)?;
    pairs.found.extend(contained);
    limits.check(Quantity::Overlaps, pairs.found.len())?;
    let mut sorted: Vec<Pair> = pairs.found.into_iter().collect();
    sorted.sort_unstable();
    Ok(sorted)
}

/// Pieces on the same side of one edge.
fn add_same_side(sides: &EdgeSides, pairs: &mut Pairs) -> Result<(), RegionError> {
    let mut further = sides.further().to_vec();
    further.sort_unstable_by_key(|(edge, piece)| (edge.index(), *piece));
    for run in further.chunk_by(|a, b| a.0 == b.0) {
        for (index, &(edge, piece)) in run.iter().enumerate() {
            let others = run[..index].iter().map(|(_, other)| *other);
            for other in sides.left_of(edge).into_iter().chain(others) {
                pairs.add(other, piece)?;
            }
        }
    }
    Ok(())
}

/// Pieces that have a sector in common at a node where three or more edges meet. (Where two meet,
/// each side of both edges belongs to one piece, or is listed already.)
fn add_common_sectors(
    ellipsoid: &Ellipsoid,
    graph: &BoundaryGraph,
    sides: &EdgeSides,
    pieces: &[Boundary],
    pairs: &mut Pairs,
) -> Result<(), RegionError> {
    let mut stars: FxHashMap<u32, Vec<DirectedEdge>> = FxHashMap::default();
    for &edge in pieces.iter().flat_map(|piece| piece.loops.iter().flatten()) {
        for outgoing in [edge, edge.reversed()] {
            let node = graph.start_node(outgoing);
            if sides.degree(node) > 2 {
                stars.entry(node).or_default().push(outgoing);
            }
        }
    }
    let mut further: FxHashMap<DirectedEdge, Vec<u32>> = FxHashMap::default();
    for &(edge, piece) in sides.further() {
        further.entry(edge).or_default().push(piece);
    }
    let left_of = |edge: DirectedEdge| {
        let more = further.get(&edge).into_iter().flatten().copied();
        sides.left_of(edge).into_iter().chain(more)
    };
    for star in stars.values_mut() {
        star.sort_unstable_by_key(|edge| edge.index());
        star.dedup();
        let certain = sort_counter_clockwise(ellipsoid, graph, star);
        let mut present: Vec<u32> = Vec::new();
        // The first round finds what covers the first edge's beginning.
        for edge in star.iter().chain(star.iter()) {
            if certain {
                for ended in left_of(edge.reversed()) {
                    present.retain(|&piece| piece != ended);
                }
            }
            for begun in left_of(*edge) {
                for &other in &present {
                    pairs.add(other, begun)?;
                }
                if !present.contains(&begun) {
                    present.push(begun);
                }
            }
        }
    }
    Ok(())
}

/// Pieces that contain a vertex of a loop of another, beside `found` pairs known before.
fn contained(
    ellipsoid: &Ellipsoid,
    graph: &BoundaryGraph,
    sides: &EdgeSides,
    pieces: &[Boundary],
    limits: &Limits,
    found: usize,
) -> Result<Vec<Pair>, RegionError> {
    let labelled = pieces.iter().enumerate().flat_map(|(piece, boundary)| {
        boundary
            .loops
            .iter()
            .flatten()
            .map(move |&edge| (edge, piece as u32))
    });
    let index = MeridianIndex::new(ellipsoid, graph, labelled);
    let loops = || pieces.iter().flat_map(|piece| &piece.loops);
    let starts = loops().map(|edges| point_on(graph, edges.iter().copied()));
    if starts.map(|point| index.passed(point)).sum::<u64>() > MOST_PASSED {
        return Err(RegionError::Tangled {
            edges: loops().map(Vec::len).sum(),
        });
    }
    let count = AtomicUsize::new(found);
    let most = limits.most(Quantity::Overlaps);
    let has_pole = |piece: u32| {
        let boundary = &pieces[piece as usize];
        boundary.loops.is_empty() || boundary.enclosed.has_north_pole()
    };
    let polar: Vec<u32> = (0..pieces.len() as u32)
        .filter(|&piece| has_pole(piece))
        .collect();
    let pairs = pieces
        .par_iter()
        .enumerate()
        .flat_map_iter(|(own, boundary)| {
            let own = own as u32;
            let (index, polar, count) = (&index, &polar, &count);
            let is_full = move || count.load(Ordering::Relaxed) > most;
            let loops = boundary.loops.iter().take_while(move |_| !is_full());
            loops.flat_map(move |edges| {
                let mut void = vec![own];
                let point = quiet_point_on(graph, sides, edges);
                let separating =
                    index.separating(ellipsoid, graph, point, |label| void.push(label));
                let outside_pole = separating.iter().filter(|&&other| !has_pole(other));
                let around_pole = polar
                    .iter()
                    .filter(|other| separating.binary_search(other).is_err());
                let containing = outside_pole
                    .chain(around_pole)
                    .filter(|other| !void.contains(other));
                let pairs: Vec<Pair> = containing.map(|&other| pair(own, other)).collect();
                count.fetch_add(pairs.len(), Ordering::Relaxed);
                pairs
            })
        })
        .collect();
    limits.check(Quantity::Overlaps, count.into_inner())?;
    Ok(pairs)
}

/// A node of a loop where, if there is one, no other piece's edges end: many loops may share a node.
fn quiet_point_on(
    graph: &BoundaryGraph,
    sides: &EdgeSides,
    edges: &[DirectedEdge],
) -> LatticePoint {
    let is_quiet = |edge: &&DirectedEdge| sides.degree(graph.start_node(**edge)) == 2;
    let own = point_on(graph, edges.iter().filter(is_quiet).copied());
    if own == LatticePoint::default() {
        point_on(graph, edges.iter().copied())
    } else {
        own
    }
}
