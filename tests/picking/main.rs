//! Which fills are at a pixel: asked of the GPU, and of geometry in f64.

#[path = "../common/mod.rs"]
mod common;
mod fills;
mod frames;
mod host;
