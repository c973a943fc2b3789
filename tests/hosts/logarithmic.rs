//! Hosts with logarithmic depths, as three.js and CesiumJS write them.

use globefill::{Frame, LogDepth, LonLat, RendererError, View};

use crate::{
    common::{
        camera::{DepthRange, DepthSteps, Pose},
        draw::IdPainter,
        headless::gpu,
        score::{expected_ids, judge},
        surface::{Cast, DepthKind, Surface, Terrain},
        watch::{CountPainter, judge_counts},
        watcher::{Optics, Watcher},
    },
    gate::{Gate, PLATEAU, SIZE, Subject, TECHNIQUES, cast, figure},
};

const KINDS: [DepthKind; 3] = [
    DepthKind::Logarithmic,
    DepthKind::FromNear,
    DepthKind::Logarithmic24,
];

/// Of frames without logarithms.
const PLAIN: [DepthKind; 2] = [DepthKind::Standard, DepthKind::ReversedFinite];

#[test]
fn nothing_is_wrong_at_an_edge() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu);
    let subject = Subject::pair();
    for (terrain, height_m, heading_deg, pitch_deg) in [
        (Terrain::Bare, 1.0, 0.0, -90.0),
        (PLATEAU, 1.7, 65.0, -10.0),
        (Terrain::Bare, 100.0, 70.0, -20.0),
        (Terrain::Rough, 100.0, 0.0, -90.0),
        (Terrain::Rough, 3e3, 65.0, -40.0),
        (Terrain::Bare, 5e4, 65.0, -5.0),
        (PLATEAU, 2e5, 0.0, -90.0),
        (Terrain::Bare, 2e7, 0.0, -90.0),
        (Terrain::Bare, 4e8, 0.0, -90.0),
    ] {
        let mut pose = subject
            .pose(terrain, height_m)
            .turned(heading_deg, pitch_deg);
        if height_m > 1e8 {
            pose.fov_deg = 1.0;
        }
        gate.check(&subject, pose, terrain, &KINDS);
    }
    gate.finish();
}

/// Other steepness, and a near plane that cuts walls.
#[test]
fn nothing_is_wrong_with_other_logarithms() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu);
    let subject = Subject::pair();
    let pose = subject.pose(PLATEAU, 50.0).turned(65.0, -30.0);
    let cast = cast(&pose, PLATEAU);
    for log_depth in [
        LogDepth {
            per_m: 1e-3,
            ..LogDepth::new(0.1, 1e8)
        },
        LogDepth {
            per_m: 1e4,
            ..LogDepth::new(0.01, 1e7)
        },
        LogDepth::from_near(0.9 * cast.nearest_m(), 1e10),
    ] {
        let range = DepthRange::Logarithmic(log_depth);
        let surface = Surface::stored(&cast, range, DepthSteps::Float);
        gate.judge(&format!("{log_depth:?}"), &subject, &surface);
    }
    gate.finish();
}

#[test]
fn nothing_is_wrong_with_four_samples() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu);
    let subject = Subject::pair();
    for (height_m, pitch_deg) in [(100.0, -40.0), (9e5, -90.0)] {
        let pose = subject
            .pose(Terrain::Bare, height_m)
            .turned(65.0, pitch_deg);
        let cast = Cast::new(&figure(), &pose, SIZE, 4, Terrain::Bare);
        let surface = Surface::new(&cast, DepthKind::Logarithmic);
        gate.judge(&format!("{height_m} m"), &subject, &surface);
    }
    gate.finish();
}

/// Frames of one view with and without logarithms, and with parallel lines of sight, by renderers whose other
/// depths run either way.
#[test]
fn depths_may_change_from_frame_to_frame() {
    let Some(gpu) = gpu() else { return };
    let subject = Subject::pair();
    for (count, plain) in TECHNIQUES
        .into_iter()
        .flat_map(|count| PLAIN.map(|plain| (count, plain)))
    {
        let straight = subject.pose(Terrain::Bare, 5e3);
        let surfaces = [
            (straight, plain),
            (straight, DepthKind::Logarithmic),
            (straight.parallel(4e3), plain),
            (straight, DepthKind::FromNear),
            (straight, plain),
        ]
        .map(|(pose, kind)| Surface::new(&cast(&pose, Terrain::Bare), kind));
        let mut painter = IdPainter::new(gpu, subject.mesh.clone(), &surfaces[0], count);
        let mut view = View::default();
        let mut passes = Vec::new();
        for surface in &surfaces {
            let picture = painter.draw(gpu, &mut view, surface, 0.0);
            let expected = expected_ids(&subject.oracle, surface);
            let score = judge(&subject.oracle, surface, &expected, &picture.ids, 0.0);
            assert!(score.is_clean() && score.covered > 0, "{score}");
            passes.push(picture.stats.passes);
        }
        // Copying costs winding sums a pass, and only where it is needed; the stencil copies anyway.
        let copied = if count == TECHNIQUES[0] { 2 } else { passes[0] };
        assert_eq!(passes, [passes[0], copied, passes[0], copied, passes[0]]);
    }
}

#[test]
fn footprints_lie_where_they_should() {
    let Some(gpu) = gpu() else { return };
    let at = LonLat::new(11.0, 47.0);
    for extrusion in [globefill::Extrusion::Normal, globefill::Extrusion::Apex] {
        let watchers = [0.0, 0.5].map(|off_rad| {
            let optics = Optics::Annulus {
                inner_rad: 0.1,
                outer_rad: 0.4,
            };
            let mut watcher = Watcher::new(at, 5e5, off_rad, 1.0, optics);
            watcher.extrusion = extrusion;
            watcher
        });
        for (terrain, height_m, pitch_deg) in [
            (Terrain::Bare, 2e7, -90.0),
            (Terrain::Bare, 1e5, -30.0),
            (PLATEAU, 4e5, -60.0),
        ] {
            let pose = Pose::nadir(10.0, 46.0, height_m).turned(20.0, pitch_deg);
            let cast = Cast::new(&figure(), &pose, SIZE, 1, terrain);
            for kind in KINDS {
                let surface = Surface::new(&cast, kind);
                let mut painter = CountPainter::new(gpu, &watchers, &surface);
                let (drawn, _) = painter.draw(gpu, &mut View::default(), &surface);
                let score = judge_counts(&watchers, &surface, &drawn);
                let name = format!("{extrusion:?} {terrain:?} {height_m} m {kind:?}");
                println!("{name}: {score}");
                assert!(score.wrong == 0 && score.covered > 0, "{name}: {score}");
            }
        }
    }
}

#[test]
fn logarithms_that_cannot_be_are_refused() {
    let Some(gpu) = gpu() else { return };
    let subject = Subject::pair();
    let pose = subject.pose(Terrain::Bare, 5e3);
    let surface = Surface::new(&cast(&pose, Terrain::Bare), DepthKind::Logarithmic);
    let mut painter = IdPainter::new(gpu, subject.mesh.clone(), &surface, TECHNIQUES[0]);
    let mut refused = |camera, log_depth| {
        let frame = Frame {
            log_depth: Some(log_depth),
            ..Frame::new(camera, SIZE)
        };
        let prepared = painter
            .renderer
            .prepare(&gpu.queue, &mut View::default(), &frame);
        prepared.map(|_| ())
    };
    let camera = surface.lens.camera();
    let good = LogDepth::new(0.1, 1e9);
    let bad: [LogDepth; 6] = [
        // The other way round.
        LogDepth {
            near_m: good.far_m,
            far_m: good.near_m,
            ..good
        },
        LogDepth {
            near_m: 0.0,
            ..good
        },
        LogDepth { far_m: 0.1, ..good },
        LogDepth {
            per_m: -1.0,
            ..good
        },
        LogDepth {
            from_m: 0.2,
            ..good
        },
        LogDepth {
            far_m: f64::INFINITY,
            ..good
        },
    ];
    for log_depth in bad {
        let error = RendererError::InvalidFrame("log_depth");
        assert_eq!(refused(camera, log_depth), Err(error));
    }
    let parallel = pose.parallel(4e3);
    let parallel = Surface::new(&cast(&parallel, Terrain::Bare), DepthKind::Standard);
    let camera_of_parallel = parallel.lens.camera();
    assert!(matches!(
        refused(camera_of_parallel, good),
        Err(RendererError::Unsupported(_))
    ));
    refused(camera, good).expect("it can be");
}
