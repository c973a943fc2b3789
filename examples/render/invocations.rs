//! How often the adapter ran vertex and fragment shaders for the fills.

use globefill::wgpu;

use crate::host::gpu::Gpu;

const KINDS: wgpu::PipelineStatisticsTypes =
    wgpu::PipelineStatisticsTypes::VERTEX_SHADER_INVOCATIONS
        .union(wgpu::PipelineStatisticsTypes::FRAGMENT_SHADER_INVOCATIONS);
/// Bytes of one pass: two counts of 64 bits.
const PASS_BYTES: u64 = 16;

/// Shader runs of one frame's fills, counting and resolving.
pub struct Invocations {
    pub vertex: u64,
    pub fragment: u64,
}

/// Pipeline statistics of a number of passes.
pub struct InvocationQueries {
    pub set: wgpu::QuerySet,
    passes: u32,
    resolved: wgpu::Buffer,
    read_back: wgpu::Buffer,
}

impl InvocationQueries {
    /// Queries for `passes` passes; `None` where the adapter cannot count.
    pub fn new(gpu: &Gpu, passes: u32) -> Option<Self> {
        let device = &gpu.device;
        if !device
            .features()
            .contains(wgpu::Features::PIPELINE_STATISTICS_QUERY)
        {
            return None;
        }
        let buffer = |label, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: PASS_BYTES * u64::from(passes),
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        Some(Self {
            set: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("invocations"),
                ty: wgpu::QueryType::PipelineStatistics(KINDS),
                count: passes,
            }),
            passes,
            resolved: buffer(
                "invocations",
                wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            ),
            read_back: buffer("invocations read back", wgpu::BufferUsages::MAP_READ),
        })
    }

    /// Index of the last pass.
    pub fn last(&self) -> u32 {
        self.passes - 1
    }

    /// Records reading the counts, after all passes.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.resolve_query_set(&self.set, 0..self.passes, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.read_back, 0, None);
    }

    /// The sums over all passes, after the frame was submitted.
    pub fn read(&self, gpu: &Gpu) -> Result<Invocations, String> {
        self.read_back.map_async(wgpu::MapMode::Read, .., |_| {});
        gpu.wait()?;
        let mapped = self
            .read_back
            .get_mapped_range(..)
            .map_err(|error| format!("cannot read statistics back: {error}"))?;
        let mut sums = [0; 2];
        for (index, count) in mapped.as_chunks::<8>().0.iter().enumerate() {
            sums[index % 2] += u64::from_le_bytes(*count);
        }
        Ok(Invocations {
            vertex: sums[0],
            fragment: sums[1],
        })
    }
}
