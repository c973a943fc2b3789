//! The window's surface, and the device that draws to it.

use std::sync::Arc;

use glam::UVec2;
use globefill::{Renderer, wgpu};
use winit::window::Window;

use crate::{graphics::Graphics, host::gpu::Gpu};

/// The window's surface.
pub struct Screen {
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
}

impl Screen {
    pub fn resize(&mut self, gpu: &Gpu, size_px: UVec2) {
        (self.config.width, self.config.height) = (size_px.x, size_px.y);
        self.surface.configure(&gpu.device, &self.config);
    }

    /// Copies the canvas to the window.
    pub fn show(&mut self, graphics: &Graphics) {
        let gpu = &graphics.gpu;
        let texture = match self.surface.get_current_texture() {
            wgpu::CurrentSurfaceTexture::Success(texture)
            | wgpu::CurrentSurfaceTexture::Suboptimal(texture) => texture,
            wgpu::CurrentSurfaceTexture::Outdated | wgpu::CurrentSurfaceTexture::Lost => {
                return self.surface.configure(&gpu.device, &self.config);
            }
            _ => return,
        };
        if texture.texture.size() == graphics.canvas.color.size() {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            encoder.copy_texture_to_texture(
                graphics.canvas.color.as_image_copy(),
                texture.texture.as_image_copy(),
                graphics.canvas.color.size(),
            );
            gpu.queue.submit([encoder.finish()]);
        }
        gpu.queue.present(texture);
    }
}

/// A device for a window, its surface, and all that is drawn there.
pub async fn open(window: Arc<Window>, size_px: UVec2) -> Result<(Graphics, Screen), String> {
    let instance =
        wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let surface = instance
        .create_surface(window)
        .map_err(|error| format!("the window cannot be drawn to: {error}"))?;
    let adapter = instance
        .request_adapter(&wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: Some(&surface),
            ..Default::default()
        })
        .await
        .map_err(|error| format!("no graphics adapter found: {error}"))?;
    let (device, queue) = adapter
        .request_device(&wgpu::DeviceDescriptor {
            required_features: Renderer::wanted_features() & adapter.features(),
            required_limits: adapter.limits(),
            ..Default::default()
        })
        .await
        .map_err(|error| format!("the graphics adapter gave no device: {error}"))?;
    let mut config = surface
        .get_default_config(&adapter, size_px.x, size_px.y)
        .ok_or("the adapter does not draw to this window")?;
    config.usage |= wgpu::TextureUsages::COPY_DST;
    let formats = surface.get_capabilities(&adapter).formats;
    let eight_bit = |format: &wgpu::TextureFormat| {
        use wgpu::TextureFormat::{Bgra8Unorm, Rgba8Unorm};
        matches!(format.remove_srgb_suffix(), Bgra8Unorm | Rgba8Unorm)
    };
    config.format = formats
        .into_iter()
        .find(eight_bit)
        .ok_or("the window has no colours of eight bits")?;
    surface.configure(&device, &config);
    let info = adapter.get_info();
    let gpu = Gpu {
        device,
        queue,
        name: format!("{} ({:?})", info.name, info.backend),
    };
    let graphics = Graphics::new(gpu, config.format, size_px)?;
    Ok((graphics, Screen { surface, config }))
}
