//! What the integration tests share: an independent oracle, a headless host, and the score.
#![allow(dead_code, reason = "each test binary uses its own part")]

pub mod edge;
pub mod figure;
pub mod oracle;
