//! Names on the map: the largest first, and none over another.

use egui::{Align2, Color32, FontId, Painter, Rect, pos2, vec2};
use glam::DVec2;
use globefill::{Ellipsoid, LonLat};

use crate::orbit::{Orbit, Picture};

/// Names whose country is narrower than so many points are left out.
const LEAST_POINTS: f64 = 34.0;
const SIZES: std::ops::RangeInclusive<f32> = 11.0..=20.0;

/// Writes names where there is room. `names` are in the order of their importance, with areas in m².
pub fn paint(
    painter: &Painter,
    orbit: &Orbit,
    picture: &Picture,
    pixels_per_point: f32,
    names: &[(&'static str, LonLat, f64)],
) {
    let mut taken: Vec<Rect> = Vec::new();
    for &(name, middle, area_m2) in names {
        let point_m = Ellipsoid::WGS84.ecef(middle, 0.0);
        let Some(at_px) = orbit.pixel_of(picture, point_m) else {
            continue;
        };
        // A square of the country's area, turned towards the eye.
        let Some(beside_px) = beside(orbit, picture, middle, area_m2.sqrt()) else {
            continue;
        };
        let across_points = at_px.distance(beside_px) / f64::from(pixels_per_point);
        if across_points < LEAST_POINTS {
            continue;
        }
        let size = (0.11 * across_points as f32 + 6.0).clamp(*SIZES.start(), *SIZES.end());
        let font = FontId::proportional(size);
        let galley = painter.layout_no_wrap(name.to_owned(), font, Color32::WHITE);
        let at = pos2(at_px.x as f32, at_px.y as f32) / pixels_per_point;
        let place = Align2::CENTER_CENTER.anchor_size(at, galley.size());
        let fits = f64::from(galley.size().x) < 1.3 * across_points;
        if !fits || !painter.clip_rect().contains_rect(place) || is_taken(&taken, place) {
            continue;
        }
        taken.push(place.expand(4.0));
        // A dark rim keeps letters legible on any colour.
        let dark = Color32::from_black_alpha(150);
        for step in [
            vec2(1.0, 0.0),
            vec2(-1.0, 0.0),
            vec2(0.0, 1.0),
            vec2(0.0, -1.0),
        ] {
            painter.galley_with_override_text_color(place.min + step, galley.clone(), dark);
        }
        painter.galley(place.min, galley, Color32::WHITE);
    }
}

fn is_taken(taken: &[Rect], place: Rect) -> bool {
    taken.iter().any(|other| other.intersects(place))
}

fn beside(orbit: &Orbit, picture: &Picture, middle: LonLat, along_m: f64) -> Option<DVec2> {
    let east_deg = (along_m / (Ellipsoid::WGS84.a_m * middle.lat_deg.to_radians().cos().max(0.05)))
        .to_degrees();
    let there = LonLat::new(middle.lon_deg + east_deg.min(40.0), middle.lat_deg);
    orbit.pixel_of(picture, Ellipsoid::WGS84.ecef(there, 0.0))
}
