//! What a view keeps of the edge pass, and recording it.

use std::collections::BTreeMap;

use glam::UVec2;

use crate::{
    frame::edge_draws::{EdgeDraws, EdgeInput, LayerEdges},
    frame::edge_uniform::EdgeUniform,
    frame::layer_set::LayerSet,
    frame::lens::LensKind,
    frame::reference::Reference,
    frame::select::Selection,
    frame::sight::Sight,
    frame::sight_uniform::SightUniform,
    gpu::count::Drawn,
    gpu::edge_pipelines::{EDGE_FORMAT, EdgeKey, EdgePipelines, NEAREST_FORMAT},
    gpu::gpu_mesh::GpuMesh,
    gpu::stream_buffer::StreamBuffer,
    options::DepthConvention,
    renderer::MeshId,
};

/// Targets, buffers and bindings of one view.
#[derive(Default)]
pub(crate) struct EdgeView {
    size_px: UVec2,
    nearest: Option<wgpu::TextureView>,
    /// By layer; none where no edges are wanted.
    layers: Vec<Option<EdgeLayer>>,
    meshes: BTreeMap<MeshId, EdgeMesh>,
    mirrored: bool,
    lens: LensKind,
}

struct EdgeLayer {
    target: wgpu::TextureView,
    reaches: StreamBuffer,
}

/// One mesh.
struct EdgeMesh {
    segments: StreamBuffer,
    /// By layer, as `EdgeView::layers`.
    layers: Vec<Option<EdgeMeshLayer>>,
}

/// One mesh in one layer.
struct EdgeMeshLayer {
    uniform: StreamBuffer,
    group: Option<wgpu::BindGroup>,
    /// The slots that the group binds.
    slots: Option<wgpu::Buffer>,
}

/// A mesh as a frame shows it.
#[derive(Clone, Copy)]
pub(crate) struct EdgeSubject<'a> {
    pub id: MeshId,
    pub gpu: &'a GpuMesh,
    pub sight: &'a Sight,
    pub selection: &'a Selection,
}

/// What a frame asks for.
#[derive(Clone, Copy)]
pub(crate) struct EdgeFrame<'a> {
    pub size_px: UVec2,
    pub depth: DepthConvention,
    /// By layer.
    pub layers: &'a [Option<LayerEdges>],
}

/// What the edge passes of a frame cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct EdgeCost {
    pub passes: u32,
    pub draws: u32,
    pub vertices: u64,
}

impl EdgeView {
    /// Uploads what changed, in the order in which the meshes are drawn; returns the bytes, and whether
    /// targets were replaced, which invalidates bindings of [`target`](Self::target).
    pub(crate) fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        pipelines: &mut EdgePipelines,
        frame: &EdgeFrame<'_>,
        subjects: &[EdgeSubject<'_>],
    ) -> (u64, bool) {
        self.mirrored = subjects.iter().any(|subject| subject.sight.mirrored);
        self.lens = subjects
            .first()
            .map_or(LensKind::default(), |subject| subject.sight.kind);
        for input in EdgeInput::ALL {
            pipelines.ensure(device, self.key(input));
        }
        let replaced = self.ensure_targets(device, frame);
        let mut bytes = 0;
        let mut moved = vec![false; self.layers.len()];
        for ((layer, wanted), moved) in self.layers.iter_mut().zip(frame.layers).zip(&mut moved) {
            if let (Some(layer), Some(wanted)) = (layer, wanted) {
                let reaches = bytemuck::cast_slice(&wanted.reaches);
                let (uploaded, replaced) = layer.reaches.write(device, queue, reaches);
                bytes += uploaded;
                *moved = replaced;
            }
        }
        self.meshes
            .retain(|id, _| subjects.iter().any(|subject| subject.id == *id));
        for subject in subjects {
            let mesh = self.meshes.entry(subject.id);
            let mesh = mesh.or_insert_with(|| EdgeMesh::new(device));
            let with = Upload {
                device,
                queue,
                pipelines,
                frame,
                layers: &self.layers,
                moved: &moved,
            };
            bytes += mesh.upload(&with, subject);
        }
        (bytes, replaced)
    }

    fn key(&self, input: EdgeInput) -> EdgeKey {
        EdgeKey {
            input,
            mirrored: self.mirrored,
            lens: self.lens,
        }
    }

    fn ensure_targets(&mut self, device: &wgpu::Device, frame: &EdgeFrame<'_>) -> bool {
        let wanted = frame.layers.iter().map(Option::is_some);
        let held = self.layers.iter().map(Option::is_some);
        if self.size_px == frame.size_px && held.eq(wanted.clone()) {
            return false;
        }
        let layer = |wanted: bool| {
            wanted.then(|| EdgeLayer {
                target: edge_target(device, frame.size_px),
                reaches: StreamBuffer::new(
                    device,
                    "globefill reaches",
                    wgpu::BufferUsages::STORAGE,
                ),
            })
        };
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        self.nearest = Some(texture(device, frame.size_px, NEAREST_FORMAT, attachment));
        self.layers = wanted.map(layer).collect();
        self.size_px = frame.size_px;
        // Their bindings refer to the layers' buffers.
        self.meshes.clear();
        true
    }

    /// What the edge pass of a layer writes: `EDGE_FORMAT`, of the view's size, one sample. None for layers
    /// without edges.
    pub(crate) fn target(&self, layer: usize) -> Option<&wgpu::TextureView> {
        let layer = self.layers.get(layer)?.as_ref()?;
        Some(&layer.target)
    }

    /// Records the passes: outside any pass, once the host's depth is final. `meshes` are those of
    /// [`prepare`](Self::prepare), or some of them; `surface` is the depth with its camera.
    pub(crate) fn record(
        &self,
        pipelines: &EdgePipelines,
        encoder: &mut wgpu::CommandEncoder,
        surface: &wgpu::BindGroup,
        meshes: &[Drawn<'_>],
        shown: LayerSet,
    ) {
        let Some(nearest) = &self.nearest else {
            return;
        };
        for (index, layer) in self.layers.iter().enumerate() {
            let Some(layer) = layer.as_ref().filter(|_| shown.contains(index)) else {
                continue;
            };
            let mut pass = begin(encoder, &layer.target, nearest);
            pass.set_bind_group(2, surface, &[]);
            for drawn in meshes {
                let Some(mesh) = self.meshes.get(&drawn.id) else {
                    continue;
                };
                let edges = &drawn.view.selection.layers[index].edges;
                let Some(group) = mesh.group(index) else {
                    continue;
                };
                pass.set_bind_group(0, &drawn.view.frame_group, &[]);
                pass.set_bind_group(1, &drawn.view.layers[index].mesh_group, &[]);
                pass.set_bind_group(3, group, &[]);
                self.draw(&mut pass, pipelines, mesh, edges);
            }
        }
    }

    fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        pipelines: &EdgePipelines,
        mesh: &EdgeMesh,
        edges: &EdgeDraws,
    ) {
        for input in EdgeInput::ALL {
            let runs = edges.runs(input);
            if runs.is_empty() {
                continue;
            }
            pass.set_pipeline(pipelines.get(self.key(input)));
            if input == EdgeInput::Segments {
                pass.set_vertex_buffer(0, mesh.segments.buffer.slice(..));
            }
            for run in runs {
                pass.draw(0..input.corners(), edges.chords_of(input, run));
            }
        }
    }
}

/// What the edge passes of a frame cost, given how each mesh is drawn.
pub(crate) fn edge_cost<'a>(
    layers: &[Option<LayerEdges>],
    selections: impl Iterator<Item = &'a Selection>,
) -> EdgeCost {
    let mut cost = EdgeCost::default();
    let mut shown = LayerSet::default();
    for selection in selections {
        selection.add_shown(&mut shown);
        for edges in selection.layers.iter().map(|draws| &draws.edges) {
            for input in EdgeInput::ALL {
                let runs = edges.runs(input);
                cost.draws += runs.len() as u32;
                let chords = runs.iter().map(|run| edges.chords_of(input, run).len());
                cost.vertices += u64::from(input.corners()) * chords.sum::<usize>() as u64;
            }
        }
    }
    let edged = shown
        .iter()
        .filter(|&layer| matches!(layers.get(layer), Some(Some(_))));
    cost.passes = edged.count() as u32;
    cost
}

/// Where a view uploads to.
struct Upload<'a> {
    device: &'a wgpu::Device,
    queue: &'a wgpu::Queue,
    pipelines: &'a EdgePipelines,
    frame: &'a EdgeFrame<'a>,
    layers: &'a [Option<EdgeLayer>],
    /// By layer: whether its buffers were replaced.
    moved: &'a [bool],
}

impl EdgeMesh {
    fn new(device: &wgpu::Device) -> Self {
        Self {
            segments: StreamBuffer::new(device, "globefill segments", wgpu::BufferUsages::VERTEX),
            layers: Vec::new(),
        }
    }

    fn group(&self, layer: usize) -> Option<&wgpu::BindGroup> {
        self.layers.get(layer)?.as_ref()?.group.as_ref()
    }

    fn upload(&mut self, to: &Upload<'_>, subject: &EdgeSubject<'_>) -> u64 {
        let (device, queue) = (to.device, to.queue);
        let sight = subject.sight;
        let reference = Reference::new(sight.ellipsoid, sight.eye_ecef_m);
        let rays = SightUniform::new(sight, &reference, to.frame.depth, to.frame.size_px);
        let pieces = bytemuck::cast_slice(&subject.selection.segments.pieces);
        let mut bytes = self.segments.write(device, queue, pieces).0;
        self.layers.resize_with(to.layers.len(), || None);
        for (index, (layer, wanted)) in to.layers.iter().zip(to.frame.layers).enumerate() {
            let (Some(layer), Some(wanted)) = (layer, wanted) else {
                continue;
            };
            let uniform = EdgeUniform::new(sight, &reference, &rays, &wanted.code);
            let Some(slots) = subject.gpu.known_edge_slots() else {
                continue;
            };
            let mut kept = match self.layers[index].take() {
                Some(kept) => kept,
                None => EdgeMeshLayer::new(device),
            };
            let uniform = bytemuck::bytes_of(&uniform);
            bytes += kept.uniform.write(device, queue, uniform).0;
            if to.moved[index] || kept.slots.as_ref() != Some(&slots.buffer) {
                let buffers = [&kept.uniform.buffer, &layer.reaches.buffer, &slots.buffer];
                kept.group = Some(edge_group(device, to.pipelines, buffers));
                kept.slots = Some(slots.buffer.clone());
            }
            self.layers[index] = Some(kept);
        }
        bytes
    }
}

impl EdgeMeshLayer {
    fn new(device: &wgpu::Device) -> Self {
        let uniform = wgpu::BufferUsages::UNIFORM;
        Self {
            uniform: StreamBuffer::new(device, "globefill edge", uniform),
            group: None,
            slots: None,
        }
    }
}

/// A target of the edge pass.
pub(crate) fn edge_target(device: &wgpu::Device, size_px: UVec2) -> wgpu::TextureView {
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT
        | wgpu::TextureUsages::TEXTURE_BINDING
        | wgpu::TextureUsages::COPY_SRC;
    texture(device, size_px, EDGE_FORMAT, usage)
}

fn texture(
    device: &wgpu::Device,
    size_px: UVec2,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("globefill edges"),
        size: wgpu::Extent3d {
            width: size_px.x,
            height: size_px.y,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn edge_group(
    device: &wgpu::Device,
    pipelines: &EdgePipelines,
    buffers: [&wgpu::Buffer; 3],
) -> wgpu::BindGroup {
    let entries: Vec<_> = (0..)
        .zip(buffers)
        .map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("globefill edge"),
        layout: &pipelines.edge_layout,
        entries: &entries,
    })
}

fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    target: &wgpu::TextureView,
    nearest: &wgpu::TextureView,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("globefill edges"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                // No ids: no edge.
                load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                store: wgpu::StoreOp::Store,
            },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: nearest,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(1.0),
                store: wgpu::StoreOp::Discard,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}
