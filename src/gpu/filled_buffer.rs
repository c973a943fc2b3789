//! Buffers that are made with their contents.

use wgpu::util::BufferInitDescriptor;

/// Making a buffer with its contents, a multiple of 4 bytes and not empty.
pub(crate) trait FilledBuffer {
    /// Like wgpu's `create_buffer_init`, which panics if the device was lost; then this one is of no use,
    /// as all that belongs to such a device.
    fn filled_buffer(&self, with: &BufferInitDescriptor<'_>) -> wgpu::Buffer;
}

impl FilledBuffer for wgpu::Device {
    fn filled_buffer(&self, with: &BufferInitDescriptor<'_>) -> wgpu::Buffer {
        let buffer = self.create_buffer(&wgpu::BufferDescriptor {
            label: with.label,
            size: with.contents.len() as u64,
            usage: with.usage,
            mapped_at_creation: true,
        });
        if let Ok(mut mapped) = buffer.get_mapped_range_mut(..) {
            mapped.slice(..).copy_from_slice(with.contents);
        }
        buffer.unmap();
        buffer
    }
}
