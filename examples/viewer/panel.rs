//! The panels over the globe.

use egui::{Align2, Color32, Context, RichText, Slider, Ui, vec2};
use globefill::HatchKind;

use crate::{
    labels,
    layers::{
        fill_layer::{FillLayer, Look},
        satellites::{MOST, Satellites},
    },
    viewer::{Loading, Viewer, Wish},
};

pub fn show(viewer: &mut Viewer, ctx: &Context) {
    if viewer.labels {
        let painter = ctx.layer_painter(egui::LayerId::background());
        labels::paint(viewer, &painter, ctx.pixels_per_point());
    }
    egui::Window::new("globefill")
        .anchor(Align2::LEFT_TOP, vec2(12.0, 12.0))
        .default_width(230.0)
        .resizable(false)
        .show(ctx, |ui| {
            egui::ScrollArea::vertical().show(ui, |ui| scene(viewer, ui));
        });
    egui::Window::new("Frame")
        .anchor(Align2::RIGHT_TOP, vec2(-12.0, 12.0))
        .default_width(200.0)
        .resizable(false)
        .show(ctx, |ui| frame(viewer, ui));
    facts(viewer, ctx);
    notices(viewer, ctx);
}

fn scene(viewer: &mut Viewer, ui: &mut Ui) {
    ui.horizontal(|ui| {
        if ui.button("Open GeoJSON…").clicked() {
            viewer.wishes.push(Wish::OpenFile);
        }
        if ui.button("Screenshot").clicked() {
            viewer.wishes.push(Wish::Screenshot);
        }
    });
    ui.horizontal(|ui| {
        ui.checkbox(&mut viewer.labels, "Labels");
        ui.add_enabled_ui(viewer.has_terrain, |ui| {
            ui.checkbox(&mut viewer.terrain, "Terrain");
        });
    });
    ui.separator();
    let mut closed = None;
    for (index, layer) in viewer.layers.iter_mut().enumerate() {
        let asked = ui.push_id(index, |ui| layer_controls(layer, ui)).inner;
        closed = closed.or(asked.then_some(index));
    }
    if let Some(index) = closed {
        viewer.close(index);
    }
    for Loading { name, step, since } in &viewer.loading {
        ui.horizontal(|ui| {
            ui.spinner();
            let line = format!("{name}: {step}, {} s", since.elapsed().as_secs());
            ui.add(egui::Label::new(line).truncate());
        });
    }
    satellites(&mut viewer.satellites, ui);
}

/// Answers whether the layer is to be closed.
fn layer_controls(layer: &mut FillLayer, ui: &mut Ui) -> bool {
    let FillLayer { title, look, .. } = layer;
    let closes = ui
        .horizontal(|ui| {
            ui.checkbox(&mut look.visible, RichText::new(title.as_str()).strong());
            layer.can_be_closed && ui.small_button("×").on_hover_text("Close").clicked()
        })
        .inner;
    if look.visible {
        ui.collapsing("Style", |ui| look_controls(look, ui));
    }
    closes
}

fn look_controls(look: &mut Look, ui: &mut Ui) {
    ui.add(Slider::new(&mut look.opacity, 0.0..=1.0).text("opacity"));
    let kinds = [
        ("plain", None),
        ("lines", Some(HatchKind::Lines)),
        ("cross", Some(HatchKind::Cross)),
        ("dots", Some(HatchKind::Dots)),
        ("checker", Some(HatchKind::Checker)),
    ];
    ui.horizontal_wrapped(|ui| {
        for (name, kind) in kinds {
            ui.selectable_value(&mut look.hatch, kind, name);
        }
    });
    if look.hatch.is_some() {
        ui.add(Slider::new(&mut look.spacing_px, 4.0..=40.0).text("spacing, px"));
    }
    ui.add(Slider::new(&mut look.stroke_px, 0.0..=8.0).text("outline, px"));
}

fn satellites(satellites: &mut Satellites, ui: &mut Ui) {
    let settings = &mut satellites.settings;
    ui.checkbox(&mut settings.visible, RichText::new("Satellites").strong());
    if !settings.visible {
        return;
    }
    ui.horizontal(|ui| {
        let label = if satellites.playing { "Pause" } else { "Play" };
        if ui.button(label).clicked() {
            satellites.playing = !satellites.playing;
        }
        let speed = Slider::new(&mut satellites.speed, 1.0..=1000.0).logarithmic(true);
        ui.add(speed.text("× time"));
    });
    let count = Slider::new(&mut settings.count, 1..=MOST).logarithmic(true);
    ui.add(count.text("count"));
    ui.add(
        Slider::new(&mut settings.height_km, 200.0..=36_000.0)
            .logarithmic(true)
            .text("height, km"),
    );
    ui.add(Slider::new(&mut settings.inclination_deg, 0.0..=90.0).text("inclination, °"));
    ui.add(Slider::new(&mut settings.half_angle_deg, 1.0..=60.0).text("half angle, °"));
    ui.horizontal(|ui| {
        ui.selectable_value(&mut settings.rectangular, false, "conic");
        ui.selectable_value(&mut settings.rectangular, true, "rectangular");
    });
    ui.horizontal(|ui| {
        ui.selectable_value(&mut settings.from_apex, false, "along normal");
        ui.selectable_value(&mut settings.from_apex, true, "from apex");
    });
    ui.checkbox(&mut settings.coverage, "coverage");
    if !settings.coverage {
        ui.add(Slider::new(&mut settings.opacity, 0.02..=0.8).text("opacity"));
    }
}

fn frame(viewer: &mut Viewer, ui: &mut Ui) {
    let stats = viewer.stats;
    let rows = [
        ("time", format!("{:.1} ms", viewer.frame_ms)),
        ("technique", format!("{:?}", stats.technique).to_lowercase()),
        ("upload", bytes(stats.upload_bytes)),
        ("GPU memory", bytes(stats.gpu_bytes)),
        ("fills drawn", format!("{} of {}", stats.drawn, stats.fills)),
        ("draws", stats.draws.to_string()),
        ("passes", stats.passes.to_string()),
        (
            "layers",
            format!("{} ({} styled)", stats.layers, stats.styled_layers),
        ),
        ("sensors", stats.sensors.to_string()),
        ("level", stats.level.to_string()),
    ];
    egui::Grid::new("frame").num_columns(2).show(ui, |ui| {
        for (name, value) in rows {
            ui.label(name);
            ui.monospace(value);
            ui.end_row();
        }
    });
    ui.add(Slider::new(&mut viewer.pixel_error, 0.05..=2.0).text("budget, px"));
    ui.add(egui::Label::new(RichText::new(&viewer.adapter).small()).truncate());
}

fn facts(viewer: &Viewer, ctx: &Context) {
    let fact = |hit: crate::viewer::Hit| {
        let layer = viewer.layers.get(hit.layer)?;
        layer.facts.get(hit.fill as usize)
    };
    if let (Some(fact), Some(px)) = (viewer.hovered.and_then(fact), viewer.pointer_px) {
        let at = px.as_vec2() / ctx.pixels_per_point();
        egui::Area::new(egui::Id::unique("tip"))
            .fixed_pos(egui::pos2(at.x + 16.0, at.y + 16.0))
            .interactable(false)
            .show(ctx, |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| {
                    ui.strong(&fact.name);
                    ui.label(area(fact.area_m2));
                });
            });
    }
    let orbit = &viewer.orbit;
    let mut line = format!(
        "{}   {}   eye {} up",
        degrees(orbit.focus.lat_deg, "N", "S"),
        degrees(orbit.focus.lon_deg, "E", "W"),
        length(orbit.viewpoint().height_m),
    );
    if let Some(fact) = viewer.picked.and_then(fact) {
        line = format!("{}   {}   |   {line}", fact.name, area(fact.area_m2));
    }
    egui::Area::new(egui::Id::unique("status"))
        .anchor(Align2::CENTER_BOTTOM, vec2(0.0, -10.0))
        .interactable(false)
        .show(ctx, |ui| {
            egui::Frame::popup(ui.style()).show(ui, |ui| {
                ui.add(egui::Label::new(line).extend());
            });
        });
}

fn notices(viewer: &mut Viewer, ctx: &Context) {
    if !viewer.errors.is_empty() {
        let shown = egui::Window::new("Could not do that")
            .anchor(Align2::CENTER_CENTER, vec2(0.0, 0.0))
            .collapsible(false)
            .show(ctx, |ui| {
                for error in &viewer.errors {
                    ui.colored_label(Color32::from_rgb(255, 140, 120), error);
                }
                ui.button("Dismiss").clicked()
            });
        if shown.and_then(|shown| shown.inner) == Some(true) {
            viewer.errors.clear();
        }
    }
    let text = if viewer.dropping {
        Some("Drop to open")
    } else {
        viewer.notice.as_deref()
    };
    if let Some(text) = text {
        egui::Area::new(egui::Id::unique("notice"))
            .anchor(Align2::CENTER_TOP, vec2(0.0, 14.0))
            .interactable(false)
            .show(ctx, |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| {
                    ui.add(egui::Label::new(text).extend());
                });
            });
    }
}

fn bytes(count: u64) -> String {
    match count {
        0..1_000 => format!("{count} B"),
        1_000..1_000_000 => format!("{:.1} kB", count as f64 / 1e3),
        _ => format!("{:.1} MB", count as f64 / 1e6),
    }
}

fn area(m2: f64) -> String {
    if m2 < 1e5 {
        format!("{m2:.0} m²")
    } else if m2 < 1e9 {
        format!("{:.2} km²", m2 / 1e6)
    } else {
        let thousands = (m2 / 1e9).round() as u64;
        format!("{thousands} 000 km²")
    }
}

fn length(m: f64) -> String {
    if m < 1e3 {
        format!("{m:.1} m")
    } else {
        format!("{:.0} km", m / 1e3)
    }
}

fn degrees(deg: f64, plus: &str, minus: &str) -> String {
    let side = if deg < 0.0 { minus } else { plus };
    format!("{:.4}° {side}", deg.abs())
}
