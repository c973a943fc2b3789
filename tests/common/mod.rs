//! What the integration tests share: an independent oracle, a headless host, and the score.
#![allow(dead_code, reason = "each test binary uses its own part")]

pub mod camera;
pub mod draw;
pub mod edge;
pub mod figure;
pub mod headless;
pub mod oracle;
pub mod pair_mesh;
pub mod scene;
pub mod score;
pub mod surface;
pub mod watch;
pub mod watcher;
pub mod zone_oracle;
