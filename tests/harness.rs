//! The harness itself: the depth buffer holds what was cast, and the score sees displacement.

mod common;

use common::{
    camera::Pose,
    figure::Figure,
    headless::gpu,
    oracle::Oracle,
    scene::{depth_texture, read_depths},
    score::{Score, expected_ids, judge},
    surface::{Cast, DepthKind, Surface, Terrain},
};
use glam::{DVec2, UVec2};
use globefill::{EdgeKind, Ellipsoid, LonLat, Polygon, Region, wgpu};

const SIZE: UVec2 = UVec2::new(160, 90);

fn surface_of(pose: &Pose, samples: u32, terrain: Terrain, kind: DepthKind) -> Surface {
    Surface::new(&Cast::new(&figure(), pose, SIZE, samples, terrain), kind)
}

fn score_of(truth: &Oracle, surface: &Surface, drawn: &[u32]) -> Score {
    judge(truth, surface, &expected_ids(truth, surface), drawn, 0.0)
}

fn figure() -> Figure {
    Figure::new(Ellipsoid::WGS84)
}

fn poses() -> Vec<Pose> {
    vec![
        Pose::nadir(10.0, 50.0, 2e7),
        Pose::nadir(10.0, 50.0, 9e5),
        Pose::nadir(-80.0, -30.0, 5e4).turned(70.0, -5.0),
        Pose::nadir(0.0, 90.0, 1e6).turned(120.0, -60.0),
        Pose::nadir(7.0, 46.0, 12_000.0).turned(200.0, -20.0),
    ]
}

#[test]
fn projecting_a_ray_returns_its_pixel() {
    for pose in poses() {
        for kind in [DepthKind::Reversed, DepthKind::Standard] {
            let surface = surface_of(&pose, 1, Terrain::Bare, kind);
            for (index, point_m) in surface.points_m.iter().enumerate() {
                let Some(point_m) = point_m else { continue };
                let (x, y) = (index as u32 % SIZE.x, index as u32 / SIZE.x);
                let (px, distance_m) = surface.lens.project(*point_m);
                let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                assert!((px - at).length() < 1e-6, "{px} {at}");
                let clip = surface.lens.camera().clip_from_view
                    * (surface.lens.camera().view_from_ecef
                        * (*point_m - surface.lens.camera().eye_ecef_m))
                        .extend(1.0);
                let depth = (clip.z / clip.w) as f32;
                let stored = surface.depths[index];
                assert!((depth.to_bits() as i64 - stored.to_bits() as i64).abs() <= 1);
                assert!((clip.w - distance_m).abs() < 1e-6);
            }
        }
    }
}

#[test]
fn rays_meet_the_surface() {
    for pose in poses() {
        for terrain in [
            Terrain::Bare,
            Terrain::Plateau { height_m: 4000.0 },
            Terrain::Rough,
        ] {
            let surface = surface_of(&pose, 1, terrain, DepthKind::Reversed);
            let (low_m, high_m) = terrain.range_m();
            for (index, point_m) in surface.points_m.iter().enumerate() {
                let Some(point_m) = point_m else { continue };
                let (foot, height_m) = figure().geodetic(*point_m);
                let unit_m = {
                    let depth = surface.depths[index];
                    surface.lens.distance_m(depth.next_down()) - surface.lens.distance_m(depth)
                };
                let off_m = height_m - terrain.height_m(figure().normal(foot));
                assert!(off_m.abs() < 1e-7 + 2.0 * unit_m, "{terrain:?}: {off_m} m");
                assert!(height_m > low_m - 2.0 * unit_m - 1e-7);
                assert!(height_m < high_m + 2.0 * unit_m + 1e-7);
            }
        }
    }
}

#[test]
fn the_depth_texture_holds_the_surface() {
    let Some(gpu) = gpu() else { return };
    for kind in [DepthKind::Reversed, DepthKind::Standard] {
        let surface = surface_of(&poses()[2], 1, Terrain::Rough, kind);
        let (texture, _) = depth_texture(gpu, &surface, wgpu::TextureFormat::Depth32Float);
        assert!(read_depths(gpu, &texture) == surface.depths);
        let surface = surface_of(&poses()[2], 4, Terrain::Rough, kind);
        depth_texture(gpu, &surface, wgpu::TextureFormat::Depth32Float);
    }
}

fn meadow(shift_deg: f64) -> Vec<Region> {
    let square = |west: f64, east: f64| Region {
        polygons: vec![Polygon {
            shell: [(west, 45.0), (east, 45.0), (east, 47.0), (west, 47.0)]
                .map(|(x, y)| LonLat::new(x + shift_deg, y))
                .to_vec(),
            holes: vec![],
        }],
        edges: EdgeKind::Straight,
        ..Default::default()
    };
    vec![square(6.0, 7.0), square(7.0, 8.0)]
}

/// A picture drawn with every boundary `shift_px` to the east must be judged so.
#[test]
fn the_score_sees_displacement() {
    let pose = Pose::nadir(7.0, 46.0, 20_000.0);
    for terrain in [Terrain::Bare, Terrain::Plateau { height_m: 4000.0 }] {
        let surface = surface_of(&pose, 1, terrain, DepthKind::Reversed);
        let truth = Oracle::new(&meadow(0.0), Ellipsoid::WGS84);
        let perfect = expected_ids(&truth, &surface);
        let score = score_of(&truth, &surface, &perfect);
        assert!(score.is_clean() && score.covered == SIZE.element_product() as usize);
        let middle = (SIZE / 2).as_dvec2();
        let ground_m = figure().ecef(LonLat::new(7.0, 46.0), terrain.range_m().1);
        let metre_px = (surface.lens.project(ground_m).1 * 30f64.to_radians().tan() * 2.0
            / f64::from(SIZE.y))
        .recip();
        assert!((surface.lens.project(ground_m).0 - middle).length() < 1e-6);
        let metre_deg = 1.0
            / (figure().ecef(LonLat::new(8.0, 46.0), 0.0)
                - figure().ecef(LonLat::new(7.0, 46.0), 0.0))
            .length();
        for shift_px in [0.51, 3.3] {
            let shifted = Oracle::new(&meadow(shift_px / metre_px * metre_deg), Ellipsoid::WGS84);
            let drawn = expected_ids(&shifted, &surface);
            let score = score_of(&truth, &surface, &drawn);
            // The border runs down the middle of the picture: whole columns of pixels are wrong.
            let columns = f64::round(shift_px) as usize;
            assert_eq!(
                score.wrong,
                columns * SIZE.y as usize,
                "{shift_px}: {score:?}"
            );
            assert_eq!(score.stray, score.wrong);
            let worst_px = columns as f64 - 0.5;
            assert!(
                (score.worst_px - worst_px).abs() < 0.02,
                "{shift_px}: {score:?}"
            );
        }
        let mut painted = perfect.clone();
        painted[0] = 0;
        painted[1] = 77;
        let score = score_of(&truth, &surface, &painted);
        assert_eq!((score.wrong, score.stray), (2, 1));
    }
}

#[test]
fn the_score_forgives_the_band_only() {
    let pose = Pose::nadir(7.0, 46.0, 20_000.0);
    let surface = surface_of(&pose, 1, Terrain::Bare, DepthKind::Reversed);
    // The pixel column right of the border: 0.5 px off. Move the truth so that it is 0.02 px off.
    let (_, distance_m) = surface
        .lens
        .project(figure().ecef(LonLat::new(7.0, 46.0), 0.0));
    let pixel_m = distance_m * 30f64.to_radians().tan() * 2.0 / f64::from(SIZE.y);
    let degree_m = (figure().ecef(LonLat::new(7.001, 46.0), 0.0)
        - figure().ecef(LonLat::new(7.0, 46.0), 0.0))
    .length()
        / 0.001;
    for (off_px, clean) in [(0.02, true), (0.045, false)] {
        let truth = Oracle::new(
            &meadow((0.5 + off_px) * pixel_m / degree_m),
            Ellipsoid::WGS84,
        );
        let drawn = expected_ids(&Oracle::new(&meadow(0.0), Ellipsoid::WGS84), &surface);
        let score = score_of(&truth, &surface, &drawn);
        assert_eq!(score.wrong == 0, clean, "{score:?}");
        assert!(score.differing >= SIZE.y as usize / 2);
    }
}
