//! One chart as SVG.

use plotters::{coord::Shift, prelude::*};

const SIZE_PX: (u32, u32) = (900, 560);
const FONT: (&str, u32) = ("sans-serif", 15);

/// What is drawn.
pub struct Chart {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub series: Vec<Series>,
    /// Whether points of a series are joined by lines.
    pub joined: bool,
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
        for (index, series) in self.series.iter().enumerate() {
            let color = Palette99::pick(index).to_rgba();
            let place = |point: &Point| (self.x.place(point.x), self.y.place(point.y));
            let dots = series
                .points
                .iter()
                .map(|point| Circle::new(place(point), 4, color.filled()));
            chart
                .draw_series(dots)?
                .label(&series.name)
                .legend(move |(x, y)| Circle::new((x + 8, y), 4, color.filled()));
            if self.joined {
                let line = series.points.iter().map(place);
                chart.draw_series(LineSeries::new(line, color.stroke_width(2)))?;
            }
            let defaults = series.points.iter().filter(|point| point.is_default);
            chart.draw_series(
                defaults.map(|point| Circle::new(place(point), 8, BLACK.stroke_width(2))),
            )?;
            chart.draw_series(series.points.iter().filter_map(|point| {
                let label = point.label.clone()?;
                // Labels of one series start above those of the next.
                let above_px = 14 + 2 * index as i32;
                Some(
                    EmptyElement::at(place(point))
                        + Text::new(label, (9, -above_px), FONT.into_font().color(&color)),
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
            format!("{:.2e}", 10_f64.powf(place))
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
