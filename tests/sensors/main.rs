//! Footprints drawn, judged pixel by pixel by lines of sight in f64. The pictures are small so that
//! `cargo test` stays short. The whole:
//! `cargo test --release --test sensors -- --ignored --nocapture`

#[path = "../common/mod.rs"]
mod common;
mod edges;
mod gate;
mod limbs;
mod poses;
mod subjects;

use common::surface::Terrain;
use glam::UVec2;
use globefill::{Extrusion, LonLat};

const SMALL: UVec2 = UVec2::new(144, 81);
const LARGE: UVec2 = UVec2::new(320, 180);
const EXTRUSIONS: [Extrusion; 2] = [Extrusion::Normal, Extrusion::Apex];
const PLATEAU: Terrain = Terrain::Plateau { height_m: 4000.0 };

/// Where the subjects are.
const AT: LonLat = LonLat::new(23.0, 41.0);
