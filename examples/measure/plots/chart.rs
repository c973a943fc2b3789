//! One chart as SVG.

use plotters::{coord::Shift, prelude::*};

const SIZE_PX: (u32, u32) = (900, 560);
const FONT: (&str, u32) = ("sans-serif", 15);
/// Of series, and where their labels start.
const COLORS: [RGBColor; 4] = [
    RGBColor(190, 30, 45),
    RGBColor(20, 120, 60),
    RGBColor(120, 60, 160),
    RGBColor(20, 90, 190),
];
const LABELS_PX: [(i32, i32); 3] = [(9, -16), (-34, -6), (9, 6)];

/// What is drawn.
pub struct Chart {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub series: Vec<Series>,
    pub lines: Lines,
}

/// What joins points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lines {
    /// Those of each series, in order.
    Series,
    /// Those of all series that none beats on both axes.
    ParetoFront,
}

pub struct Axis {
    pub label: &'static str,
    pub logarithmic: bool,
}

pub struct Series {
    pub name: String,
    pub points: Vec<Point>,
}

#[derive(Clone, Debug)]
pub struct Point {
    pub x: f64,
    pub y: f64,
    pub label: Option<String>,
    /// Is ringed.
    pub is_default: bool,
}

impl Point {
    pub fn is_finite(&self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

impl Chart {
    pub fn svg(&self) -> Result<String, String> {
        let mut text = String::new();
        {
            let area = SVGBackend::with_string(&mut text, SIZE_PX).into_drawing_area();
            self.draw(&area).map_err(|error| error.to_string())?;
        }
        Ok(text)
    }

    /// Coordinates are of what is shown: logarithms, where an axis has them, are taken beforehand.
    fn draw(
        &self,
        area: &DrawingArea<SVGBackend<'_>, Shift>,
    ) -> Result<(), Box<dyn std::error::Error + '_>> {
        area.fill(&WHITE)?;
        let points = || self.series.iter().flat_map(|series| &series.points);
        let (left, right) = self.x.range(points().map(|point| point.x));
        let (low, high) = self.y.range(points().map(|point| point.y));
        let mut chart = ChartBuilder::on(area)
            .caption(&self.title, ("sans-serif", 20))
            .margin(12)
            .x_label_area_size(46)
            .y_label_area_size(66)
            .build_cartesian_2d(left..right, low..high)?;
        chart
            .configure_mesh()
            .x_desc(self.x.label)
            .y_desc(self.y.label)
            .x_label_formatter(&|value| self.x.written(*value))
            .y_label_formatter(&|value| self.y.written(*value))
            .light_line_style(WHITE)
            .label_style(FONT)
            .draw()?;
        if self.lines == Lines::ParetoFront {
            let front = pareto_front(points().map(|point| (point.x, point.y)).collect());
            let steps = front
                .iter()
                .map(|&(x, y)| (self.x.place(x), self.y.place(y)));
            chart.draw_series(LineSeries::new(steps, BLACK.mix(0.3).stroke_width(2)))?;
        }
        for (index, series) in self.series.iter().enumerate() {
            let color = COLORS[index % COLORS.len()].to_rgba();
            let away_px = LABELS_PX[index % LABELS_PX.len()];
            let place = |point: &Point| (self.x.place(point.x), self.y.place(point.y));
            let dots = series
                .points
                .iter()
                .map(|point| Circle::new(place(point), 4, color.filled()));
            chart
                .draw_series(dots)?
                .label(&series.name)
                .legend(move |(x, y)| Circle::new((x + 8, y), 4, color.filled()));
            if self.lines == Lines::Series {
                let line = series.points.iter().map(place);
                chart.draw_series(LineSeries::new(line, color.stroke_width(2)))?;
            }
            let defaults = series.points.iter().filter(|point| point.is_default);
            chart.draw_series(
                defaults.map(|point| Circle::new(place(point), 8, BLACK.stroke_width(2))),
            )?;
            chart.draw_series(series.points.iter().filter_map(|point| {
                let label = point.label.clone()?;
                Some(
                    EmptyElement::at(place(point))
                        + Text::new(label, away_px, FONT.into_font().color(&color)),
                )
            }))?;
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE.mix(0.8))
            .border_style(BLACK)
            .label_font(FONT)
            .draw()?;
        area.present()?;
        Ok(())
    }
}

impl Axis {
    fn place(&self, value: f64) -> f64 {
        if self.logarithmic {
            value.log10()
        } else {
            value
        }
    }

    fn written(&self, place: f64) -> String {
        if self.logarithmic {
            let value = 10_f64.powf(place);
            if (0.01..1e4).contains(&value) {
                format!("{}", (value * 100.0).round() / 100.0)
            } else {
                format!("{value:.0e}")
            }
        } else {
            format!("{place:.0}")
        }
    }

    /// All values, with room; linear axes start at 0.
    fn range(&self, values: impl Iterator<Item = f64>) -> (f64, f64) {
        let (least, most) = values
            .map(|value| self.place(value))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            });
        if !least.is_finite() || !most.is_finite() {
            return (0.0, 1.0);
        }
        if self.logarithmic {
            (
                least.floor() - 0.1,
                most.ceil().max(least.floor() + 1.0) + 0.1,
            )
        } else {
            (least.min(0.0), 1.15 * most.max(1e-9))
        }
    }
}

/// The points that no other beats on both axes, from left to right.
fn pareto_front(mut points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut least = f64::INFINITY;
    points.retain(|&(_, y)| {
        let is_better = y < least;
        least = least.min(y);
        is_better
    });
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_has_what_nothing_beats() {
        let points = vec![(2.0, 3.0), (1.0, 5.0), (3.0, 4.0), (4.0, 1.0), (1.0, 6.0)];
        assert_eq!(pareto_front(points), [(1.0, 5.0), (2.0, 3.0), (4.0, 1.0)]);
        assert!(pareto_front(Vec::new()).is_empty());
    }
}
