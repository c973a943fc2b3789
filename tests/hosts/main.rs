//! Hosts of all kinds: whatever the lens, the depth buffer and the adapter, the same answers or a typed
//! error.

#[path = "../common/mod.rs"]
mod common;

mod adapters;
mod gate;
mod lenses;
mod logarithmic;
mod lost_device;
mod mirrored;
mod parallel;
mod underground;
mod viewports;
