//! A host without a window, shared by the examples: device, camera, ground, targets and files.

#![allow(dead_code, reason = "each example uses a part of it")]

pub mod camera;
pub mod cli;
pub mod elevation;
pub mod gpu;
pub mod ground;
pub mod output;
pub mod palette;
pub mod png;
pub mod progress;
pub mod spiral;
pub mod targets;
pub mod times;

mod globe;
mod host_view;
mod picture;
mod relief;
mod terrain;
mod terrain_mesh;
mod tiles;
