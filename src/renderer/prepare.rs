//! Preparing a frame: layers, selection, targets, pipelines, upload.

use glam::UVec2;

use super::{MeshId, Renderer, Resident, chosen::Chosen, windows::layer_window};
use crate::{
    error::RendererError,
    frame::edge_draws::EdgeWants,
    frame::layer_set::LayerSet,
    frame::layers::{Counting, Styled},
    frame::lens::log_range,
    frame::placed::PatternPlace,
    frame::select::{LayerDraws, Selection},
    frame::sight::Sight,
    frame::volumes::volumes,
    frame::window::WindowDraw,
    frame_stats::FrameStats,
    gpu::count,
    gpu::count_cost::cost,
    gpu::layer_tables::{LayerTables, require},
    gpu::pipelines::{Input, Key},
    gpu::projection::Projection,
    gpu::style_table::StyleSource,
    gpu::targets::{Copied, Targets, TargetsKey},
    options::{CountTechnique, Frame},
    pick::Pick,
    view::{MeshView, Prepared, Upload, View, Weights},
};

impl Renderer {
    /// What [`Renderer::prepare`] promises of the fills.
    pub(super) fn prepare_fills(
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
        let size_limit = self.device.limits().max_texture_dimension_2d;
        if frame.size_px.max_element() > size_limit {
            return Err(RendererError::InvalidFrame("size_px"));
        }
        let (chosen, selections) = self.choose_layers(frame)?;
        let counting = chosen.counting;
        let layers = self.layers(counting)?;
        let sight = selections.first().map(|selected| &selected.sight);
        let mut prepared = Prepared {
            frame: *frame,
            revision: self.revision,
            technique: layers.layering.technique,
            mirrored: sight.is_some_and(|sight| sight.mirrored),
            projection: sight.map(Projection::of).unwrap_or_default(),
            logarithm: sight.and_then(logarithm),
            shown: LayerSet::default(),
            stats: FrameStats::default(),
        };
        for selected in &selections {
            selected.selection.add_shown(&mut prepared.shown);
        }
        require(self.device.features(), prepared.projection.features())?;
        self.check_styles(&selections, counting)?;
        self.ensure_targets(view, &prepared, &chosen)?;
        self.ensure_pipelines(&prepared, &selections, &chosen)?;
        let place_bytes = self.prepare_styles(queue, view, &prepared, &selections, &chosen);
        view.windows = self.windows(counting, &selections, frame.size_px)?;
        let mesh_bytes = self.upload(queue, view, selections, &chosen)?;
        prepared.stats.joined_layers =
            chosen.joined.iter().filter(|&&bits| bits > 0).count() as u32;
        prepared.stats.upload_bytes = chosen.table_bytes + place_bytes + mesh_bytes;
        self.fill_stats(view, &mut prepared);
        view.prepared = Some(prepared);
        Ok(prepared.stats)
    }

    pub(super) fn make_layers(&self, counting: Counting) -> Result<LayerTables, RendererError> {
        let styled: Vec<Styled<'_>> = self
            .meshes
            .values()
            .map(|resident| Styled {
                mesh: &resident.mesh,
                styles: &resident.styles,
            })
            .collect();
        let places: Vec<&[Option<PatternPlace>]> = self
            .meshes
            .values()
            .map(|resident| resident.places.as_slice())
            .collect();
        let from = StyleSource {
            styled: &styled,
            places: &places,
            images: self.images.as_ref(),
            smooth: self.options.smooth_edges && self.options.sample_count == 1,
        };
        LayerTables::new(&self.device, &from, counting, self.mantissa)
    }

    pub(super) fn layers(&self, counting: Counting) -> Result<&LayerTables, RendererError> {
        match &self.layers[counting as usize] {
            Some(Ok(layers)) => Ok(layers),
            Some(Err(error)) => Err(error.clone()),
            None => Err(RendererError::NoSuchMesh),
        }
    }

    pub(super) fn select(
        &self,
        frame: &Frame,
        counting: Counting,
    ) -> Result<Vec<Selected>, RendererError> {
        let tables = self.layers(counting)?;
        let layering = &tables.layering;
        self.meshes
            .iter()
            .enumerate()
            .map(|(index, (&id, resident))| {
                let mesh = &resident.mesh;
                let finest = Sight::new(mesh.ellipsoid, mesh.sag_m, frame, &self.options)?;
                let edged = tables.edges.iter().any(Option::is_some);
                // Boundaries are measured from the true edges, which only the finest level knows.
                let (level, sight) = if edged {
                    (0, finest)
                } else {
                    self.level_for(resident, frame, finest)?
                };
                let slots = edged.then(|| resident.gpu.edge_slots(&self.device, mesh));
                let wants = EdgeWants {
                    layers: &tables.edges,
                    slots: slots.map_or(&[], |slots| slots.slots.as_slice()),
                };
                let mesh = resident.level(level);
                let sight = sight.flat_beyond(resident.longest_edges_rad[level]);
                Ok(Selected {
                    id,
                    level,
                    selection: Selection::of(mesh, layering.coded(index), &sight, &wants),
                    sight,
                })
            })
            .collect()
    }

    /// The coarsest level that is within the frame's budget wherever it is seen, and the sight for it.
    fn level_for(
        &self,
        resident: &Resident,
        frame: &Frame,
        finest: Sight,
    ) -> Result<(usize, Sight), RendererError> {
        if resident.coarser.is_empty() {
            return Ok((0, finest));
        }
        let mesh = &resident.mesh;
        let distance_m = finest.distance_to_detail_m(mesh);
        for (index, level) in resident.coarser.iter().enumerate().rev() {
            let sag_m = mesh.coarser[index].sag_m;
            let sight = Sight::new(mesh.ellipsoid, sag_m, frame, &self.options)?;
            if level.coarseness.suffices(&sight, distance_m) {
                return Ok((index + 1, sight));
            }
        }
        Ok((0, finest))
    }

    fn ensure_targets(
        &self,
        view: &mut View,
        prepared: &Prepared,
        chosen: &Chosen,
    ) -> Result<(), RendererError> {
        let layers = self.layers(chosen.counting)?;
        let key = TargetsKey {
            size_px: prepared.frame.size_px,
            planes: layers.planes(&chosen.joined),
            copied: prepared.copied(),
            layer_revision: (self.revision, chosen.counting),
        };
        if view
            .targets
            .as_ref()
            .is_none_or(|targets| targets.key != key)
        {
            let samples = self.options.sample_count;
            let pick = Pick::new(layers.layering.clone(), self.meshes.keys().copied());
            let targets = Targets::new(&self.device, &self.pipelines, samples, layers, pick, key);
            view.targets = Some(targets);
        }
        Ok(())
    }

    fn ensure_pipelines(
        &mut self,
        prepared: &Prepared,
        selections: &[Selected],
        chosen: &Chosen,
    ) -> Result<(), RendererError> {
        let layers = self.layers(chosen.counting)?;
        let resolved_by = layers.resolved_by(&chosen.joined);
        for (index, planes) in layers.planes(&chosen.joined).into_iter().enumerate() {
            let uses = |has: fn(&LayerDraws) -> bool| {
                selections
                    .iter()
                    .any(|selected| has(&selected.selection.layers[index]))
            };
            let inputs: Vec<Input> = [
                (
                    Input::Caps,
                    uses(|draws| draws.caps.iter().any(|run| run.piece.is_some())),
                ),
                (
                    Input::MixedCaps,
                    uses(|draws| draws.caps.iter().any(|run| run.piece.is_none())),
                ),
                (Input::Walls, uses(|draws| !draws.walls.is_empty())),
                (Input::Patches, uses(|draws| !draws.patches.is_empty())),
            ]
            .into_iter()
            .filter_map(|(input, used)| used.then_some(input))
            .collect();
            let keys = count::keys(prepared.technique, planes, prepared.projection, &inputs);
            let copy = prepared.copied().map(|copied| Key::CopyDepth {
                logarithmic: prepared.logarithm.is_some(),
                stencil: copied == Copied::WithStencil,
            });
            for key in keys.into_iter().chain(copy).chain([resolved_by[index]]) {
                self.pipelines.ensure(&self.device, key);
            }
        }
        Ok(())
    }

    /// Where each layer is resolved that plain colours do for.
    fn windows(
        &self,
        counting: Counting,
        selections: &[Selected],
        size_px: UVec2,
    ) -> Result<Vec<Option<WindowDraw>>, RendererError> {
        let tables = self.layers(counting)?;
        let windows = (0..tables.layering.count()).map(|layer| {
            if tables.styles.get(layer).is_some_and(Option::is_some) {
                return None;
            }
            // Pixels at a fill's edge may take what their neighbours show.
            layer_window(&self.meshes, selections, layer, 0.0).draw(size_px, 1.0)
        });
        Ok(windows.collect())
    }

    /// Uploads what the view's selection changes; returns the bytes.
    fn upload(
        &self,
        queue: &wgpu::Queue,
        view: &mut View,
        selections: Vec<Selected>,
        chosen: &Chosen,
    ) -> Result<u64, RendererError> {
        let layering = &self.layers(chosen.counting)?.layering;
        let weights = layering.mixture.as_ref().map(|mixture| Weights {
            layer: layering.layers.len(),
            by_code: mixture.weights(chosen.mixture_scale),
        });
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
                    mesh: resident.gpu(&self.device, selected.level),
                    weights: weights.as_ref(),
                },
                selected.level,
                &selected.sight,
                selected.selection,
            );
        }
        let mixture = view.targets.as_mut().and_then(|it| it.mixture.as_mut());
        if let Some(stream) = mixture {
            let unit = [1.0 / chosen.mixture_scale as f32, 0.0, 0.0, 0.0];
            bytes += stream
                .write(&self.device, queue, bytemuck::bytes_of(&unit))
                .0;
        }
        Ok(bytes)
    }

    /// Volumes for the stencil, and the frame's statistics.
    fn fill_stats(&self, view: &mut View, prepared: &mut Prepared) {
        let copied = prepared.copied();
        let stats = &mut prepared.stats;
        stats.technique = prepared.technique;
        for (id, resident) in &self.meshes {
            stats.fills += resident.mesh.fills.len() as u32;
            stats.gpu_bytes += resident.gpu_bytes();
            let Some(mesh_view) = view.meshes.get_mut(id) else {
                continue;
            };
            mesh_view.volumes = match prepared.technique {
                CountTechnique::Winding => Vec::new(),
                CountTechnique::Stencil => mesh_view
                    .selection
                    .layers
                    .iter()
                    .map(|draws| volumes(resident.level(mesh_view.level), draws))
                    .collect(),
            };
            let cost = cost(mesh_view);
            stats.level = stats.level.max(mesh_view.level as u32);
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
        // Resolve draws a window a layer, or one for each array of images; a copy of the depth is another.
        for layer in prepared.shown.iter() {
            let styled = view
                .styles
                .as_ref()
                .and_then(|styles| styles.draws_of(layer));
            stats.styled_layers += u32::from(styled.is_some());
            stats.draws += styled.unwrap_or(u32::from(view.windows[layer].is_some()));
        }
        if let Some(styles) = &view.styles {
            stats.edge_passes = styles.edge_cost.passes;
            stats.draws += styles.edge_cost.draws;
            stats.vertices += styles.edge_cost.vertices;
        }
        stats.passes = prepared.shown.len();
        if copied.is_some() && stats.passes > 0 {
            stats.draws += 1;
            stats.passes += 1;
        }
    }
}

impl Prepared {
    /// How the host's depth is copied, if it is.
    pub(super) fn copied(&self) -> Option<Copied> {
        match self.technique {
            CountTechnique::Stencil => Some(Copied::WithStencil),
            CountTechnique::Winding => self.logarithm.map(|_| Copied::Alone),
        }
    }
}

/// `logarithm` of copy_linear.wgsl.
fn logarithm(sight: &Sight) -> Option<[f32; 4]> {
    let log = sight.log_depth?;
    let parts = [log_range(&log), 1.0 / log.per_m, log.from_m, sight.near_m];
    Some(parts.map(|part| part as f32))
}

/// What a frame shows of one mesh.
pub(super) struct Selected {
    pub(super) id: MeshId,
    pub(super) level: usize,
    pub(super) sight: Sight,
    pub(super) selection: Selection,
}
