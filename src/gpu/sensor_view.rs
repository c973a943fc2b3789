//! What a view keeps of the sensors: their records, the tiles, and what is bound.

use crate::{
    frame::reference::Reference,
    frame::sensor_records::SensorRecords,
    frame::sight_uniform::{SightUniform, tiles},
    gpu::sensor_pipelines::{SensorPipelines, Shown},
    gpu::stream_buffer::StreamBuffer,
    options::Frame,
    sensor_set::{SensorDisplay, SensorSet},
};

/// Most bytes of the lists of all tiles.
const MOST_LIST_BYTES: u64 = 64 << 20;
/// Bytes of `Tile` of tile.wgsl.
const TILE_BYTES: u64 = 32;

/// Buffers and bindings of one view.
pub(crate) struct SensorView {
    records: SensorRecords,
    uniform: StreamBuffer,
    sensors: StreamBuffer,
    planes: StreamBuffer,
    colors: StreamBuffer,
    tiles: Option<Tiles>,
    scene: Option<wgpu::BindGroup>,
    /// The depth last given to `count`.
    depth: Option<(wgpu::TextureView, wgpu::BindGroup)>,
    pub shown: Shown,
    pub tile_count: u32,
    /// What was last uploaded for, and the stamp of its set.
    prepared: Option<(Frame, u64)>,
}

/// Tiles and their lists.
struct Tiles {
    /// Tiles, and entries in the list of each.
    key: (u32, u32),
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
            uniform: stream("globefill sight", wgpu::BufferUsages::UNIFORM),
            sensors: stream("globefill sensors", storage),
            planes: stream("globefill planes", storage),
            colors: stream("globefill coverage colours", storage),
            tiles: None,
            scene: None,
            depth: None,
            shown: Shown::Blended,
            tile_count: 0,
            prepared: None,
        }
    }

    /// Whether the view already holds this frame.
    pub(crate) fn holds(&self, frame: &Frame, set: &SensorSet) -> bool {
        self.prepared == Some((*frame, set.changed()))
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
        let grid = tiles(with.frame.size_px);
        self.tile_count = grid.element_product();
        let capacity = list_capacity(device, self.tile_count, set.len());
        let mut uniform = with.uniform;
        uniform.weight[0] = self.records.depth_per_weight() as f32;
        uniform.counts = [set.len() as u32, capacity, 0, 0];
        let colors: Vec<[f32; 4]> = match set.display() {
            SensorDisplay::Blended => {
                self.shown = Shown::Blended;
                Vec::new()
            }
            SensorDisplay::Coverage(colors) => {
                self.shown = Shown::Coverage;
                uniform.counts[3] = u32::from(colors.colors_gaps());
                colors.premultiplied().collect()
            }
        };
        uniform.counts[2] = colors.len() as u32;
        let mut bytes = 0;
        let mut moved = self.scene.is_none();
        let uploads: [(&mut StreamBuffer, &[u8]); 4] = [
            (&mut self.uniform, bytemuck::bytes_of(&uniform)),
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
        let key = (self.tile_count, capacity);
        if self.tiles.as_ref().is_none_or(|tiles| tiles.key != key) {
            self.tiles = Some(Tiles::new(device, pipelines, key));
        }
        self.prepared = Some((*with.frame, set.changed()));
        bytes
    }

    fn bind(&mut self, device: &wgpu::Device, pipelines: &SensorPipelines) {
        let streams = [&self.uniform, &self.sensors, &self.planes, &self.colors];
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
        self.bind_depth(device, pipelines, depth);
        let (Some(scene), Some(tiles), Some((_, depth))) = (&self.scene, &self.tiles, &self.depth)
        else {
            return;
        };
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("globefill bin sensors"),
            timestamp_writes: None,
        });
        pass.set_pipeline(&pipelines.bin);
        for (index, group) in (0..).zip([scene, &tiles.binned, depth]) {
            pass.set_bind_group(index, group, &[]);
        }
        pass.dispatch_workgroups(self.tile_count.div_ceil(64), 1, 1);
    }

    fn bind_depth(
        &mut self,
        device: &wgpu::Device,
        pipelines: &SensorPipelines,
        depth: &wgpu::TextureView,
    ) {
        if self.depth.as_ref().is_some_and(|(view, _)| view == depth) {
            return;
        }
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("globefill depth"),
            layout: &pipelines.depth_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&crate::gpu::count::depth_only(depth)),
            }],
        });
        self.depth = Some((depth.clone(), group));
    }

    /// Draws the tiles into the host's pass.
    pub(crate) fn resolve(&self, pipelines: &SensorPipelines, pass: &mut wgpu::RenderPass<'_>) {
        let (Some(scene), Some(tiles), Some((_, depth)), Some(pipeline)) = (
            &self.scene,
            &self.tiles,
            &self.depth,
            pipelines.get(self.shown),
        ) else {
            return;
        };
        pass.set_pipeline(pipeline);
        for (index, group) in (0..).zip([scene, &tiles.read, depth]) {
            pass.set_bind_group(index, group, &[]);
        }
        pass.draw(0..4, 0..self.tile_count);
    }

    /// Records the counting at one pixel into `answer`, which starts with the pixel.
    pub(crate) fn count_at(
        &self,
        device: &wgpu::Device,
        pipelines: &SensorPipelines,
        encoder: &mut wgpu::CommandEncoder,
        answer: &wgpu::Buffer,
    ) {
        let (Some(scene), Some((_, depth))) = (&self.scene, &self.depth) else {
            return;
        };
        let answer = group(device, &pipelines.answer_layout, &[answer]);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("globefill count sensors"),
            timestamp_writes: None,
        });
        pass.set_pipeline(&pipelines.count);
        for (index, group) in (0..).zip([scene, &answer, depth]) {
            pass.set_bind_group(index, group, &[]);
        }
        pass.dispatch_workgroups(1, 1, 1);
    }
}

impl Tiles {
    fn new(device: &wgpu::Device, pipelines: &SensorPipelines, key: (u32, u32)) -> Self {
        let (tiles, capacity) = key;
        let buffer = |label, size| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: wgpu::BufferUsages::STORAGE,
                mapped_at_creation: false,
            })
        };
        let heads = buffer("globefill tiles", u64::from(tiles) * TILE_BYTES);
        let lists = buffer(
            "globefill tile lists",
            4 * u64::from(tiles) * u64::from(capacity),
        );
        let buffers = [&heads, &lists];
        Self {
            key,
            binned: group(device, &pipelines.binned_layout, &buffers),
            read: group(device, &pipelines.tiles_layout, &buffers),
        }
    }
}

/// Entries in the list of each tile: enough for all sensors, as far as memory allows. Tiles whose
/// list is too short ask all sensors, which is slow and as right.
fn list_capacity(device: &wgpu::Device, tiles: u32, sensors: usize) -> u32 {
    let most_bytes = device
        .limits()
        .max_storage_buffer_binding_size
        .min(MOST_LIST_BYTES);
    let most = (most_bytes / 4 / u64::from(tiles.max(1))).max(1);
    (sensors.next_power_of_two() as u64).min(most) as u32
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
