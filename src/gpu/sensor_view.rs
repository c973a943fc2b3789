//! What a view keeps of the sensors: their records, the tiles, and what is bound.

use glam::UVec2;

use crate::{
    frame::reference::Reference,
    frame::sensor_records::SensorRecords,
    frame::sight_uniform::{SightUniform, TILE, divided},
    gpu::sensor_pipelines::{SensorKey, SensorPipelines},
    gpu::stream_buffer::StreamBuffer,
    gpu::surface_binding::SurfaceBinding,
    options::Frame,
    sensor_set::{SensorDisplay, SensorSet, Version},
};

/// Entries of a page of tile.wgsl, and its bytes with its link.
pub(crate) const PAGE_ENTRIES: usize = 32;
const PAGE_BYTES: u64 = 4 * (PAGE_ENTRIES as u64 + 1);
/// Pages a list on average, at most.
const PAGES_PER_LIST: usize = 8;
/// Most bytes of all pages.
const MOST_PAGE_BYTES: u64 = 64 << 20;
/// Invocations of a workgroup of bin_sensors.wgsl.
pub(crate) const WORKGROUP: u32 = 64;
/// Bytes of `Tile` of tile.wgsl.
pub(crate) const TILE_BYTES: u64 = 48;

/// Buffers and bindings of one view.
pub(crate) struct SensorView {
    records: SensorRecords,
    surface: SurfaceBinding,
    sensors: StreamBuffer,
    planes: StreamBuffer,
    colors: StreamBuffer,
    tiles: Option<Tiles>,
    scene: Option<wgpu::BindGroup>,
    /// What is drawn, if anything is.
    pub key: Option<SensorKey>,
    pub block_count: u32,
    tile_count: u32,
    /// What was last uploaded for.
    prepared: Option<(Frame, Version)>,
}

/// Tiles, blocks and their lists.
struct Tiles {
    key: TilesKey,
    used: wgpu::Buffer,
    binned: wgpu::BindGroup,
    read: wgpu::BindGroup,
}

/// What a frame brings.
pub(crate) struct SensorFrame<'a> {
    pub set: &'a SensorSet,
    pub frame: &'a Frame,
    pub reference: Reference,
    pub uniform: SightUniform,
}

impl SensorView {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let stream = |label, usage| StreamBuffer::new(device, label, usage);
        let storage = wgpu::BufferUsages::STORAGE;
        Self {
            records: SensorRecords::default(),
            surface: SurfaceBinding::new(device),
            sensors: stream("globefill sensors", storage),
            planes: stream("globefill planes", storage),
            colors: stream("globefill coverage colours", storage),
            tiles: None,
            scene: None,
            key: None,
            block_count: 0,
            tile_count: 0,
            prepared: None,
        }
    }

    /// Whether the view already holds this frame.
    pub(crate) fn holds(&self, frame: &Frame, set: &SensorSet) -> bool {
        self.prepared == Some((*frame, set.version()))
    }

    /// Encodes and uploads what changed; returns the bytes.
    pub(crate) fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        pipelines: &SensorPipelines,
        with: SensorFrame<'_>,
    ) -> u64 {
        let set = with.set;
        self.records.update(set, with.reference);
        let mut uniform = with.uniform;
        [self.tile_count, self.block_count] = [uniform.tiles[2], uniform.blocks[2]];
        let pages = page_count(device, self.tile_count + self.block_count, set.len());
        let key = [self.tile_count, self.block_count, pages];
        uniform.bounds[2] = self.records.depth_per_weight() as f32;
        uniform.counts[..2].copy_from_slice(&[set.len() as u32, pages]);
        let colors: Vec<[f32; 4]> = match set.display() {
            SensorDisplay::Blended => Vec::new(),
            SensorDisplay::Coverage(colors) => {
                uniform.counts[3] = u32::from(colors.colors_gaps());
                colors.premultiplied().collect()
            }
        };
        uniform.counts[2] = colors.len() as u32;
        let mut bytes = self.surface.write(device, queue, &uniform);
        let mut moved = self.scene.is_none();
        let uploads: [(&mut StreamBuffer, &[u8]); 3] = [
            (
                &mut self.sensors,
                bytemuck::cast_slice(&self.records.records),
            ),
            (&mut self.planes, bytemuck::cast_slice(&self.records.planes)),
            (&mut self.colors, bytemuck::cast_slice(&colors)),
        ];
        for (stream, contents) in uploads {
            let (uploaded, replaced) = stream.write(device, queue, contents);
            bytes += uploaded;
            moved |= replaced;
        }
        if moved {
            self.bind(device, pipelines);
        }
        if self.tiles.as_ref().is_none_or(|tiles| tiles.key != key) {
            self.tiles = Some(Tiles::new(device, pipelines, key));
        }
        self.prepared = Some((*with.frame, set.version()));
        bytes
    }

    fn bind(&mut self, device: &wgpu::Device, pipelines: &SensorPipelines) {
        let streams = [&self.sensors, &self.planes, &self.colors];
        let buffers = streams.map(|stream| &stream.buffer);
        self.scene = Some(group(device, &pipelines.scene_layout, &buffers));
    }

    /// Records the binning.
    pub(crate) fn bin(
        &mut self,
        device: &wgpu::Device,
        pipelines: &SensorPipelines,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
    ) {
        let Some(program) = self.key.and_then(|key| pipelines.get(key)) else {
            return;
        };
        self.surface.bind(device, &pipelines.surface_layout, depth);
        let (Some(scene), Some(tiles), Some(surface)) =
            (&self.scene, &self.tiles, self.surface.group())
        else {
            return;
        };
        encoder.clear_buffer(&tiles.used, 0, None);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("globefill bin sensors"),
            timestamp_writes: None,
        });
        for (index, group) in (0..).zip([scene, &tiles.binned, surface]) {
            pass.set_bind_group(index, group, &[]);
        }
        let counts = [self.tile_count, self.block_count, self.tile_count];
        for (pipeline, count) in program.binning.iter().zip(counts) {
            pass.set_pipeline(pipeline);
            pass.dispatch_workgroups(count.div_ceil(WORKGROUP), 1, 1);
        }
    }

    /// Draws the tiles into the host's pass.
    pub(crate) fn resolve(&self, pipelines: &SensorPipelines, pass: &mut wgpu::RenderPass<'_>) {
        let (Some(scene), Some(tiles), Some(surface), Some(program)) = (
            &self.scene,
            &self.tiles,
            self.surface.group(),
            self.key.and_then(|key| pipelines.get(key)),
        ) else {
            return;
        };
        pass.set_pipeline(&program.resolve);
        for (index, group) in (0..).zip([scene, &tiles.read, surface]) {
            pass.set_bind_group(index, group, &[]);
        }
        pass.draw(0..4, 0..self.block_count);
    }

    /// Records the counting at one pixel into `answer`, which starts with the pixel; answers whether
    /// there was a depth to look at.
    pub(crate) fn count_at(
        &self,
        device: &wgpu::Device,
        pipelines: &SensorPipelines,
        encoder: &mut wgpu::CommandEncoder,
        answer: &wgpu::Buffer,
    ) -> bool {
        let program = self.key.and_then(|key| pipelines.get(key));
        let (Some(scene), Some(surface), Some(program)) =
            (&self.scene, self.surface.group(), program)
        else {
            return false;
        };
        let answer = group(device, &pipelines.answer_layout, &[answer]);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("globefill count sensors"),
            timestamp_writes: None,
        });
        for (index, group) in (0..).zip([scene, &answer, surface]) {
            pass.set_bind_group(index, group, &[]);
        }
        for pipeline in &program.counting {
            pass.set_pipeline(pipeline);
            pass.dispatch_workgroups(1, 1, 1);
        }
        true
    }
}

/// Whether a device can bin a picture of this size.
pub(crate) fn has_room_for_tiles(limits: &wgpu::Limits, size_px: UVec2) -> bool {
    let tiles = divided(size_px, TILE).element_product();
    tiles.div_ceil(WORKGROUP) <= limits.max_compute_workgroups_per_dimension
        && u64::from(tiles) * TILE_BYTES <= limits.max_storage_buffer_binding_size
}

/// How many tiles, blocks and pages there are.
type TilesKey = [u32; 3];

impl Tiles {
    fn new(device: &wgpu::Device, pipelines: &SensorPipelines, key: TilesKey) -> Self {
        let buffer = |label, size| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let [tiles, blocks, pages] = key.map(u64::from);
        let tiles = buffer("globefill tiles", tiles * TILE_BYTES);
        let blocks = buffer("globefill blocks", blocks * TILE_BYTES);
        let pages = buffer("globefill pages", pages * PAGE_BYTES);
        let used = buffer("globefill pages used", 4);
        Self {
            key,
            binned: group(
                device,
                &pipelines.binned_layout,
                &[&tiles, &blocks, &pages, &used],
            ),
            read: group(device, &pipelines.tiles_layout, &[&tiles, &blocks, &pages]),
            used,
        }
    }
}

/// Pages for the lists of all tiles and blocks: enough for a few hundred sensors in every list.
/// Where they run out, pixels ask longer lists, which is slow and as right.
fn page_count(device: &wgpu::Device, lists: u32, sensors: usize) -> u32 {
    let most_bytes = device
        .limits()
        .max_storage_buffer_binding_size
        .min(MOST_PAGE_BYTES);
    let longest = sensors.div_ceil(PAGE_ENTRIES).next_power_of_two();
    let pages = longest.min(PAGES_PER_LIST) as u64;
    (pages * u64::from(lists)).min(most_bytes / PAGE_BYTES) as u32
}

fn group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    buffers: &[&wgpu::Buffer],
) -> wgpu::BindGroup {
    let entries: Vec<_> = (0..)
        .zip(buffers)
        .map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("globefill sensors"),
        layout,
        entries: &entries,
    })
}
