//! Wrong pixels, counted against the oracle: 0 is the only pass.
//!
//! The pictures are small so that `cargo test` stays short. The full-size run:
//! `cargo test --release --test accuracy -- --ignored --nocapture`

mod common;

use std::{collections::BTreeSet, time::Instant};

use common::{
    camera::Pose,
    draw::IdPainter,
    figure::Figure,
    headless::{Gpu, gpu},
    oracle::Oracle,
    pair_mesh::Pair,
    score::{Score, expected_ids, judge},
    surface::{Cast, DepthKind, Surface, Terrain},
};
use glam::UVec2;
use globefill::{
    CountTechnique, EdgeKind, Ellipsoid, FillMesh, LonLat, Polygon, Region, View,
    countries::Dataset, fill_mesh::MeshOptions,
};

const SMALL: UVec2 = UVec2::new(320, 180);
const FULL: UVec2 = UVec2::new(1280, 720);
const TECHNIQUES: [CountTechnique; 2] = [CountTechnique::Winding, CountTechnique::Stencil];
const PLATEAU: Terrain = Terrain::Plateau { height_m: 4000.0 };

/// Regions, their mesh and their judge.
struct Subject {
    name: String,
    mesh: FillMesh,
    oracle: Oracle,
}

impl Subject {
    fn new(name: &str, regions: &[Region], mesh: FillMesh) -> Self {
        Self {
            name: name.to_owned(),
            mesh,
            oracle: Oracle::new(regions, Ellipsoid::WGS84),
        }
    }

    fn pair(name: &str, pair: Pair) -> Self {
        Self::new(name, &pair.regions(), pair.mesh())
    }

    fn countries(dataset: Dataset) -> Self {
        let regions: Vec<Region> = dataset.countries().into_iter().map(|c| c.region).collect();
        let mesh = FillMesh::build(&regions, &MeshOptions::default()).expect("real countries");
        Self::new(&format!("{dataset:?}"), &regions, mesh)
    }

    /// The middle of the first edge of the first region.
    fn middle(&self) -> LonLat {
        let edge = self.oracle.boundary(0).next().expect("a triangle");
        edge.point(&self.oracle.figure, 0.5)
    }
}

/// Judges every picture before it fails, so that one run shows them all.
struct Gate<'a> {
    gpu: &'a Gpu,
    size_px: UVec2,
    samples: u32,
    pictures: usize,
    /// What `FrameStats::joined_layers` said of winding sums.
    joined: BTreeSet<u32>,
    failed: Vec<String>,
}

impl<'a> Gate<'a> {
    fn new(gpu: &'a Gpu, size_px: UVec2, samples: u32) -> Self {
        Self {
            gpu,
            size_px,
            samples,
            pictures: 0,
            joined: BTreeSet::new(),
            failed: Vec::new(),
        }
    }

    /// Draws and judges a view with both depth conventions and both techniques, which must agree
    /// pixel for pixel.
    fn check(&mut self, subject: &Subject, pose: Pose, terrain: Terrain) {
        let cast = Cast::new(
            &subject.oracle.figure,
            &pose,
            self.size_px,
            self.samples,
            terrain,
        );
        for depth in [DepthKind::Reversed, DepthKind::Standard] {
            let surface = Surface::new(&cast, depth);
            let expected = expected_ids(&subject.oracle, &surface);
            let view = format!(
                "{} from {:.0} m, heading {}, pitch {}, {terrain:?}, {depth:?}",
                subject.name, pose.height_m, pose.heading_deg, pose.pitch_deg
            );
            let pictures = TECHNIQUES.map(|count| {
                let start = Instant::now();
                let mut painter = IdPainter::new(self.gpu, subject.mesh.clone(), &surface, count);
                let picture = painter.draw(self.gpu, &mut View::default(), &surface, 0.0);
                let ms = start.elapsed().as_millis();
                assert_eq!(picture.stats.technique, count, "{view}: no head-room");
                let score = judge(&subject.oracle, &surface, &expected, &picture.ids, 0.0);
                println!("{view}, {count:?}: {score}; {:?}; {ms} ms", picture.stats);
                self.note(&format!("{view}, {count:?}"), &score);
                if count == CountTechnique::Winding {
                    self.joined.insert(picture.stats.joined_layers);
                } else {
                    assert_eq!(picture.stats.joined_layers, 0);
                }
                picture.ids
            });
            let disagreeing: Vec<usize> = (0..surface.pixel_count())
                .filter(|&pixel| pictures[0][pixel] != pictures[1][pixel])
                .collect();
            if let Some(&pixel) = disagreeing.first() {
                let width = self.size_px.x as usize;
                self.failed.push(format!(
                    "{view}: techniques disagree at {} pixels; at {}, {}: {} and {}, truly {}",
                    disagreeing.len(),
                    pixel % width,
                    pixel / width,
                    pictures[0][pixel],
                    pictures[1][pixel],
                    expected[pixel]
                ));
            }
        }
    }

    fn note(&mut self, name: &str, score: &Score) {
        self.pictures += 1;
        assert!(score.surface > 0, "{name}: only sky");
        if !score.is_clean() {
            self.failed
                .push(format!("{name}: {score}; {:?}", score.examples));
        }
    }

    fn finish(self) {
        assert!(self.pictures > 0);
        assert!(
            self.failed.is_empty(),
            "{} failures in {} pictures:\n{}",
            self.failed.len(),
            self.pictures,
            self.failed.join("\n")
        );
    }
}

/// Height of the ellipsoid's normal at which an eye is `height_m` above the terrain.
fn above(terrain: Terrain, at: LonLat, height_m: f64) -> f64 {
    let figure = Figure::new(Ellipsoid::WGS84);
    terrain.height_m(figure.normal(at)) + height_m
}

/// Edges of about 100 km, of every kind, and where longitudes are of no use.
fn edges_of_100_km() -> Vec<Subject> {
    let mut subjects: Vec<Subject> = [EdgeKind::Straight, EdgeKind::Rhumb, EdgeKind::Geodesic]
        .map(|kind| {
            let pair = Pair::about(kind, 11.0, 47.0, 65.0, 0.9);
            Subject::pair(&format!("{kind:?} edge"), pair)
        })
        .into();
    let antimeridian = Pair::about(EdgeKind::Straight, 180.0, -17.0, 80.0, 0.9);
    subjects.push(Subject::pair("edge over the antimeridian", antimeridian));
    let at = |lon_deg| LonLat::new(lon_deg, 89.55);
    let over_the_pole = Pair {
        kind: EdgeKind::Geodesic,
        a: at(20.0),
        b: at(-160.0),
        left: at(-70.0),
        right: at(110.0),
    };
    subjects.push(Subject::pair("edge over the pole", over_the_pole));
    subjects
}

/// Nadir over the middle of one 100 km edge: where a chord, a skew wall and single precision show.
fn over_the_middle_of_an_edge(size_px: UVec2) {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu, size_px, 1);
    for subject in edges_of_100_km() {
        let middle = subject.middle();
        for terrain in [Terrain::Bare, PLATEAU, Terrain::Rough] {
            for height_m in [1.0, 10.0, 100.0] {
                let height_m = above(terrain, middle, height_m);
                let pose = Pose::nadir(middle.lon_deg, middle.lat_deg, height_m);
                gate.check(&subject, pose, terrain);
            }
        }
    }
    gate.finish();
}

/// Slanting and far views of the same edges.
fn along_and_across_an_edge(size_px: UVec2, samples: u32) {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu, size_px, samples);
    for subject in edges_of_100_km() {
        let middle = subject.middle();
        for (height_m, heading_deg, pitch_deg) in [
            (1.7, 65.0, -10.0),
            (100.0, 70.0, -20.0),
            (1000.0, 150.0, -35.0),
            (5e4, 65.0, -5.0),
            (9e5, 0.0, -90.0),
            (2e7, 0.0, -90.0),
        ] {
            let pose_over = |terrain| {
                let height_m = above(terrain, middle, height_m);
                Pose::nadir(middle.lon_deg, middle.lat_deg, height_m).turned(heading_deg, pitch_deg)
            };
            gate.check(&subject, pose_over(Terrain::Bare), Terrain::Bare);
            if height_m < 1e5 && samples == 1 {
                gate.check(&subject, pose_over(PLATEAU), PLATEAU);
                gate.check(&subject, pose_over(Terrain::Rough), Terrain::Rough);
            }
        }
    }
    gate.finish();
}

#[test]
fn nothing_is_wrong_over_the_middle_of_an_edge() {
    over_the_middle_of_an_edge(SMALL);
}

#[test]
#[ignore = "full size; see the head of this file"]
fn nothing_is_wrong_over_the_middle_of_an_edge_at_full_size() {
    over_the_middle_of_an_edge(FULL);
}

#[test]
fn nothing_is_wrong_along_and_across_an_edge() {
    along_and_across_an_edge(SMALL, 1);
}

#[test]
#[ignore = "full size; see the head of this file"]
fn nothing_is_wrong_along_and_across_an_edge_at_full_size() {
    along_and_across_an_edge(FULL, 1);
}

#[test]
fn nothing_is_wrong_with_four_samples() {
    along_and_across_an_edge(SMALL, 4);
}

/// A point of the border between Germany and France where the Rhine is: near Strasbourg.
fn on_the_rhine(subject: &Subject) -> LonLat {
    let figure = &subject.oracle.figure;
    let strasbourg = figure.ecef(LonLat::new(7.8, 48.57), 0.0);
    let nearest = (0..subject.oracle.region_count())
        .flat_map(|region| subject.oracle.boundary(region))
        .map(|edge| (edge.nearest(figure, strasbourg), edge))
        .min_by(|a, b| a.0.0.total_cmp(&b.0.0));
    let ((_, t), edge) = nearest.expect("countries have edges");
    edge.point(figure, t)
}

/// The world, a country, the horizon, and a border from near by.
fn countries_from_everywhere(dataset: Dataset, size_px: UVec2) {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu, size_px, 1);
    let subject = Subject::countries(dataset);
    for (lon_deg, lat_deg) in [(10.0, 20.0), (100.0, 30.0), (-100.0, 10.0), (180.0, -20.0)] {
        gate.check(&subject, Pose::nadir(lon_deg, lat_deg, 2e7), Terrain::Bare);
    }
    for lat_deg in [90.0, -90.0] {
        gate.check(&subject, Pose::nadir(0.0, lat_deg, 1e7), Terrain::Bare);
    }
    // From the Moon.
    gate.check(&subject, Pose::nadir(20.0, 10.0, 4e8), Terrain::Bare);
    let germany = Pose::nadir(10.4, 51.1, 9e5);
    let horizon = Pose::nadir(8.0, 47.0, 5e4).turned(20.0, -5.0);
    for terrain in [Terrain::Bare, PLATEAU, Terrain::Rough] {
        gate.check(&subject, germany, terrain);
        gate.check(&subject, horizon, terrain);
    }
    let border = on_the_rhine(&subject);
    for terrain in [Terrain::Bare, PLATEAU, Terrain::Rough] {
        for (height_m, heading_deg, pitch_deg) in [
            (1000.0, 30.0, -30.0),
            (100.0, 200.0, -30.0),
            (1.7, 30.0, -15.0),
        ] {
            let height_m = above(terrain, border, height_m);
            let pose = Pose::nadir(border.lon_deg, border.lat_deg, height_m)
                .turned(heading_deg, pitch_deg);
            gate.check(&subject, pose, terrain);
        }
    }
    gate.finish();
}

#[test]
fn nothing_is_wrong_on_countries_of_110m() {
    countries_from_everywhere(Dataset::Countries110m, SMALL);
}

#[test]
fn nothing_is_wrong_on_countries_of_50m() {
    countries_from_everywhere(Dataset::Countries50m, SMALL);
}

#[test]
#[ignore = "full size; see the head of this file"]
fn nothing_is_wrong_on_countries_at_full_size() {
    countries_from_everywhere(Dataset::Countries110m, FULL);
    countries_from_everywhere(Dataset::Countries50m, FULL);
}

/// Rings about each other, each a fill.
fn rings(count: u32) -> Subject {
    const CORNERS: u32 = 24;
    let ring = |k: u32| -> Vec<LonLat> {
        let corners = (0..CORNERS).map(|corner| {
            let turn = std::f64::consts::TAU * f64::from(corner) / f64::from(CORNERS);
            let radius_deg = 0.5 + 5.0 * f64::from(k) / f64::from(count);
            LonLat::new(
                20.0 + radius_deg * turn.cos(),
                10.0 + radius_deg * turn.sin(),
            )
        });
        corners.collect()
    };
    let regions: Vec<Region> = (1..=count)
        .map(|k| Region {
            polygons: vec![Polygon {
                shell: ring(k),
                holes: vec![ring(k - 1)],
            }],
            ..Default::default()
        })
        .collect();
    let mesh = FillMesh::build(&regions, &MeshOptions::default()).expect("rings are sound");
    Subject::new(&format!("{count} rings"), &regions, mesh)
}

/// Ids and checks share a plane while sums have room in it, and no longer: where the faces of many fills may
/// lie over each other, there is none.
#[test]
fn nothing_is_wrong_whether_sums_share_a_plane_or_not() {
    let Some(gpu) = gpu() else { return };
    for (count, joined) in [(6, 1), (220, 0)] {
        let mut gate = Gate::new(gpu, SMALL, 1);
        let subject = rings(count);
        for (height_m, pitch_deg) in [(1.5e6, -90.0), (1e5, -40.0)] {
            let pose = Pose::nadir(20.0, 8.0, height_m).turned(10.0, pitch_deg);
            gate.check(&subject, pose, Terrain::Rough);
        }
        assert_eq!(gate.joined, BTreeSet::from([joined]), "{count} rings");
        gate.finish();
    }
}

/// The gate can fail: a border drawn a fifth of a pixel aside is seen as that.
#[test]
fn a_displaced_border_is_seen() {
    let Some(gpu) = gpu() else { return };
    let pair = Pair::about(EdgeKind::Straight, 11.0, 47.0, 0.0, 0.9);
    let subject = Subject::pair("true border", pair);
    let middle = subject.middle();
    let pose = Pose::nadir(middle.lon_deg, middle.lat_deg, 50.0);
    let cast = Cast::new(&subject.oracle.figure, &pose, SMALL, 1, Terrain::Bare);
    let surface = Surface::new(&cast, DepthKind::Reversed);
    let expected = expected_ids(&subject.oracle, &surface);
    // The border runs north between two columns of pixels: 0.7 px aside it has passed one of them,
    // whose centres are half a pixel from where the border should be.
    let degree_m = 111_412.84 * 47f64.to_radians().cos() - 93.5 * (3.0 * 47f64.to_radians()).cos();
    let pixel_m = 50.0 * 2.0 * 30f64.to_radians().tan() / f64::from(SMALL.y);
    let aside = |p: LonLat| LonLat::new(p.lon_deg + 0.7 * pixel_m / degree_m, p.lat_deg);
    let moved = Pair {
        a: aside(pair.a),
        b: aside(pair.b),
        ..pair
    };
    let mut painter = IdPainter::new(gpu, moved.mesh(), &surface, TECHNIQUES[0]);
    let picture = painter.draw(gpu, &mut View::default(), &surface, 0.0);
    let score = judge(&subject.oracle, &surface, &expected, &picture.ids, 0.0);
    assert_eq!(score.wrong, SMALL.y as usize, "{score}");
    assert!((score.worst_px - 0.5).abs() < 0.01, "{score}");
    let shifted = Oracle::new(&moved.regions(), Ellipsoid::WGS84);
    let expected = expected_ids(&shifted, &surface);
    let score = judge(&shifted, &surface, &expected, &picture.ids, 0.0);
    assert!(score.is_clean(), "{score}");
}
