//! Levels of detail: 0 pixels wrong beyond the budget, whatever level a view draws.

mod common;

use common::{
    camera::Pose,
    draw::IdPainter,
    headless::{Gpu, gpu},
    oracle::Oracle,
    score::{expected_ids, judge},
    surface::{Cast, DepthKind, Surface, Terrain},
};
use glam::UVec2;
use globefill::{
    CountTechnique, Ellipsoid, FillMesh, FrameStats, Region, View, countries::Dataset,
    fill_mesh::MeshOptions,
};

const SIZE_PX: UVec2 = UVec2::new(480, 270);

struct Subject {
    mesh: FillMesh,
    oracle: Oracle,
}

impl Subject {
    fn countries(dataset: Dataset) -> Self {
        let countries = dataset.countries().into_iter();
        let regions: Vec<Region> = countries.map(|country| country.region).collect();
        Self {
            mesh: FillMesh::build(&regions, &MeshOptions::default()).expect("real countries"),
            oracle: Oracle::new(&regions, Ellipsoid::WGS84),
        }
    }

    /// Draws a view with both techniques, judges both, and says what the last drew.
    fn check(&self, gpu: &Gpu, pose: Pose, terrain: Terrain, budget_px: f64) -> FrameStats {
        let cast = Cast::new(&self.oracle.figure, &pose, SIZE_PX, 1, terrain);
        let surface = Surface::new(&cast, DepthKind::Reversed);
        let expected = expected_ids(&self.oracle, &surface);
        let techniques = [CountTechnique::Stencil, CountTechnique::Winding];
        let stats = techniques.map(|count| {
            let mut painter = IdPainter::new(gpu, self.mesh.clone(), &surface, count);
            let picture = painter.draw(gpu, &mut View::default(), &surface, budget_px);
            let score = judge(&self.oracle, &surface, &expected, &picture.ids, budget_px);
            let view = format!(
                "{:.0} m, pitch {}, {terrain:?}, budget {budget_px}, {count:?}",
                pose.height_m, pose.pitch_deg
            );
            let stats = picture.stats;
            println!(
                "{view}: level {}, {} vertices: {score}",
                stats.level, stats.vertices
            );
            assert!(score.is_clean(), "{view}: {score}; {:?}", score.examples);
            stats
        });
        stats[1]
    }
}

#[test]
fn nothing_is_wrong_beyond_the_budget() {
    let Some(gpu) = gpu() else { return };
    for dataset in [Dataset::Countries110m, Dataset::Countries50m] {
        let subject = Subject::countries(dataset);
        let mut levels = Vec::new();
        for budget_px in [0.25, 1.0] {
            for (height_m, pitch_deg) in [
                (4e8, -90.0),
                (1e8, -90.0),
                (2e7, -90.0),
                (6e6, -60.0),
                (2e6, -35.0),
                (6e5, -90.0),
            ] {
                let pose = Pose::nadir(12.0, 44.0, height_m).turned(20.0, pitch_deg);
                let terrain = if height_m < 5e6 {
                    Terrain::Rough
                } else {
                    Terrain::Bare
                };
                levels.push(subject.check(gpu, pose, terrain, budget_px).level);
            }
        }
        let greatest = subject.mesh.coarser.len() as u32;
        assert_eq!(levels[0], greatest, "from far off");
        assert!(levels[..3].iter().all(|&level| level > 0), "{levels:?}");
    }
}

/// From afar what is drawn follows the picture, not the data.
#[test]
fn finer_data_costs_little_more_from_afar() {
    let Some(gpu) = gpu() else { return };
    let pose = Pose::nadir(10.0, 25.0, 1e8);
    let vertices = [Dataset::Countries110m, Dataset::Countries50m].map(|dataset| {
        let subject = Subject::countries(dataset);
        let drawn = subject.check(gpu, pose, Terrain::Bare, 0.25).vertices;
        let stored = subject.mesh.vertices.len();
        println!("{dataset:?}: {drawn} of {stored}");
        drawn
    });
    assert!(vertices[1] < 2 * vertices[0], "{vertices:?}");
}
