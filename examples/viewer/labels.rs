//! Names on the globe, the largest first, none over another.

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, vec2};
use globefill::Ellipsoid;

use crate::{layers::fill_layer::Fact, viewer::Viewer};

/// Names of fills narrower than this are left out.
const LEAST_WIDTH_PX: f64 = 46.0;
const MOST: usize = 60;

pub fn paint(viewer: &Viewer, painter: &Painter, pixels_per_point: f32) {
    let mut facts: Vec<&Fact> = viewer
        .layers
        .iter()
        .filter(|layer| layer.look.visible)
        .flat_map(|layer| &layer.facts)
        .collect();
    facts.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2));
    let mut taken: Vec<Rect> = Vec::new();
    for fact in facts {
        if taken.len() == MOST {
            return;
        }
        let Some((at, width_px)) = place(viewer, fact) else {
            continue;
        };
        if width_px < LEAST_WIDTH_PX {
            continue;
        }
        let at = at / pixels_per_point;
        let font = FontId::proportional((11.0 + width_px / 70.0).min(17.0) as f32);
        let galley = painter.layout_no_wrap(fact.name.clone(), font.clone(), Color32::WHITE);
        let rect = Align2::CENTER_CENTER.anchor_size(at.to_pos2(), galley.size());
        if taken.iter().any(|other| other.expand(4.0).intersects(rect)) {
            continue;
        }
        taken.push(rect);
        // A dark rim keeps names legible over any colour.
        for (x, y) in [
            (-1.0, 0.0),
            (1.0, 0.0),
            (0.0, -1.0),
            (0.0, 1.0),
            (0.8, 0.8),
            (-0.8, -0.8),
        ] {
            write(
                painter,
                rect.center() + vec2(x, y),
                &fact.name,
                &font,
                Color32::from_black_alpha(170),
            );
        }
        write(painter, rect.center(), &fact.name, &font, Color32::WHITE);
    }
}

fn write(painter: &Painter, at: Pos2, text: &str, font: &FontId, color: Color32) {
    painter.text(at, Align2::CENTER_CENTER, text, font.clone(), color);
}

/// Where a fill's middle is in the picture and how wide it is, pixels; none behind the horizon.
fn place(viewer: &Viewer, fact: &Fact) -> Option<(egui::Vec2, f64)> {
    let orbit = &viewer.orbit;
    let eye = orbit.eye(None);
    let label_at = fact.label_at?;
    let ground_m = Ellipsoid::WGS84.ecef(label_at, orbit.ground_m);
    let relative_m = ground_m - eye.camera.eye_ecef_m;
    let slant = -relative_m
        .normalize()
        .dot(Ellipsoid::WGS84.normal(label_at));
    if slant < 0.25 {
        return None;
    }
    let view = eye.camera.view_from_ecef * relative_m;
    let clip = eye.camera.clip_from_view * view.extend(1.0);
    if clip.w <= 0.0 || clip.x.abs() > clip.w || clip.y.abs() > clip.w {
        return None;
    }
    let size_px = orbit.size_px.as_dvec2();
    let x = (clip.x / clip.w * 0.5 + 0.5) * size_px.x;
    let y = (0.5 - clip.y / clip.w * 0.5) * size_px.y;
    let width_px = fact.area_m2.sqrt() * slant / (clip.w * eye.pixel_size());
    Some((vec2(x as f32, y as f32), width_px))
}
