//! Several viewports of one renderer in one frame, and viewports that change their size.

use glam::UVec2;
use globefill::{CountTechnique, View};

use crate::{
    common::{
        camera::Pose,
        draw::IdPainter,
        headless::gpu,
        score::{expected_ids, judge},
        surface::{Cast, DepthKind, Surface, Terrain},
    },
    gate::{PLATEAU, Subject, TECHNIQUES, figure},
};

fn surface(pose: &Pose, size_px: UVec2, terrain: Terrain) -> Surface {
    let cast = Cast::new(&figure(), pose, size_px, 1, terrain);
    Surface::new(&cast, DepthKind::Reversed)
}

fn assert_right(subject: &Subject, surface: &Surface, ids: &[u32], name: &str) {
    let expected = expected_ids(&subject.oracle, surface);
    let score = judge(&subject.oracle, surface, &expected, ids, 0.0);
    assert!(score.is_clean() && score.covered > 0, "{name}: {score}");
}

/// A map beside a close view, of different sizes, prepared in turn for several frames.
#[test]
fn viewports_do_not_disturb_each_other() {
    let Some(gpu) = gpu() else { return };
    let subject = Subject::pair();
    for count in TECHNIQUES {
        let scenes = [
            (
                subject.pose(Terrain::Bare, 2e6),
                UVec2::new(200, 120),
                Terrain::Bare,
            ),
            (subject.pose(PLATEAU, 20.0), UVec2::new(90, 160), PLATEAU),
            (
                subject.pose(Terrain::Bare, 1e4).turned(65.0, -30.0),
                UVec2::new(160, 90),
                Terrain::Bare,
            ),
        ];
        let surfaces = scenes.map(|(pose, size_px, terrain)| surface(&pose, size_px, terrain));
        let mut painter = IdPainter::new(gpu, subject.mesh.clone(), &surfaces[0], count);
        let mut views: [View; 3] = Default::default();
        for frame in 0..3 {
            for (index, surface) in surfaces.iter().enumerate() {
                let picture = painter.draw(gpu, &mut views[index], surface, 0.0);
                let name = format!("{count:?}, frame {frame}, view {index}");
                assert_right(&subject, surface, &picture.ids, &name);
            }
        }
        // What did not change is not uploaded again.
        let again = painter.draw(gpu, &mut views[1], &surfaces[1], 0.0);
        assert_eq!(again.stats.upload_bytes, 0);
    }
}

#[test]
fn views_follow_their_windows_size() {
    let Some(gpu) = gpu() else { return };
    let subject = Subject::pair();
    for count in TECHNIQUES {
        let mut painter: Option<IdPainter> = None;
        let mut view = View::default();
        for (width, height) in [(64, 48), (200, 100), (1, 1), (33, 77), (64, 48)] {
            let pose = subject.pose(Terrain::Bare, 5e3);
            let surface = surface(&pose, UVec2::new(width, height), Terrain::Bare);
            let painter = painter
                .get_or_insert_with(|| IdPainter::new(gpu, subject.mesh.clone(), &surface, count));
            let ids = painter.draw(gpu, &mut view, &surface, 0.0).ids;
            assert_right(&subject, &surface, &ids, &format!("{width} x {height}"));
        }
    }
}

/// Depth that runs the other way is another host: views may be kept, renderers not.
#[test]
fn a_view_may_move_to_another_renderer() {
    let Some(gpu) = gpu() else { return };
    let subject = Subject::pair();
    let pose = subject.pose(Terrain::Bare, 5e3);
    let cast = Cast::new(&figure(), &pose, UVec2::new(160, 90), 1, Terrain::Bare);
    let surfaces = [DepthKind::Reversed, DepthKind::Standard].map(|kind| Surface::new(&cast, kind));
    for surface in &surfaces {
        let mut view = View::default();
        let mesh = subject.mesh.clone();
        let mut painter = IdPainter::new(gpu, mesh, surface, CountTechnique::Winding);
        let ids = painter.draw(gpu, &mut view, surface, 0.0).ids;
        assert_right(&subject, surface, &ids, "either way");
    }
}
