//! How to use the crate, chapter by chapter. What an item does stands with the item; here is what to choose.
//!
//! 1. [`getting_started`]: from a GeoJSON file to fills in a frame.
//! 2. [`frame_order`]: what the host does before, between and after.
//! 3. [`choosing`]: meshes and sensors, styles, counting.
//! 4. [`accuracy`]: what is exact, and what the budgets mean.
//! 5. [`performance`]: what costs, and what does not.
//! 6. [`troubleshooting`]: if something is not drawn as expected.

#[doc = include_str!("guide/getting_started.md")]
pub mod getting_started {}

#[doc = include_str!("guide/frame_order.md")]
pub mod frame_order {}

#[doc = include_str!("guide/choosing.md")]
pub mod choosing {}

#[doc = include_str!("guide/accuracy.md")]
pub mod accuracy {}

#[doc = include_str!("guide/performance.md")]
pub mod performance {}

#[doc = include_str!("guide/troubleshooting.md")]
pub mod troubleshooting {}
