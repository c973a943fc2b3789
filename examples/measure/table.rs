//! Rows for people.

use globefill::CountTechnique;

use crate::{
    row::{Measured, Row},
    technique::TechniqueName,
};

const HEADINGS: [&str; 14] = [
    "scene",
    "technique",
    "median",
    "p95",
    "extra",
    "cpu",
    "+cpu",
    "vertices",
    "fragments",
    "draws",
    "upload",
    "MB",
    "wrong",
    "worst px / m",
];

/// Lines of a table: times in milliseconds, vertices and fragments in thousands of shader runs.
pub fn heading() -> String {
    let [scene, technique, columns @ ..] = HEADINGS;
    let columns: String = columns.map(|name| format!(" {name:>9}")).concat();
    format!("{scene:<14} {technique:<9}{columns}")
}

pub fn line(row: &Row) -> String {
    let start = format!("{:<14} {:<9}", row.scene, row.technique);
    let end = row.variant.as_ref().map_or(String::new(), |variant| {
        let mark = if variant.is_default { " (default)" } else { "" };
        format!("  {} {}{mark}", variant.sweep, variant.value)
    });
    match &row.outcome {
        Ok(measured) => {
            let by_stencil = row.technique == TechniqueName::Winding
                && measured.cost.count == Some(CountTechnique::Stencil);
            let note = if by_stencil {
                "  counted by stencil"
            } else {
                ""
            };
            format!("{start}{}{end}{note}", columns(measured))
        }
        Err(reason) => format!("{start} refused: {reason}{end}"),
    }
}

fn columns(measured: &Measured) -> String {
    let ms = |value: Option<f64>| value.map_or("-".into(), |ms| format!("{ms:.1}"));
    let thousands = |value: Option<u64>| {
        value.map_or("-".into(), |count| format!("{:.1}k", count as f64 / 1e3))
    };
    let error = measured.error.as_ref();
    let columns = [
        ms(Some(measured.median_ms)),
        ms(Some(measured.p95_ms)),
        ms(measured.extra_ms),
        ms(measured.cpu_ms),
        ms(measured.extra_cpu_ms),
        thousands(measured.vertex_invocations),
        thousands(measured.fragment_invocations),
        measured.cost.draws.to_string(),
        measured.cost.upload_bytes.to_string(),
        format!("{:.1}", measured.cost.gpu_bytes as f64 / 1e6),
        error.map_or("-".into(), |error| error.wrong_px.to_string()),
        error.map_or("-".into(), |error| {
            format!("{:.3} / {:.1}", error.worst_px, error.worst_m)
        }),
    ];
    columns.map(|column| format!(" {column:>9}")).concat()
}
