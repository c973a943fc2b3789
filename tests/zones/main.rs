//! Zones against their definition: distances and azimuths by Karney's inverse problem.
//!
//! All pictures: `cargo test --release --test zones -- --ignored nothing_is_wrong --nocapture`

mod answers;
#[path = "../common/mod.rs"]
mod common;
mod cover;
mod pictures;
mod refusals;
mod subjects;
