//! The parts of the examples' common host that a window needs: camera, globe, terrain.

#![allow(dead_code, reason = "each example uses a part of it")]

#[path = "../host/camera.rs"]
pub mod camera;
#[path = "../host/elevation.rs"]
pub mod elevation;
#[path = "../host/globe.rs"]
mod globe;
#[path = "../host/gpu.rs"]
pub mod gpu;
#[path = "../host/ground.rs"]
pub mod ground;
#[path = "../host/host_view.rs"]
mod host_view;
#[path = "../host/palette.rs"]
pub mod palette;
#[path = "../host/picture.rs"]
mod picture;
#[path = "../host/png.rs"]
pub mod png;
#[path = "../host/relief.rs"]
mod relief;
#[path = "../host/terrain.rs"]
mod terrain;
#[path = "../host/terrain_mesh.rs"]
mod terrain_mesh;
#[path = "../host/tiles.rs"]
mod tiles;
