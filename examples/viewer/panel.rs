//! The panel beside the globe: layers, files, and what a frame costs.

use egui::{CollapsingHeader, Color32, Grid, Panel, RichText, ScrollArea, Slider, Ui};
use globefill::{CountTechnique, Extrusion, HatchKind};

use crate::{
    files::Files,
    satellites::{MOST, Shape},
    viewer::Viewer,
};

const WIDTH: f32 = 300.0;

pub fn show(ui: &mut Ui, viewer: &mut Viewer) {
    Panel::left("layers").exact_size(WIDTH).show(ui, |ui| {
        ScrollArea::vertical().show(ui, |ui| {
            ui.spacing_mut().slider_width = 130.0;
            ui.add_space(8.0);
            ui.heading("globefill");
            ui.label(RichText::new(place(viewer)).monospace().weak());
            ui.separator();
            section(ui, "Countries", |ui| countries(ui, viewer));
            section(ui, "Zones", |ui| zones(ui, viewer));
            section(ui, "Satellites", |ui| satellites(ui, viewer));
            section(ui, "Files", |ui| files(ui, viewer));
            section(ui, "Frame", |ui| frame(ui, viewer));
            ui.separator();
            ui.label(
                RichText::new(
                    "Drag: move · wheel: zoom · right drag: tilt\nN: north up · Home: whole Earth · F: panel",
                )
                .small()
                .weak(),
            );
        });
    });
}

/// What went wrong with files, until it is read.
pub fn errors(ui: &Ui, files: &mut Files) {
    if files.errors.is_empty() {
        return;
    }
    let mut open = true;
    egui::Window::new("Not opened")
        .open(&mut open)
        .collapsible(false)
        .anchor(egui::Align2::CENTER_TOP, [0.0, 24.0])
        .show(ui.ctx(), |ui| {
            for error in &files.errors {
                ui.colored_label(Color32::from_rgb(255, 150, 130), error);
            }
        });
    if !open {
        files.errors.clear();
    }
}

fn section(ui: &mut Ui, title: &str, contents: impl FnOnce(&mut Ui)) {
    CollapsingHeader::new(RichText::new(title).strong())
        .default_open(true)
        .show(ui, contents);
}

fn place(viewer: &Viewer) -> String {
    let viewpoint = &viewer.orbit.viewpoint;
    let height = match viewpoint.height_m {
        height_m if height_m < 1e4 => format!("{height_m:.1} m"),
        height_m => format!("{:.0} km", height_m * 1e-3),
    };
    let at = viewer.pointer_on.unwrap_or(viewpoint.foot);
    let side = |degrees: f64, positive, negative| if degrees < 0.0 { negative } else { positive };
    format!(
        "{:.4}°{} {:.4}°{}\nfrom {height}",
        at.lat_deg.abs(),
        side(at.lat_deg, 'N', 'S'),
        at.lon_deg.abs(),
        side(at.lon_deg, 'E', 'W'),
    )
}

fn countries(ui: &mut Ui, viewer: &mut Viewer) {
    let countries = &mut viewer.scene.countries;
    ui.horizontal(|ui| {
        ui.checkbox(&mut countries.shown, "Fills");
        ui.checkbox(&mut viewer.show_labels, "Names");
    });
    ui.add(Slider::new(&mut countries.opacity, 0.0..=1.0).text("opacity"));
    match countries.chosen {
        Some(country) => {
            ui.label(RichText::new(countries.name(country)).strong());
            ui.label(countries.area(country));
        }
        None => {
            ui.label(RichText::new("Click a country to keep it lit.").weak());
        }
    }
}

fn zones(ui: &mut Ui, viewer: &mut Viewer) {
    let zones = &mut viewer.scene.zones;
    ui.horizontal(|ui| {
        ui.checkbox(&mut zones.shown, "Fills");
        ui.checkbox(&mut zones.outlined, "Outlines");
    });
    ui.horizontal(|ui| {
        for (kind, name) in [
            (HatchKind::Lines, "Lines"),
            (HatchKind::Cross, "Cross"),
            (HatchKind::Dots, "Dots"),
        ] {
            ui.selectable_value(&mut zones.kind, kind, name);
        }
    });
    ui.add(Slider::new(&mut zones.spacing_px, 4.0..=40.0).text("px apart"));
}

fn satellites(ui: &mut Ui, viewer: &mut Viewer) {
    let satellites = &mut viewer.satellites;
    let look = &mut satellites.look;
    ui.horizontal(|ui| {
        ui.checkbox(&mut look.shown, "Footprints");
        ui.checkbox(&mut look.coverage, "Coverage");
    });
    ui.horizontal(|ui| {
        let title = if satellites.playing { "Pause" } else { "Play" };
        if ui.button(title).clicked() {
            satellites.playing = !satellites.playing;
        }
        ui.add(
            Slider::new(&mut satellites.speed, 1.0..=2000.0)
                .logarithmic(true)
                .suffix("×"),
        );
    });
    ui.add(
        Slider::new(&mut look.count, 0..=MOST)
            .logarithmic(true)
            .text("satellites"),
    );
    ui.horizontal(|ui| {
        ui.selectable_value(&mut look.shape, Shape::Conic, "Conic");
        ui.selectable_value(&mut look.shape, Shape::Rectangular, "Rectangular");
    });
    ui.horizontal(|ui| {
        ui.selectable_value(&mut look.extrusion, Extrusion::Normal, "Along normals");
        ui.selectable_value(&mut look.extrusion, Extrusion::Apex, "From the apex");
    });
    ui.add(Slider::new(&mut look.half_angle_deg, 1.0..=60.0).text("° half angle"));
}

fn files(ui: &mut Ui, viewer: &mut Viewer) {
    ui.label(RichText::new("Drop GeoJSON files on the window.").weak());
    let mut closed = None;
    for (index, file) in viewer.scene.files.open.iter_mut().enumerate() {
        ui.horizontal(|ui| {
            ui.checkbox(&mut file.shown, &file.name);
            ui.label(RichText::new(format!("{}", file.fills)).weak())
                .on_hover_text(format!("{} fills, {} repairs", file.fills, file.repairs));
            if ui.small_button("✕").clicked() {
                closed = Some(index);
            }
        });
    }
    for name in &viewer.scene.files.loading {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.label(name);
        });
    }
    if let Some(index) = closed {
        let scene = &mut viewer.scene;
        if let Err(error) = scene.files.close(index, &mut scene.renderer) {
            scene.files.errors.push(error);
        }
    }
}

fn frame(ui: &mut Ui, viewer: &mut Viewer) {
    ui.add(Slider::new(&mut viewer.scene.pixel_error, 0.0..=2.0).text("px budget"));
    let stats = viewer.scene.stats;
    let technique = match stats.technique {
        CountTechnique::Winding => "winding",
        CountTechnique::Stencil => "stencil",
    };
    Grid::new("stats").num_columns(2).show(ui, |ui| {
        let mut row = |name: &str, value: String| {
            ui.label(RichText::new(name).weak());
            ui.monospace(value);
            ui.end_row();
        };
        row("frame", format!("{:.1} ms", viewer.frame_ms));
        row("technique", format!("{technique}, level {}", stats.level));
        row("fills", format!("{} of {}", stats.drawn, stats.fills));
        row("sensors", stats.sensors.to_string());
        row(
            "layers, passes",
            format!("{}, {}", stats.layers, stats.passes),
        );
        row("draws", stats.draws.to_string());
        row("vertices", stats.vertices.to_string());
        row("uploaded", format!("{} B", stats.upload_bytes));
        row(
            "on the GPU",
            format!("{:.1} MB", stats.gpu_bytes as f64 * 1e-6),
        );
    });
    ui.label(RichText::new(&viewer.adapter).small().weak());
    if ui.button("Save picture").clicked() {
        viewer.wants_screenshot = true;
    }
}
