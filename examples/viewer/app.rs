//! The window: events in, frames out. It draws only when something changed or moves.

mod input;

use std::sync::Arc;

use glam::UVec2;
use globefill::wgpu;
use web_time::Instant;
use winit::{
    application::ApplicationHandler,
    event::{ElementState, WindowEvent},
    event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy},
    window::{Window, WindowId},
};

use crate::{
    flags::Flags,
    graphics::{Graphics, Paint},
    host::elevation::Elevation,
    layers::{countries, files::File, fill_layer::FillLayer, zones},
    panel, platform,
    screen::{self, Screen},
    viewer::{Viewer, Wish},
};

/// After a pause time goes on from here, not in one leap.
const LONGEST_STEP_S: f64 = 0.1;
/// Frames drawn before a screenshot: egui sizes its windows in the first.
const SETTLING_FRAMES: u32 = 4;

/// The terrain among what is being loaded.
const TERRAIN: &str = "terrain";
const READING: &str = "reading";
const MESHING: &str = "meshing";

/// What other threads and futures send.
enum Message {
    Opened(Box<Result<(Graphics, Screen), String>>),
    Loaded(String, Box<Result<FillLayer, String>>),
    /// What is being loaded, and what is done of it.
    Loading(String, String),
    Terrain(Box<Result<Elevation, String>>),
    Picture(Result<Vec<u8>, String>),
    Hovers(bool),
}

struct App {
    flags: Flags,
    proxy: EventLoopProxy<Message>,
    viewer: Viewer,
    window: Option<Arc<Window>>,
    drawn_with: Option<(Graphics, Screen)>,
    egui: egui::Context,
    egui_winit: Option<egui_winit::State>,
    start: Instant,
    last_s: f64,
    ctrl: bool,
    settled_frames: u32,
}

pub fn run(flags: Flags) -> Result<(), String> {
    let events = EventLoop::<Message>::with_user_event()
        .build()
        .map_err(|error| format!("no window: {error}"))?;
    events.set_control_flow(ControlFlow::Wait);
    let size_px = flags.size_px.unwrap_or(UVec2::new(1280, 720));
    let mut viewer = Viewer::new(size_px);
    if let Some(camera) = &flags.camera {
        viewer.orbit.stand_at(camera);
    }
    viewer.satellites.settings.visible = flags.satellites;
    viewer.satellites.settings.coverage = flags.coverage;
    viewer.satellites.playing = flags.screenshot.is_none();
    viewer.terrain = flags.terrain;
    let egui = egui::Context::default();
    egui.set_theme(egui::Theme::Dark);
    let app = App {
        flags,
        proxy: events.create_proxy(),
        viewer,
        window: None,
        drawn_with: None,
        egui,
        egui_winit: None,
        start: Instant::now(),
        last_s: 0.0,
        ctrl: false,
        settled_frames: 0,
    };
    platform::run_app(events, app)
}

impl App {
    fn now_s(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    fn redraw(&self) {
        if let Some(window) = &self.window {
            window.request_redraw();
        }
    }

    /// Loads a layer beside the thread that draws.
    fn load(
        &mut self,
        name: &str,
        build: impl FnOnce() -> Result<FillLayer, String> + wgpu::WasmNotSend + 'static,
    ) {
        self.viewer.loads(name, MESHING);
        let (proxy, name) = (self.proxy.clone(), name.to_owned());
        platform::spawn(move || {
            // The window may be closed by now.
            let _ = proxy.send_event(Message::Loaded(name, Box::new(build())));
        });
    }

    /// What to do with the text of a file.
    fn reader(&self) -> impl Fn(String, Result<String, String>) + wgpu::WasmNotSend + 'static {
        let proxy = self.proxy.clone();
        move |name, text| {
            // The window may be closed by now.
            let _ = proxy.send_event(Message::Loading(name.clone(), READING.to_owned()));
            let proxy = proxy.clone();
            platform::spawn(
                move || match text.and_then(|text| File::parse(&name, &text)) {
                    Ok(file) => {
                        let step = format!("{MESHING} {}", file.size());
                        let _ = proxy.send_event(Message::Loading(name.clone(), step));
                        // A job of its own: where there is one thread, a person is told in between.
                        platform::spawn(move || {
                            let _ = proxy.send_event(Message::Loaded(name, Box::new(file.build())));
                        });
                    }
                    Err(error) => {
                        let _ = proxy.send_event(Message::Loaded(name, Box::new(Err(error))));
                    }
                },
            );
        }
    }

    /// Loads what there is to see, once there is something to see it on.
    fn load_all(&mut self) {
        let proxy = self.proxy.clone();
        self.viewer.loads(TERRAIN, READING);
        platform::elevation(move |elevation| {
            let _ = proxy.send_event(Message::Terrain(Box::new(elevation)));
        });
        self.load("countries", countries::build);
        self.load("zones", zones::build);
        for file in self.flags.files.clone() {
            self.viewer.loads(&platform::name(file.as_ref()), READING);
            platform::read_file(file.into(), self.reader());
        }
        let proxy = self.proxy.clone();
        platform::watch_drops(self.reader(), move |hovers| {
            let _ = proxy.send_event(Message::Hovers(hovers));
        });
    }

    fn grant_wishes(&mut self) {
        for wish in std::mem::take(&mut self.viewer.wishes) {
            match wish {
                Wish::OpenFile => platform::ask_file(self.reader()),
                Wish::Screenshot => self.take_picture(),
            }
        }
    }

    /// Asks for the canvas as it was drawn last.
    fn take_picture(&self) {
        if let Some((graphics, _)) = &self.drawn_with {
            let proxy = self.proxy.clone();
            platform::picture(graphics, move |png| {
                let _ = proxy.send_event(Message::Picture(png));
            });
        }
    }

    fn keep_picture(&mut self, png: Result<Vec<u8>, String>, events: &ActiveEventLoop) {
        let asked = self.flags.screenshot.take();
        let file = asked.as_deref().unwrap_or("globefill.png");
        match png.and_then(|png| platform::save(file, &png)) {
            Ok(notice) if asked.is_some() => {
                println!("{notice}\n{:?}", self.viewer.stats);
                events.exit();
            }
            Ok(notice) => self.viewer.notice = Some(notice),
            Err(error) if asked.is_some() => platform::give_up(&error),
            Err(error) => self.viewer.errors.push(error),
        }
    }

    fn draw(&mut self) -> Result<(), String> {
        // egui tells of its textures once: not before they can be made.
        if self.drawn_with.is_none() {
            return Ok(());
        }
        let now_s = self.now_s();
        let step_s = (now_s - self.last_s).min(LONGEST_STEP_S);
        self.last_s = now_s;
        let moves = self.viewer.advance(step_s);
        let paint = self.run_egui();
        self.grant_wishes();
        let Some(((graphics, screen), paint)) = self.drawn_with.as_mut().zip(paint) else {
            return Ok(());
        };
        let (paint, wants_repaint) = paint;
        let start = Instant::now();
        self.viewer.stats = graphics.draw(&mut self.viewer, Some(paint))?;
        screen.show(graphics);
        self.viewer.frame_ms = start.elapsed().as_secs_f64() * 1e3;
        platform::log(|| self.viewer.summary());
        if self.viewer.loading.is_empty() {
            self.settled_frames += 1;
        }
        if self.flags.screenshot.is_some() {
            if self.settled_frames == SETTLING_FRAMES {
                self.take_picture();
            }
            self.redraw();
        }
        if moves || wants_repaint {
            self.redraw();
        }
        Ok(())
    }

    /// What egui wants drawn, and whether it wants to be asked again.
    fn run_egui(&mut self) -> Option<(Paint, bool)> {
        let (window, state) = (self.window.as_ref()?, self.egui_winit.as_mut()?);
        let input = state.take_egui_input(window);
        let viewer = &mut self.viewer;
        let output = self.egui.run_ui(input, |ui| panel::show(viewer, ui.ctx()));
        state.handle_platform_output(window, output.platform_output);
        let soon = output
            .viewport_output
            .values()
            .any(|it| it.repaint_delay.as_millis() < 50);
        let paint = Paint {
            jobs: self.egui.tessellate(output.shapes, output.pixels_per_point),
            textures: output.textures_delta,
            pixels_per_point: output.pixels_per_point,
        };
        Some((paint, soon))
    }
}

impl ApplicationHandler<Message> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.window.is_some() {
            return;
        }
        let size_px = self.viewer.orbit.size_px;
        let created = platform::window(size_px).and_then(|attributes| {
            let window = events.create_window(attributes);
            window.map_err(|error| format!("no window: {error}"))
        });
        let window = match created {
            Ok(window) => Arc::new(window),
            Err(error) => return platform::give_up(&error),
        };
        self.egui_winit = Some(egui_winit::State::new(
            self.egui.clone(),
            egui::ViewportId::ROOT,
            &window,
            Some(window.scale_factor() as f32),
            None,
            None,
        ));
        self.window = Some(window.clone());
        let proxy = self.proxy.clone();
        platform::run(async move {
            let opened = screen::open(window, size_px).await;
            let _ = proxy.send_event(Message::Opened(Box::new(opened)));
        });
    }

    fn user_event(&mut self, events: &ActiveEventLoop, message: Message) {
        match message {
            Message::Opened(opened) => match *opened {
                Ok((graphics, mut screen)) => {
                    // The window may have got another size meanwhile.
                    screen.resize(&graphics.gpu, self.viewer.orbit.size_px);
                    self.viewer.adapter = graphics.gpu.name.clone();
                    self.drawn_with = Some((graphics, screen));
                    self.load_all();
                }
                Err(error) => platform::give_up(&error),
            },
            Message::Loaded(name, layer) => self.viewer.loaded(&name, *layer),
            Message::Loading(name, step) => self.viewer.loads(&name, &step),
            Message::Terrain(elevation) => {
                self.viewer.ended(TERRAIN);
                match (*elevation, &mut self.drawn_with) {
                    (Ok(elevation), Some((graphics, _))) => {
                        graphics.elevation = Some(elevation);
                        self.viewer.has_terrain = true;
                    }
                    (Err(error), _) => self.viewer.errors.push(error),
                    (Ok(_), None) => {}
                }
            }
            Message::Picture(png) => self.keep_picture(png, events),
            Message::Hovers(hovers) => self.viewer.dropping = hovers,
        }
        self.redraw();
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let (Some(window), Some(state)) = (self.window.clone(), self.egui_winit.as_mut()) else {
            return;
        };
        let response = state.on_window_event(&window, &event);
        if response.repaint && !matches!(event, WindowEvent::RedrawRequested) {
            window.request_redraw();
        }
        match &event {
            WindowEvent::CloseRequested => return events.exit(),
            WindowEvent::Resized(size) if size.width > 0 && size.height > 0 => {
                self.viewer.orbit.size_px = UVec2::new(size.width, size.height);
                if let Some((graphics, screen)) = &mut self.drawn_with {
                    screen.resize(&graphics.gpu, self.viewer.orbit.size_px);
                }
                window.request_redraw();
            }
            WindowEvent::ModifiersChanged(modifiers) => self.ctrl = modifiers.state().control_key(),
            WindowEvent::HoveredFile(_) => self.viewer.dropping = true,
            WindowEvent::HoveredFileCancelled => self.viewer.dropping = false,
            WindowEvent::DroppedFile(path) => {
                self.viewer.dropping = false;
                platform::read_file(path.clone(), self.reader());
            }
            // Wherever the button comes up, the drag ends.
            WindowEvent::MouseInput {
                state: ElementState::Released,
                ..
            } => {
                let now_s = self.now_s();
                self.viewer.release(now_s);
            }
            WindowEvent::RedrawRequested => {
                if let Err(error) = self.draw() {
                    platform::give_up(&error);
                }
                return;
            }
            _ => {}
        }
        if !response.consumed || matches!(event, WindowEvent::Touch(_)) {
            let rested = !self.viewer.orbit.is_moving() && !self.viewer.satellites.playing;
            if rested {
                self.last_s = self.now_s();
            }
            self.input(&event);
        } else if matches!(event, WindowEvent::CursorMoved { .. }) {
            self.viewer.leave();
        }
    }
}
