//! The window: winit's events in, the viewer's picture out.

use std::{path::Path, sync::Arc, time::Instant};

use egui::ViewportId;
use glam::UVec2;
use globefill::{Renderer, wgpu};
use winit::{
    application::ApplicationHandler,
    dpi::PhysicalSize,
    event::{StartCause, WindowEvent},
    event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy},
    window::{Window, WindowId},
};

use crate::{
    Arguments,
    host::{gpu::Gpu, output::Outputs, png},
    viewer::Viewer,
};

/// Opens the window and stays until it is closed.
pub fn run(arguments: Arguments) -> Result<(), String> {
    let events = EventLoop::with_user_event()
        .build()
        .map_err(|error| format!("no window: {error}"))?;
    let mut app = App {
        arguments,
        proxy: events.create_proxy(),
        shown: None,
        result: Ok(()),
    };
    events
        .run_app(&mut app)
        .map_err(|error| format!("the window failed: {error}"))?;
    app.result
}

struct App {
    arguments: Arguments,
    proxy: EventLoopProxy<Woken>,
    shown: Option<Shown>,
    result: Result<(), String>,
}

/// A window that is there.
struct Shown {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    input: egui_winit::State,
    viewer: Viewer,
    started: Instant,
}

impl ApplicationHandler<Woken> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.shown.is_none() {
            match Shown::new(events, &self.arguments, self.proxy.clone()) {
                Ok(shown) => self.shown = Some(shown),
                Err(error) => self.fail(events, error),
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(shown) = &mut self.shown else {
            return;
        };
        let response = shown.input.on_window_event(&shown.window, &event);
        if response.repaint {
            shown.window.request_redraw();
        }
        let result = match event {
            WindowEvent::CloseRequested => {
                events.exit();
                Ok(())
            }
            WindowEvent::Resized(size) => shown.resize(size),
            WindowEvent::DroppedFile(path) => {
                shown.viewer.open(&path);
                shown.window.request_redraw();
                Ok(())
            }
            WindowEvent::RedrawRequested => shown.redraw(events),
            _ => Ok(()),
        };
        if let Err(error) = result {
            self.fail(events, error);
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let Some(shown) = &self.shown else {
            return;
        };
        let still_for = shown.viewer.still_for();
        if still_for.is_zero() || shown.viewer.context().has_requested_repaint() {
            shown.window.request_redraw();
        } else if let Some(then) = Instant::now().checked_add(still_for) {
            events.set_control_flow(ControlFlow::WaitUntil(then));
        }
    }

    fn new_events(&mut self, _: &ActiveEventLoop, cause: StartCause) {
        if let (StartCause::ResumeTimeReached { .. }, Some(shown)) = (cause, &self.shown) {
            shown.window.request_redraw();
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, Woken: Woken) {
        if let Some(shown) = &self.shown {
            shown.window.request_redraw();
        }
    }
}

/// Something was finished on another thread.
#[derive(Debug)]
struct Woken;

impl App {
    fn fail(&mut self, events: &ActiveEventLoop, error: String) {
        self.result = Err(error);
        events.exit();
    }
}

impl Shown {
    fn new(
        events: &ActiveEventLoop,
        arguments: &Arguments,
        proxy: EventLoopProxy<Woken>,
    ) -> Result<Self, String> {
        let UVec2 { x, y } = arguments.size;
        let attributes = Window::default_attributes()
            .with_title("globefill")
            .with_inner_size(PhysicalSize::new(x, y));
        let window = events
            .create_window(attributes)
            .map_err(|error| format!("no window: {error}"))?;
        let window = Arc::new(window);
        let (gpu, surface, mut config) = pollster::block_on(open(&window))?;
        config.present_mode = wgpu::PresentMode::AutoVsync;
        surface.configure(&gpu.device, &config);
        let size_px = UVec2::new(config.width, config.height);
        let mut viewer = Viewer::new(gpu, config.format, size_px, arguments.camera)?;
        viewer.show_panel = !arguments.bare;
        // egui asks for frames from other threads, too.
        viewer.context().set_request_repaint_callback(move |_| {
            // Without a window nobody waits for it.
            let _ = proxy.send_event(Woken);
        });
        arguments.files.iter().for_each(|file| viewer.open(file));
        let scale = Some(window.scale_factor() as f32);
        let context = viewer.context().clone();
        let input = egui_winit::State::new(context, ViewportId::ROOT, &window, scale, None, None);
        Ok(Self {
            window,
            surface,
            config,
            input,
            viewer,
            started: Instant::now(),
        })
    }

    fn resize(&mut self, size: PhysicalSize<u32>) -> Result<(), String> {
        if size.width == 0 || size.height == 0 {
            return Ok(());
        }
        (self.config.width, self.config.height) = (size.width, size.height);
        self.surface
            .configure(&self.viewer.gpu().device, &self.config);
        self.window.request_redraw();
        self.viewer.resize(UVec2::new(size.width, size.height))
    }

    fn redraw(&mut self, events: &ActiveEventLoop) -> Result<(), String> {
        events.set_control_flow(ControlFlow::Wait);
        let mut input = self.input.take_egui_input(&self.window);
        input.time = Some(self.started.elapsed().as_secs_f64());
        let output = self.viewer.frame(input)?;
        self.input.handle_platform_output(&self.window, output);
        self.present()?;
        if std::mem::take(&mut self.viewer.wants_screenshot) {
            self.save()?;
        }
        Ok(())
    }

    /// Shows the viewer's picture.
    fn present(&mut self) -> Result<(), String> {
        use wgpu::CurrentSurfaceTexture as Current;
        let gpu = self.viewer.gpu();
        let shown = match self.surface.get_current_texture() {
            Current::Success(shown) | Current::Suboptimal(shown) => shown,
            Current::Outdated | Current::Lost => {
                self.surface.configure(&gpu.device, &self.config);
                self.window.request_redraw();
                return Ok(());
            }
            // Hidden, or busy: the next frame shows it.
            _ => return Ok(()),
        };
        let (from, to) = (self.viewer.color(), &shown.texture);
        if from.size() == to.size() {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let (from, to) = (from.as_image_copy(), to.as_image_copy());
            encoder.copy_texture_to_texture(from, to, shown.texture.size());
            gpu.queue.submit([encoder.finish()]);
        }
        self.window.pre_present_notify();
        gpu.queue.present(shown);
        Ok(())
    }

    fn save(&self) -> Result<(), String> {
        let mut texels = self.viewer.picture()?;
        if is_blue_first(self.config.format) {
            texels
                .as_chunks_mut::<4>()
                .0
                .iter_mut()
                .for_each(|it| it.swap(0, 2));
        }
        let size_px = UVec2::new(self.config.width, self.config.height);
        let mut outputs = Outputs::default();
        outputs.add(Path::new("out/viewer.png"), png::rgb(size_px, &texels)?);
        outputs.write()?;
        println!("out/viewer.png");
        Ok(())
    }
}

fn is_blue_first(format: wgpu::TextureFormat) -> bool {
    format.remove_srgb_suffix() == wgpu::TextureFormat::Bgra8Unorm
}

/// A device that can show pictures in the window.
async fn open(
    window: &Arc<Window>,
) -> Result<(Gpu, wgpu::Surface<'static>, wgpu::SurfaceConfiguration), String> {
    let instance =
        wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let surface = instance
        .create_surface(window.clone())
        .map_err(|error| format!("cannot draw in the window: {error}"))?;
    let adapter = instance
        .request_adapter(&wgpu::RequestAdapterOptions {
            compatible_surface: Some(&surface),
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        })
        .await
        .map_err(|error| format!("no graphics adapter for the window: {error}"))?;
    let gpu = Gpu::of(&adapter, Renderer::wanted_features()).await?;
    let size = window.inner_size();
    let mut config = surface
        .get_default_config(&adapter, size.width.max(1), size.height.max(1))
        .ok_or("the adapter cannot show pictures in the window")?;
    let formats = surface.get_capabilities(&adapter).formats;
    config.format = formats
        .iter()
        .copied()
        .find(|format| format.is_srgb())
        .unwrap_or(config.format);
    config.usage |= wgpu::TextureUsages::COPY_DST;
    Ok((gpu, surface, config))
}
