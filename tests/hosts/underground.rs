//! Eyes below the ellipsoid, and inside the volumes.

use crate::{
    common::{
        headless::gpu,
        surface::{DepthKind, Terrain},
    },
    gate::{Gate, Subject},
};

const KINDS: [DepthKind; 2] = [DepthKind::Reversed, DepthKind::Standard];

/// Over a sea floor, in the depths where the bottoms of volumes are.
#[test]
fn nothing_is_wrong_below_the_ellipsoid() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu);
    let subject = Subject::pair();
    for height_m in [-400.0, -10_900.0] {
        let floor = Terrain::Plateau { height_m };
        for (above_m, heading_deg, pitch_deg) in [
            (1.0, 0.0, -90.0),
            (5.0, 65.0, -20.0),
            (100.0, 150.0, -35.0),
            (350.0, 65.0, -5.0),
        ] {
            let pose = subject.pose(floor, above_m).turned(heading_deg, pitch_deg);
            gate.check(&subject, pose, floor, &KINDS);
        }
    }
    gate.finish();
}

/// Between the least and the greatest height that the surface may have.
#[test]
fn nothing_is_wrong_inside_volumes() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu);
    let subject = Subject::pair();
    for (above_m, heading_deg, pitch_deg) in
        [(0.5, 0.0, -90.0), (30.0, 65.0, -10.0), (800.0, 245.0, 0.0)]
    {
        let pose = subject
            .pose(Terrain::Rough, above_m)
            .turned(heading_deg, pitch_deg);
        gate.check(&subject, pose, Terrain::Rough, &KINDS);
    }
    gate.finish();
}

/// Under the surface, looking up at it and through the globe.
#[test]
fn nothing_is_wrong_seen_from_below() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu);
    let subject = Subject::pair();
    for (below_m, heading_deg, pitch_deg) in [
        (2.0, 0.0, 90.0),
        (50.0, 65.0, 30.0),
        (3e3, 150.0, 60.0),
        (2e5, 0.0, 90.0),
    ] {
        let pose = subject
            .pose(Terrain::Ceiling, -below_m)
            .turned(heading_deg, pitch_deg);
        gate.check(&subject, pose, Terrain::Ceiling, &KINDS);
    }
    gate.finish();
}
