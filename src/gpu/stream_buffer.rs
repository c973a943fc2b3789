//! A GPU buffer that is rewritten from time to time, and only where its contents changed.

use std::ops::Range;

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

    /// A buffer that holds `least` bytes before it grows.
    pub(crate) fn with_size(
        device: &wgpu::Device,
        label: &'static str,
        usage: wgpu::BufferUsages,
        least: u64,
    ) -> Self {
        let mut stream = Self::new(device, label, usage);
        stream.buffer = allocate(device, label, stream.usage, least);
        stream
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
            self.contents.clear();
        }
        let mut uploaded = 0;
        for run in changed_runs(&self.contents, bytes) {
            queue.write_buffer(&self.buffer, run.start as u64, &bytes[run.clone()]);
            uploaded += run.len() as u64;
        }
        let kept = bytes.len().min(self.contents.len());
        self.contents[..kept].copy_from_slice(&bytes[..kept]);
        self.contents.extend_from_slice(&bytes[kept..]);
        (uploaded, replaced)
    }
}

/// Bytes compared at a time.
const BLOCK: usize = 128;
/// Runs nearer than this are written as one, and more than so many runs too: every write makes a
/// staging buffer, which costs more than copying what lies between.
const JOINED: usize = 2048;
const MOST_RUNS: usize = 16;

/// Where `new` differs from what `old` holds there.
fn changed_runs(old: &[u8], new: &[u8]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for start in (0..new.len()).step_by(BLOCK) {
        let block = start..(start + BLOCK).min(new.len());
        if old.get(block.clone()) == Some(&new[block.clone()]) {
            continue;
        }
        let full = runs.len() == MOST_RUNS;
        match runs.last_mut() {
            Some(run) if start - run.end < JOINED || full => run.end = block.end,
            _ => runs.push(block),
        }
    }
    runs
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_changed_is_written() {
        let old = vec![0; 100 * BLOCK];
        assert!(changed_runs(&old, &old).is_empty());
        assert!(changed_runs(&old, &old[..BLOCK]).is_empty());
        let mut new = old.clone();
        new[3] = 1;
        new[2 * BLOCK] = 1;
        new[90 * BLOCK + 5] = 1;
        let runs = [0..3 * BLOCK, 90 * BLOCK..91 * BLOCK];
        assert_eq!(changed_runs(&old, &new), runs);
        new.extend([7; 8]);
        assert_eq!(
            changed_runs(&old, &new).last(),
            Some(&(90 * BLOCK..100 * BLOCK + 8))
        );
    }
}
