//! The views of Schneider and Klein's paper on draping vectors over terrain (2007): all, one country, the
//! horizon; the cameras are those that CesiumJS was measured with.

use globefill::countries::Dataset;

use crate::{
    host::camera::Viewpoint,
    scene::{Scene, nadir},
};

/// Both data sets in all three views.
pub fn all() -> Result<Vec<Scene>, String> {
    let horizon = Viewpoint {
        heading_deg: 90.0,
        pitch_deg: -5.0,
        ..nadir(8.0, 46.0, 5e4)
    };
    let views = [
        ("all", nadir(10.0, 20.0, 2e7)),
        ("country", nadir(10.4, 51.1, 9e5)),
        ("horizon", horizon),
    ];
    let mut scenes = Vec::new();
    for (data, dataset) in [
        ("110m", Dataset::Countries110m),
        ("50m", Dataset::Countries50m),
    ] {
        let regions: Vec<_> = dataset
            .countries()
            .into_iter()
            .map(|country| country.region)
            .collect();
        for (view, viewpoint) in views {
            scenes.push(Scene::new(
                format!("{data}-{view}"),
                viewpoint,
                regions.clone(),
            ));
        }
    }
    Ok(scenes)
}
