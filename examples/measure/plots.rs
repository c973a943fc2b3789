//! Pictures of run time against error.

mod chart;

use std::collections::BTreeSet;

use crate::{
    plots::chart::{Axis, Chart, Lines, Point, Series},
    row::Row,
};

/// Errors below are drawn here: no pixel differed by more.
const LEAST_PX: f64 = 1e-3;

/// A name and the text of an SVG for every scene whose settings were swept, and every sweep over heights.
pub fn all(rows: &[Row]) -> Result<Vec<(String, String)>, String> {
    let mut plots = Vec::new();
    for scene in scenes_of(rows, "pixel_error") {
        let sweeps = ["technique", "pixel_error", "tolerance_m"];
        let series = sweeps.map(|sweep| trade_off(rows, &scene, sweep));
        let chart = Chart {
            title: format!("{scene}: time against error"),
            x: Axis {
                label: "worst displacement, px (0.001: none seen)",
                logarithmic: true,
            },
            y: Axis {
                label: "processor time over the bare globe, ms",
                logarithmic: false,
            },
            series: series.into_iter().collect(),
            lines: Lines::ParetoFront,
        };
        plots.push((format!("trade-offs-{scene}.svg"), chart.svg()?));
    }
    for (sweep, prefix) in [("encoding", "corner-"), ("normals", "plateau-")] {
        let series = over_heights(rows, sweep, prefix);
        if series.is_empty() {
            continue;
        }
        let chart = Chart {
            title: format!("{sweep}: error against the eye's height"),
            x: Axis {
                label: "height over the ground, m",
                logarithmic: true,
            },
            y: Axis {
                label: "worst displacement, px (0.001: none seen)",
                logarithmic: true,
            },
            series,
            lines: Lines::Series,
        };
        plots.push((format!("{sweep}.svg"), chart.svg()?));
    }
    Ok(plots)
}

fn scenes_of(rows: &[Row], sweep: &str) -> BTreeSet<String> {
    let swept = rows.iter().filter(|row| {
        let variant = row.variant.as_ref();
        variant.is_some_and(|variant| variant.sweep == sweep)
    });
    swept.map(|row| row.scene.clone()).collect()
}

/// Points of one sweep in one scene.
fn trade_off(rows: &[Row], scene: &str, sweep: &str) -> Series {
    let points = rows.iter().filter(|row| row.scene == scene);
    Series {
        name: sweep.to_owned(),
        points: points
            .filter_map(|row| {
                let variant = row
                    .variant
                    .as_ref()
                    .filter(|variant| variant.sweep == sweep)?;
                let measured = row.outcome.as_ref().ok()?;
                Some(Point {
                    x: measured.error?.worst_px.max(LEAST_PX),
                    y: measured.extra_cpu_ms.or(measured.extra_ms)?,
                    label: Some(variant.value.clone()),
                    is_default: variant.is_default,
                })
            })
            .filter(Point::is_finite)
            .collect(),
    }
}

/// A line for each value of a sweep: the error in scenes called after heights.
fn over_heights(rows: &[Row], sweep: &str, prefix: &str) -> Vec<Series> {
    let mut lines: Vec<Series> = Vec::new();
    for row in rows {
        let Some(variant) = row
            .variant
            .as_ref()
            .filter(|variant| variant.sweep == sweep)
        else {
            continue;
        };
        let height = row.scene.strip_prefix(prefix);
        let height = height.and_then(|text| text.strip_suffix('m')?.parse::<f64>().ok());
        let error = row
            .outcome
            .as_ref()
            .ok()
            .and_then(|measured| measured.error);
        let (Some(height_m), Some(error)) = (height, error) else {
            continue;
        };
        let point = Point {
            x: height_m,
            y: error.worst_px.max(LEAST_PX),
            label: None,
            is_default: variant.is_default,
        };
        match lines.iter_mut().find(|line| line.name == variant.value) {
            _ if !point.is_finite() => {}
            Some(line) => line.points.push(point),
            None => lines.push(Series {
                name: variant.value.clone(),
                points: vec![point],
            }),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{accuracy::PictureError, heat::Variant, row::Measured, technique::TechniqueName};

    fn row(scene: &str, sweep: &'static str, value: &str, worst_px: f64) -> Row {
        Row {
            scene: scene.into(),
            technique: TechniqueName::Doubled,
            variant: Some(Variant {
                sweep,
                value: value.into(),
                is_default: value == "fixed",
            }),
            build_ms: 1.0,
            outcome: Ok(Measured {
                extra_cpu_ms: Some(12.0),
                error: Some(PictureError {
                    worst_px,
                    ..Default::default()
                }),
                ..Default::default()
            }),
        }
    }

    #[test]
    fn lines_go_over_heights() {
        let rows = [
            row("corner-1m", "encoding", "plain", 40.0),
            row("corner-1m", "encoding", "fixed", 0.0),
            row("corner-2e7m", "encoding", "plain", 0.0),
        ];
        let lines = over_heights(&rows, "encoding", "corner-");
        assert_eq!(lines.len(), 2);
        assert_eq!(lines[0].points[1].x, 2e7);
        assert_eq!(lines[1].points[0].y, LEAST_PX);
        let plots = all(&rows).unwrap();
        assert_eq!(plots.len(), 1);
        assert!(plots[0].0 == "encoding.svg" && plots[0].1.contains("plain"));
    }

    #[test]
    fn what_is_nowhere_near_is_left_out() {
        let rows = [
            row("50m-all", "pixel_error", "0", f64::INFINITY),
            row("50m-all", "pixel_error", "1", 0.5),
        ];
        let series = trade_off(&rows, "50m-all", "pixel_error");
        assert_eq!(series.points.len(), 1);
        assert_eq!(all(&rows).unwrap()[0].0, "trade-offs-50m-all.svg");
    }
}
