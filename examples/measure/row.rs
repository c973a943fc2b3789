//! One technique in one scene: what it took and what was wrong.

use serde_json::{Map, Value, json};

use crate::{
    accuracy::PictureError,
    heat::Variant,
    technique::{Cost, TechniqueName},
};

/// A line of the report.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub scene: String,
    pub technique: TechniqueName,
    pub variant: Option<Variant>,
    /// How long the scene's mesh took to make, milliseconds.
    pub build_ms: f64,
    pub outcome: Result<Measured, String>,
}

/// Medians are of frames drawn in turn with all other techniques.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measured {
    pub median_ms: f64,
    pub p95_ms: f64,
    /// Over the bare globe: median of the differences, frame by frame.
    pub extra_ms: Option<f64>,
    /// Processor time of all threads.
    pub cpu_ms: Option<f64>,
    pub extra_cpu_ms: Option<f64>,
    /// Shader runs for the fills; `None` where the adapter does not count.
    pub vertex_invocations: Option<u64>,
    pub fragment_invocations: Option<u64>,
    pub cost: Cost,
    pub error: Option<PictureError>,
}

impl Row {
    pub fn json(&self) -> Value {
        let mut row = Map::new();
        row.insert("scene".into(), json!(self.scene));
        row.insert("technique".into(), json!(self.technique.to_string()));
        if let Some(variant) = &self.variant {
            row.insert("sweep".into(), json!(variant.sweep));
            row.insert("value".into(), json!(variant.value));
            row.insert("is_default".into(), json!(variant.is_default));
        }
        row.insert("build_ms".into(), json!(self.build_ms));
        match &self.outcome {
            Ok(measured) => {
                let Value::Object(fields) = measured.json() else {
                    return Value::Null;
                };
                row.extend(fields);
            }
            Err(reason) => {
                row.insert("refused".into(), json!(reason));
            }
        }
        Value::Object(row)
    }
}

impl Measured {
    /// What is not finite or not known is null.
    fn json(&self) -> Value {
        let error = self.error.as_ref();
        json!({
            "median_ms": self.median_ms,
            "p95_ms": self.p95_ms,
            "extra_ms": self.extra_ms,
            "cpu_ms": self.cpu_ms,
            "extra_cpu_ms": self.extra_cpu_ms,
            "vertex_invocations": self.vertex_invocations,
            "fragment_invocations": self.fragment_invocations,
            "count": self.cost.count.map(|count| format!("{count:?}").to_lowercase()),
            "draws": self.cost.draws,
            "passes": self.cost.passes,
            "upload_bytes": self.cost.upload_bytes,
            "gpu_bytes": self.cost.gpu_bytes,
            "wrong_px": error.map(|error| error.wrong_px),
            "differing_px": error.map(|error| error.differing_px),
            "worst_px": error.map(|error| error.worst_px),
            "worst_m": error.map(|error| error.worst_m),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_say_what_was_measured_or_why_not() {
        let row = |outcome| Row {
            scene: "110m-all".into(),
            technique: TechniqueName::Winding,
            variant: None,
            build_ms: 1.0,
            outcome,
        };
        let measured = row(Ok(Measured {
            median_ms: 12.5,
            error: Some(PictureError {
                wrong_px: 3,
                worst_px: f64::INFINITY,
                ..Default::default()
            }),
            ..Default::default()
        }))
        .json();
        assert_eq!(measured["scene"], "110m-all");
        assert_eq!(measured["technique"], "winding");
        assert_eq!(measured["median_ms"], 12.5);
        assert_eq!(measured["wrong_px"], 3);
        assert!(measured["worst_px"].is_null() && measured["cpu_ms"].is_null());
        assert!(measured.get("refused").is_none());
        let refused = row(Err("too deep".into())).json();
        assert_eq!(refused["refused"], "too deep");
        assert!(refused.get("median_ms").is_none());
    }
}
