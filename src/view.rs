//! What a renderer keeps for one camera.

use std::collections::HashMap;

use crate::{
    frame::layer_set::LayerSet,
    frame::select::Selection,
    frame::sight::Sight,
    frame::volumes::Volume,
    frame::window::WindowDraw,
    frame_stats::FrameStats,
    gpu::fixed_point::FixedEye,
    gpu::gpu_mesh::GpuMesh,
    gpu::pipelines::Pipelines,
    gpu::projection::Projection,
    gpu::sensor_view::SensorView,
    gpu::stream_buffer::StreamBuffer,
    gpu::style_view::StyleView,
    gpu::targets::Targets,
    options::{CountTechnique, Frame},
    renderer::MeshId,
};

/// What a renderer keeps for one camera: targets of the size of its depth texture and what was
/// uploaded for its last frame. Make one a viewport with `View::default()`.
#[derive(Default)]
pub struct View {
    pub(crate) targets: Option<Targets>,
    pub(crate) meshes: HashMap<MeshId, MeshView>,
    /// By layer: where its plain colours are drawn, if they are.
    pub(crate) windows: Vec<Option<WindowDraw>>,
    /// Only while there are patterns, strokes or fades.
    pub(crate) styles: Option<StyleView>,
    /// Only while there are sensors.
    pub(crate) sensors: Option<SensorView>,
    /// What the last `prepare` was given, and its answer.
    pub(crate) prepared: Option<Prepared>,
}

/// The state a `prepare` left behind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Prepared {
    pub frame: Frame,
    pub revision: u64,
    pub technique: CountTechnique,
    pub mirrored: bool,
    pub projection: Projection,
    /// What a copy of logarithmic depths is made with: `logarithm` of copy_linear.wgsl.
    pub logarithm: Option<[f32; 4]>,
    /// The layers in which anything is drawn: only these are counted and resolved.
    pub shown: LayerSet,
    pub stats: FrameStats,
}

/// What one view draws of one mesh.
pub(crate) struct MeshView {
    /// The level of detail that is drawn.
    pub level: usize,
    pub selection: Selection,
    /// By layer; empty unless counted by stencil.
    pub volumes: Vec<Vec<Volume>>,
    uniform: StreamBuffer,
    pub frame_group: wgpu::BindGroup,
    patch_vertices: StreamBuffer,
    pub patch_indices: StreamBuffer,
    pub layers: Vec<LayerView>,
}

/// Where a view uploads to, and the mesh it draws.
pub(crate) struct Upload<'a> {
    pub device: &'a wgpu::Device,
    pub queue: &'a wgpu::Queue,
    pub pipelines: &'a Pipelines,
    pub mesh: &'a GpuMesh,
    pub weights: Option<&'a Weights>,
}

/// What is summed in the layer of a mixture.
pub(crate) struct Weights {
    pub layer: usize,
    /// By code, as the extruder reads them.
    pub by_code: Vec<[u32; 2]>,
}

impl Weights {
    /// The codes of a layer's pieces, replaced if it is that layer.
    fn in_layer(&self, layer: usize, codes: &[u32]) -> Option<Vec<[u32; 2]>> {
        let weight = |&code: &u32| self.by_code[code as usize];
        (layer == self.layer).then(|| codes.iter().map(weight).collect())
    }
}

/// Codes of one mesh in one layer.
pub(crate) struct LayerView {
    codes: StreamBuffer,
    pub mesh_group: wgpu::BindGroup,
    pub patch_group: wgpu::BindGroup,
}

impl MeshView {
    pub(crate) fn new(device: &wgpu::Device, pipelines: &Pipelines) -> Self {
        let uniform = StreamBuffer::new(device, "globefill frame", wgpu::BufferUsages::UNIFORM);
        let frame_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("globefill frame"),
            layout: &pipelines.frame_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: uniform.buffer.as_entire_binding(),
            }],
        });
        Self {
            level: 0,
            selection: Selection::default(),
            volumes: Vec::new(),
            uniform,
            frame_group,
            patch_vertices: StreamBuffer::new(
                device,
                "globefill patch vertices",
                wgpu::BufferUsages::STORAGE,
            ),
            patch_indices: StreamBuffer::new(
                device,
                "globefill patch indices",
                wgpu::BufferUsages::INDEX,
            ),
            layers: Vec::new(),
        }
    }

    /// Uploads what changed; returns the bytes.
    pub(crate) fn upload(
        &mut self,
        to: &Upload<'_>,
        level: usize,
        sight: &Sight,
        selection: Selection,
    ) -> u64 {
        let (device, queue) = (to.device, to.queue);
        let other_level = std::mem::replace(&mut self.level, level) != level;
        let mut bytes = 0;
        let uniform = FrameUniform::new(sight);
        // The uniform never grows, so its bind group stays.
        bytes += self
            .uniform
            .write(device, queue, bytemuck::bytes_of(&uniform))
            .0;
        let patch = &selection.patch;
        let (uploaded, patch_moved) =
            self.patch_vertices
                .write(device, queue, bytemuck::cast_slice(&patch.vertices));
        bytes += uploaded;
        bytes += self
            .patch_indices
            .write(device, queue, bytemuck::cast_slice(&patch.indices))
            .0;
        self.layers.truncate(selection.layers.len());
        for (index, draws) in selection.layers.iter().enumerate() {
            let weights = to
                .weights
                .and_then(|weights| weights.in_layer(index, &draws.codes));
            let codes: &[u8] = match &weights {
                Some(weights) => bytemuck::cast_slice(weights),
                None => bytemuck::cast_slice(&draws.codes),
            };
            let patch_vertices = &self.patch_vertices.buffer;
            if let Some(layer) = self.layers.get_mut(index) {
                let (uploaded, moved) = layer.codes.write(device, queue, codes);
                bytes += uploaded;
                if moved || patch_moved || other_level {
                    layer.rebind(to, patch_vertices);
                }
            } else {
                let mut stream =
                    StreamBuffer::new(device, "globefill codes", wgpu::BufferUsages::STORAGE);
                bytes += stream.write(device, queue, codes).0;
                let layer = LayerView::new(to, patch_vertices, stream);
                self.layers.push(layer);
            }
        }
        self.selection = selection;
        bytes
    }
}

impl LayerView {
    fn new(to: &Upload<'_>, patch_vertices: &wgpu::Buffer, codes: StreamBuffer) -> Self {
        let group = |vertices| mesh_group(to, vertices, &codes.buffer);
        Self {
            mesh_group: group(&to.mesh.vertices),
            patch_group: group(patch_vertices),
            codes,
        }
    }

    fn rebind(&mut self, to: &Upload<'_>, patch_vertices: &wgpu::Buffer) {
        self.mesh_group = mesh_group(to, &to.mesh.vertices, &self.codes.buffer);
        self.patch_group = mesh_group(to, patch_vertices, &self.codes.buffer);
    }
}

fn mesh_group(to: &Upload<'_>, vertices: &wgpu::Buffer, codes: &wgpu::Buffer) -> wgpu::BindGroup {
    let buffers = [vertices, &to.mesh.arc_at, &to.mesh.arcs, codes];
    let entries: Vec<_> = (0..)
        .zip(buffers)
        .map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    to.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("globefill mesh"),
        layout: &to.pipelines.mesh_layout,
        entries: &entries,
    })
}

/// `Frame` of extrude.wgsl; see there for units.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct FrameUniform {
    pub clip_from_relative: [f32; 16],
    pub eye: [i32; 4],
    pub eye_fraction: [i32; 4],
    pub eye_remainder: [f32; 4],
    pub normal_scale: [f32; 4],
    pub heights: [f32; 4],
    pub slack: [f32; 4],
    pub depth: [f32; 4],
    pub beyond: [i32; 4],
}

impl FrameUniform {
    fn new(sight: &Sight) -> Self {
        let eye = FixedEye::new(sight.eye_ecef_m);
        let [x, y, z] = eye.remainder_m.as_vec3().to_array();
        let outward = if sight.mirrored { -1.0 } else { 1.0 };
        let ratio = sight.ellipsoid.a_m / sight.ellipsoid.b_m;
        let extrusion = &sight.extrusion;
        let heights = [
            extrusion.top_m,
            extrusion.bottom_m,
            extrusion.push_per_m,
            extrusion.limit_m,
        ];
        let [constant, linear, quadratic] = extrusion.slack.map(|part| part as f32);
        let padded = |[x, y, z]: [i32; 3]| [x, y, z, 0];
        // First what distance, or w, is multiplied with.
        let mut depth = sight.depth;
        if sight.parallel {
            depth.reverse();
        }
        Self {
            clip_from_relative: sight.clip_from_relative.as_mat4().to_cols_array(),
            eye: padded(eye.steps),
            eye_fraction: padded(eye.fractions),
            eye_remainder: [x, y, z, outward],
            normal_scale: [1.0, 1.0, (ratio * ratio) as f32, 0.0],
            heights: heights.map(|height| height as f32),
            slack: [constant, linear, quadratic, sight.near_m as f32],
            depth: [depth[0] as f32, depth[1] as f32, 0.0, 0.0],
            beyond: sight.beyond.map_or([0, 0, 0, i32::MIN], |beyond| {
                let [x, y, z] = beyond.direction;
                [x, y, z, beyond.limit]
            }),
        }
    }
}
