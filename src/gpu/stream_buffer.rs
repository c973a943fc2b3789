//! A GPU buffer that is rewritten from time to time, and only where its contents changed.

/// A buffer that grows as needed and knows what it holds.
pub(crate) struct StreamBuffer {
    label: &'static str,
    usage: wgpu::BufferUsages,
    pub buffer: wgpu::Buffer,
    contents: Vec<u8>,
}

impl StreamBuffer {
    pub(crate) fn new(
        device: &wgpu::Device,
        label: &'static str,
        usage: wgpu::BufferUsages,
    ) -> Self {
        let usage = usage | wgpu::BufferUsages::COPY_DST;
        Self {
            label,
            usage,
            buffer: allocate(device, label, usage, 0),
            contents: Vec::new(),
        }
    }

    /// Makes the buffer start with `bytes` (a multiple of 4). Returns how many were uploaded and
    /// whether the buffer had to be replaced, which invalidates bind groups.
    pub(crate) fn write(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        bytes: &[u8],
    ) -> (u64, bool) {
        let replaced = bytes.len() as u64 > self.buffer.size();
        if replaced {
            self.buffer = allocate(device, self.label, self.usage, bytes.len() as u64);
        } else if self.contents.starts_with(bytes) {
            return (0, false);
        }
        queue.write_buffer(&self.buffer, 0, bytes);
        self.contents.clear();
        self.contents.extend_from_slice(bytes);
        (bytes.len() as u64, replaced)
    }
}

fn allocate(
    device: &wgpu::Device,
    label: &'static str,
    usage: wgpu::BufferUsages,
    least: u64,
) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: least.next_power_of_two().max(256),
        usage,
        mapped_at_creation: false,
    })
}
