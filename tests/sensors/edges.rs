//! Edges of every kind, looked at from every height.

use globefill::{Ellipsoid, LonLat};

use crate::{
    AT, EXTRUSIONS, LARGE, PLATEAU, SMALL,
    common::{camera, headless::gpu, surface::Terrain},
    gate::Gate,
    subjects::{Subject, subjects},
};

fn check_edges(gate: &mut Gate<'_>, heights_m: &[f64], terrains: &[Terrain]) {
    for subject in subjects() {
        for extrusion in EXTRUSIONS {
            for &terrain in terrains {
                let mut watcher = subject.watcher.clone();
                watcher.extrusion = extrusion;
                let ground_m = |normal| terrain.height_m(normal);
                let edge = watcher.edge_between(subject.inside, subject.outside, ground_m);
                let ground_m = ground_m(watcher.figure.normal(edge));
                for &height_m in heights_m {
                    let mut over =
                        camera::Pose::nadir(edge.lon_deg, edge.lat_deg, ground_m + height_m);
                    // The Moon's view is a telescope's.
                    over.fov_deg = if height_m > 1e8 { 1.5 } else { 60.0 };
                    // The edge runs about north.
                    let oblique = over.turned(10.0, -25.0);
                    let poses = if height_m > 1e6 {
                        vec![over]
                    } else {
                        vec![over, oblique]
                    };
                    for pose in poses {
                        let name = format!(
                            "{}, {extrusion:?}, seen from {height_m} m at {}",
                            subject.name, pose.pitch_deg
                        );
                        gate.check(&name, std::slice::from_ref(&watcher), pose, terrain);
                    }
                }
            }
        }
    }
}

#[test]
fn edges_are_sharp_near_and_far() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu, SMALL);
    check_edges(&mut gate, &[1.0, 1e4, 2e7], &[Terrain::Bare, PLATEAU]);
    gate.finish();
}

#[test]
#[ignore = "the whole; minutes"]
fn edges_are_sharp_at_every_height() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu, LARGE);
    gate.both = true;
    let heights_m = [1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6, 2e7, 4e8];
    check_edges(
        &mut gate,
        &heights_m,
        &[Terrain::Bare, PLATEAU, Terrain::Rough],
    );
    gate.finish();
}

#[test]
fn other_bodies_are_seen_as_sharply() {
    let Some(gpu) = gpu() else { return };
    let mut gate = Gate::new(gpu, SMALL);
    for ellipsoid in [Ellipsoid::MOON, Ellipsoid::MARS] {
        let smaller = |subject: &Subject| !subject.name.starts_with("inner");
        for subject in subjects().into_iter().filter(smaller) {
            for extrusion in EXTRUSIONS {
                let mut watcher = subject.watcher.clone().moved_to(ellipsoid);
                watcher.extrusion = extrusion;
                let ground_m = |normal| PLATEAU.height_m(normal);
                let far = LonLat::new(AT.lon_deg + 150.0, AT.lat_deg);
                let edge = watcher.edge_between(subject.inside, far, ground_m);
                for height_m in [10.0, 1e5] {
                    let over = camera::Pose::nadir(edge.lon_deg, edge.lat_deg, 4000.0 + height_m);
                    let name = format!("{} over {ellipsoid:?} from {height_m} m", subject.name);
                    gate.check(&name, std::slice::from_ref(&watcher), over, PLATEAU);
                }
            }
        }
    }
    gate.finish();
}
