//! What one view draws in one frame, decided in f64 without the GPU.

pub(crate) mod code;
pub(crate) mod layers;
pub(crate) mod refine;
pub(crate) mod select;
pub(crate) mod sight;
pub(crate) mod volumes;
