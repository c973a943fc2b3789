//! A device without a window, and reading textures back.

#[cfg(not(target_arch = "wasm32"))]
use glam::UVec2;
#[cfg(not(target_arch = "wasm32"))]
use globefill::Renderer;
use globefill::wgpu;

/// An adapter's device and queue.
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    /// Name, backend and driver, as people recognise them.
    pub name: String,
}

/// All of this waits, which browsers do not.
#[cfg(not(target_arch = "wasm32"))]
impl Gpu {
    /// The first adapter that wgpu finds; `WGPU_BACKEND` chooses another backend.
    pub fn open() -> Result<Self, String> {
        pollster::block_on(Self::request())
    }

    async fn request() -> Result<Self, String> {
        let instance =
            wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let adapter = instance
            .request_adapter(&wgpu::RequestAdapterOptions {
                power_preference: wgpu::PowerPreference::HighPerformance,
                ..Default::default()
            })
            .await
            .map_err(|error| {
                let reason = error.to_string();
                let reason = reason.lines().next().unwrap_or_default();
                format!(
                    "no graphics adapter found ({reason}); a software one will do, on Debian and \
                     Ubuntu the package mesa-vulkan-drivers"
                )
            })?;
        let wanted = Renderer::wanted_features()
            | wgpu::Features::PIPELINE_STATISTICS_QUERY
            | wgpu::Features::TIMESTAMP_QUERY;
        let (device, queue) = adapter
            .request_device(&wgpu::DeviceDescriptor {
                label: Some("example"),
                required_features: wanted & adapter.features(),
                required_limits: adapter.limits(),
                ..Default::default()
            })
            .await
            .map_err(|error| format!("the graphics adapter gave no device: {error}"))?;
        let info = adapter.get_info();
        let name = format!("{} ({:?}, {})", info.name, info.backend, info.driver_info);
        Ok(Self {
            device,
            queue,
            name,
        })
    }

    /// Runs `make`, which allocates, and turns lack of memory into an error.
    pub fn allocate<T>(&self, what: &str, make: impl FnOnce() -> T) -> Result<T, String> {
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let made = make();
        match pollster::block_on(memory.pop()) {
            None => Ok(made),
            Some(_) => Err(format!("the graphics adapter has no memory for {what}")),
        }
    }

    /// Submits, and waits until the GPU has finished.
    pub fn run(&self, encoder: wgpu::CommandEncoder) -> Result<(), String> {
        self.queue.submit([encoder.finish()]);
        self.wait()
    }

    /// Waits until the GPU has finished what was submitted.
    pub fn wait(&self) -> Result<(), String> {
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map(|_| ())
            .map_err(|error| format!("the graphics device stopped answering: {error}"))
    }

    /// Texels of a texture of 4 bytes a texel, row after row, without padding.
    pub fn read_texture(&self, texture: &wgpu::Texture) -> Result<Vec<u8>, String> {
        let size_px = UVec2::new(texture.width(), texture.height());
        let row_bytes = size_px.x * 4;
        let padded_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.allocate("reading a picture back", || {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("read back"),
                size: u64::from(padded_bytes) * u64::from(size_px.y),
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            })
        })?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded_bytes),
                    rows_per_image: None,
                },
            },
            texture.size(),
        );
        self.queue.submit([encoder.finish()]);
        // The outcome shows when the mapped range is asked for.
        buffer.map_async(wgpu::MapMode::Read, .., |_| {});
        self.wait()?;
        let mapped = buffer
            .get_mapped_range(..)
            .map_err(|error| format!("cannot read a picture back: {error}"))?;
        let mut texels = Vec::with_capacity(row_bytes as usize * size_px.y as usize);
        for row in mapped.chunks(padded_bytes as usize) {
            texels.extend_from_slice(&row[..row_bytes as usize]);
        }
        Ok(texels)
    }
}
