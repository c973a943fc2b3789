//! If something is not drawn as expected.
//!
//! | What is seen | Why |
//! |---|---|
//! | nothing, though `FrameStats::drawn` is above 0 | the globe's pass ends with `StoreOp::Discard` for the depth; `RendererOptions::depth` runs the other way; the camera is not the one that the globe was drawn with |
//! | fills on models | what is in the depth when `count` runs is filled: draw models after `resolve` |
//! | mountains stay bare | they stand above `Frame::terrain.max_m` |
//! | wgpu asks for `TEXTURE_BINDING` | sensors, patterns, strokes, fades, smooth edges, the stencil and logarithmic depths read the depth as a texture |
//! | jagged edges | four samples, or `RendererOptions::smooth_edges` on hosts with one |
//! | the first frame is slow | pipelines are compiled when a frame first needs them |
//! | the rest of the globe is filled | `Region::inside` |
