//! Hosts whose projections turn the picture over: faces then wind the other way round.

use glam::DVec2;
use globefill::{Extrusion, LonLat, View};

use crate::{
    common::{
        camera::Pose,
        headless::gpu,
        surface::{Cast, DepthKind, Surface, Terrain},
        watch::{CountPainter, judge_counts},
        watcher::{Optics, Watcher},
    },
    gate::{Gate, PLATEAU, SIZE, Subject, figure},
};

/// Right turned over, top turned over, both.
const TURNED_OVER: [DVec2; 3] = [
    DVec2::new(-1.0, 1.0),
    DVec2::new(1.0, -1.0),
    DVec2::new(-1.0, -1.0),
];

#[test]
fn nothing_is_wrong_in_perspectives() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu);
    let subject = Subject::pair();
    let kinds = [
        DepthKind::Reversed,
        DepthKind::Standard,
        DepthKind::Logarithmic,
    ];
    for signs in TURNED_OVER {
        for (terrain, height_m, pitch_deg) in [
            (Terrain::Bare, 2.0, -90.0),
            (PLATEAU, 100.0, -30.0),
            (Terrain::Rough, 3e3, -40.0),
            (Terrain::Bare, 9e5, -90.0),
        ] {
            let mut pose = subject.pose(terrain, height_m).turned(65.0, pitch_deg);
            (pose.signs, pose.aside) = (signs, DVec2::new(0.2, -0.3));
            gate.check(&subject, pose, terrain, &kinds);
        }
    }
    gate.finish();
}

#[test]
fn nothing_is_wrong_along_parallel_lines() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu);
    let subject = Subject::pair();
    let kinds = [DepthKind::Reversed, DepthKind::Standard];
    for signs in TURNED_OVER {
        for (terrain, picture_m, pitch_deg) in [
            (Terrain::Bare, 2.0, -90.0),
            (PLATEAU, 1e3, -35.0),
            (PLATEAU, 3e4, -8.0),
            (Terrain::Rough, 3e4, -50.0),
            (Terrain::Bare, 3e5, -90.0),
        ] {
            let mut pose = subject
                .pose(terrain, 0.0)
                .turned(65.0, pitch_deg)
                .parallel(picture_m)
                .back_by(1e6);
            (pose.signs, pose.aside) = (signs, DVec2::new(0.2, -0.3));
            gate.check(&subject, pose, terrain, &kinds);
        }
    }
    gate.finish();
}

#[test]
fn footprints_lie_where_they_should() {
    let Some(gpu) = gpu() else { return };
    let at = LonLat::new(11.0, 47.0);
    for extrusion in [Extrusion::Normal, Extrusion::Apex] {
        let watchers = [0.0, 0.5].map(|off_rad| {
            let optics = Optics::Rectangle {
                right_rad: 0.3,
                up_rad: 0.1,
            };
            let mut watcher = Watcher::new(at, 5e5, off_rad, 1.0, optics);
            watcher.extrusion = extrusion;
            watcher
        });
        for pose in [
            Pose::nadir(10.0, 46.0, 4e5).turned(20.0, -60.0),
            Pose::nadir(11.0, 47.0, 0.0)
                .turned(20.0, -50.0)
                .parallel(5e5)
                .back_by(3e6),
        ] {
            for signs in TURNED_OVER {
                let pose = Pose { signs, ..pose };
                let cast = Cast::new(&figure(), &pose, SIZE, 1, PLATEAU);
                let surface = Surface::new(&cast, DepthKind::Reversed);
                let mut painter = CountPainter::new(gpu, &watchers, &surface);
                let (drawn, _) = painter.draw(gpu, &mut View::default(), &surface);
                let score = judge_counts(&watchers, &surface, &drawn);
                let name = format!("{extrusion:?} {:?} {signs}", pose.parallel_m);
                println!("{name}: {score}");
                assert!(score.wrong == 0 && score.covered > 0, "{name}: {score}");
            }
        }
    }
}
