//! Which side of a polygon's boundary is inside.

use rayon::prelude::*;

use crate::{
    boundary::authalic::{Authalic, Enclosed},
    boundary::boundary_graph::{BoundaryGraph, DirectedEdge},
    boundary::lattice::LatticePoint,
    boundary::meridian_index::MeridianIndex,
    boundary::simple_loops::Component,
    ellipsoid::Ellipsoid,
    error::RegionError,
    region::Inside,
};

/// A polygon's boundary with the inside to the left of every loop.
#[derive(Clone, Debug, Default)]
pub(crate) struct Boundary {
    /// Closed loops, none of which visits a node twice.
    pub(crate) loops: Vec<Vec<DirectedEdge>>,
    /// What they enclose together.
    pub(crate) enclosed: Enclosed,
    /// Rings that were dropped because they remove nothing.
    pub(crate) idle_holes: Vec<usize>,
}

/// A component, and what lies to its left.
struct Side {
    component: Component,
    enclosed: Enclosed,
}

impl Side {
    fn reverse(&mut self) {
        self.component.reverse();
        self.enclosed = self.enclosed.reversed();
    }
}

/// Directs a polygon's components by the inside rule.
///
/// The component of the shell that encloses most is directed by `inside`, other parts of the shell by
/// the even-odd rule; `Smaller` turns them round if together they enclose more than half of the globe. Of a hole, the side away from the shell is removed; a hole outside the shell, or
/// within another hole, removes nothing and is dropped. With no shell left, holes are cut out of
/// the whole globe, their smaller side each.
pub(crate) fn direct(
    ellipsoid: &Ellipsoid,
    graph: &BoundaryGraph,
    authalic: &Authalic,
    components: Vec<Component>,
    inside: Inside,
) -> Result<Boundary, RegionError> {
    let mut sides: Vec<Side> = components
        .into_iter()
        .map(|component| {
            let edges: Vec<_> = component.edges().collect();
            Side {
                enclosed: authalic.enclosed(graph, &edges),
                component,
            }
        })
        .collect();
    let half_m2 = 0.5 * authalic.globe_m2();
    let smaller_m2 = |side: &Side| {
        let left_m2 = authalic.left_m2(side.enclosed);
        left_m2.min(authalic.globe_m2() - left_m2)
    };
    let main = (0..sides.len())
        .filter(|&index| !sides[index].component.is_hole())
        .max_by(|&a, &b| smaller_m2(&sides[a]).total_cmp(&smaller_m2(&sides[b])));
    let Some(main) = main else {
        for side in &mut sides {
            if authalic.left_m2(side.enclosed) < half_m2 {
                side.reverse();
            }
        }
        return Ok(gather(sides.into_iter()));
    };
    if inside == Inside::Smaller && authalic.left_m2(sides[main].enclosed) > half_m2 {
        sides[main].reverse();
    }
    if sides.len() == 1 {
        return Ok(gather(sides.into_iter()));
    }
    let mut kept = direct_others(ellipsoid, graph, &mut sides, main)?;
    // A belt has two components, each with its smaller side beyond.
    if inside == Inside::Smaller && shell_m2(authalic, &sides) > half_m2 {
        sides[main].reverse();
        kept = direct_others(ellipsoid, graph, &mut sides, main)?;
    }
    let idle_holes = sides.iter().zip(&kept).filter(|(_, kept)| !**kept);
    let idle_holes = idle_holes.map(|(side, _)| side.component.ring).collect();
    let kept = sides.into_iter().zip(kept).filter(|(_, kept)| *kept);
    Ok(Boundary {
        idle_holes,
        ..gather(kept.map(|(side, _)| side))
    })
}

/// Area inside the shell, holes not counted.
fn shell_m2(authalic: &Authalic, sides: &[Side]) -> f64 {
    let shell = sides.iter().filter(|side| !side.component.is_hole());
    let enclosed = shell.map(|side| side.enclosed);
    authalic.left_m2(enclosed.fold(Enclosed::default(), Enclosed::plus))
}

fn gather(sides: impl Iterator<Item = Side>) -> Boundary {
    let mut boundary = Boundary::default();
    for side in sides {
        boundary.enclosed = boundary.enclosed.plus(side.enclosed);
        boundary.loops.extend(side.component.loops);
    }
    boundary
}

/// Edges and components passed on meridians before a polygon counts as a tangle: of rings within rings
/// each has all that hold it on its way.
const MOST_PASSED: u64 = 4_000_000_000;

/// What becomes of a component.
#[derive(Clone, Copy, PartialEq)]
enum Fate {
    Kept,
    Reversed,
    Dropped,
}

/// Directs all components but the main one; answers which of them bound anything.
fn direct_others(
    ellipsoid: &Ellipsoid,
    graph: &BoundaryGraph,
    sides: &mut [Side],
    main: usize,
) -> Result<Vec<bool>, RegionError> {
    let labelled = sides
        .iter()
        .enumerate()
        .flat_map(|(label, side)| side.component.edges().map(move |edge| (edge, label as u32)));
    let index = MeridianIndex::new(ellipsoid, graph, labelled);
    let start_of = |side: &Side| point_on(graph, side.component.edges());
    if sides
        .iter()
        .map(|side| index.passed(start_of(side)))
        .sum::<u64>()
        > MOST_PASSED
    {
        let edges = sides.iter().map(|side| side.component.edges().count());
        return Err(RegionError::Tangled { edges: edges.sum() });
    }
    // Components that separate a point of this one from the north pole. Looked up one by one: of rings
    // within rings all together would be more than memory holds.
    let separating = |side: &Side| index.separating(ellipsoid, graph, start_of(side), |_| {});
    let of_main = separating(&sides[main]);
    let fate_of = |own: usize| {
        if own == main {
            return Fate::Kept;
        }
        fate(sides, [own, main], &separating(&sides[own]), &of_main)
    };
    let fates: Vec<Fate> = (0..sides.len()).into_par_iter().map(fate_of).collect();
    for (side, fate) in sides.iter_mut().zip(&fates) {
        if *fate == Fate::Reversed {
            side.reverse();
        }
    }
    Ok(fates
        .into_iter()
        .map(|fate| fate != Fate::Dropped)
        .collect())
}

/// What becomes of the component `own`, from what separates it, and the main one, from the north pole.
fn fate(sides: &[Side], [own, main]: [usize; 2], of_own: &[u32], of_main: &[u32]) -> Fate {
    let separates = |other: usize, from: &[u32]| from.binary_search(&(other as u32)).is_ok();
    let main_has_own = sides[main].enclosed.has_north_pole() != separates(main, of_own);
    let mut hole_between = false;
    let mut facing_inside = main_has_own;
    // Only components on one of the two meridians can lie between.
    for &between in of_own.iter().chain(of_main) {
        let between = between as usize;
        let is_between = separates(between, of_own) != separates(between, of_main);
        if between == own || between == main || !is_between {
            continue;
        }
        if !sides[between].component.is_hole() {
            facing_inside = !facing_inside;
        } else {
            hole_between = true;
        }
    }
    if sides[own].component.is_hole() && (hole_between || !facing_inside) {
        return Fate::Dropped;
    }
    let left_has_main = sides[own].enclosed.has_north_pole() != separates(own, of_main);
    if left_has_main == facing_inside {
        Fate::Kept
    } else {
        Fate::Reversed
    }
}

/// A node of closed edges that is not a pole.
pub(crate) fn point_on(
    graph: &BoundaryGraph,
    edges: impl Iterator<Item = DirectedEdge>,
) -> LatticePoint {
    edges
        .map(|edge| graph.nodes[graph.start_node(edge) as usize])
        .find(|point| !point.is_pole())
        .unwrap_or_default()
}
