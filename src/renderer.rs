//! The façade: what a host calls.

mod chosen;
mod picking;
mod prepare;
mod sensors;
mod styles;
mod windows;

use std::{
    collections::{BTreeMap, HashMap},
    sync::OnceLock,
};

use crate::{
    error::RendererError,
    fill_mesh::FillMesh,
    frame::beyond::longest_edge_rad,
    frame::code::Mantissa,
    frame::detail::Coarseness,
    frame::layers::Counting,
    frame::placed::PatternPlace,
    frame_stats::FrameStats,
    gpu::count::{Drawn, Recorder},
    gpu::gpu_mesh::GpuMesh,
    gpu::image_arrays::ImageArrays,
    gpu::layer_tables::{LayerTables, require},
    gpu::pick_pipeline::PickPipeline,
    gpu::pipelines::Pipelines,
    gpu::projection::FAR_PLANE_FEATURES,
    gpu::sensor_pipelines::SensorPipelines,
    gpu::style_pipelines::StylePipelines,
    options::{CountTechnique, Frame, RendererOptions},
    sensor_set::SensorSet,
    style::FillStyle,
    view::{MeshView, View},
};

/// Names a mesh in a [`Renderer`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MeshId(pub(crate) u32);

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
    /// Layers of the current meshes and styles for each way of counting, once asked for.
    layers: [Option<Result<LayerTables, RendererError>>; Counting::ALL.len()],
    /// Made when a frame first needs them.
    style_pipelines: Option<StylePipelines>,
    /// Made for the first image, or when a frame first has styles that may show one.
    images: Option<ImageArrays>,
    sensors: SensorSet,
    /// Made when a frame first has sensors.
    sensor_pipelines: Option<SensorPipelines>,
    /// Made when a pixel is first asked about.
    pick_pipeline: OnceLock<PickPipeline>,
}

struct Resident {
    mesh: FillMesh,
    styles: Vec<FillStyle>,
    /// Where the patterns of the styles lie.
    places: Vec<Option<PatternPlace>>,
    gpu: GpuMesh,
    coarser: Vec<CoarserLevel>,
    /// By level, the finest first: the longest edge drawn, in coordinates divided by the radii.
    longest_edges_rad: Vec<f64>,
}

/// A level of detail behind the first.
struct CoarserLevel {
    coarseness: Coarseness,
    /// Made when a frame first needs it.
    gpu: OnceLock<GpuMesh>,
}

impl Resident {
    fn new(device: &wgpu::Device, mut mesh: FillMesh) -> Self {
        mesh.chunk_by_piece();
        mesh.coarser.iter_mut().for_each(FillMesh::chunk_by_piece);
        let level = |level| CoarserLevel {
            coarseness: Coarseness::of(level),
            gpu: OnceLock::new(),
        };
        Self {
            gpu: GpuMesh::new(device, &mesh),
            longest_edges_rad: std::iter::once(&mesh)
                .chain(&mesh.coarser)
                .map(longest_edge_rad)
                .collect(),
            coarser: mesh.coarser.iter().map(level).collect(),
            styles: vec![FillStyle::default(); mesh.fills.len()],
            places: vec![None; mesh.fills.len()],
            mesh,
        }
    }

    /// The mesh of a level, 0 being the finest.
    fn level(&self, level: usize) -> &FillMesh {
        match level.checked_sub(1) {
            Some(coarser) => &self.mesh.coarser[coarser],
            None => &self.mesh,
        }
    }

    /// The upload of a level.
    fn gpu(&self, device: &wgpu::Device, level: usize) -> &GpuMesh {
        let Some(coarser) = level.checked_sub(1) else {
            return &self.gpu;
        };
        let gpu = &self.coarser[coarser].gpu;
        gpu.get_or_init(|| GpuMesh::new(device, &self.mesh.coarser[coarser]))
    }

    /// Bytes of all levels that were uploaded.
    fn gpu_bytes(&self) -> u64 {
        let coarser = self.coarser.iter().zip(&self.mesh.coarser);
        let uploaded = coarser.filter(|(level, _)| level.gpu.get().is_some());
        self.mesh.gpu_bytes() + uploaded.map(|(_, mesh)| mesh.gpu_bytes()).sum::<u64>()
    }
}

impl Renderer {
    /// Features that serve where the adapter has them; ask for them as
    /// `Renderer::wanted_features() & adapter.features()`.
    ///
    /// Without `FLOAT32_BLENDABLE` winding sums are half floats and large scenes are counted by
    /// stencil, which needs `DEPTH32FLOAT_STENCIL8`. Without `DEPTH_CLIP_CONTROL` and
    /// `CLIP_DISTANCES` a perspective must not have a far plane, and without the former a projection must
    /// not be orthographic.
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
        if !options.depth_format.has_depth_aspect()
            || options.depth_format == wgpu::TextureFormat::Depth16Unorm
        {
            return Err(RendererError::Unsupported(
                "depth_format needs a depth of 24 bits or more",
            ));
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
            layers: Default::default(),
            style_pipelines: None,
            images: None,
            sensors: SensorSet::default(),
            sensor_pipelines: None,
            pick_pipeline: OnceLock::new(),
        })
    }

    /// Uploads a mesh. Its fills start with the default style.
    pub fn insert(&mut self, mesh: FillMesh) -> MeshId {
        let id = MeshId(self.next_id);
        self.next_id += 1;
        self.meshes.insert(id, Resident::new(&self.device, mesh));
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

    fn changed(&mut self) {
        self.revision += 1;
        self.layers = Default::default();
    }

    /// The sensors whose footprints are drawn.
    pub fn sensors(&self) -> &SensorSet {
        &self.sensors
    }

    /// The sensors, to change them; on another ellipsoid than WGS84 after
    /// `*renderer.sensors_mut() = SensorSet::new(ellipsoid)`.
    pub fn sensors_mut(&mut self) -> &mut SensorSet {
        &mut self.sensors
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
        let sensor_sight = self.sensor_sight(frame)?;
        let mut stats = self.prepare_fills(queue, view, frame)?;
        self.prepare_sensors(queue, view, frame, sensor_sight.as_ref(), &mut stats);
        Ok(stats)
    }

    /// Records the counting passes: after the host's depth is final, outside any pass.
    ///
    /// `depth` is a view of the depth texture the frame was prepared for. It is attached read-only;
    /// the stencil technique, sensors and patterns bind it as a texture too, which needs `TEXTURE_BINDING`.
    /// Sensors and patterns read it once more in [`resolve`](Self::resolve).
    pub fn count(
        &self,
        view: &mut View,
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
        view: &mut View,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
        queries: &wgpu::QuerySet,
    ) {
        self.record_count(view, encoder, depth, Some(queries));
    }

    fn record_count(
        &self,
        view: &mut View,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
        statistics: Option<&wgpu::QuerySet>,
    ) {
        self.bin_sensors(view, encoder, depth);
        self.count_styles(view, encoder, depth);
        let (Some(prepared), Some(targets)) = (view.prepared, &view.targets) else {
            return;
        };
        let recorder = Recorder {
            device: &self.device,
            pipelines: &self.pipelines,
            prepared,
            targets,
            meshes: self.drawn(&view.meshes),
            statistics,
        };
        recorder.record(encoder, depth);
    }

    /// The meshes as a view draws them.
    fn drawn<'a>(&'a self, views: &'a HashMap<MeshId, MeshView>) -> Vec<Drawn<'a>> {
        let drawn = self.meshes.iter().filter_map(|(&id, resident)| {
            let view = views.get(&id)?;
            let gpu = resident.gpu(&self.device, view.level);
            Some(Drawn { id, gpu, view })
        });
        drawn.collect()
    }

    /// Records the fills, then the sensors, into the host's pass, which has the colour target, the
    /// options' sample count and no depth attachment. Colours are premultiplied and blended over what
    /// is there.
    pub fn resolve(&self, view: &View, pass: &mut wgpu::RenderPass<'_>) {
        if let (Some(targets), Some(prepared)) = (&view.targets, &view.prepared) {
            for index in prepared.shown.iter() {
                let target = &targets.layers[index];
                pass.set_bind_group(0, &target.resolve_group, &[]);
                if !self.resolve_styled(view, pass, index, target)
                    && let Some(draw) = view.windows.get(index).copied().flatten()
                {
                    pass.set_pipeline(self.pipelines.get(target.resolved_by));
                    let (vertex, instance) = (draw.vertex, draw.instance);
                    pass.draw(vertex..vertex + 4, instance..instance + 1);
                }
            }
        }
        self.resolve_sensors(view, pass);
    }
}
