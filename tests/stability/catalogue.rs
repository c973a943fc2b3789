//! Which cells are judged: a fixed choice always, all of them on demand.

use globefill::EdgeKind;

use crate::{
    common::headless::gpu,
    gate::Gate,
    placement::{
        BESIDE_POLE, DATELINE, DATELINE_EDGE, EQUATOR, GENERIC, NORTH_POLE, PLACEMENTS, POLE_EDGE,
        POLE_VERTEX, Placement, SOUTHERN,
    },
    real,
    shape::Shape,
    shapes,
    shot::{BARE, HIGH_AND_LOW, Shot},
    subject::Subject,
};

/// Every shape, every kind of edge, every place, every camera; but the kinds that follow the grid at every
/// other place.
fn all_of(name: &'static str, shapes: Vec<Shape>, shots: &[Shot]) {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(name, gpu);
    for shape in &shapes {
        for (kind, &edges) in shape.edges.iter().enumerate() {
            let stride = if kind == 0 { 1 } else { 2 };
            for placement in PLACEMENTS.iter().skip(kind / 2).step_by(stride) {
                gate.check(&Subject::placed(shape, placement, edges), shots);
            }
        }
    }
    gate.finish();
}

fn all_fixed(name: &'static str, subjects: Vec<Subject>) {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(name, gpu);
    for subject in &subjects {
        gate.check(subject, &[&BARE[..], &HIGH_AND_LOW].concat());
    }
    gate.finish();
}

#[test]
#[ignore = "minutes; see main.rs"]
fn great_shapes() {
    all_of("great shapes", shapes::great(), &BARE);
}

#[test]
#[ignore = "minutes; see main.rs"]
fn antipodal_edges() {
    all_of("antipodal edges", shapes::antipodal(), &BARE);
}

#[test]
#[ignore = "minutes; see main.rs"]
fn crossing_rings() {
    all_of("crossing rings", shapes::crossing(), &BARE);
}

#[test]
#[ignore = "minutes; see main.rs"]
fn tiny_shapes() {
    all_of("tiny shapes", shapes::tiny(), &BARE);
}

#[test]
#[ignore = "minutes; see main.rs"]
fn thin_shapes() {
    all_of("thin shapes", shapes::thin(), &BARE);
}

#[test]
#[ignore = "minutes; see main.rs"]
fn holes_and_islands() {
    all_of("holes and islands", shapes::holes(), &BARE);
}

#[test]
#[ignore = "minutes; see main.rs"]
fn many_parts() {
    all_of("many parts", shapes::many(), &BARE);
}

#[test]
#[ignore = "minutes; see main.rs"]
fn other_figures() {
    all_of("other figures", shapes::figures(), &BARE);
}

#[test]
#[ignore = "minutes; see main.rs"]
fn fixed_rings() {
    all_fixed("rings over the antimeridian", real::over_the_antimeridian());
    all_fixed("boxes", real::boxes());
}

#[test]
#[ignore = "minutes; see main.rs"]
fn countries() {
    all_fixed("countries", real::countries());
}

/// Geodesics of all kinds of shapes over mountains and trenches.
#[test]
#[ignore = "minutes; see main.rs"]
fn high_and_low() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new("high and low", gpu);
    for shape in terrain_shapes() {
        for placement in &PLACEMENTS {
            let subject = Subject::placed(&shape, placement, EdgeKind::Geodesic);
            // Of the pie of 200 m the last camera is a known issue.
            let edge_on = shape.name.starts_with("pie of 40");
            gate.check(
                &subject,
                &HIGH_AND_LOW[..HIGH_AND_LOW.len() - usize::from(edge_on)],
            );
        }
    }
    gate.finish();
}

/// A few of each kind.
fn terrain_shapes() -> Vec<Shape> {
    let few = |shapes: Vec<Shape>, count: usize| shapes.into_iter().take(count);
    few(shapes::great(), 4)
        .chain(few(shapes::crossing(), 4))
        .chain(few(shapes::tiny(), 1))
        .chain(few(shapes::thin(), 2))
        .chain(few(shapes::holes(), 1))
        .chain(shapes::many())
        .collect()
}

/// One shape, where it is put, how its edges run, and which cameras: every sixth from `first` on.
struct Choice {
    shape: Shape,
    placement: Placement,
    edges: EdgeKind,
    first: usize,
}

/// What plain `cargo test` judges: every shape once, places, edges and cameras in turn.
#[test]
fn nothing_is_wrong_in_a_choice_of_cells() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new("the choice", gpu);
    for choice in choices() {
        let subject = Subject::placed(&choice.shape, &choice.placement, choice.edges);
        let shots: Vec<Shot> = BARE.into_iter().skip(choice.first).step_by(6).collect();
        gate.check(&subject, &shots);
    }
    // And amid volumes between −11 and 9 km.
    for (k, shape) in terrain_shapes().iter().enumerate() {
        let placement = &PLACEMENTS[k * 3 % PLACEMENTS.len()];
        let subject = Subject::placed(shape, placement, EdgeKind::Geodesic);
        gate.check(&subject, &HIGH_AND_LOW[6 + k % 2..7 + k % 2]);
    }
    gate.finish();
}

fn choices() -> Vec<Choice> {
    const PLACES: [Placement; 9] = [
        POLE_EDGE,
        DATELINE_EDGE,
        NORTH_POLE,
        GENERIC,
        POLE_VERTEX,
        DATELINE,
        BESIDE_POLE,
        EQUATOR,
        SOUTHERN,
    ];
    let shapes = [
        shapes::great(),
        shapes::antipodal(),
        shapes::crossing(),
        shapes::tiny(),
        shapes::thin(),
        shapes::holes(),
        shapes::many(),
        shapes::figures(),
    ];
    shapes
        .into_iter()
        .flatten()
        .enumerate()
        .map(|(k, shape)| Choice {
            placement: PLACES[k % PLACES.len()],
            edges: shape.edges[k % shape.edges.len()],
            first: k * 5 % 6,
            shape,
        })
        .collect()
}
