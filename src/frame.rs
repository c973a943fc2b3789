//! What one view draws in one frame, decided in f64 without the GPU.

pub(crate) mod beyond;
pub(crate) mod code;
pub(crate) mod detail;
pub(crate) mod edge_draws;
pub(crate) mod edge_segments;
pub(crate) mod edge_uniform;
pub(crate) mod layer_set;
pub(crate) mod layers;
pub(crate) mod lens;
pub(crate) mod mixture;
pub(crate) mod optical_depth;
pub(crate) mod placed;
pub(crate) mod reference;
pub(crate) mod refine;
pub(crate) mod select;
pub(crate) mod sensor_record;
pub(crate) mod sensor_records;
pub(crate) mod sight;
pub(crate) mod sight_uniform;
pub(crate) mod volumes;
pub(crate) mod window;
