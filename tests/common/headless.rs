//! A device without a window, shared by the tests of a binary.

use std::sync::OnceLock;

use globefill::{Renderer, wgpu};

pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub adapter: wgpu::AdapterInfo,
}

/// The device. Without an adapter: None, said loudly; a failure where CI=true.
pub fn gpu() -> Option<&'static Gpu> {
    static GPU: OnceLock<Result<Gpu, String>> = OnceLock::new();
    let opened = GPU.get_or_init(|| pollster::block_on(open(wgpu::Features::empty(), |_| {})));
    opened.as_ref().map_err(|reason| missing(reason)).ok()
}

/// A device of its own that lacks `withheld`, as poorer adapters do.
#[allow(dead_code, reason = "not every test binary tests poorer adapters")]
pub fn gpu_without(withheld: wgpu::Features) -> Option<Gpu> {
    pollster::block_on(open(withheld, |_| {}))
        .map_err(|reason| missing(&reason))
        .ok()
}

/// A device of its own with lower limits.
#[allow(dead_code, reason = "not every test binary tests poorer adapters")]
pub fn gpu_limited(lower: impl Fn(&mut wgpu::Limits)) -> Option<Gpu> {
    pollster::block_on(open(wgpu::Features::empty(), lower))
        .map_err(|reason| missing(&reason))
        .ok()
}

/// Says loudly that nothing was tested; fails where CI=true.
fn missing(reason: &str) {
    let ci = std::env::var("CI").is_ok_and(|value| value == "true" || value == "1");
    assert!(!ci, "CI must draw, and there is no GPU adapter: {reason}");
    eprintln!(
        "\n*** NOT TESTED: no GPU adapter ({reason}). Install a Vulkan driver; \
         Mesa's lavapipe (mesa-vulkan-drivers) will do. ***\n"
    );
}

async fn open(withheld: wgpu::Features, lower: impl Fn(&mut wgpu::Limits)) -> Result<Gpu, String> {
    let instance =
        wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = instance
        .request_adapter(&wgpu::RequestAdapterOptions::default())
        .await
        .map_err(|error| error.to_string())?;
    let mut limits = adapter.limits();
    lower(&mut limits);
    let (device, queue) = adapter
        .request_device(&wgpu::DeviceDescriptor {
            required_features: (Renderer::wanted_features() & adapter.features()) - withheld,
            required_limits: limits,
            ..Default::default()
        })
        .await
        .map_err(|error| error.to_string())?;
    Ok(Gpu {
        device,
        queue,
        adapter: adapter.get_info(),
    })
}

/// Copies a texture of 4 bytes a texel to the CPU, row after row.
pub fn read_texture(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    aspect: wgpu::TextureAspect,
) -> Vec<[u8; 4]> {
    let size = texture.size();
    let row_bytes = (size.width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size: u64::from(row_bytes) * u64::from(size.height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: 0,
            origin: wgpu::Origin3d::ZERO,
            aspect,
        },
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row_bytes),
                rows_per_image: None,
            },
        },
        size,
    );
    gpu.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |result| {
        result.expect("the buffer can be mapped");
    });
    gpu.device
        .poll(wgpu::PollType::wait_indefinitely())
        .expect("the device answers");
    let bytes = buffer.get_mapped_range(..).expect("it is mapped");
    bytes
        .chunks_exact(row_bytes as usize)
        .flat_map(|row| row.chunks_exact(4).take(size.width as usize))
        .map(|texel| texel.try_into().expect("four bytes"))
        .collect()
}
