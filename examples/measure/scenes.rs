//! The scenes, by name.

mod paper;
mod polygons;

use globefill::{Ellipsoid, FieldOfView, LonLat};

use crate::{
    host::{camera::Viewpoint, spiral::spiral},
    scene::{Scene, Sensors, nadir},
};

/// How many fills share one total area.
const FILL_COUNTS: [usize; 6] = [1, 10, 100, 1000, 3600, 10_000];
/// What is filled of all within [`REACH_DEG`].
const FILLED_SHARE: f64 = 0.4;
/// Around which scenes of circles lie, and how far from it.
const MIDDLE: LonLat = LonLat::new(10.0, 20.0);
const REACH_DEG: f64 = 65.0;
/// Circles that lie apart or over each other.
const DEEP_COUNT: usize = 2000;
/// The same circles, over each other, within this of the middle.
const DEEP_REACH_DEG: f64 = 5.0;
/// Vertices of the mesh that is seen at a slant, and its rings.
const OBLIQUE_VERTICES: usize = 446_540;
const OBLIQUE_RINGS: usize = 20;
const MOVING_SENSORS: usize = 100;
const MOVING_RADIUS_DEG: f64 = 7.2;
const SENSOR_HEIGHT_M: f64 = 700e3;

/// All that a word of the command line names.
pub fn named(word: &str) -> Result<Vec<Scene>, String> {
    let scenes: Vec<Scene> = match word {
        "paper" => paper::all()?,
        "fills" => FILL_COUNTS.into_iter().map(fills).collect(),
        "depth" => vec![overlapping()?, separate()?],
        "overlapping" => vec![overlapping()?],
        "separate" => vec![separate()?],
        "oblique" => vec![oblique()],
        "footprints" => vec![footprints()?],
        _ => match word.strip_prefix("fills-").map(str::parse) {
            Some(Ok(count)) if (1..=100_000).contains(&count) => vec![fills(count)],
            _ => {
                let mut paper = paper::all()?;
                paper.retain(|scene| scene.name == word);
                paper
            }
        },
    };
    if scenes.is_empty() {
        return Err(format!(
            "--scene {word}: no such scene; there are paper (110m-all, 110m-country, 110m-horizon, \
             50m-…), fills (fills-N), depth (overlapping, separate), oblique, footprints, sweep"
        ));
    }
    Ok(scenes)
}

fn from_afar() -> Viewpoint {
    nadir(MIDDLE.lon_deg, MIDDLE.lat_deg, 2e7)
}

/// Radius of each of `count` circles that together fill the share, degrees.
fn radius_deg(count: usize) -> f64 {
    let within = 1.0 - REACH_DEG.to_radians().cos();
    let cosine = 1.0 - FILLED_SHARE * within / count as f64;
    cosine.acos().to_degrees()
}

fn fills(count: usize) -> Scene {
    let middles = spiral(MIDDLE, REACH_DEG, count);
    let regions = polygons::circles(&middles, radius_deg(count));
    Scene::new(format!("fills-{count}"), from_afar(), regions)
}

fn separate() -> Result<Scene, String> {
    circles_and_sensors("separate", REACH_DEG)
}

fn overlapping() -> Result<Scene, String> {
    circles_and_sensors("overlapping", DEEP_REACH_DEG)
}

fn circles_and_sensors(name: &str, reach_deg: f64) -> Result<Scene, String> {
    let middles = spiral(MIDDLE, reach_deg, DEEP_COUNT);
    let radius_deg = radius_deg(DEEP_COUNT);
    let regions = polygons::circles(&middles, radius_deg);
    Ok(Scene {
        sensors: Some(Sensors {
            field_of_view: cone_over(radius_deg)?,
            height_m: SENSOR_HEIGHT_M,
            feet: middles,
            step_deg: 0.0,
        }),
        unordered: true,
        ..Scene::new(name, from_afar(), regions)
    })
}

fn oblique() -> Scene {
    let viewpoint = Viewpoint {
        heading_deg: 90.0,
        pitch_deg: -30.0,
        ..nadir(0.0, 47.0, 300e3)
    };
    let regions = polygons::rough_rings(OBLIQUE_RINGS, OBLIQUE_VERTICES);
    Scene::new("oblique", viewpoint, regions)
}

fn footprints() -> Result<Scene, String> {
    Ok(Scene {
        sensors: Some(Sensors {
            field_of_view: cone_over(MOVING_RADIUS_DEG)?,
            height_m: SENSOR_HEIGHT_M,
            feet: spiral(MIDDLE, REACH_DEG, MOVING_SENSORS),
            step_deg: 0.2,
        }),
        ..Scene::new("footprints", from_afar(), Vec::new())
    })
}

/// The cone that cuts a circle of that radius out of a sphere; out of the ellipsoid, within 1 %.
fn cone_over(radius_deg: f64) -> Result<FieldOfView, String> {
    let arc_rad = radius_deg.to_radians();
    let apex = 1.0 + SENSOR_HEIGHT_M / Ellipsoid::WGS84.a_m;
    FieldOfView::conic(arc_rad.sin().atan2(apex - arc_rad.cos())).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(at: LonLat) -> glam::DVec3 {
        let (sin_lat, cos_lat) = at.lat_deg.to_radians().sin_cos();
        let (sin_lon, cos_lon) = at.lon_deg.to_radians().sin_cos();
        glam::DVec3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat)
    }

    #[test]
    fn circles_of_one_total_area_lie_apart() {
        for count in FILL_COUNTS {
            let middles: Vec<_> = spiral(MIDDLE, REACH_DEG, count)
                .into_iter()
                .map(unit)
                .collect();
            let apart = (2.0 * radius_deg(count)).to_radians().cos();
            for (index, a) in middles.iter().enumerate().take(300) {
                for b in &middles[..index] {
                    assert!(a.dot(*b) < apart, "{count}");
                }
            }
            let area = count as f64 * (1.0 - radius_deg(count).to_radians().cos());
            assert!((area - FILLED_SHARE * (1.0 - REACH_DEG.to_radians().cos())).abs() < 1e-9);
        }
    }

    #[test]
    fn overlapping_circles_lie_fifty_deep() {
        let within = radius_deg(DEEP_COUNT).to_radians().cos();
        let middle = unit(MIDDLE);
        let depth = spiral(MIDDLE, DEEP_REACH_DEG, DEEP_COUNT)
            .into_iter()
            .filter(|&at| unit(at).dot(middle) > within)
            .count();
        assert!(depth >= 50, "{depth}");
    }

    #[test]
    fn the_slanted_mesh_has_its_vertices() {
        let regions = polygons::rough_rings(OBLIQUE_RINGS, OBLIQUE_VERTICES);
        let vertices = regions
            .iter()
            .flat_map(|region| &region.polygons)
            .map(|polygon| polygon.shell.len());
        assert_eq!(vertices.sum::<usize>(), OBLIQUE_VERTICES);
    }

    #[test]
    fn words_name_scenes_or_nothing() {
        let names = |word| -> Vec<String> {
            let scenes: Vec<Scene> = named(word).unwrap();
            scenes.into_iter().map(|scene| scene.name).collect()
        };
        assert_eq!(names("paper").len(), 6);
        assert_eq!(names("50m-horizon"), ["50m-horizon"]);
        assert_eq!(names("fills-7"), ["fills-7"]);
        assert!(named("fills-0").is_err());
        assert!(named("moon").is_err());
    }
}
