//! The viewer without its window: what is asked of it goes in as egui's input, a picture comes out.

use std::{
    path::Path,
    time::{Duration, Instant},
};

use egui::{CentralPanel, Key, PointerButton, Sense, Ui};
use glam::{DVec2, UVec2};
use globefill::{Ellipsoid, LonLat, wgpu};

use crate::{
    globe_view::{FOV_DEG, GlobeView},
    host::{camera::Viewpoint, gpu::Gpu},
    labels,
    orbit::{Orbit, Picture},
    panel,
    satellites::Satellites,
    scene::Scene,
    screen::Screen,
};

/// What Home shows.
const HOME: Viewpoint = Viewpoint {
    foot: LonLat::new(20.0, 22.0),
    height_m: 1.4e7,
    heading_deg: 0.0,
    pitch_deg: -90.0,
};

/// Everything but the window.
pub struct Viewer {
    pub orbit: Orbit,
    pub scene: Scene,
    pub satellites: Satellites,
    pub show_panel: bool,
    pub show_labels: bool,
    /// Milliseconds from frame to frame, smoothed; of those that follow each other at once.
    pub frame_ms: f64,
    pub adapter: String,
    pub wants_screenshot: bool,
    gpu: Gpu,
    globe: GlobeView,
    screen: Screen,
    size_px: UVec2,
    /// Where the pointer is over the globe.
    pub pointer_on: Option<LonLat>,
    /// Of the last frame, on egui's clock.
    last_seconds: f64,
    last_frame: Option<Instant>,
}

impl Viewer {
    pub fn new(
        gpu: Gpu,
        format: wgpu::TextureFormat,
        size_px: UVec2,
        viewpoint: Viewpoint,
    ) -> Result<Self, String> {
        Ok(Self {
            orbit: Orbit::new(viewpoint),
            scene: Scene::new(&gpu, format)?,
            satellites: Satellites::default(),
            show_panel: true,
            show_labels: true,
            frame_ms: 0.0,
            adapter: gpu.name.clone(),
            wants_screenshot: false,
            globe: GlobeView::new(&gpu, format, size_px, &viewpoint)?,
            screen: Screen::new(&gpu, format),
            size_px,
            pointer_on: None,
            last_seconds: 0.0,
            last_frame: None,
            gpu,
        })
    }

    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    pub fn context(&self) -> &egui::Context {
        &self.screen.context
    }

    /// The picture that the last frame was drawn into.
    pub fn color(&self) -> &wgpu::Texture {
        &self.globe.targets.color
    }

    /// Starts reading a GeoJSON file.
    pub fn open(&mut self, path: &Path) {
        let context = self.screen.context.clone();
        let wake = move || context.request_repaint();
        self.scene.files.load(path, wake);
    }

    pub fn resize(&mut self, size_px: UVec2) -> Result<(), String> {
        if size_px != self.size_px && size_px.min_element() > 0 {
            self.size_px = size_px;
            self.globe.resize(&self.gpu, size_px)?;
        }
        Ok(())
    }

    /// What comes in if nobody touches anything, at a time.
    pub fn still_input(&self, seconds: f64) -> egui::RawInput {
        let size = self.size_px.as_vec2();
        let corner = egui::pos2(size.x, size.y);
        egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_max(egui::Pos2::ZERO, corner)),
            time: Some(seconds),
            ..Default::default()
        }
    }

    /// Whether anything on the globe moves by itself.
    fn is_moving(&self) -> bool {
        self.satellites.is_moving() || self.orbit.is_drifting()
    }

    /// How long the picture stays as it is if nobody touches anything.
    pub fn still_for(&self) -> Duration {
        if self.is_moving() {
            Duration::ZERO
        } else {
            self.screen.repaint_after
        }
    }

    /// Whether all that was asked for is there.
    pub fn is_settled(&self) -> bool {
        self.scene.files.loading.is_empty() && !self.still_for().is_zero()
    }

    /// Takes what was done since the last frame, and draws the next one.
    pub fn frame(&mut self, input: egui::RawInput) -> Result<egui::PlatformOutput, String> {
        let now = Instant::now();
        if let Some(last) = self.last_frame.replace(now)
            && self.is_moving()
        {
            let milliseconds = 1e3 * (now - last).as_secs_f64();
            self.frame_ms += 0.1 * (milliseconds - self.frame_ms);
        }
        let seconds = input.time.unwrap_or(self.last_seconds + 1.0 / 60.0);
        // After a rest the world does not leap.
        let passed = (seconds - self.last_seconds).clamp(0.0, 0.1);
        self.last_seconds = seconds;
        self.orbit.advance(passed);
        self.satellites.advance(passed);
        self.lay_out(input, passed);
        self.scene.restyle(&mut self.satellites)?;
        self.globe
            .look(&self.gpu, self.size_px, &self.orbit.viewpoint);
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let (gpu, size_px) = (&self.gpu, self.size_px);
        self.scene.draw(gpu, &self.globe, size_px, &mut encoder)?;
        let target = self.globe.targets.color.create_view(&Default::default());
        let done = self.screen.paint(gpu, &mut encoder, &target, size_px);
        self.gpu.queue.submit([encoder.finish()]);
        Ok(done)
    }

    /// The texels of the last frame, four bytes each, row after row.
    pub fn picture(&self) -> Result<Vec<u8>, String> {
        self.gpu.read_texture(self.color())
    }

    fn lay_out(&mut self, input: egui::RawInput, passed: f64) {
        let context = self.screen.context.clone();
        let output = context.run_ui(input, |ui| self.ui(ui, passed));
        self.screen.take(output);
    }

    fn ui(&mut self, ui: &mut Ui, passed: f64) {
        if self.show_panel {
            panel::show(ui, self);
        }
        panel::errors(ui, &mut self.scene.files);
        CentralPanel::default()
            .frame(egui::Frame::NONE)
            .show(ui, |ui| self.globe_ui(ui, passed));
        self.keys(ui);
    }

    /// Looking, pointing and choosing.
    fn globe_ui(&mut self, ui: &mut Ui, passed: f64) {
        let scale = ui.ctx().pixels_per_point();
        let picture = Picture::new(self.size_px.as_dvec2(), FOV_DEG);
        let to_px =
            |at: egui::Pos2| DVec2::new(f64::from(at.x), f64::from(at.y)) * f64::from(scale);
        let globe = ui.interact(
            ui.max_rect(),
            ui.scope_id().with("globe"),
            Sense::click_and_drag(),
        );
        let pointer_px = globe
            .interact_pointer_pos()
            .or(globe.hover_pos())
            .map(to_px);
        let held = ui.input(|input| input.modifiers.ctrl || input.modifiers.shift);
        let tilts = globe.dragged_by(PointerButton::Secondary)
            || globe.dragged_by(PointerButton::Middle)
            || held && globe.dragged_by(PointerButton::Primary);
        if let Some(at_px) = pointer_px {
            if tilts {
                let moved = globe.drag_delta();
                self.orbit
                    .tilt(&picture, 0.3 * f64::from(moved.x), 0.3 * f64::from(moved.y));
            } else if globe.drag_started_by(PointerButton::Primary) {
                let from_px = ui.input(|input| input.pointer.press_origin()).map(to_px);
                self.orbit.grab(&picture, from_px.unwrap_or(at_px));
            }
            if !tilts && globe.dragged_by(PointerButton::Primary) {
                self.orbit.drag(&picture, at_px, passed);
            }
            let (rolled, pinched) =
                ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            let factor = (-0.004 * f64::from(rolled)).exp() / f64::from(pinched);
            if globe.hovered() && factor != 1.0 {
                self.orbit.zoom(&picture, factor, at_px);
            }
        }
        if globe.drag_stopped() {
            self.orbit.release();
        }
        let ground_m = pointer_px.and_then(|at_px| self.orbit.ground_at(&picture, at_px));
        self.pointer_on = ground_m.map(|ground_m| Ellipsoid::WGS84.geodetic(ground_m).0);
        self.point(&globe);
        if self.show_labels && self.scene.countries.shown {
            let names = self.scene.countries.names();
            labels::paint(ui.painter(), &self.orbit, &picture, scale, &names);
        }
    }

    /// Shows what is under the pointer, and keeps what is clicked.
    fn point(&mut self, globe: &egui::Response) {
        let countries = &mut self.scene.countries;
        let found = self.pointer_on.and_then(|place| countries.at(place));
        let hovers = globe.hovered() && !globe.dragged();
        countries.under_pointer = found.filter(|_| hovers);
        if globe.clicked() {
            countries.chosen = if countries.chosen == found {
                None
            } else {
                found
            };
        }
        if let Some(country) = countries.under_pointer {
            let (name, area) = (countries.name(country), countries.area(country));
            let at = globe.hover_pos().unwrap_or_default() + egui::vec2(18.0, 14.0);
            egui::Area::new(globe.id.with("name"))
                .order(egui::Order::Tooltip)
                .fixed_pos(at)
                .interactable(false)
                .show(&globe.ctx, |ui| {
                    egui::Frame::popup(ui.style()).show(ui, |ui| {
                        ui.strong(name);
                        ui.label(area);
                    })
                });
        }
    }

    fn keys(&mut self, ui: &Ui) {
        if ui.ctx().egui_wants_keyboard_input() {
            return;
        }
        let picture = Picture::new(self.size_px.as_dvec2(), FOV_DEG);
        let middle_px = 0.5 * picture.size_px;
        let pressed = |key| ui.input(|input| input.key_pressed(key));
        for (key, right, up) in [
            (Key::ArrowLeft, -0.1, 0.0),
            (Key::ArrowRight, 0.1, 0.0),
            (Key::ArrowDown, 0.0, -0.1),
            (Key::ArrowUp, 0.0, 0.1),
        ] {
            if pressed(key) {
                self.orbit.pan(&picture, DVec2::new(right, up));
            }
        }
        for (key, factor) in [(Key::Plus, 0.8), (Key::Equals, 0.8), (Key::Minus, 1.25)] {
            if pressed(key) {
                self.orbit.zoom(&picture, factor, middle_px);
            }
        }
        if pressed(Key::N) {
            self.orbit.face_north(&picture);
        }
        if pressed(Key::Home) {
            self.orbit = Orbit::new(HOME);
        }
        if pressed(Key::Space) {
            self.satellites.playing = !self.satellites.playing;
        }
        if pressed(Key::F) {
            self.show_panel = !self.show_panel;
        }
    }
}
