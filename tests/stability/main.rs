//! Shapes that break others, turned all round the globe, seen from 1 m to beyond the Moon, counted by
//! both techniques: no pixel may be wrong.
//!
//! A cell is one picture: a shape, where it was put, a camera, a technique. Plain `cargo test` runs a
//! fixed choice of cells; all of them, one line each, and totals:
//! `cargo test --release --test stability -- --ignored --nocapture`
//!
//! Shapes are rings of directions, turned rigidly so that their middle, a vertex or the middle of an edge
//! comes to lie at a place (`placement.rs`), and then read as geodetic longitudes and latitudes. What is
//! inside the turned ring is judged by the oracle alone: crossing parity along meridians, the even-odd
//! rule for rings that cross themselves, whichever way they wind.

mod catalogue;
mod charts;
#[path = "../common/mod.rs"]
mod common;
mod gate;
mod once_failed;
mod placement;
mod real;
mod shape;
mod shapes;
mod shot;
mod stage;
mod subject;
