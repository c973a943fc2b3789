//! What lies on the globe.

pub mod countries;
pub mod files;
pub mod fill_layer;
pub mod satellites;
pub mod zones;
