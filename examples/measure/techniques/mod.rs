//! The ways of filling, one a file.

pub mod crate_fills;
pub mod doubled;
pub mod globe;
pub mod moving_sensors;
pub mod records;
pub mod surface;

mod eye_uniform;
mod fill_faces;
mod stored_vertex;
mod volume_sums;
