//! The façade: what a host calls.

use std::collections::BTreeMap;

use crate::{
    error::RendererError,
    fill_mesh::FillMesh,
    frame::code::Mantissa,
    frame::code::PlaneSums,
    frame::layers::Styled,
    frame::select::Selection,
    frame::sight::Sight,
    frame::volumes::volumes,
    frame_stats::FrameStats,
    gpu::count::{self, Drawn, Recorder},
    gpu::gpu_mesh::GpuMesh,
    gpu::layer_tables::{LayerTables, require},
    gpu::pipelines::{FAR_PLANE_FEATURES, Input, Key, Pipelines},
    gpu::targets::{Targets, TargetsKey},
    options::{CountTechnique, FillStyle, Frame, RendererOptions},
    view::{MeshView, Prepared, Upload, View},
};

/// Names a mesh in a [`Renderer`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MeshId(u32);

/// Draws fills into the frames of one host configuration.
///
/// It borrows device, queue, encoder and passes, and never submits. Frame order: the host draws its
/// surface, then [`prepare`](Self::prepare), [`count`](Self::count) once the depth is final,
/// [`resolve`](Self::resolve), then what is to stay unfilled, such as models and labels.
pub struct Renderer {
    device: wgpu::Device,
    options: RendererOptions,
    mantissa: Mantissa,
    pipelines: Pipelines,
    meshes: BTreeMap<MeshId, Resident>,
    next_id: u32,
    /// Grows with every change of meshes and styles.
    revision: u64,
    /// Layers of the current meshes and styles, once asked for.
    layers: Option<Result<LayerTables, RendererError>>,
}

struct Resident {
    mesh: FillMesh,
    styles: Vec<FillStyle>,
    gpu: GpuMesh,
}

impl Renderer {
    /// Features that serve where the adapter has them; ask for them as
    /// `Renderer::wanted_features() & adapter.features()`.
    ///
    /// Without `FLOAT32_BLENDABLE` winding sums are half floats and large scenes are counted by
    /// stencil, which needs `DEPTH32FLOAT_STENCIL8`. Without `DEPTH_CLIP_CONTROL` and
    /// `CLIP_DISTANCES` a projection must not have a far plane.
    pub fn wanted_features() -> wgpu::Features {
        wgpu::Features::FLOAT32_BLENDABLE
            | FAR_PLANE_FEATURES
            | wgpu::Features::DEPTH32FLOAT_STENCIL8
    }

    /// A renderer for one host configuration.
    ///
    /// # Errors
    /// [`RendererError::Unsupported`] for options that contradict each other,
    /// [`RendererError::MissingFeature`] if the stencil technique lacks its format.
    pub fn new(device: &wgpu::Device, options: RendererOptions) -> Result<Self, RendererError> {
        if !matches!(options.sample_count, 1 | 4) {
            return Err(RendererError::Unsupported("sample_count must be 1 or 4"));
        }
        if !options.depth_format.has_depth_aspect() {
            return Err(RendererError::Unsupported("depth_format has no depth"));
        }
        if !options.color_format.has_color_aspect() {
            return Err(RendererError::Unsupported("color_format has no colour"));
        }
        let features = device.features();
        if options.count == CountTechnique::Stencil {
            require(features, wgpu::Features::DEPTH32FLOAT_STENCIL8)?;
        }
        let single = features.contains(wgpu::Features::FLOAT32_BLENDABLE);
        Ok(Self {
            device: device.clone(),
            options,
            mantissa: if single {
                Mantissa::Single
            } else {
                Mantissa::Half
            },
            pipelines: Pipelines::new(device, options),
            meshes: BTreeMap::new(),
            next_id: 0,
            revision: 0,
            layers: None,
        })
    }

    /// Uploads a mesh. Its fills start with the default style.
    pub fn insert(&mut self, mesh: FillMesh) -> MeshId {
        let id = MeshId(self.next_id);
        self.next_id += 1;
        let resident = Resident {
            gpu: GpuMesh::new(&self.device, &mesh),
            styles: vec![FillStyle::default(); mesh.fills.len()],
            mesh,
        };
        self.meshes.insert(id, resident);
        self.changed();
        id
    }

    /// Removes a mesh and frees its buffers.
    ///
    /// # Errors
    /// [`RendererError::NoSuchMesh`].
    pub fn remove(&mut self, mesh: MeshId) -> Result<(), RendererError> {
        self.meshes.remove(&mesh).ok_or(RendererError::NoSuchMesh)?;
        self.changed();
        Ok(())
    }

    /// Sets how a fill looks from the next `prepare` on; `fill` is the index of its region in the
    /// mesh.
    ///
    /// # Errors
    /// [`RendererError::NoSuchMesh`], [`RendererError::NoSuchFill`], and
    /// [`RendererError::InvalidStyle`] if the colour is not finite or its alpha not within 0 … 1; the
    /// previous style stays.
    pub fn set_style(
        &mut self,
        mesh: MeshId,
        fill: u32,
        style: FillStyle,
    ) -> Result<(), RendererError> {
        let alpha = style.color[3];
        if !(style.color.iter().all(|part| part.is_finite()) && (0.0..=1.0).contains(&alpha)) {
            return Err(RendererError::InvalidStyle { fill });
        }
        let styles = &mut self
            .meshes
            .get_mut(&mesh)
            .ok_or(RendererError::NoSuchMesh)?
            .styles;
        let fills = styles.len() as u32;
        let current = styles
            .get_mut(fill as usize)
            .ok_or(RendererError::NoSuchFill { fill, fills })?;
        if *current != style {
            *current = style;
            self.changed();
        }
        Ok(())
    }

    fn changed(&mut self) {
        self.revision += 1;
        self.layers = None;
    }

    /// Selects what to draw and uploads what changed. Call it for every view and frame, before
    /// `count`. A frame equal to the view's last one costs nothing and uploads nothing.
    ///
    /// # Errors
    /// [`RendererError::InvalidFrame`] and others that say what cannot be drawn; the view then keeps
    /// its last frame.
    pub fn prepare(
        &mut self,
        queue: &wgpu::Queue,
        view: &mut View,
        frame: &Frame,
    ) -> Result<FrameStats, RendererError> {
        if let Some(prepared) = &mut view.prepared
            && prepared.frame == *frame
            && prepared.revision == self.revision
        {
            prepared.stats.upload_bytes = 0;
            return Ok(prepared.stats);
        }
        let (table_bytes, selections) = self.layers_and_selections(frame)?;
        let layers = self.layers()?;
        let sight = selections.first().map(|selected| &selected.sight);
        let mut prepared = Prepared {
            frame: *frame,
            revision: self.revision,
            technique: layers.layering.technique,
            mirrored: sight.is_some_and(|sight| sight.mirrored),
            unclipped: sight.is_some_and(|sight| sight.far_plane),
            stats: FrameStats::default(),
        };
        if prepared.unclipped {
            require(self.device.features(), FAR_PLANE_FEATURES)?;
        }
        self.ensure_targets(view, frame)?;
        self.ensure_pipelines(&prepared, &selections)?;
        prepared.stats.upload_bytes = table_bytes + self.upload(queue, view, selections);
        self.fill_stats(view, &mut prepared);
        view.prepared = Some(prepared);
        Ok(prepared.stats)
    }

    /// Records the counting passes: after the host's depth is final, outside any pass.
    ///
    /// `depth` is a view of the depth texture the frame was prepared for. It is attached read-only;
    /// the stencil technique binds it as a texture instead, which needs `TEXTURE_BINDING`.
    pub fn count(
        &self,
        view: &View,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
    ) {
        self.record_count(view, encoder, depth, None);
    }

    /// Like [`count`](Self::count), with the pipeline statistics of the k-th counting pass written to
    /// the k-th of `queries`, of which there must be [`FrameStats::passes`]. Needs
    /// `PIPELINE_STATISTICS_QUERY`.
    pub fn count_measured(
        &self,
        view: &View,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
        queries: &wgpu::QuerySet,
    ) {
        self.record_count(view, encoder, depth, Some(queries));
    }

    fn record_count(
        &self,
        view: &View,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
        statistics: Option<&wgpu::QuerySet>,
    ) {
        let (Some(prepared), Some(targets)) = (view.prepared, &view.targets) else {
            return;
        };
        let meshes = self
            .meshes
            .iter()
            .filter_map(|(id, resident)| {
                view.meshes.get(id).map(|view| Drawn {
                    gpu: &resident.gpu,
                    view,
                })
            })
            .collect();
        let recorder = Recorder {
            device: &self.device,
            pipelines: &self.pipelines,
            prepared,
            targets,
            meshes,
            statistics,
        };
        recorder.record(encoder, depth);
    }

    /// Records the fills into the host's pass, which has the colour target, the options' sample
    /// count and no depth attachment. Colours are premultiplied and blended over what is there.
    pub fn resolve(&self, view: &View, pass: &mut wgpu::RenderPass<'_>) {
        let Some(targets) = &view.targets else {
            return;
        };
        if targets.layers.is_empty() {
            return;
        }
        pass.set_pipeline(self.pipelines.get(Key::Resolve));
        for layer in &targets.layers {
            pass.set_bind_group(0, &layer.resolve_group, &[]);
            pass.draw(0..3, 0..1);
        }
    }

    /// Layers of the current styles and what the frame shows of them. Falls back to the stencil where
    /// refined walls leave no head-room for winding sums. The number is of bytes uploaded.
    fn layers_and_selections(
        &mut self,
        frame: &Frame,
    ) -> Result<(u64, Vec<Selected>), RendererError> {
        let mut bytes = 0;
        if self.layers.is_none() {
            bytes += self.assign_layers(self.options.count);
        }
        let selections = self.select(frame)?;
        if self.has_head_room(&selections)? {
            return Ok((bytes, selections));
        }
        bytes += self.assign_layers(CountTechnique::Stencil);
        Ok((bytes, self.select(frame)?))
    }

    /// Makes the layers and their tables; returns the bytes uploaded.
    fn assign_layers(&mut self, technique: CountTechnique) -> u64 {
        let styled: Vec<Styled<'_>> = self
            .meshes
            .values()
            .map(|resident| Styled {
                mesh: &resident.mesh,
                styles: &resident.styles,
            })
            .collect();
        let tables = LayerTables::new(&self.device, &styled, technique, self.mantissa);
        let bytes = tables.as_ref().map_or(0, |tables| tables.bytes);
        self.layers = Some(tables);
        bytes
    }

    /// Whether the sums of this frame, refined walls included, are proven exact.
    fn has_head_room(&self, selections: &[Selected]) -> Result<bool, RendererError> {
        let layers = self.layers()?;
        let refined: Vec<PlaneSums> = (0..layers.layering.layers.len())
            .map(|layer| {
                let mut sums = PlaneSums::default();
                for selected in selections {
                    let mesh = &self.meshes[&selected.id].mesh;
                    selected.selection.layers[layer].add_refined_sums(mesh, &mut sums);
                }
                sums
            })
            .collect();
        Ok(layers.leave_room_for(&refined))
    }

    fn layers(&self) -> Result<&LayerTables, RendererError> {
        match &self.layers {
            Some(Ok(layers)) => Ok(layers),
            Some(Err(error)) => Err(error.clone()),
            None => Err(RendererError::NoSuchMesh),
        }
    }

    fn select(&self, frame: &Frame) -> Result<Vec<Selected>, RendererError> {
        let layering = &self.layers()?.layering;
        let layer_count = layering.layers.len();
        self.meshes
            .iter()
            .zip(&layering.codes)
            .map(|((&id, resident), codes)| {
                let mesh = &resident.mesh;
                let sight = Sight::new(mesh.ellipsoid, mesh.sag_m, frame, &self.options)?;
                Ok(Selected {
                    id,
                    selection: Selection::of(mesh, codes, layer_count, &sight),
                    sight,
                })
            })
            .collect()
    }

    fn ensure_targets(&self, view: &mut View, frame: &Frame) -> Result<(), RendererError> {
        let layers = self.layers()?;
        let key = TargetsKey {
            size_px: frame.size_px,
            planes: layers.planes(),
            stencil: layers.layering.technique == CountTechnique::Stencil,
            layer_revision: self.revision,
        };
        if view
            .targets
            .as_ref()
            .is_none_or(|targets| targets.key != key)
        {
            let samples = self.options.sample_count;
            let targets = Targets::new(&self.device, &self.pipelines, samples, &layers.tables, key);
            view.targets = Some(targets);
        }
        Ok(())
    }

    fn ensure_pipelines(
        &mut self,
        prepared: &Prepared,
        selections: &[Selected],
    ) -> Result<(), RendererError> {
        let planes = self.layers()?.planes();
        let draws = |index: usize| {
            let layer = move |selected: &Selected| selected.selection.layers[index].clone();
            selections.iter().map(layer)
        };
        for (index, planes) in planes.into_iter().enumerate() {
            let mut inputs = Vec::new();
            for (input, used) in [
                (
                    Input::Caps,
                    draws(index).any(|draws| !draws.caps.is_empty()),
                ),
                (
                    Input::Walls,
                    draws(index).any(|draws| !draws.walls.is_empty()),
                ),
                (
                    Input::Patches,
                    draws(index).any(|draws| !draws.patches.is_empty()),
                ),
            ] {
                if used {
                    inputs.push(input);
                }
            }
            let keys = count::keys(prepared.technique, planes, prepared.unclipped, &inputs);
            for key in keys.into_iter().chain([Key::Resolve]) {
                self.pipelines.ensure(&self.device, key);
            }
        }
        Ok(())
    }

    /// Uploads what the view's selection changes; returns the bytes.
    fn upload(&self, queue: &wgpu::Queue, view: &mut View, selections: Vec<Selected>) -> u64 {
        view.meshes.retain(|id, _| self.meshes.contains_key(id));
        let mut bytes = 0;
        for selected in selections {
            let resident = &self.meshes[&selected.id];
            let mesh_view = view
                .meshes
                .entry(selected.id)
                .or_insert_with(|| MeshView::new(&self.device, &self.pipelines));
            bytes += mesh_view.upload(
                &Upload {
                    device: &self.device,
                    queue,
                    pipelines: &self.pipelines,
                    mesh: &resident.gpu,
                },
                &selected.sight,
                selected.selection,
            );
        }
        bytes
    }

    /// Volumes for the stencil, and the frame's statistics.
    fn fill_stats(&self, view: &mut View, prepared: &mut Prepared) {
        let stats = &mut prepared.stats;
        stats.technique = prepared.technique;
        for (id, resident) in &self.meshes {
            stats.fills += resident.mesh.fills.len() as u32;
            stats.gpu_bytes += resident.mesh.gpu_bytes();
            let Some(mesh_view) = view.meshes.get_mut(id) else {
                continue;
            };
            mesh_view.volumes = match prepared.technique {
                CountTechnique::Winding => Vec::new(),
                CountTechnique::Stencil => mesh_view
                    .selection
                    .layers
                    .iter()
                    .map(|draws| volumes(&resident.mesh, draws))
                    .collect(),
            };
            let cost = count::cost(mesh_view);
            stats.drawn += mesh_view.selection.fills_drawn;
            stats.culled += mesh_view.selection.fills_culled;
            stats.refined_chords += mesh_view.selection.patch.chords.len() as u32;
            stats.draws += cost.draws;
            stats.vertices += cost.vertices;
        }
        stats.layers = view
            .targets
            .as_ref()
            .map_or(0, |targets| targets.layers.len() as u32);
        // Resolve draws a triangle a layer; the stencil copies the depth once.
        stats.draws += stats.layers;
        stats.passes = stats.layers;
        if prepared.technique == CountTechnique::Stencil && stats.layers > 0 {
            stats.draws += 1;
            stats.passes += 1;
        }
    }
}

/// What a frame shows of one mesh.
struct Selected {
    id: MeshId,
    sight: Sight,
    selection: Selection,
}
