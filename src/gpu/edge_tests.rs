//! The edge pass against boundaries measured in f64.

mod draw;
mod truth;
mod worst;

use glam::UVec2;

use self::{draw::draw, truth::Truth, worst::compare};
use crate::{
    EdgeKind, LonLat,
    common::{
        camera::Pose,
        edge::TrueEdge,
        figure::Figure,
        headless::{Gpu, gpu},
        pair_mesh::Pair,
        surface::{Cast, DepthKind, Surface, Terrain},
    },
    ellipsoid::Ellipsoid,
};

const SIZE: UVec2 = UVec2::new(112, 64);

/// A picture to draw and to judge.
#[derive(Clone, Copy)]
struct Case {
    pair: Pair,
    pose: Pose,
    terrain: Terrain,
    samples: u32,
    /// Metres and pixels.
    reach: [f32; 2],
    /// Whether the projection mirrors the picture.
    mirrored: bool,
}

impl Case {
    fn new(pair: Pair, pose: Pose) -> Self {
        Self {
            pair,
            pose,
            terrain: Terrain::Bare,
            samples: 1,
            reach: [0.0, 6.0],
            mirrored: false,
        }
    }

    /// Draws with both depth conventions and judges; answers what failed.
    fn check(&self, gpu: &Gpu) -> Vec<String> {
        let mut failed = Vec::new();
        let truth = Truth::new(&self.pair);
        let mesh = self.pair.mesh();
        let cast = |samples| Cast::new(&truth.figure, &self.pose, SIZE, samples, self.terrain);
        let centres = cast(1);
        for depth in [DepthKind::Reversed, DepthKind::Standard] {
            let expected = Surface::new(&centres, depth);
            let mut drawn = Surface::new(&cast(self.samples), depth);
            if self.mirrored {
                mirror(&mut drawn.depths);
            }
            let mut texels = draw(gpu, &mesh, &drawn, self.reach, self.mirrored);
            if self.mirrored {
                mirror(&mut texels);
            }
            let worst = compare(&truth, &expected, &texels, self.reach);
            let view = format!("{self}, {depth:?}");
            println!("{view}: {worst:?}");
            if !worst.passes() {
                failed.push(format!("{view}: {worst:?}"));
            }
        }
        failed
    }
}

impl std::fmt::Display for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Pose {
            at,
            height_m,
            pitch_deg,
            ..
        } = self.pose;
        write!(
            f,
            "{:?} at {} N from {height_m} m, pitch {pitch_deg}, {:?}, {} samples, reach {:?}",
            self.pair.kind, at.lat_deg, self.terrain, self.samples, self.reach
        )?;
        f.write_str(if self.mirrored { ", mirrored" } else { "" })
    }
}

/// Turns the rows of a picture around.
fn mirror<T>(pixels: &mut [T]) {
    for row in pixels.chunks_exact_mut(SIZE.x as usize) {
        row.reverse();
    }
}

fn assert_passes(gpu: &Gpu, cases: impl IntoIterator<Item = Case>) {
    let failed: Vec<String> = cases.into_iter().flat_map(|case| case.check(gpu)).collect();
    assert!(failed.is_empty(), "{failed:#?}");
}

fn pair(kind: EdgeKind, length_deg: f64) -> Pair {
    Pair::about(kind, 10.0, 47.0, 60.0, length_deg)
}

/// Views of the middle of the common edge, from beside it.
fn views(pair: &Pair, height_m: f64) -> [Pose; 3] {
    let figure = Figure::new(Ellipsoid::WGS84);
    let common = &TrueEdge::between(&figure, pair.kind, pair.a, pair.b)[0];
    let middle = common.point(&figure, 0.5);
    let aside_deg = (0.2 * height_m / 111_000.0).min(5.0);
    let pose = Pose::nadir(middle.lon_deg + aside_deg, middle.lat_deg, height_m);
    let fov_deg = if height_m > 1e6 { 30.0 } else { 60.0 };
    let pose = Pose { fov_deg, ..pose };
    [pose, pose.turned(290.0, -35.0), pose.turned(200.0, -12.0)]
}

#[test]
fn distances_are_those_to_the_true_boundary() {
    let Some(gpu) = gpu() else { return };
    for (kind, height_m, length_deg) in [
        (EdgeKind::Geodesic, 10.0, 1.0),
        (EdgeKind::Rhumb, 1e3, 1.0),
        (EdgeKind::Straight, 1e5, 2.0),
    ] {
        let pair = pair(kind, length_deg);
        assert_passes(
            gpu,
            views(&pair, height_m).map(|pose| Case::new(pair, pose)),
        );
    }
    let pair = pair(EdgeKind::Geodesic, 25.0);
    assert_passes(gpu, [Case::new(pair, views(&pair, 2e7)[0])]);
}

/// Where many chords end within reach, what is nearest in metres is not nearest in pixels.
#[test]
fn metres_across_the_ends_of_chords_are_those_to_the_nearest() {
    let Some(gpu) = gpu() else { return };
    let pair = pair(EdgeKind::Straight, 2.0);
    let [nadir, oblique, _] = views(&pair, 1e5);
    let case = |pose, metres| Case {
        reach: [metres, 0.0],
        ..Case::new(pair, pose)
    };
    let cases = [(nadir, 1e4), (oblique, 2e4)];
    assert_passes(gpu, cases.map(|(pose, metres)| case(pose, metres)));
}

#[test]
fn metres_and_samples_are_measured_alike() {
    let Some(gpu) = gpu() else { return };
    let pair = pair(EdgeKind::Geodesic, 1.0);
    let [nadir, oblique, _] = views(&pair, 1e3).map(|pose| Case::new(pair, pose));
    let samples = Case {
        samples: 4,
        reach: [0.0, 4.0],
        ..nadir
    };
    let metres = [nadir, oblique].map(|case| Case {
        reach: [100.0, 0.0],
        ..case
    });
    assert_passes(gpu, [samples].into_iter().chain(metres));
}

#[test]
fn terrain_is_measured_at_its_height() {
    let Some(gpu) = gpu() else { return };
    let pair = pair(EdgeKind::Geodesic, 1.0);
    let plateau = Case {
        terrain: Terrain::Plateau { height_m: 4e3 },
        ..Case::new(pair, views(&pair, 5e3)[0])
    };
    assert_passes(gpu, [plateau]);
}

/// Mountains hide each other, and chords lie kilometres below what is seen.
#[test]
fn boundaries_on_mountains_are_measured_where_they_are_seen() {
    let Some(gpu) = gpu() else { return };
    let pair = pair(EdgeKind::Straight, 1.0);
    let [nadir, oblique, _] = views(&pair, 1.2e4).map(|pose| Case {
        terrain: Terrain::Rough,
        ..Case::new(pair, pose)
    });
    let metres = [nadir, oblique].map(|case| Case {
        reach: [500.0, 0.0],
        ..case
    });
    assert_passes(gpu, [nadir, oblique].into_iter().chain(metres));
}

/// An edge over the pole.
#[test]
fn boundaries_at_a_pole_are_measured_like_others() {
    let Some(gpu) = gpu() else { return };
    let pair = Pair {
        kind: EdgeKind::Geodesic,
        a: LonLat::new(180.0, 89.5),
        b: LonLat::new(0.0, 89.5),
        left: LonLat::new(90.0, 89.2),
        right: LonLat::new(-90.0, 89.2),
    };
    let over = Pose::nadir(60.0, 89.95, 1e4);
    let towards = Pose::nadir(60.0, 89.95, 2e3).turned(20.0, -12.0);
    assert_passes(gpu, [over, towards].map(|pose| Case::new(pair, pose)));
}

#[test]
fn mirrored_projections_are_measured_like_others() {
    let Some(gpu) = gpu() else { return };
    let pair = pair(EdgeKind::Geodesic, 1.0);
    let mirrored = |case| Case {
        mirrored: true,
        ..case
    };
    let [nadir, oblique, _] = views(&pair, 1e3).map(|pose| mirrored(Case::new(pair, pose)));
    let mountains = Case {
        terrain: Terrain::Rough,
        ..mirrored(Case::new(pair, views(&pair, 1.2e4)[1]))
    };
    assert_passes(gpu, [nadir, oblique, mountains]);
}
