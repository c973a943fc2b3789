//! Recording the count passes.

use wgpu::util::BufferInitDescriptor;

use crate::{
    frame::select::{CapRun, LayerDraws},
    frame::volumes::{Volume, Walls},
    gpu::filled_buffer::FilledBuffer as _,
    gpu::fixed_function::{NONE_COUNTED, ONE_COUNTED},
    gpu::gpu_mesh::GpuMesh,
    gpu::pipelines::{Input, Key, Pipelines},
    gpu::planes::Planes,
    gpu::projection::Projection,
    gpu::targets::{Copied, LayerTarget, Targets},
    options::CountTechnique,
    renderer::MeshId,
    view::{LayerView, MeshView, Prepared},
};

/// A mesh as one view draws it.
#[derive(Clone, Copy)]
pub(crate) struct Drawn<'a> {
    pub id: MeshId,
    pub gpu: &'a GpuMesh,
    pub view: &'a MeshView,
}

/// Everything the passes of one view need.
pub(crate) struct Recorder<'a> {
    pub device: &'a wgpu::Device,
    pub pipelines: &'a Pipelines,
    pub prepared: Prepared,
    pub targets: &'a Targets,
    pub meshes: Vec<Drawn<'a>>,
    /// Takes the pipeline statistics of each pass.
    pub statistics: Option<&'a wgpu::QuerySet>,
}

/// The pipelines that counting a layer needs.
pub(crate) fn keys(
    technique: CountTechnique,
    planes: Planes,
    projection: Projection,
    inputs: &[Input],
) -> Vec<Key> {
    let mut keys = Vec::new();
    for &input in inputs {
        match technique {
            CountTechnique::Winding => keys.push(Key::Count {
                input,
                planes,
                projection,
            }),
            CountTechnique::Stencil => {
                keys.extend([false, true].map(|flipped| Key::Stencil {
                    input,
                    planes,
                    flipped,
                    projection,
                }));
                keys.push(Key::Cover {
                    input,
                    planes,
                    projection,
                });
                keys.push(Key::Reject {
                    input,
                    planes,
                    projection,
                });
            }
        }
    }
    keys
}

impl Recorder<'_> {
    pub(crate) fn record(&self, encoder: &mut wgpu::CommandEncoder, depth: &wgpu::TextureView) {
        if self.prepared.shown.is_empty() {
            return;
        }
        let copy = self.targets.copy.as_ref();
        if let Some(copy) = copy {
            self.record_depth_copy(encoder, depth, copy);
        }
        for index in self.prepared.shown.iter() {
            let target = &self.targets.layers[index];
            match (self.prepared.technique, copy) {
                (CountTechnique::Winding, copy) => {
                    self.record_winding(encoder, copy.unwrap_or(depth), index, target);
                }
                (CountTechnique::Stencil, Some(stencil)) => {
                    self.record_stencil(encoder, stencil, index, target);
                }
                // The stencil always works on a copy.
                (CountTechnique::Stencil, None) => {}
            }
        }
    }

    fn record_winding(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
        index: usize,
        target: &LayerTarget,
    ) {
        let read_only = wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: None,
            stencil_ops: None,
        };
        let mut pass = begin(encoder, "globefill count", Some(target), read_only);
        self.begin_statistics(&mut pass, self.query(index));
        let count = |input| Key::Count {
            input,
            planes: self.targets.key.planes[index],
            projection: self.prepared.projection,
        };
        for drawn in &self.meshes {
            let (draws, layer) = (
                &drawn.view.selection.layers[index],
                &drawn.view.layers[index],
            );
            pass.set_bind_group(0, &drawn.view.frame_group, &[]);
            pass.set_bind_group(1, &layer.mesh_group, &[]);
            self.draw_caps(&mut pass, count, drawn, draws);
            if !draws.walls.is_empty() {
                pass.set_pipeline(self.pipelines.get(count(Input::Walls)));
                for slots in &draws.walls {
                    pass.draw(2 * slots.start..2 * slots.end, 0..1);
                }
            }
            if !draws.patches.is_empty() {
                pass.set_pipeline(self.pipelines.get(count(Input::Patches)));
                self.bind_patch(&mut pass, drawn.view, layer);
                for run in &draws.patches {
                    pass.draw_indexed(run.indices.clone(), 0, run.arc..run.arc + 1);
                }
            }
        }
        self.end_statistics(&mut pass);
    }

    /// The query of a layer's pass: the first belongs to the copy of the depth, if there is one.
    fn query(&self, layer: usize) -> u32 {
        let copies = usize::from(self.targets.copy.is_some());
        let before = self.prepared.shown.iter().take_while(|&it| it < layer);
        (copies + before.count()) as u32
    }

    fn begin_statistics(&self, pass: &mut wgpu::RenderPass<'_>, index: u32) {
        if let Some(queries) = self.statistics {
            pass.begin_pipeline_statistics_query(queries, index);
        }
    }

    fn end_statistics(&self, pass: &mut wgpu::RenderPass<'_>) {
        if self.statistics.is_some() {
            pass.end_pipeline_statistics_query();
        }
    }

    /// Caps, raised where that can matter and pushed down.
    fn draw_caps(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        key: impl Fn(Input) -> Key,
        drawn: &Drawn<'_>,
        draws: &LayerDraws,
    ) {
        pass.set_index_buffer(drawn.gpu.cap_indices.slice(..), wgpu::IndexFormat::Uint32);
        for input in [Input::Caps, Input::MixedCaps] {
            let mut runs = draws
                .caps
                .iter()
                .filter(|run| run.input() == input)
                .peekable();
            if runs.peek().is_some() {
                pass.set_pipeline(self.pipelines.get(key(input)));
            }
            for run in runs {
                let indices = 3 * run.triangles.start..3 * run.triangles.end;
                pass.draw_indexed(indices, 0, run.instances());
            }
        }
    }

    fn bind_patch(&self, pass: &mut wgpu::RenderPass<'_>, view: &MeshView, layer: &LayerView) {
        pass.set_bind_group(1, &layer.patch_group, &[]);
        let indices = view.patch_indices.buffer.slice(..);
        pass.set_index_buffer(indices, wgpu::IndexFormat::Uint32);
    }

    fn record_depth_copy(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
        copy: &wgpu::TextureView,
    ) {
        let with_stencil = self.targets.key.copied == Some(Copied::WithStencil);
        let logarithm = self.prepared.logarithm.map(|logarithm| {
            self.device.filled_buffer(&BufferInitDescriptor {
                label: Some("globefill logarithm"),
                contents: bytemuck::bytes_of(&logarithm),
                usage: wgpu::BufferUsages::UNIFORM,
            })
        });
        let depth = depth_only(depth);
        let mut entries = vec![wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::TextureView(&depth),
        }];
        entries.extend(logarithm.as_ref().map(|buffer| wgpu::BindGroupEntry {
            binding: 1,
            resource: buffer.as_entire_binding(),
        }));
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("globefill depth"),
            layout: self.pipelines.copied_layout(logarithm.is_some()),
            entries: &entries,
        });
        let cleared = wgpu::RenderPassDepthStencilAttachment {
            view: copy,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0.0),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: with_stencil.then_some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0),
                store: wgpu::StoreOp::Store,
            }),
        };
        let mut pass = begin(encoder, "globefill copy depth", None, cleared);
        self.begin_statistics(&mut pass, 0);
        pass.set_pipeline(self.pipelines.get(Key::CopyDepth {
            logarithmic: logarithm.is_some(),
            stencil: with_stencil,
        }));
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        self.end_statistics(&mut pass);
    }

    fn record_stencil(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        stencil: &wgpu::TextureView,
        index: usize,
        target: &LayerTarget,
    ) {
        let attachment = wgpu::RenderPassDepthStencilAttachment {
            view: stencil,
            depth_ops: None,
            // Of the layer before, rejected pixels are left.
            stencil_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0),
                store: wgpu::StoreOp::Store,
            }),
        };
        // Counting writes no colour but keeps the targets attached: one pass serves all fills.
        let mut pass = begin(encoder, "globefill stencil", Some(target), attachment);
        self.begin_statistics(&mut pass, self.query(index));
        for drawn in &self.meshes {
            pass.set_bind_group(0, &drawn.view.frame_group, &[]);
            for volume in &drawn.view.volumes[index] {
                for stage in [Stage::Count, Stage::Cover, Stage::Reject] {
                    self.draw_volume(&mut pass, drawn, index, volume, stage);
                }
            }
        }
        self.end_statistics(&mut pass);
    }

    fn draw_volume(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        drawn: &Drawn<'_>,
        index: usize,
        volume: &Volume,
        stage: Stage,
    ) {
        let layer = &drawn.view.layers[index];
        let planes = self.targets.key.planes[index];
        let key = |input, inward: bool| match stage {
            Stage::Count => Key::Stencil {
                input,
                planes,
                flipped: inward != self.prepared.mirrored,
                projection: self.prepared.projection,
            },
            Stage::Cover => Key::Cover {
                input,
                planes,
                projection: self.prepared.projection,
            },
            Stage::Reject => Key::Reject {
                input,
                planes,
                projection: self.prepared.projection,
            },
        };
        pass.set_stencil_reference(match stage {
            Stage::Count | Stage::Cover => ONE_COUNTED,
            Stage::Reject => NONE_COUNTED,
        });
        pass.set_bind_group(1, &layer.mesh_group, &[]);
        pass.set_index_buffer(drawn.gpu.cap_indices.slice(..), wgpu::IndexFormat::Uint32);
        // The bottom cap is the top's triangles seen from below.
        for bottom in 0..2 {
            pass.set_pipeline(self.pipelines.get(key(Input::Caps, bottom == 1)));
            let instance = 2 * volume.piece + bottom;
            for triangles in &volume.caps {
                let indices = 3 * triangles.start..3 * triangles.end;
                pass.draw_indexed(indices, 0, instance..instance + 1);
            }
        }
        let piece = volume.piece..volume.piece + 1;
        let sides: [(&Walls, bool); 2] = [(&volume.left_of, false), (&volume.right_of, true)];
        for (walls, inward) in sides {
            if !walls.slots.is_empty() {
                pass.set_pipeline(self.pipelines.get(key(Input::Walls, inward)));
                for slots in &walls.slots {
                    pass.draw(2 * slots.start..2 * slots.end, piece.clone());
                }
            }
        }
        for (walls, inward) in sides {
            if !walls.patches.is_empty() {
                pass.set_pipeline(self.pipelines.get(key(Input::Patches, inward)));
                self.bind_patch(pass, drawn.view, layer);
                for indices in &walls.patches {
                    pass.draw_indexed(indices.clone(), 0, piece.clone());
                }
            }
        }
    }
}

impl CapRun {
    /// How it is drawn.
    pub(crate) fn input(&self) -> Input {
        match self.piece {
            Some(_) => Input::Caps,
            None => Input::MixedCaps,
        }
    }
}

/// The view to bind as a texture: a stencil cannot be bound beside the depth.
pub(crate) fn depth_only(view: &wgpu::TextureView) -> wgpu::TextureView {
    if !view.texture().format().has_stencil_aspect() {
        return view.clone();
    }
    view.texture().create_view(&wgpu::TextureViewDescriptor {
        aspect: wgpu::TextureAspect::DepthOnly,
        ..Default::default()
    })
}

#[derive(Clone, Copy)]
enum Stage {
    Count,
    Cover,
    Reject,
}

fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    label: &str,
    target: Option<&LayerTarget>,
    depth_stencil: wgpu::RenderPassDepthStencilAttachment<'_>,
) -> wgpu::RenderPass<'a> {
    let planes: &[wgpu::TextureView] = target.map_or(&[], |target| &target.planes);
    let color_attachments: Vec<_> = planes
        .iter()
        .map(|view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })
        })
        .collect();
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &color_attachments,
        depth_stencil_attachment: Some(depth_stencil),
        ..Default::default()
    })
}
