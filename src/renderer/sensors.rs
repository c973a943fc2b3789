//! Drawing the sensors of a renderer.

use glam::UVec2;
use wgpu::util::{BufferInitDescriptor, DeviceExt as _};

use super::Renderer;
use crate::{
    error::RendererError,
    frame::reference::Reference,
    frame::sensor_record::SensorRecord,
    frame::sight::Sight,
    frame::sight_uniform::SightUniform,
    frame_stats::FrameStats,
    gpu::sensor_pipelines::{SensorPipelines, Shown},
    gpu::sensor_view::{SensorFrame, SensorView, WORKGROUP, workgroups},
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

    /// Whether the device can draw the sensors, if any, in a picture of this size.
    pub(super) fn check_sensors(&self, size_px: UVec2) -> Result<(), RendererError> {
        if !self.shows_sensors() {
            return Ok(());
        }
        let limits = self.device.limits();
        if limits.max_compute_invocations_per_workgroup < WORKGROUP
            || limits.max_storage_buffers_per_shader_stage < STORAGE_BUFFERS
        {
            return Err(RendererError::Unsupported(
                "sensors need compute shaders with seven storage buffers",
            ));
        }
        if workgroups(size_px) > limits.max_compute_workgroups_per_dimension {
            return Err(RendererError::InvalidFrame("size_px"));
        }
        let sensors = self.sensors.len();
        let most = limits.max_storage_buffer_binding_size as usize / size_of::<SensorRecord>();
        if sensors > most {
            return Err(RendererError::TooManySensors { sensors, most });
        }
        Ok(())
    }

    /// Encodes and uploads the sensors that changed, or all if the camera did, and adds to the stats.
    pub(super) fn prepare_sensors(
        &mut self,
        queue: &wgpu::Queue,
        view: &mut View,
        frame: &Frame,
        stats: &mut FrameStats,
    ) -> Result<(), RendererError> {
        let set = &self.sensors;
        if !self.shows_sensors() {
            view.sensors = None;
            return Ok(());
        }
        let shown = match set.display() {
            SensorDisplay::Blended => Shown::Blended,
            SensorDisplay::Coverage(_) => Shown::Coverage,
        };
        let pipelines = self
            .sensor_pipelines
            .get_or_insert_with(|| SensorPipelines::new(&self.device, self.options));
        pipelines.ensure(&self.device, shown);
        let sensors = view
            .sensors
            .get_or_insert_with(|| SensorView::new(&self.device));
        if !sensors.holds(frame, set) {
            let sight = Sight::new(set.ellipsoid(), 0.0, frame, &self.options)?;
            let reference = Reference::new(set.ellipsoid(), frame.camera.eye_ecef_m);
            let depth = self.options.depth;
            let with = SensorFrame {
                set,
                frame,
                uniform: SightUniform::new(&sight, &reference, depth, frame.size_px),
                reference,
            };
            stats.upload_bytes += sensors.prepare(&self.device, queue, pipelines, with);
        }
        stats.sensors = set.visible_count() as u32;
        stats.dispatches = pipelines.binning.len() as u32;
        stats.draws += 1;
        stats.vertices += 4 * u64::from(sensors.block_count);
        Ok(())
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
    /// Which sensors they are, [`SensorSet::covering`](crate::SensorSet::covering) says.
    ///
    /// # Errors
    /// [`RendererError::NoSuchPixel`] if the pixel lies outside the prepared frame.
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
        let (Some(sensors), Some(pipelines)) = (&view.sensors, &self.sensor_pipelines) else {
            encoder.clear_buffer(into, offset, Some(4));
            return Ok(());
        };
        let question = [pixel.x, pixel.y, 0, 0];
        let answer = self.device.create_buffer_init(&BufferInitDescriptor {
            label: Some("globefill answer"),
            contents: bytemuck::cast_slice(&question),
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        });
        sensors.count_at(&self.device, pipelines, encoder, &answer);
        encoder.copy_buffer_to_buffer(&answer, 8, into, offset, Some(4));
        Ok(())
    }
}
