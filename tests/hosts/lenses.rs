//! Perspectives of every width, off their middle, with near planes near and far, and every depth buffer.

use glam::DVec2;

use crate::{
    common::{
        camera::{DepthRange, DepthSteps, Pose},
        headless::gpu,
        surface::{DepthKind, Surface, Terrain},
    },
    gate::{Gate, PLATEAU, Subject, cast},
};

const EVERY_DEPTH: [DepthKind; 5] = [
    DepthKind::Reversed,
    DepthKind::ReversedFinite,
    DepthKind::Standard,
    DepthKind::Reversed24,
    DepthKind::Standard24,
];

#[test]
fn nothing_is_wrong_with_any_depth_buffer() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu);
    let subject = Subject::pair();
    for terrain in [Terrain::Bare, PLATEAU] {
        for (height_m, heading_deg, pitch_deg) in
            [(10.0, 0.0, -90.0), (1e3, 150.0, -35.0), (9e5, 0.0, -90.0)]
        {
            let pose = subject
                .pose(terrain, height_m)
                .turned(heading_deg, pitch_deg);
            gate.check(&subject, pose, terrain, &EVERY_DEPTH);
        }
    }
    gate.finish();
}

#[test]
fn nothing_is_wrong_through_telescopes_and_wide_lenses() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu);
    let subject = Subject::pair();
    for fov_deg in [1.0, 10.0, 120.0, 150.0] {
        for (terrain, height_m, heading_deg, pitch_deg) in [
            (Terrain::Bare, 2.0, 0.0, -90.0),
            (PLATEAU, 100.0, 20.0, -90.0),
            (Terrain::Rough, 100.0, 150.0, -60.0),
            (Terrain::Bare, 1e3, 65.0, -30.0),
            (Terrain::Bare, 1e5, 0.0, -90.0),
            (Terrain::Bare, 2e7, 0.0, -90.0),
        ] {
            let pose = Pose {
                fov_deg,
                ..subject
                    .pose(terrain, height_m)
                    .turned(heading_deg, pitch_deg)
            };
            let kinds = [DepthKind::Reversed, DepthKind::Standard];
            gate.check(&subject, pose, terrain, &kinds);
        }
    }
    gate.finish();
}

#[test]
fn nothing_is_wrong_off_the_middle_of_a_lens() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu);
    let subject = Subject::pair();
    for (height_m, aside) in [
        (5.0, DVec2::new(0.6, -0.3)),
        (1e3, DVec2::new(-0.2, 0.8)),
        (1e6, DVec2::new(0.05, 0.02)),
    ] {
        let pose = Pose {
            aside,
            ..subject.pose(PLATEAU, height_m)
        };
        let kinds = [DepthKind::Reversed, DepthKind::Standard];
        gate.check(&subject, pose, PLATEAU, &kinds);
    }
    gate.finish();
}

/// Near planes of a centimetre, and such that they cut the walls, or end just before the surface.
#[test]
fn nothing_is_wrong_behind_near_planes_near_and_far() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu);
    let subject = Subject::pair();
    for (terrain, height_m, heading_deg, pitch_deg) in [
        (Terrain::Bare, 2.0, 0.0, -90.0),
        (PLATEAU, 10.0, 65.0, -30.0),
        (PLATEAU, 500.0, 10.0, -60.0),
        (Terrain::Rough, 3e3, 65.0, -40.0),
    ] {
        let pose = subject
            .pose(terrain, height_m)
            .turned(heading_deg, pitch_deg);
        let cast = cast(&pose, terrain);
        let nearest_m = cast.nearest_m();
        for near_m in [0.01, 0.5 * nearest_m, 0.99 * nearest_m] {
            let far_m = 1e7;
            for range in [
                DepthRange::ReversedInfinite { near_m },
                DepthRange::ReversedFinite { near_m, far_m },
            ] {
                let surface = Surface::stored(&cast, range, DepthSteps::Float);
                gate.judge(&format!("{pose:?}, {range:?}"), &subject, &surface);
            }
        }
    }
    gate.finish();
}
