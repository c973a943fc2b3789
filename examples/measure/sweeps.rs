//! Run time against error: one setting at a time.

use globefill::{EdgeKind, Inside, LonLat, Polygon, Region};

use crate::{
    heat::{Entry, Heat, Variant},
    scene::{Scene, nadir},
    scenes,
    settings::{Encoding, Normals, Settings, Yardstick},
    technique::TechniqueName,
};

const VIEWS: [&str; 3] = ["50m-all", "50m-country", "50m-horizon"];
const BUDGETS_PX: [f64; 5] = [0.0, 0.1, 0.25, 0.5, 1.0];
const TOLERANCES_M: [f64; 4] = [0.5, 5.0, 50.0, 500.0];
const DEFAULT_BUDGET_PX: f64 = 0.25;
const TECHNIQUES: [TechniqueName; 4] = [
    TechniqueName::Winding,
    TechniqueName::Records,
    TechniqueName::Doubled,
    TechniqueName::Surface,
];
/// Heights of the eye over the ground from which encodings and normals are judged.
const HEIGHTS_M: [f64; 8] = [1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6, 2e7];
/// Of the ground over which normals are judged: on the ellipsoid itself both are right. Seen from a kilometre
/// or more, as the host's ground is some centimetres off.
const PLATEAU_M: f64 = 8000.0;
/// The corner that is looked at, where normals differ most.
const CORNER: LonLat = LonLat::new(10.0, 45.0);

/// All sweeps.
pub fn all(settings: Settings) -> Result<Vec<Heat>, String> {
    let mut heats = Vec::new();
    for view in VIEWS {
        for scene in scenes::named(view)? {
            heats.push(trade_offs(&scene, settings));
        }
    }
    heats.extend(HEIGHTS_M.map(|height_m| encodings(height_m, settings)));
    let high = HEIGHTS_M.into_iter().filter(|&height_m| height_m >= 1e3);
    heats.extend(high.map(|height_m| normals(height_m, settings)));
    Ok(heats)
}

/// Budgets, tolerances and techniques in one view.
fn trade_offs(scene: &Scene, settings: Settings) -> Heat {
    let mut heat = Heat::of_techniques(scene, settings, &[]);
    let entry = |technique, sweep, value: String, is_default| Entry {
        scene: scene.clone(),
        settings,
        technique,
        variant: Some(Variant {
            sweep,
            value,
            is_default,
        }),
    };
    for technique in TECHNIQUES {
        let is_default = technique == TechniqueName::Winding;
        let value = technique.to_string();
        heat.entries
            .push(entry(technique, "technique", value, is_default));
    }
    for pixel_error in BUDGETS_PX {
        let mut of_budget = entry(
            TechniqueName::Winding,
            "pixel_error",
            pixel_error.to_string(),
            pixel_error == DEFAULT_BUDGET_PX,
        );
        of_budget.settings.pixel_error = pixel_error;
        heat.entries.push(of_budget);
    }
    for tolerance_m in TOLERANCES_M {
        let mut of_tolerance = entry(
            TechniqueName::Winding,
            "tolerance_m",
            tolerance_m.to_string(),
            tolerance_m == scene.tolerance_m,
        );
        of_tolerance.scene.tolerance_m = tolerance_m;
        heat.entries.push(of_tolerance);
    }
    heat
}

/// Doubled vertices in every encoding, over a corner.
fn encodings(height_m: f64, settings: Settings) -> Heat {
    let scene = corner(format!("corner-{}", metres(height_m)), height_m, 0.0);
    let variants = [
        (Encoding::Plain, "plain"),
        (Encoding::Local, "local"),
        (Encoding::HighLow, "high-low"),
        (Encoding::Fixed, "fixed"),
    ];
    doubled(&scene, settings, "encoding", &variants, |encoding| {
        let is_default = encoding == Encoding::Fixed;
        let normals = Normals::Geodetic;
        (Yardstick { encoding, normals }, is_default)
    })
}

/// Doubled vertices that stand on either normal, over a corner of a plateau.
fn normals(height_m: f64, settings: Settings) -> Heat {
    let scene = corner(format!("plateau-{}", metres(height_m)), height_m, PLATEAU_M);
    let variants = [
        (Normals::Geodetic, "geodetic"),
        (Normals::Geocentric, "geocentric"),
    ];
    doubled(&scene, settings, "normals", &variants, |normals| {
        let is_default = normals == Normals::Geodetic;
        let encoding = Encoding::Fixed;
        (Yardstick { encoding, normals }, is_default)
    })
}

fn doubled<T: Copy>(
    scene: &Scene,
    settings: Settings,
    sweep: &'static str,
    variants: &[(T, &str)],
    yardstick: impl Fn(T) -> (Yardstick, bool),
) -> Heat {
    let mut heat = Heat::of_techniques(scene, settings, &[]);
    for &(variant, value) in variants {
        let (yardstick, is_default) = yardstick(variant);
        heat.entries.push(Entry {
            scene: scene.clone(),
            settings: Settings {
                yardstick,
                ..settings
            },
            technique: TechniqueName::Doubled,
            variant: Some(Variant {
                sweep,
                value: value.to_owned(),
                is_default,
            }),
        });
    }
    heat
}

fn metres(height_m: f64) -> String {
    if height_m < 1e4 {
        format!("{height_m}m")
    } else {
        format!("{height_m:e}m")
    }
}

/// A triangle some hundred kilometres wide, seen from above one corner; so finely stored that chords do not tell.
fn corner(name: String, height_m: f64, ground_m: f64) -> Scene {
    let at = |east_deg: f64, north_deg: f64| {
        LonLat::new(CORNER.lon_deg + east_deg, CORNER.lat_deg + north_deg)
    };
    let polygon = Polygon {
        shell: vec![CORNER, at(3.1, 0.7), at(1.3, 2.9)],
        holes: Vec::new(),
    };
    let region = Region {
        polygons: vec![polygon],
        edges: EdgeKind::Geodesic,
        inside: Inside::Smaller,
        zones: Vec::new(),
    };
    let viewpoint = nadir(CORNER.lon_deg, CORNER.lat_deg, ground_m + height_m);
    Scene {
        tolerance_m: 0.001,
        ground_m,
        origin: at(1.5, 1.2),
        ..Scene::new(name, viewpoint, vec![region])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is compared is drawn in one heat, with one default each.
    #[test]
    fn every_sweep_has_a_default() {
        let settings = Settings {
            size_px: glam::UVec2::new(64, 36),
            pixel_error: DEFAULT_BUDGET_PX,
            yardstick: Yardstick::default(),
            moving: false,
        };
        for heat in all(settings).unwrap() {
            assert_eq!(heat.entries[0].technique, TechniqueName::Globe);
            let variants = || {
                heat.entries
                    .iter()
                    .filter_map(|entry| entry.variant.clone())
            };
            for sweep in variants().map(|variant| variant.sweep) {
                let defaults = variants()
                    .filter(|variant| variant.sweep == sweep && variant.is_default)
                    .count();
                assert_eq!(defaults, 1, "{sweep}");
            }
        }
    }
}
