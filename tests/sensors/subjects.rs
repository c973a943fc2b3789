//! The sensors whose edges are judged.

use globefill::LonLat;

use crate::{
    AT,
    common::watcher::{Optics, Watcher},
};

/// A sensor with a covered place and an uncovered one; its edge is looked at between the two.
pub struct Subject {
    pub name: String,
    pub watcher: Watcher,
    pub inside: LonLat,
    pub outside: LonLat,
}

/// One sensor of each kind at each height, and such as see to the limb or a least elevation.
pub fn subjects() -> Vec<Subject> {
    let mut subjects = Vec::new();
    for height_m in [1e4, 5.5e5, 3.6e7] {
        let scale = if height_m > 1e7 { 0.2 } else { 1.0 };
        let kinds = [
            (
                "cone",
                Optics::Annulus {
                    inner_rad: 0.0,
                    outer_rad: 0.4 * scale,
                },
            ),
            (
                "rectangle",
                Optics::Rectangle {
                    right_rad: 0.5 * scale,
                    up_rad: 0.2 * scale,
                },
            ),
            (
                "corners",
                Optics::Corners(
                    [(0.4, -0.3), (0.1, 0.5), (-0.4, -0.2)]
                        .map(|(right, up)| (right * scale, up * scale))
                        .to_vec(),
                ),
            ),
        ];
        let east = |angle_deg: f64| LonLat::new(AT.lon_deg + angle_deg, AT.lat_deg);
        let far = east(90_f64.min(height_m / 1e4));
        for (kind, optics) in kinds {
            subjects.push(Subject {
                name: format!("{kind} from {height_m:.0} m"),
                watcher: Watcher::new(AT, height_m, 0.1 * scale, 1.0, optics),
                inside: AT,
                outside: far,
            });
        }
        let all = |inner_rad| Optics::Annulus {
            inner_rad,
            outer_rad: 2.0,
        };
        for least_deg in [None, Some(1.0), Some(10.0)] {
            let mut watcher = Watcher::new(AT, height_m, 0.3, 1.0, all(0.0));
            watcher.min_elevation_rad = least_deg.map(f64::to_radians);
            subjects.push(Subject {
                name: format!("elevation {least_deg:?} from {height_m:.0} m"),
                watcher,
                inside: AT,
                outside: east(150.0),
            });
        }
        // The inner edge, from the covered outside in.
        subjects.push(Subject {
            name: format!("inner cone from {height_m:.0} m"),
            watcher: Watcher::new(AT, height_m, 0.02, 1.0, all(0.3 * scale)),
            inside: east(if height_m > 1e7 {
                60.0
            } else {
                0.00001 * height_m
            }),
            outside: AT,
        });
    }
    subjects
}
