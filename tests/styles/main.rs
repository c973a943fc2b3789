//! Styles as drawn, against what their documentation says, computed in f64. The whole:
//! `cargo test --release --test styles -- everywhere --ignored --nocapture`
//! (what else is ignored fails for a known reason, said beside it).

#[path = "../common/mod.rs"]
mod common;

mod chart;
mod colors;
mod coordinates;
mod coverage;
mod edges;
mod hosts;
mod images;
mod ink;
mod logarithmic;
mod many;
mod parallel;
mod ramps;
mod refusals;
mod seams;
mod spacing;
mod stage;
mod strokes;
mod unordered;
mod unused;

use glam::UVec2;
use globefill::LonLat;

const SMALL: UVec2 = UVec2::new(96, 72);

/// A place like any, both poles, and the antimeridian.
const PLACES: [LonLat; 4] = [
    LonLat::new(11.3, 47.2),
    LonLat::new(25.0, 90.0),
    LonLat::new(-140.0, -90.0),
    LonLat::new(180.0, -17.3),
];

const HEIGHTS_M: [f64; 9] = [1.0, 10.0, 100.0, 1e3, 1e5, 1e6, 2e7, 3.6e7, 4e8];
