//! What a view keeps of styles: where its eye finds the patterns, and what is bound.

use crate::{
    frame::layer_set::LayerSet,
    frame::layers::Counting,
    frame::lens::LensKind,
    frame::placed::{PatternPlace, Placed},
    frame::reference::Reference,
    frame::sight_uniform::SightUniform,
    gpu::count::Drawn,
    gpu::edge_view::{EdgeCost, EdgeFrame, EdgeSubject, EdgeView, edge_cost},
    gpu::image_arrays::ImageArrays,
    gpu::layer_tables::LayerTables,
    gpu::stream_buffer::StreamBuffer,
    gpu::style_pipelines::{StyleKey, StylePipelines},
    gpu::style_table::{UNIFORM_PLACES_BYTES, UNIFORM_STYLES_BYTES},
    gpu::surface_binding::SurfaceBinding,
};

/// Buffers and bindings of one view.
pub(crate) struct StyleView {
    surface: SurfaceBinding,
    places: StreamBuffer,
    /// Only while boundaries are measured.
    edges: Option<EdgeView>,
    /// What measuring them costs.
    pub edge_cost: EdgeCost,
    /// By layer; none where plain colours say all.
    layers: Vec<Option<StyledLayer>>,
    /// Which layer tables are bound.
    revision: (u64, Counting),
    lens: LensKind,
}

struct StyledLayer {
    key: StyleKey,
    arrays: Vec<u32>,
    group: wgpu::BindGroup,
}

/// Flag of the draw that shows the last array; as in resolve_styled.wgsl.
const LAST_ARRAY: u32 = 1 << 16;

/// What a frame brings.
pub(crate) struct StyleFrame<'a> {
    pub tables: &'a LayerTables,
    /// Which tables these are.
    pub revision: (u64, Counting),
    pub reference: Reference,
    pub uniform: SightUniform,
    pub lens: LensKind,
    pub edges: EdgeFrame<'a>,
    /// The meshes, in the order they are drawn in.
    pub subjects: &'a [EdgeSubject<'a>],
}

impl StyleView {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let either = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::UNIFORM;
        let places = "globefill places";
        Self {
            surface: SurfaceBinding::new(device),
            places: StreamBuffer::with_size(device, places, either, UNIFORM_PLACES_BYTES),
            edges: None,
            edge_cost: EdgeCost::default(),
            layers: Vec::new(),
            revision: (0, Counting::Winding),
            lens: LensKind::default(),
        }
    }

    /// Places the patterns for the frame's eye and uploads what changed; returns the bytes.
    pub(crate) fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        pipelines: &mut StylePipelines,
        with: &StyleFrame<'_>,
    ) -> u64 {
        let placed: Vec<Placed> = with
            .tables
            .places
            .iter()
            .map(|place: &PatternPlace| place.seen_from(&with.reference))
            .collect();
        let bytes = self.surface.write(device, queue, &with.uniform);
        let contents = bytemuck::cast_slice(&placed);
        let (uploaded, moved) = self.places.write(device, queue, contents);
        let (edge_bytes, replaced) = self.prepare_edges(device, queue, pipelines, with);
        let turned = self.lens != with.lens;
        self.lens = with.lens;
        if moved || replaced || turned || self.revision != with.revision || self.layers.is_empty() {
            self.revision = with.revision;
            self.bind(device, pipelines, with.tables);
        }
        bytes + uploaded + edge_bytes
    }

    /// Whatever measuring boundaries needs; the bytes, and whether what is bound of it changed.
    fn prepare_edges(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        pipelines: &mut StylePipelines,
        with: &StyleFrame<'_>,
    ) -> (u64, bool) {
        let Some(edge_pipelines) = &mut pipelines.edges else {
            return (0, false);
        };
        if with.edges.layers.iter().all(Option::is_none) {
            self.edge_cost = EdgeCost::default();
            return (0, self.edges.take().is_some());
        }
        let selections = with.subjects.iter().map(|subject| subject.selection);
        self.edge_cost = edge_cost(with.edges.layers, selections);
        let edges = self.edges.get_or_insert_default();
        edges.prepare(device, queue, edge_pipelines, &with.edges, with.subjects)
    }

    fn bind(&mut self, device: &wgpu::Device, pipelines: &StylePipelines, tables: &LayerTables) {
        let styled = tables.styles.iter().enumerate().map(|(layer, table)| {
            let table = table.as_ref()?;
            let edges = self.edges.as_ref().and_then(|edges| edges.target(layer));
            let key = tables.style_key(device, layer, table, self.lens);
            // Uniforms have a largest size.
            let bound = |buffer, few_bytes| {
                wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer,
                    offset: 0,
                    size: wgpu::BufferSize::new(few_bytes).filter(|_| key.few),
                })
            };
            let resources = [
                bound(&table.styles, UNIFORM_STYLES_BYTES),
                bound(&self.places.buffer, UNIFORM_PLACES_BYTES),
                wgpu::BindingResource::TextureView(edges.unwrap_or(&pipelines.no_edges)),
            ];
            let entries: Vec<_> = (0..)
                .zip(resources)
                .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
                .collect();
            Some(StyledLayer {
                key,
                arrays: table.arrays.clone(),
                group: device.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: Some("globefill styles"),
                    layout: pipelines.style_layout(key),
                    entries: &entries,
                }),
            })
        });
        self.layers = styled.collect();
    }

    /// Binds the depth, and records measuring how far its pixels are from boundaries. `meshes` are the
    /// subjects of [`Self::prepare`].
    pub(crate) fn count(
        &mut self,
        device: &wgpu::Device,
        pipelines: &StylePipelines,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
        meshes: &[Drawn<'_>],
        shown: LayerSet,
    ) {
        self.surface.bind(device, &pipelines.surface_layout, depth);
        if let (Some(edges), Some(edge_pipelines), Some(surface)) =
            (&self.edges, &pipelines.edges, self.surface.group())
        {
            edges.record(edge_pipelines, encoder, surface, meshes, shown);
        }
    }

    /// How many draws resolve a layer; none where plain colours do.
    pub(crate) fn draws_of(&self, layer: usize) -> Option<u32> {
        let styled = self.layers.get(layer)?.as_ref()?;
        Some(styled.arrays.len() as u32)
    }

    /// Draws a layer whose table and sums are bound as group 0, so many bits of the check in the plane of the id.
    pub(crate) fn resolve(
        &self,
        pipelines: &StylePipelines,
        images: &ImageArrays,
        pass: &mut wgpu::RenderPass<'_>,
        layer: usize,
        joined: u32,
    ) {
        let styled = self.layers.get(layer).and_then(Option::as_ref);
        let (Some(styled), Some(surface)) = (styled, self.surface.group()) else {
            return;
        };
        let Some(pipeline) = pipelines.get(styled.key.joined(joined)) else {
            return;
        };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &styled.group, &[]);
        pass.set_bind_group(2, surface, &[]);
        for (index, &array) in styled.arrays.iter().enumerate() {
            let last = index + 1 == styled.arrays.len();
            let instance = array | if last { LAST_ARRAY } else { 0 };
            pass.set_bind_group(3, images.group(array), &[]);
            pass.draw(0..4, instance..instance + 1);
        }
    }
}
