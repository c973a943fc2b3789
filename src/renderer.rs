//! The façade: what a host calls.

use crate::{
    error::RendererError,
    fill_mesh::FillMesh,
    frame_stats::FrameStats,
    options::{FillStyle, Frame, RendererOptions},
};

/// Draws fills into the frames of one host configuration.
pub struct Renderer {}

/// Names a mesh in a [`Renderer`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MeshId(u32);

/// What a renderer keeps for one camera: targets of the size of its depth texture and what was
/// uploaded for its last frame.
#[derive(Default)]
pub struct View {}

impl Renderer {
    /// Features that make the renderer better where the adapter has them; ask for
    /// `Renderer::wanted_features() & adapter.features()`.
    pub fn wanted_features() -> wgpu::Features {
        wgpu::Features::FLOAT32_BLENDABLE | wgpu::Features::DEPTH_CLIP_CONTROL
    }

    /// A renderer for one host configuration.
    pub fn new(_device: &wgpu::Device, _options: RendererOptions) -> Result<Self, RendererError> {
        todo!()
    }

    /// Uploads a mesh. Its fills start with the default style.
    pub fn insert(
        &mut self,
        _device: &wgpu::Device,
        _queue: &wgpu::Queue,
        _mesh: FillMesh,
    ) -> MeshId {
        todo!()
    }

    /// Removes a mesh and frees its buffers.
    pub fn remove(&mut self, _mesh: MeshId) -> Result<(), RendererError> {
        todo!()
    }

    /// Sets how a fill looks from the next `prepare` on.
    pub fn set_style(
        &mut self,
        _mesh: MeshId,
        _fill: u32,
        _style: FillStyle,
    ) -> Result<(), RendererError> {
        todo!()
    }

    /// Selects what to draw and uploads what changed. Call once a frame and view, before `count`.
    pub fn prepare(
        &mut self,
        _device: &wgpu::Device,
        _queue: &wgpu::Queue,
        _view: &mut View,
        _frame: &Frame,
    ) -> Result<FrameStats, RendererError> {
        todo!()
    }

    /// Records the counting pass, after the host's depth is final and outside any pass.
    pub fn count(
        &self,
        _view: &View,
        _encoder: &mut wgpu::CommandEncoder,
        _depth: &wgpu::TextureView,
    ) {
        todo!()
    }

    /// Records the fills into the host's pass, which has the colour target and no depth attachment.
    pub fn resolve(&self, _view: &View, _pass: &mut wgpu::RenderPass<'_>) {
        todo!()
    }
}
