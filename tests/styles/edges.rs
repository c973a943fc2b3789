//! Where the edges of lines lie, in fractions of a pixel, and how they move.

use std::collections::BTreeMap;

use glam::{DVec2, UVec2};
use globefill::{HatchKind, Length, LonLat};

use crate::{
    PLACES,
    chart::Sheet,
    common::{camera::Pose, figure::Figure, headless::gpu, surface::Surface},
    coverage::style_of,
    ink::{hatch, sheet},
    stage::{Stage, bare, figure, ground, middle_px, pixel_m, point_at, pose},
};

const SIZE: UVec2 = UVec2::new(160, 60);

/// Across lines, in metres, at a point of the picture.
fn across_m(surface: &Surface, sheet: &Sheet, at_px: DVec2) -> Option<f64> {
    point_at(surface, at_px).map(|point_m| sheet.at_m(point_m).x)
}

/// By row, number of the line and side of it: how far, pixels across the edge, it is drawn from where it
/// should be. Where an edge passes within a quarter of a pixel of the middle of one, the ink there tells
/// how far, whatever the shape of the pixel.
pub fn edges_off(
    surface: &Surface,
    sheet: &Sheet,
    drawn: &[[u8; 4]],
    spacing_m: f64,
    share: f64,
) -> BTreeMap<(usize, i64, bool), f64> {
    let mut offs = BTreeMap::new();
    for (pixel, texel) in drawn.iter().enumerate() {
        let ink = f64::from(texel[0]) / 255.0;
        if !(0.25..0.75).contains(&ink) {
            continue;
        }
        let middle_px = middle_px(surface, pixel);
        let around = [DVec2::ZERO, DVec2::X, -DVec2::X, DVec2::Y, -DVec2::Y]
            .map(|step| across_m(surface, sheet, middle_px + 0.5 * step));
        let [
            Some(here),
            Some(right),
            Some(left),
            Some(below),
            Some(above),
        ] = around
        else {
            continue;
        };
        let per_px = DVec2::new(right - left, below - above).length();
        // Other edges must be some pixels away.
        if per_px > 0.25 * share.min(1.0 - share) * spacing_m {
            continue;
        }
        // Edges lie half a share on either side of multiples of the spacing.
        let number = (here / spacing_m).round();
        let side = (here - number * spacing_m).signum();
        let into_px = (0.5 * share * spacing_m - (here - number * spacing_m).abs()) / per_px;
        let row = pixel / surface.size_px().x as usize;
        offs.insert((row, number as i64, side > 0.0), ink - 0.5 - into_px);
    }
    offs
}

fn worst(offs: impl IntoIterator<Item = f64>) -> f64 {
    offs.into_iter()
        .fold(0.0, |worst, off| worst.max(off.abs()))
}

/// Where lines are drawn steep enough to be met by rows.
const ANGLE_RAD: f32 = 0.35;

fn line_edges(places: &[LonLat], heights_m: &[f64], tilts: &[f64], far_anchors: bool) -> f64 {
    let Some(gpu) = gpu() else { return 0.0 };
    let mut most = 0.0f64;
    for &at in places {
        let first = bare(&pose(at, 1e3, 0.0), SIZE);
        let mut stage = Stage::new(gpu, ground(at), &first);
        // Beside the eye, some degrees away, and on another continent.
        let towards_equator = -at.lat_deg.signum();
        let anchors = [
            at,
            LonLat::new(at.lon_deg - 3.0, at.lat_deg + 2.0 * towards_equator),
            LonLat::new(at.lon_deg + 40.0, at.lat_deg + 55.0 * towards_equator),
        ];
        let anchors = if far_anchors {
            &anchors[..]
        } else {
            &anchors[..1]
        };
        for &anchor in anchors {
            let sheet = sheet(anchor, ANGLE_RAD);
            for &height_m in heights_m {
                for &tilt in tilts {
                    let surface = bare(&pose(at, height_m, tilt), SIZE);
                    let spacing = (23.7 * pixel_m(&surface)) as f32;
                    let lines = hatch(
                        HatchKind::Lines,
                        Length::Metres(spacing),
                        0.5,
                        ANGLE_RAD,
                        anchor,
                    );
                    stage.set(0, style_of(lines));
                    let drawn = stage.draw(&surface).texels;
                    let offs = edges_off(&surface, &sheet, &drawn, f64::from(spacing), 0.5);
                    let off = worst(offs.values().copied());
                    if off > 0.04 || offs.len() < 4 {
                        println!(
                            "{at:?} from {anchor:?} {height_m} m {tilt}: {off:.4} px of {}",
                            offs.len()
                        );
                    }
                    most = most.max(off);
                }
            }
        }
    }
    println!("edges of lines: {most:.4} px");
    most
}

#[test]
fn edges_of_lines_lie_where_they_should() {
    let heights_m = [1.0, 1e3, 1e6, 3.6e7, 4e8];
    assert!(line_edges(&PLACES, &heights_m, &[0.0, 0.7], true) <= 0.05);
}

#[test]
#[ignore = "minutes"]
fn edges_of_lines_lie_where_they_should_everywhere() {
    let heights_m: Vec<f64> = (0..30).map(|k| 1.1 * 1.96f64.powi(k)).collect();
    assert!(line_edges(&PLACES, &heights_m, &[0.0, 0.3, 0.6, 0.85], true) <= 0.05);
}

/// The pose moved along the ground.
fn moved(figure: &Figure, pose: Pose, way_m: f64) -> Pose {
    let east_m = figure.a_m * pose.at.lat_deg.to_radians().cos();
    let mut moved = pose;
    moved.at.lon_deg += (0.8 * way_m / east_m).to_degrees();
    moved.at.lat_deg += (0.6 * way_m / figure.a_m).to_degrees();
    moved
}

#[test]
fn lines_stay_in_place_while_the_camera_moves() {
    let Some(gpu) = gpu() else { return };
    let at = PLACES[0];
    let mut most = (0.0f64, 0.0f64);
    let mut followed = 0;
    let start = bare(&pose(at, 1e3, 0.0), SIZE);
    let mut stage = Stage::new(gpu, ground(at), &start);
    for height_m in [1.0, 10.0, 1e3, 1e6] {
        let pose = pose(at, height_m, 0.3);
        let step_m = 0.17 * pixel_m(&bare(&pose, SIZE));
        let anchor = LonLat::new(at.lon_deg - 3.0, at.lat_deg + 2.0);
        let sheet = sheet(anchor, ANGLE_RAD);
        let spacing = (23.7 * pixel_m(&bare(&pose, SIZE))) as f32;
        let lines = hatch(
            HatchKind::Lines,
            Length::Metres(spacing),
            0.5,
            ANGLE_RAD,
            anchor,
        );
        stage.set(0, style_of(lines));
        let mut last = BTreeMap::new();
        let mut worst_here = 0.0f64;
        for k in 0..50 {
            let surface = bare(&moved(&figure(), pose, f64::from(k) * step_m), SIZE);
            let drawn = stage.draw(&surface).texels;
            let offs = edges_off(&surface, &sheet, &drawn, f64::from(spacing), 0.5);
            for (edge, off) in &offs {
                most.1 = most.1.max(off.abs());
                if let Some(before) = last.get(edge) {
                    let jump: f64 = off - before;
                    worst_here = worst_here.max(jump.abs());
                    followed += 1;
                }
            }
            last = offs;
        }
        println!("{height_m} m: steps off by {worst_here:.4} px");
        most.0 = most.0.max(worst_here);
    }
    println!(
        "steps off by {:.4} px, edges by {:.4} px, {followed} steps",
        most.0, most.1
    );
    assert!(followed > 2000 && most.0 <= 0.05 && most.1 <= 0.05);
}
