//! What a frame drew and what it cost.

use crate::options::CountTechnique;

/// What one view drew in one frame, in machine-independent units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameStats {
    /// Fills inserted.
    pub fills: u32,
    /// Fills with at least one piece drawn.
    pub drawn: u32,
    /// Visible fills left out because nothing of them can be seen.
    pub culled: u32,
    /// The technique that counted; differs from the one asked for where head-room forbade it.
    pub technique: CountTechnique,
    /// Layers of mutually disjoint fills, and one of all that are unordered.
    pub layers: u32,
    /// Layers that are resolved with patterns, strokes or fades: 0 where plain colours say all.
    pub styled_layers: u32,
    /// Layers whose sums take one channel a pixel instead of two, since this frame's are proven to fit.
    pub joined_layers: u32,
    /// Counting passes that `count` records: one for each layer of which anything is drawn.
    pub passes: u32,
    /// Passes in which `count` measures how far pixels are from boundaries: one for each layer with
    /// strokes or smooth edges.
    pub edge_passes: u32,
    /// Draw calls, of `count` and `resolve`.
    pub draws: u32,
    /// Vertices submitted to the vertex stage (before any vertex cache).
    pub vertices: u64,
    /// The coarsest level of detail drawn of any mesh; 0 is the finest.
    pub level: u32,
    /// Boundary chords replaced by finer ones for this view.
    pub refined_chords: u32,
    /// Visible sensors.
    pub sensors: u32,
    /// Compute dispatches that `count` records: none where nothing is shown of
    /// sensors, and as many for one as for all.
    pub dispatches: u32,
    /// Bytes written to GPU buffers since the previous frame of this view.
    pub upload_bytes: u64,
    /// Bytes of GPU buffers that hold meshes (not the view's targets).
    pub gpu_bytes: u64,
}
