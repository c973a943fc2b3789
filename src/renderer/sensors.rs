//! Drawing the sensors of a renderer.

use glam::UVec2;
use wgpu::util::BufferInitDescriptor;

use super::Renderer;
use crate::{
    error::RendererError,
    frame::reference::Reference,
    frame::sensor_record::SensorRecord,
    frame::sight::Sight,
    frame::sight_uniform::SightUniform,
    frame_stats::FrameStats,
    gpu::filled_buffer::FilledBuffer as _,
    gpu::sensor_pipelines::{SensorKey, SensorPipelines, Shown},
    gpu::sensor_view::{self, SensorFrame, SensorView},
    options::Frame,
    sensor_set::SensorDisplay,
    view::View,
};

/// Storage buffers that the binning binds.
const STORAGE_BUFFERS: u32 = 7;

impl Renderer {
    /// Whether there is anything to draw: footprints, or where they are missing.
    fn shows_sensors(&self) -> bool {
        let gaps = match self.sensors.display() {
            SensorDisplay::Blended => false,
            SensorDisplay::Coverage(colors) => colors.colors_gaps(),
        };
        gaps || self.sensors.visible_count() > 0
    }

    /// How the sensors see the frame, if there is anything to see and the device can draw it.
    pub(super) fn sensor_sight(&self, frame: &Frame) -> Result<Option<Sight>, RendererError> {
        if !self.shows_sensors() {
            return Ok(None);
        }
        let sight = Sight::new(self.sensors.ellipsoid(), 0.0, frame, &self.options)?;
        let limits = self.device.limits();
        if limits.max_compute_invocations_per_workgroup < sensor_view::WORKGROUP
            || limits.max_storage_buffers_per_shader_stage < STORAGE_BUFFERS
        {
            return Err(RendererError::Unsupported(
                "sensors need compute shaders with seven storage buffers",
            ));
        }
        if !sensor_view::has_room_for_tiles(&limits, frame.size_px) {
            return Err(RendererError::InvalidFrame("size_px"));
        }
        let sensors = self.sensors.len();
        // Buffers grow to powers of two, which must be bound whole.
        let most_bytes = 1 << limits.max_storage_buffer_binding_size.ilog2();
        let most = most_bytes as usize / size_of::<SensorRecord>();
        if sensors > most || self.sensors.plane_count() as u64 * 16 > most_bytes {
            return Err(RendererError::TooManySensors { sensors, most });
        }
        Ok(Some(sight))
    }

    /// Encodes and uploads the sensors that changed, or all if the camera did, and adds to the stats.
    pub(super) fn prepare_sensors(
        &mut self,
        queue: &wgpu::Queue,
        view: &mut View,
        frame: &Frame,
        sight: Option<&Sight>,
        stats: &mut FrameStats,
    ) {
        let set = &self.sensors;
        let Some(sight) = sight else {
            // Sensors that are hidden for a while keep their buffers.
            match &mut view.sensors {
                Some(sensors) if !set.is_empty() => sensors.key = None,
                none => *none = None,
            }
            return;
        };
        let shown = match set.display() {
            SensorDisplay::Blended => Shown::Blended,
            SensorDisplay::Coverage(_) => Shown::Coverage,
        };
        let pipelines = self
            .sensor_pipelines
            .get_or_insert_with(|| SensorPipelines::new(&self.device, self.options));
        let key = SensorKey {
            shown,
            needs: set.needs(),
            lens: sight.kind,
        };
        pipelines.ensure(&self.device, key);
        let sensors = view
            .sensors
            .get_or_insert_with(|| SensorView::new(&self.device));
        sensors.key = Some(key);
        if !sensors.holds(frame, set) {
            let reference = Reference::new(set.ellipsoid(), sight.eye_ecef_m);
            let depth = self.options.depth;
            let with = SensorFrame {
                set,
                frame,
                uniform: SightUniform::new(sight, &reference, depth, frame.size_px),
                reference,
            };
            stats.upload_bytes += sensors.prepare(&self.device, queue, pipelines, with);
        }
        stats.sensors = set.visible_count() as u32;
        stats.dispatches = pipelines
            .get(key)
            .map_or(0, |program| program.binning.len() as u32);
        stats.draws += 1;
        stats.vertices += 4 * u64::from(sensors.block_count);
    }

    pub(super) fn bin_sensors(
        &self,
        view: &mut View,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
    ) {
        if let (Some(sensors), Some(pipelines)) = (&mut view.sensors, &self.sensor_pipelines) {
            sensors.bin(&self.device, pipelines, encoder, depth);
        }
    }

    pub(super) fn resolve_sensors(&self, view: &View, pass: &mut wgpu::RenderPass<'_>) {
        if let (Some(sensors), Some(pipelines)) = (&view.sensors, &self.sensor_pipelines) {
            sensors.resolve(pipelines, pass);
        }
    }

    /// Records reading back how many visible sensors cover the surface at a pixel (its first sample):
    /// after [`count`](Self::count), outside any pass. Once submitted, four bytes of `into` from
    /// `offset`, a multiple of 4, hold the number as a little-endian `u32`; 0 for the sky. `into` needs
    /// `COPY_DST`, and `MAP_READ` to be read by the host.
    ///
    /// Which sensors they are, [`SensorSet::covering`](crate::SensorSet::covering) says; which fills
    /// are at a pixel, [`read_fills`](Self::read_fills).
    ///
    /// # Errors
    /// [`RendererError::NoSuchPixel`] if the pixel lies outside the prepared frame, or nothing was
    /// counted.
    pub fn read_coverage(
        &self,
        view: &View,
        encoder: &mut wgpu::CommandEncoder,
        pixel: UVec2,
        into: &wgpu::Buffer,
        offset: u64,
    ) -> Result<(), RendererError> {
        let size_px = view.prepared.map_or(UVec2::ZERO, |it| it.frame.size_px);
        if pixel.cmpge(size_px).any() {
            return Err(RendererError::NoSuchPixel(pixel));
        }
        let shown = view
            .sensors
            .as_ref()
            .filter(|sensors| sensors.key.is_some());
        let (Some(sensors), Some(pipelines)) = (shown, &self.sensor_pipelines) else {
            encoder.clear_buffer(into, offset, Some(4));
            return Ok(());
        };
        let question = [pixel.x, pixel.y, 0, 0];
        let answer = self.device.filled_buffer(&BufferInitDescriptor {
            label: Some("globefill answer"),
            contents: bytemuck::cast_slice(&question),
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        });
        if !sensors.count_at(&self.device, pipelines, encoder, &answer) {
            return Err(RendererError::NoSuchPixel(pixel));
        }
        encoder.copy_buffer_to_buffer(&answer, 8, into, offset, Some(4));
        Ok(())
    }
}
