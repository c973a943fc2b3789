//! Which fills a pixel shows.

use glam::UVec2;

use super::Renderer;
use crate::{
    error::RendererError,
    gpu::pick_pipeline::{IDS_AT, PickPipeline},
    gpu::targets::LayerTarget,
    pick::Pick,
    view::View,
};

impl Renderer {
    /// Records reading back which fills cover a pixel (its first sample): after
    /// [`count`](Self::count), outside any pass. Once submitted, [`Pick::BYTES`] bytes of `into` from
    /// `offset`, a multiple of 4, hold the answer, which [`Pick::fills`] reads. `into` needs `COPY_DST`,
    /// and `MAP_READ` to be read by the host.
    ///
    /// The answer is what the pixels of the view's last prepared frame show, with the styles and meshes
    /// it was prepared with. Fills that were hidden or paint nothing, and unordered ones, are not found. As in the picture a
    /// boundary is where it was drawn, within the frame's
    /// [`pixel_error`](crate::Frame::pixel_error); a [`Locator`](crate::Locator) answers exactly.
    /// Sensors are not fills: [`read_coverage`](Self::read_coverage) counts those.
    ///
    /// It costs a dispatch of one invocation a layer, and the first time the compilation of their
    /// pipeline.
    ///
    /// # Errors
    /// [`RendererError::NoSuchPixel`] if the pixel lies outside the prepared frame, or none was;
    /// [`RendererError::Unsupported`] on devices without compute shaders.
    pub fn read_fills(
        &self,
        view: &View,
        encoder: &mut wgpu::CommandEncoder,
        pixel: UVec2,
        into: &wgpu::Buffer,
        offset: u64,
    ) -> Result<Pick, RendererError> {
        let size_px = view.prepared.map_or(UVec2::ZERO, |it| it.frame.size_px);
        let Some(targets) = view.targets.as_ref().filter(|_| pixel.cmplt(size_px).all()) else {
            return Err(RendererError::NoSuchPixel(pixel));
        };
        let shown = view.prepared.map(|it| it.shown).unwrap_or_default();
        let pick = targets.pick.asking(shown);
        let asked: Vec<&LayerTarget> = pick.layers().map(|layer| &targets.layers[layer]).collect();
        if asked.is_empty() {
            encoder.clear_buffer(into, offset, Some(Pick::BYTES));
            return Ok(pick);
        }
        if self.device.limits().max_compute_invocations_per_workgroup == 0 {
            return Err(RendererError::Unsupported("picking needs compute shaders"));
        }
        let pipeline = self.pick_pipeline.get_or_init(|| {
            let samples = self.options.sample_count;
            PickPipeline::new(&self.device, &self.pipelines.resolve_layout, samples)
        });
        let answer = pipeline.ask(&self.device, encoder, &asked, pixel);
        encoder.copy_buffer_to_buffer(&answer, IDS_AT, into, offset, Some(Pick::BYTES));
        Ok(pick)
    }
}
