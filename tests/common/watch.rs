//! Counts of sensors, pixel by pixel: what was drawn against brute force.

use std::fmt;

use glam::{DVec2, DVec3};
use globefill::{
    CoverageColors, Ellipsoid, FrameStats, Renderer, RendererOptions, SensorDisplay, SensorId,
    SensorSet, SensorStyle, View,
};
use rayon::prelude::*;

use super::{
    draw::{COLOR, id_color, id_of_color, paint},
    headless::Gpu,
    score::BAND_PX,
    surface::{Surface, sample_positions},
    watcher::Watcher,
};

/// A renderer that paints each pixel with the number of sensors that cover it.
pub struct CountPainter {
    pub renderer: Renderer,
    pub options: RendererOptions,
    pub ids: Vec<SensorId>,
}

impl CountPainter {
    pub fn new(gpu: &Gpu, watchers: &[Watcher], surface: &Surface) -> Self {
        let options = RendererOptions {
            color_format: COLOR,
            depth_format: surface.depth_format(),
            depth: surface.range.convention(),
            sample_count: surface.samples(),
            ..Default::default()
        };
        let mut renderer = Renderer::new(&gpu.device, options).expect("the options are sound");
        let colors = (0..=watchers.len() as u32).map(id_color).collect();
        let colors = CoverageColors::table(colors).expect("sound colours");
        let figure = surface.figure();
        let sensors = renderer.sensors_mut();
        *sensors = SensorSet::new(Ellipsoid {
            a_m: figure.a_m,
            b_m: figure.b_m,
        });
        sensors.set_display(SensorDisplay::Coverage(colors));
        let ids = watchers
            .iter()
            .map(|watcher| {
                sensors
                    .insert(watcher.sensor(), SensorStyle::default())
                    .expect("a sound sensor")
            })
            .collect();
        Self {
            renderer,
            options,
            ids,
        }
    }

    /// The number of sensors at each pixel; `u32::MAX` for the sky.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        view: &mut View,
        surface: &Surface,
    ) -> (Vec<u32>, FrameStats) {
        let painted = paint(gpu, &mut self.renderer, &self.options, view, surface, 0.0);
        let counts = painted
            .texels
            .into_iter()
            .map(|texel| {
                if texel == [0; 4] {
                    u32::MAX
                } else {
                    id_of_color(texel)
                }
            })
            .collect();
        (counts, painted.stats)
    }
}

/// The verdict on one picture.
#[derive(Clone, Debug, Default)]
pub struct CountScore {
    pub surface: usize,
    pub covered: usize,
    pub differing: usize,
    pub wrong: usize,
    /// The greatest distance of a differing pixel from where its answer would be right.
    pub worst_px: f64,
    /// x, y, drawn, expected of the first wrong pixels.
    pub examples: Vec<(usize, usize, u32, u32)>,
}

impl fmt::Display for CountScore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "covered {} of {}, differing {}, wrong {}, worst {:.4} px {:?}",
            self.covered, self.surface, self.differing, self.wrong, self.worst_px, self.examples
        )
    }
}

/// Judges counts of a picture of one sample a pixel.
pub fn judge_counts(watchers: &[Watcher], surface: &Surface, drawn: &[u32]) -> CountScore {
    let width = surface.size_px().x as usize;
    let judged: Vec<(usize, u32, f64)> = (0..surface.pixel_count())
        .into_par_iter()
        .filter_map(|pixel| {
            let Some(point_m) = surface.points_m[pixel] else {
                assert_eq!(drawn[pixel], u32::MAX, "the sky is painted at {pixel}");
                return None;
            };
            if surface.at_discontinuity(pixel) {
                return None;
            }
            let expected = watchers.iter().filter(|w| w.covers(point_m)).count() as u32;
            let off_px = if drawn[pixel] == expected {
                0.0
            } else {
                off_px(watchers, surface, pixel, drawn[pixel])
            };
            Some((pixel, expected, off_px))
        })
        .collect();
    let mut score = CountScore::default();
    for (pixel, expected, off_px) in judged {
        score.surface += 1;
        score.covered += usize::from(expected > 0);
        score.differing += usize::from(drawn[pixel] != expected);
        score.worst_px = score.worst_px.max(off_px);
        if off_px > BAND_PX {
            score.wrong += 1;
            if score.examples.len() < 4 {
                let at = (pixel % width, pixel / width);
                score.examples.push((at.0, at.1, drawn[pixel], expected));
            }
        }
    }
    score
}

/// Radii tried, pixels.
const RADII_PX: [f64; 8] = [1e-4, 1e-3, 0.004, 0.008, 1.0 / 64.0, 1.0 / 32.0, 0.25, 1.0];

/// How far from a pixel its drawn count would be right: the radius of a disc within which, and within
/// one unit of depth, sensors change their answer often enough.
fn off_px(watchers: &[Watcher], surface: &Surface, pixel: usize, drawn: u32) -> f64 {
    let width = surface.size_px().x as usize;
    let middle_px = DVec2::new((pixel % width) as f64, (pixel / width) as f64)
        + sample_positions(surface.samples())[0];
    RADII_PX
        .into_iter()
        .find(|&radius_px| {
            let points = points_about(surface, pixel, middle_px, radius_px);
            let answers = watchers.iter().map(|watcher| {
                let covered = points
                    .iter()
                    .filter(|&&point| watcher.covers(point))
                    .count();
                (covered == points.len(), covered > 0)
            });
            let (least, most) = answers.fold((0, 0), |(least, most), (all, any)| {
                (least + u32::from(all), most + u32::from(any))
            });
            (least..=most).contains(&drawn)
        })
        .unwrap_or(f64::INFINITY)
}

/// Surface points within a radius of a pixel, and one unit of depth before and behind it.
fn points_about(surface: &Surface, pixel: usize, middle_px: DVec2, radius_px: f64) -> Vec<DVec3> {
    let lens = &surface.lens;
    let depth = surface.depths[pixel];
    let mut points: Vec<DVec3> = surface.points_m[pixel].into_iter().collect();
    points.extend(
        [depth.next_up(), depth.next_down()]
            .map(|depth| lens.point_m(middle_px, lens.distance_m(depth))),
    );
    for k in 0..24 {
        let angle = f64::from(k) * std::f64::consts::TAU / 24.0;
        let at_px = middle_px + radius_px * DVec2::from_angle(angle);
        let (origin_m, ray) = (lens.origin_m(at_px), lens.ray(at_px));
        if let Some(t) = surface.terrain.hit(surface.figure(), origin_m, ray) {
            points.push(origin_m + ray * t);
        }
    }
    points
}
