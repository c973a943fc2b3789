//! Upload, and the passes that count and resolve.

pub(crate) mod count;
pub(crate) mod count_cost;
pub(crate) mod edge_pipelines;
#[cfg(test)]
mod edge_tests;
pub(crate) mod edge_view;
pub(crate) mod filled_buffer;
pub(crate) mod fixed_function;
pub(crate) mod fixed_point;
pub(crate) mod gpu_mesh;
pub(crate) mod image_arrays;
pub(crate) mod layer_tables;
pub(crate) mod pick_pipeline;
pub(crate) mod pipelines;
pub(crate) mod planes;
pub(crate) mod projection;
pub(crate) mod recipe;
pub(crate) mod sensor_pipelines;
pub(crate) mod sensor_view;
pub(crate) mod stream_buffer;
pub(crate) mod style_pipelines;
pub(crate) mod style_record;
pub(crate) mod style_table;
pub(crate) mod style_view;
pub(crate) mod surface_binding;
pub(crate) mod targets;
