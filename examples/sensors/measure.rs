//! What is measured: how deep footprints overlap, and what the frames cost.

use globefill::{LonLat, SensorSet};
use serde_json::{Value, json};

use crate::{drawing::Cost, host::times::median};

/// Answers asked for at most: sensors times points.
const QUESTIONS: usize = 4_000_000;

/// How many sensors see a point, on the whole globe.
pub struct Overlap {
    /// Mean over the points that any sees.
    pub mean: f64,
    /// Nearly the most: few points have more.
    pub most: usize,
}

impl Overlap {
    /// Asks at points spread evenly over the globe.
    pub fn of(set: &SensorSet) -> Self {
        let points = (QUESTIONS / set.len().max(1)).clamp(100, 4_000);
        let golden_angle_deg = 180.0 * (3.0 - 5.0_f64.sqrt());
        let seen_by = |point: usize| {
            let height = 1.0 - (2 * point + 1) as f64 / points as f64;
            let lon_deg = (point as f64 * golden_angle_deg) % 360.0;
            let position = LonLat::new(lon_deg, height.asin().to_degrees());
            set.covering(position, 0.0).count()
        };
        let mut counts: Vec<usize> = (0..points)
            .map(seen_by)
            .filter(|&count| count > 0)
            .collect();
        counts.sort_unstable();
        let sum: usize = counts.iter().sum();
        Self {
            mean: sum as f64 / counts.len().max(1) as f64,
            most: counts.get(counts.len() * 99 / 100).copied().unwrap_or(1),
        }
    }
}

/// Costs of all frames.
#[derive(Default)]
pub struct Costs {
    pub frames: Vec<Cost>,
    /// The ground alone, between the frames.
    pub globe_ms: Vec<f64>,
    /// Where the satellites are: no part of the frames.
    pub propagation_ms: Vec<f64>,
}

impl Costs {
    /// Medians over the frames; the draws of the last.
    pub fn summary(&self, sensors: usize) -> Value {
        let of = |part: fn(&Cost) -> f64| median(self.frames.iter().map(part).collect());
        let last = self
            .frames
            .last()
            .map(|cost| cost.stats)
            .unwrap_or_default();
        let upload_bytes = of(|cost| cost.stats.upload_bytes as f64);
        json!({
            "sensors": sensors,
            "visible": last.sensors,
            "update_us_per_sensor": of(|cost| cost.update_ms) * 1e3 / sensors as f64,
            "upload_bytes": upload_bytes / sensors as f64,
            "upload_bytes_per_frame": upload_bytes,
            "draws": last.draws,
            "dispatches": last.dispatches,
            "frame_ms": of(|cost| cost.frame_ms),
            "globe_ms": median(self.globe_ms.clone()),
            "script_ms": of(|cost| cost.script_ms),
            "propagation_ms": median(self.propagation_ms.clone()),
            "frames": self.frames.len(),
            "count": format!("{:?}", last.technique).to_lowercase(),
        })
    }
}
