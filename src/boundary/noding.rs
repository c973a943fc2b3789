//! Noding: edges that meet inside get a common node there, or are listed as overlapping.

use std::sync::{
    OnceLock, PoisonError, RwLock,
    atomic::{AtomicUsize, Ordering},
};

use rustc_hash::{FxHashMap, FxHashSet};

use crate::{
    boundary::boundary_graph::{BoundaryGraph, DirectedEdge, Edge},
    boundary::curved_meeting::Traced,
    boundary::edge_grid::EdgeGrid,
    boundary::lattice::LatticePoint,
    boundary::lattice_box::LatticeBox,
    boundary::meeting::{Meeting, meetings},
    boundary::rings::RingWalk,
    curve::CurveKind,
    ellipsoid::Ellipsoid,
    error::RegionError,
    limits::{Limits, Quantity},
    repair::{Place, Repair, RepairKind},
};

/// A polygon of the input as walks on the boundary graph: the shell, then the holes.
#[derive(Clone, Debug, Default)]
pub(crate) struct PolygonWalk {
    /// Region and polygon it came from.
    pub(crate) place: Place,
    pub(crate) rings: Vec<RingWalk>,
    /// Whether it is a zone: its rings may wind round parts of it more than once.
    pub(crate) is_zone: bool,
}

/// Splitting moves edges by half a lattice step, which can make new crossings a step away; each
/// round finds those of the round before. Real data needs two.
const MAX_ROUNDS: usize = 8;

/// Pairs of users looked at before the input counts as a tangle: where copies of polygons cross, each
/// meets every other at every crossing.
const MOST_VISITS: usize = 100_000_000;

/// Pairs of curved edges left unclear, and one more for every forty edges, before the input counts as
/// a tangle: each may take some ten milliseconds to give up.
const MOST_UNCLEAR: usize = 2_000;

/// Pairs of polygons (smaller first) whose boundaries cross.
pub(crate) type PolygonPairs = FxHashSet<(u32, u32)>;

/// Splits edges where vertices lie on them and where a polygon crosses itself; answers which
/// polygons cross each other.
pub(crate) fn node_boundaries(
    ellipsoid: &Ellipsoid,
    graph: &mut BoundaryGraph,
    polygons: &mut [PolygonWalk],
    repairs: &mut Vec<Repair>,
    limits: &Limits,
) -> Result<PolygonPairs, RegionError> {
    let mut crossing = PolygonPairs::default();
    let mut met = 0;
    let mut visits = 0;
    let mut first_fresh = 0;
    for _ in 0..MAX_ROUNDS {
        let users = EdgeUsers::new(graph.edges.len(), polygons);
        let found = find_meetings(ellipsoid, graph, &users, first_fresh, limits, met)?;
        met += found.len();
        let mut splits = Splits::default();
        let mut crossed = Vec::new();
        for (first, second, meeting) in found {
            match meeting {
                Meeting::NodeOnFirst(node) => splits.add(first, graph.nodes[node as usize]),
                Meeting::NodeOnSecond(node) => splits.add(second, graph.nodes[node as usize]),
                Meeting::Crossing(point) => match users.common(first, second) {
                    // Whoever else walks these edges meets at a node then, where sectors tell.
                    Some(polygon) => {
                        if !polygons[polygon as usize].is_zone {
                            crossed.push((polygon, first));
                        }
                        splits.add(first, point);
                        splits.add(second, point);
                    }
                    None => visits += users.add_pairs(first, second, &mut crossing),
                },
                Meeting::Unclear => visits += users.add_pairs(first, second, &mut crossing),
            }
            if visits > MOST_VISITS {
                return Err(RegionError::Tangled {
                    edges: graph.edges.len(),
                });
            }
        }
        report_crossings(polygons, crossed, repairs);
        if splits.points.is_empty() {
            break;
        }
        first_fresh = graph.edges.len();
        splits.apply(graph, polygons, &users);
    }
    Ok(crossing)
}

/// Reports polygons that cross themselves, each with an edge that does.
fn report_crossings(
    polygons: &[PolygonWalk],
    mut crossed: Vec<(u32, u32)>,
    repairs: &mut Vec<Repair>,
) {
    crossed.sort_unstable();
    for run in crossed.chunk_by(|a, b| a.0 == b.0) {
        let polygon = &polygons[run[0].0 as usize];
        let places = polygon.places_of(run.iter().map(|&(_, edge)| edge));
        repairs.extend(run.iter().map(|(_, edge)| Repair {
            place: places.get(edge).copied().unwrap_or(polygon.place),
            kind: RepairKind::Crossing,
        }));
    }
}

impl PolygonWalk {
    /// Where in the input these edges of this polygon start, in one walk along it.
    fn places_of(&self, edges: impl Iterator<Item = u32>) -> FxHashMap<u32, Place> {
        let mut wanted: FxHashSet<u32> = edges.collect();
        let mut places = FxHashMap::default();
        for (ring, walk) in self.rings.iter().enumerate() {
            for (edge, &vertex) in walk.edges.iter().zip(&walk.vertices) {
                // Where it is walked first.
                if wanted.remove(&edge.edge()) {
                    let vertex = vertex as usize;
                    let place = Place {
                        ring,
                        vertex,
                        ..self.place
                    };
                    places.insert(edge.edge(), place);
                }
            }
        }
        places
    }
}

/// Which polygons walk each edge.
struct EdgeUsers {
    /// Per edge the end of its run in `polygons`.
    ends: Vec<u32>,
    polygons: Vec<u32>,
}

impl EdgeUsers {
    fn new(edge_count: usize, walks: &[PolygonWalk]) -> Self {
        let uses = || {
            walks.iter().enumerate().flat_map(|(polygon, walk)| {
                let edges = walk.rings.iter().flat_map(|ring| &ring.edges);
                edges.map(move |edge| (edge.edge() as usize, polygon as u32))
            })
        };
        let mut ends = vec![0_u32; edge_count];
        uses().for_each(|(edge, _)| ends[edge] += 1);
        let mut total = 0;
        for end in &mut ends {
            total += *end;
            *end = total - *end;
        }
        let mut polygons = vec![0_u32; total as usize];
        uses().for_each(|(edge, polygon)| {
            polygons[ends[edge] as usize] = polygon;
            ends[edge] += 1;
        });
        Self { ends, polygons }
    }

    fn of(&self, edge: u32) -> &[u32] {
        let edge = edge as usize;
        let first = if edge == 0 { 0 } else { self.ends[edge - 1] };
        &self.polygons[first as usize..self.ends[edge] as usize]
    }

    /// A polygon that walks both edges.
    fn common(&self, first: u32, second: u32) -> Option<u32> {
        // Users are in the order of polygons.
        let others = self.of(second);
        let walks_second = |polygon: &u32| others.binary_search(polygon).is_ok();
        self.of(first).iter().copied().find(walks_second)
    }

    /// Adds the pairs of polygons that walk the edges; answers how many it looked at.
    fn add_pairs(&self, first: u32, second: u32, pairs: &mut PolygonPairs) -> usize {
        for &a in self.of(first) {
            for &b in self.of(second) {
                if a != b {
                    pairs.insert((a.min(b), a.max(b)));
                }
            }
        }
        self.of(first).len() * self.of(second).len()
    }
}

type Found = (u32, u32, Meeting);

/// Pairs of pieces of curves that are looked at again as fast as it is looked up that they were.
const FEW_PIECES: usize = 8;

/// Pairs of curved edges that meet or took time: long ones lie in many common cells of the grid, and are
/// looked at in one of them.
#[derive(Default)]
struct Settled(RwLock<FxHashSet<(u32, u32)>>);

impl Settled {
    fn has(&self, first: u32, second: u32) -> bool {
        let pairs = self.0.read().unwrap_or_else(PoisonError::into_inner);
        pairs.contains(&(first, second))
    }

    fn add(&self, first: u32, second: u32) {
        let mut pairs = self.0.write().unwrap_or_else(PoisonError::into_inner);
        pairs.insert((first, second));
    }
}

/// All meetings of walked edges of which one at least is numbered `first_fresh` or more, after `met`
/// others. Fails if there are too many pairs to look at, or too many meet.
fn find_meetings(
    ellipsoid: &Ellipsoid,
    graph: &BoundaryGraph,
    users: &EdgeUsers,
    first_fresh: usize,
    limits: &Limits,
    met: usize,
) -> Result<Vec<Found>, RegionError> {
    let candidates = candidates(graph, users, first_fresh);
    let edges: Vec<Edge> = candidates
        .iter()
        .map(|&edge| graph.edges[edge as usize])
        .collect();
    // Curves are traced once, by whoever needs them first; straight edges need none.
    let all_straight = edges.iter().all(|edge| edge.kind == CurveKind::Straight);
    let trace_count = if all_straight { 0 } else { edges.len() };
    let traces: Vec<OnceLock<Box<Traced>>> = std::iter::repeat_with(OnceLock::new)
        .take(trace_count)
        .collect();
    let most = limits.most(Quantity::Crossings);
    let most_unclear = MOST_UNCLEAR + edges.len() / 40;
    let unclear = AtomicUsize::new(0);
    let met = AtomicUsize::new(met);
    let settled = Settled::default();
    let found = EdgeGrid::new(&edges)
        .pairs(
            |index| candidates[index as usize] as usize >= first_fresh,
            |a, b, found| {
                if met.load(Ordering::Relaxed) > most
                    || unclear.load(Ordering::Relaxed) > most_unclear
                {
                    return;
                }
                let is_straight = |edge: u32| edges[edge as usize].kind == CurveKind::Straight;
                let is_curved = !(is_straight(a) && is_straight(b));
                if is_curved && settled.has(a, b) {
                    return;
                }
                let (first, second) = (candidates[a as usize], candidates[b as usize]);
                let (a, b) = (a as usize, b as usize);
                let traced = || {
                    [a, b].map(|index| {
                        let trace = || Box::new(Traced::new(ellipsoid, &edges[index]));
                        &**traces[index].get_or_init(trace)
                    })
                };
                let mut meets = false;
                let pieces = meetings([&edges[a], &edges[b]], traced, |meeting| {
                    meets = true;
                    met.fetch_add(1, Ordering::Relaxed);
                    if meeting == Meeting::Unclear {
                        unclear.fetch_add(1, Ordering::Relaxed);
                    }
                    found.push((first, second, meeting));
                });
                if is_curved && (meets || pieces > FEW_PIECES) {
                    settled.add(a as u32, b as u32);
                }
            },
        )
        .map_err(|_| RegionError::Tangled {
            edges: graph.edges.len(),
        })?;
    if unclear.into_inner() > most_unclear {
        return Err(RegionError::Tangled {
            edges: graph.edges.len(),
        });
    }
    limits.check(Quantity::Crossings, met.into_inner())?;
    Ok(found)
}

/// Walked edges that are fresh or lie near fresh ones.
fn candidates(graph: &BoundaryGraph, users: &EdgeUsers, first_fresh: usize) -> Vec<u32> {
    let walked = |&edge: &u32| !users.of(edge).is_empty();
    let all = (0..graph.edges.len() as u32).filter(walked);
    if first_fresh == 0 {
        return all.collect();
    }
    let fresh: Vec<LatticeBox> = (first_fresh as u32..graph.edges.len() as u32)
        .filter(walked)
        .map(|edge| LatticeBox::around(&graph.edges[edge as usize]))
        .collect();
    // A linear scan pays while few edges are fresh, which is the rule.
    if fresh.len() > 256 {
        return all.collect();
    }
    all.filter(|&edge| {
        let edge_box = LatticeBox::around(&graph.edges[edge as usize]);
        edge as usize >= first_fresh || fresh.iter().any(|other| other.meets(&edge_box))
    })
    .collect()
}

/// Points at which edges are to be split.
#[derive(Default)]
struct Splits {
    points: FxHashMap<u32, Vec<LatticePoint>>,
}

impl Splits {
    fn add(&mut self, edge: u32, point: LatticePoint) {
        self.points.entry(edge).or_default().push(point);
    }

    fn apply(self, graph: &mut BoundaryGraph, polygons: &mut [PolygonWalk], users: &EdgeUsers) {
        let mut touched: Vec<u32> = Vec::new();
        let mut parts: FxHashMap<u32, Vec<DirectedEdge>> = FxHashMap::default();
        for (edge, points) in self.points {
            touched.extend(users.of(edge));
            parts.insert(edge, split(graph, graph.edges[edge as usize], points));
        }
        touched.sort_unstable();
        touched.dedup();
        for polygon in touched {
            for ring in &mut polygons[polygon as usize].rings {
                *ring = replace_parts(ring, &parts);
            }
        }
    }
}

/// The parts of an edge between the points, in its order. Parts without length vanish.
fn split(graph: &mut BoundaryGraph, edge: Edge, points: Vec<LatticePoint>) -> Vec<DirectedEdge> {
    let (turn, rise) = (edge.turn() as f64, (edge.end.lat - edge.start.lat) as f64);
    let progress = |point: LatticePoint| {
        let (x, y) = (point.lon - edge.start.lon, point.lat - edge.start.lat);
        (x as f64 * turn + y as f64 * rise) / (turn * turn + rise * rise)
    };
    let mut stops: Vec<(f64, LatticePoint)> = points
        .into_iter()
        .map(|point| {
            // The turn of the edge: points come with canonical longitudes.
            let turned = (-2..=2)
                .map(|turns| point.turned(turns))
                .min_by_key(|turned| {
                    let middle = edge.start.lon + edge.turn() / 2;
                    (turned.lon - middle).abs()
                });
            turned.unwrap_or(point)
        })
        .map(|point| (progress(point), point))
        .collect();
    stops.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut parts = Vec::with_capacity(stops.len() + 1);
    let mut last = edge.start;
    for point in stops.into_iter().map(|(_, point)| point).chain([edge.end]) {
        parts.extend(graph.insert(edge.kind, last, point));
        last = point;
    }
    parts
}

fn replace_parts(ring: &RingWalk, parts: &FxHashMap<u32, Vec<DirectedEdge>>) -> RingWalk {
    let mut walk = RingWalk::default();
    for (&edge, &vertex) in ring.edges.iter().zip(&ring.vertices) {
        match parts.get(&edge.edge()) {
            None => walk.edges.push(edge),
            Some(parts) if edge.is_forward() => walk.edges.extend(parts),
            Some(parts) => walk
                .edges
                .extend(parts.iter().rev().map(|part| part.reversed())),
        }
        walk.vertices.resize(walk.edges.len(), vertex);
    }
    walk
}
