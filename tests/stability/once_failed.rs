//! Cells that failed once. They are in the catalogue, too.

use globefill::EdgeKind;

use crate::{
    common::headless::gpu,
    gate::Gate,
    placement::{BESIDE_POLE, NEAR_SOUTH_POLE, PLACEMENTS, POLE_EDGE},
    real, shapes,
    shot::{BARE, HIGH_AND_LOW},
    subject::Subject,
};

/// A vertex of a bottom cap falls on a pixel's centre, within 1/256 px, amid a disc whose boundary is out
/// of sight. Moved by that much and seen at a slant, the cap came before the surface.
#[test]
fn a_cap_moved_by_less_than_a_pixel_stays_below_the_surface() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new("a moved cap", gpu);
    let disc = &shapes::great()[0];
    let subject = Subject::placed(disc, &POLE_EDGE, EdgeKind::Geodesic);
    gate.check(&subject, &BARE[8..9]);
    gate.finish();
}

/// From amid tall walls, pixels met slivers between cut and straight columns, where depth is ill-defined:
/// one wrong at (159, 98), 1.1 m above the edge of Natural Earth's hole at the south pole.
#[test]
fn no_pixel_meets_a_sliver() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new("slivers", gpu);
    let mut antarctica = real::countries().swap_remove(0);
    for _ in 0..2 {
        antarctica.foci.lift_m += 0.1;
        gate.check(&antarctica, &HIGH_AND_LOW[3..4]);
    }
    gate.finish();
}

/// 50 m above the point where the forty slices of a pie meet, looking 30° down, walls from −11 to 9 km:
/// all walls between slices are seen exactly edge-on. Where one that has no width on the screen covers a
/// pixel's centre, the stencil counts the slice on one side once too often and that on the other once too
/// seldom. If the latter came first, the former was painted: slice 16 at (200, 56), 26 px outside the pie.
#[test]
fn slices_seen_from_their_common_vertex() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new("edge-on slices", gpu);
    let pie = &shapes::many()[2];
    for placement in &PLACEMENTS {
        let subject = Subject::placed(pie, placement, EdgeKind::Geodesic);
        gate.check(&subject, &HIGH_AND_LOW[8..9]);
    }
    gate.finish();
}

/// A hundred and twenty slivers of rhumb lines whose common vertex is 4° from a pole. One passes over the pole:
/// at the vertex its sides differ by 1.6e-7 rad, which was taken for a tie, and a tie for a reason to let all
/// pairs overlap.
#[test]
fn slivers_of_rhumb_lines_by_a_pole() {
    let fan = &shapes::thin()[2];
    for placement in &[POLE_EDGE, BESIDE_POLE] {
        let subject = Subject::placed(fan, placement, EdgeKind::Rhumb);
        assert_eq!(subject.mesh.overlaps, [], "{}", placement.name);
    }
}

/// Slivers 400 m wide seen from 4·10⁸ m, where that is 0.004 px: snapped to 1/256 px they may be turned over,
/// and their fill is counted −1 times, which is no fill's sum. Such a pixel took what its left neighbour alone
/// showed, a sliver 0.58 px away.
#[test]
fn slivers_far_thinner_than_a_pixel() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new("slivers from afar", gpu);
    let fan = &shapes::thin()[2];
    let subject = Subject::placed(fan, &NEAR_SOUTH_POLE, EdgeKind::Straight);
    gate.check(&subject, &BARE);
    gate.finish();
}
