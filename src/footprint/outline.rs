//! From the curves that bound a footprint to its loops.

use std::f64::consts::TAU;

use glam::DVec3;

use super::{
    FootprintLoop, arc_set::ArcSet, course::Course, edge::FootprintEdge, horizon::Horizon, rim::Rim,
};

/// Where the horizon crosses a rim.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    /// Angle round the horizon, radians.
    horizon_rad: f64,
    /// Whether the horizon comes into the field of view here.
    enters: bool,
    /// The surface point in scaled coordinates.
    unit: DVec3,
    /// Number of the rim, and where along it.
    rim: usize,
    station: f64,
}

/// The loops of a footprint: the common part of what two families of closed curves hold on their left.
///
/// Where the horizon runs inside the field of view, it bounds the footprint; where it leaves, the
/// boundary turns left into the rim it crossed, and follows that until the horizon comes in again.
pub(super) fn loops(horizon: &Horizon, rims: &[Rim]) -> Vec<FootprintLoop> {
    let lines_m = horizon.sample_lines_m();
    let arcs: Vec<_> = rims
        .iter()
        .map(|rim| rim_arcs(rim, horizon, &lines_m))
        .collect();
    let seen = ArcSet::common(&arcs);
    let mut holds_start = seen.holds_start;
    let crossings = consistent(
        crossings(horizon, rims, &arcs, &seen),
        rims,
        horizon,
        &mut holds_start,
    );
    let mut loops = linked(&crossings, rims, horizon);
    if crossings.is_empty() && holds_start {
        loops.push(FootprintLoop {
            edges: vec![whole_horizon(horizon)],
        });
    }
    for (number, rim) in rims.iter().enumerate() {
        let crossed = crossings.iter().any(|crossing| crossing.rim == number);
        let arcs = &arcs[number];
        let horizon_on_left = if arcs.ends_rad.is_empty() {
            arcs.holds_start
        } else {
            holds_start
        };
        // Within the horizon, a rim that has it on its left has its whole right there too, and the
        // other way round.
        let possible = horizon.margin(rim.well_inside(!horizon_on_left)) > 0.0;
        if !crossed && possible && is_within(rim, horizon) {
            loops.push(FootprintLoop {
                edges: rim.all_edges(horizon),
            });
        }
    }
    // A field of view narrower than rounding on the ground.
    loops.retain(|closed| !closed.edges.is_empty());
    loops
}

/// The parts of the horizon on a rim's left.
fn rim_arcs(rim: &Rim, horizon: &Horizon, lines_m: &[DVec3]) -> ArcSet {
    let mut arcs = rim.arcs_of(horizon, lines_m);
    // If no point of the rim is seen, all that is seen lies on the same side. Not by the sign along the
    // horizon: curves that are one up to rounding may each seem to lie outside the other.
    if arcs.ends_rad.is_empty() && !is_within(rim, horizon) {
        arcs.holds_start = rim.holds(horizon.middle_direction());
    }
    arcs
}

/// Whether a rim that does not cross the horizon lies within it.
fn is_within(rim: &Rim, horizon: &Horizon) -> bool {
    // They may touch: the station farthest from the horizon decides.
    let steps = rim.length().max(8.0) as usize;
    (0..steps)
        .map(|step| {
            let station = rim.length() * step as f64 / steps as f64;
            horizon.margin(rim.direction(station))
        })
        .max_by(|one, other| one.abs().total_cmp(&other.abs()))
        .is_some_and(|margin| margin > 0.0)
}

fn crossings(horizon: &Horizon, rims: &[Rim], arcs: &[ArcSet], seen: &ArcSet) -> Vec<Crossing> {
    seen.ends_rad
        .iter()
        .enumerate()
        .map(|(number, &horizon_rad)| {
            let unit = horizon.unit(horizon_rad);
            // The angle was copied from the rim's own.
            let rim = arcs
                .iter()
                .position(|arcs| arcs.ends_rad.contains(&horizon_rad))
                .unwrap_or(0);
            Crossing {
                horizon_rad,
                enters: (number % 2 == 1) == seen.holds_start,
                unit,
                rim,
                station: rims[rim].station(horizon.apex.line_m(unit)),
            }
        })
        .collect()
}

/// Takes pairs of crossings out: those nearer to each other than rounding can order them along both
/// curves, and until following the rims joins every end to a start.
///
/// Curves that touch cross twice within rounding or not at all; so does the horizon at a corner of the
/// field of view that lies on it.
fn consistent(
    mut crossings: Vec<Crossing>,
    rims: &[Rim],
    horizon: &Horizon,
    holds_start: &mut bool,
) -> Vec<Crossing> {
    let apex = &horizon.apex;
    let least_m = LEAST_GAP_M + LEAST_GAP * apex.apex_ecef_m.length();
    loop {
        let count = crossings.len();
        let gap_rad = |number: usize| {
            let next_rad = crossings[(number + 1) % count].horizon_rad;
            (next_rad - crossings[number].horizon_rad).rem_euclid(TAU)
        };
        let Some(first) = (0..count).min_by(|&one, &other| gap_rad(one).total_cmp(&gap_rad(other)))
        else {
            return crossings;
        };
        let second = (first + 1) % count;
        let apart_m = ((crossings[first].unit - crossings[second].unit) * apex.radii_m).length();
        if apart_m > least_m
            && (0..count).all(|number| is_joined(&crossings, number, rims, horizon))
        {
            return crossings;
        }
        // What was between them counts as what is around them.
        *holds_start = !crossings[first].enters;
        crossings.remove(first.max(second));
        crossings.remove(first.min(second));
    }
}

/// Crossings of the horizon nearer to each other than this, in metres and as a part of the distance of
/// the apex, are none: a hundred times what rounding moves them.
const LEAST_GAP_M: f64 = 1e-5;
const LEAST_GAP: f64 = 1e-14;

/// Whether from this crossing, if the horizon leaves there, its rim leads through seen ground to one
/// where it enters.
fn is_joined(crossings: &[Crossing], number: usize, rims: &[Rim], horizon: &Horizon) -> bool {
    let from = crossings[number];
    if from.enters {
        return true;
    }
    let Some(next) = along_rim(crossings, number, rims) else {
        return false;
    };
    let rim = &rims[from.rim];
    let way = (crossings[next].station - from.station).rem_euclid(rim.length());
    let middle = rim.direction(from.station + 0.5 * way);
    crossings[next].enters && (way < 1e-6 || horizon.margin(middle) > -1e-9)
}

/// The next crossing along a rim.
fn along_rim(crossings: &[Crossing], number: usize, rims: &[Rim]) -> Option<usize> {
    let from = crossings[number];
    let way = |other: usize| {
        (crossings[other].station - from.station).rem_euclid(rims[from.rim].length())
    };
    (0..crossings.len())
        .filter(|&other| other != number && crossings[other].rim == from.rim)
        .min_by(|&one, &other| way(one).total_cmp(&way(other)))
}

/// The loops through crossings, which alternate along the horizon and along every rim.
fn linked(crossings: &[Crossing], rims: &[Rim], horizon: &Horizon) -> Vec<FootprintLoop> {
    let count = crossings.len();
    let mut done = vec![false; count];
    let mut loops = Vec::new();
    for start in 0..count {
        let mut edges = Vec::new();
        let mut enter = start;
        while crossings[enter].enters && !done[enter] {
            done[enter] = true;
            let leave = (enter + 1) % count;
            let (from, to) = (crossings[enter], crossings[leave]);
            edges.push(horizon_arc(horizon, &from, &to));
            let Some(next) = along_rim(crossings, leave, rims) else {
                break;
            };
            let end = crossings[next];
            edges.extend(rims[to.rim].edges_between(
                horizon,
                (to.unit, to.station),
                (end.unit, end.station),
            ));
            enter = next;
        }
        edges.retain(|edge| edge.from != edge.to);
        if !edges.is_empty() {
            loops.push(FootprintLoop { edges });
        }
    }
    loops
}

fn horizon_arc(horizon: &Horizon, from: &Crossing, to: &Crossing) -> FootprintEdge {
    let mut sweep_rad = to.horizon_rad - from.horizon_rad;
    if sweep_rad < 0.0 {
        sweep_rad += TAU;
    }
    let course = Course::Horizon(Box::new(*horizon), from.horizon_rad, sweep_rad);
    FootprintEdge::new(
        horizon.bound(),
        horizon.apex.radii_m,
        (from.unit, to.unit),
        course,
    )
}

fn whole_horizon(horizon: &Horizon) -> FootprintEdge {
    let start = horizon.unit(0.0);
    let course = Course::Horizon(Box::new(*horizon), 0.0, TAU);
    FootprintEdge::new(
        horizon.bound(),
        horizon.apex.radii_m,
        (start, start),
        course,
    )
}
