//! Rows for other programs, a line each.

use serde_json::Value;

use crate::row::Row;

const COLUMNS: [&str; 23] = [
    "scene",
    "technique",
    "sweep",
    "value",
    "is_default",
    "build_ms",
    "median_ms",
    "p95_ms",
    "extra_ms",
    "cpu_ms",
    "extra_cpu_ms",
    "vertex_invocations",
    "fragment_invocations",
    "count",
    "draws",
    "passes",
    "upload_bytes",
    "gpu_bytes",
    "wrong_px",
    "differing_px",
    "worst_px",
    "worst_m",
    "refused",
];

/// A heading and all rows. What is not known is empty.
pub fn text(rows: &[Row]) -> String {
    let lines = rows.iter().map(|row| {
        let row = row.json();
        let cells = COLUMNS.map(|column| cell(&row[column]));
        cells.join(",")
    });
    let mut text = COLUMNS.join(",");
    for line in lines {
        text.push('\n');
        text.push_str(&line);
    }
    text.push('\n');
    text
}

/// As RFC 4180 quotes it.
fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) if text.contains([',', '"', '\n']) => {
            format!("\"{}\"", text.replace('"', "\"\""))
        }
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::TechniqueName;

    #[test]
    fn every_line_has_all_columns() {
        let row = Row {
            scene: "separate".into(),
            technique: TechniqueName::Stencil,
            variant: None,
            build_ms: 2.5,
            outcome: Err("too \"deep\"".into()),
        };
        let text = text(&[row]);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 2);
        assert!(lines[1].starts_with("separate,stencil,,,,2.5,"));
        assert!(lines[1].ends_with(",\"too \"\"deep\"\"\""));
        assert_eq!(lines[0].matches(',').count(), lines[1].matches(',').count());
    }

    #[test]
    fn columns_are_what_rows_have() {
        let row = Row {
            scene: "separate".into(),
            technique: TechniqueName::Stencil,
            variant: None,
            build_ms: 2.5,
            outcome: Ok(Default::default()),
        };
        let Value::Object(fields) = row.json() else {
            panic!("a row is an object");
        };
        for name in fields.keys() {
            assert!(COLUMNS.contains(&name.as_str()), "{name}");
        }
    }
}
