//! What the host draws: the bare ellipsoid or analytic terrain, ray-cast in f64.

use glam::{DVec2, DVec3, UVec2};
use globefill::{LogDepth, wgpu};
use rayon::prelude::*;

use super::{
    camera::{DepthRange, DepthSteps, Lens, Pose},
    figure::Figure,
};

/// Heights of the host's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Terrain {
    Bare,
    Plateau {
        height_m: f64,
    },
    /// The ellipsoid seen from below.
    Ceiling,
    /// Mountains between 4 and 9 km: waves of 300 m to 60 km length along three axes.
    Rough,
    /// The bare ellipsoid, of a host whose surface lies between −11 and 9 km elsewhere.
    Level,
    /// Mountains and trenches between −11 and 9 km: waves of 1.5 to 200 km length along three axes.
    Deep,
    /// Facets of a quarter of a degree between corners up to 3 km high, as of a coarse mesh.
    Coarse,
}

/// Directions and angular frequencies (per radian of arc), and heights, of the waves.
const WAVES: [(DVec3, f64); 6] = [
    (DVec3::new(640.0, 410.0, -230.0), 1000.0),
    (DVec3::new(-1900.0, 2700.0, 1300.0), 600.0),
    (DVec3::new(5200.0, 3900.0, 9100.0), 300.0),
    (DVec3::new(-21_000.0, 17_000.0, -13_000.0), 120.0),
    (DVec3::new(57_000.0, 71_000.0, -66_000.0), 30.0),
    (DVec3::new(110_000.0, -90_000.0, 130_000.0), 8.0),
];
const ROUGH_MEAN_M: f64 = 6400.0;
/// The same of [`Terrain::Deep`].
const DEEP_WAVES: [(DVec3, f64); 5] = [
    (DVec3::new(160.0, 102.0, -57.0), 7500.0),
    (DVec3::new(-475.0, 675.0, 325.0), 1800.0),
    (DVec3::new(5200.0, 3900.0, 9100.0), 300.0),
    (DVec3::new(-21_000.0, 17_000.0, -13_000.0), 120.0),
    (DVec3::new(57_000.0, 71_000.0, -66_000.0), 30.0),
];
const DEEP_MEAN_M: f64 = -1000.0;

impl Terrain {
    pub fn height_m(self, normal: DVec3) -> f64 {
        match self {
            Self::Bare | Self::Level | Self::Ceiling => 0.0,
            Self::Plateau { height_m } => height_m,
            Self::Rough => {
                let waves = WAVES.iter().map(|(k, height)| height * k.dot(normal).sin());
                ROUGH_MEAN_M + waves.sum::<f64>()
            }
            Self::Deep => {
                let waves = DEEP_WAVES.iter();
                let waves = waves.map(|(k, height)| height * k.dot(normal).sin());
                DEEP_MEAN_M + waves.sum::<f64>()
            }
            Self::Coarse => coarse_m(normal),
        }
    }

    /// Lowest and highest surface point.
    pub fn range_m(self) -> (f64, f64) {
        match self {
            Self::Rough => {
                let reach: f64 = WAVES.iter().map(|(_, height)| height).sum();
                (ROUGH_MEAN_M - reach, ROUGH_MEAN_M + reach)
            }
            Self::Level => (-11_000.0, 9000.0),
            Self::Deep => {
                let reach: f64 = DEEP_WAVES.iter().map(|(_, height)| height).sum();
                (DEEP_MEAN_M - reach, DEEP_MEAN_M + reach)
            }
            Self::Coarse => (0.0, COARSE_MOST_M),
            level => (level.height_m(DVec3::Z), level.height_m(DVec3::Z)),
        }
    }

    /// Distance along the view axis at which a ray meets the surface.
    pub fn hit(self, figure: &Figure, eye_m: DVec3, ray: DVec3) -> Option<f64> {
        if matches!(self, Self::Bare | Self::Level) {
            return figure.first_hit(eye_m, ray, 0.0);
        }
        if self == Self::Ceiling {
            let (_, leave) = figure.hits(eye_m, ray, 0.0)?;
            return (leave > 0.0).then_some(leave);
        }
        let (low_m, high_m) = self.range_m();
        // The ellipsoid with longer axes lies up to f²·h/2 below the surface of that height.
        let (enter, leave) = figure.hits(eye_m, ray, high_m + 1.0)?;
        let leave = match figure.first_hit(eye_m, ray, low_m - 1.0) {
            Some(low) => low.min(leave),
            None => leave,
        };
        let speed = ray.length();
        let gap_m = |t: f64| {
            let (foot, height_m) = figure.geodetic(eye_m + ray * t);
            height_m - self.height_m(figure.normal(foot))
        };
        let mut before = enter.max(0.0);
        let mut gap = gap_m(before);
        if gap < 0.0 {
            return None;
        }
        while before < leave {
            let step = (0.5 * gap / speed).max(3e-4 * before).max(1e-3);
            let after = (before + step).min(leave + 1e-3);
            gap = gap_m(after);
            if gap <= 0.0 {
                return Some(zero_between(gap_m, before, after));
            }
            before = after;
        }
        None
    }
}

const COARSE_MOST_M: f64 = 3000.0;
const COARSE_DEG: f64 = 0.25;

/// Heights are linear within triangles of a grid in longitude and latitude.
fn coarse_m(normal: DVec3) -> f64 {
    let lon_deg = normal.y.atan2(normal.x).to_degrees();
    let lat_deg = normal.z.atan2(normal.x.hypot(normal.y)).to_degrees();
    let at = DVec2::new(lon_deg, lat_deg) / COARSE_DEG;
    let first = at.floor();
    let share = at - first;
    let columns = 360.0 / COARSE_DEG;
    let corner_m = |dx: f64, dy: f64| {
        let (x, y) = ((first.x + dx).rem_euclid(columns), first.y + dy);
        let wave = (12.9898 * x + 78.233 * y).sin() * 43_758.545_3;
        COARSE_MOST_M * wave.rem_euclid(1.0)
    };
    let (low, high) = (corner_m(0.0, 0.0), corner_m(1.0, 1.0));
    if share.x > share.y {
        let side = corner_m(1.0, 0.0);
        low + (side - low) * share.x + (high - side) * share.y
    } else {
        let side = corner_m(0.0, 1.0);
        low + (side - low) * share.y + (high - side) * share.x
    }
}

/// The zero of a gap between two parameters of different sign: regula falsi that halves the weight
/// of an end that stays (Illinois).
fn zero_between(gap_m: impl Fn(f64) -> f64, above: f64, below: f64) -> f64 {
    let (mut low, mut high) = ((above, gap_m(above)), (below, gap_m(below)));
    let mut last_above = None;
    for _ in 0..60 {
        let t = low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1);
        let gap = gap_m(t);
        if gap.abs() < 1e-8 || t <= low.0 || t >= high.0 {
            return t;
        }
        let is_above = gap > 0.0;
        if is_above {
            low = (t, gap);
        } else {
            high = (t, gap);
        }
        if last_above == Some(is_above) {
            let stale = if is_above { &mut high.1 } else { &mut low.1 };
            *stale *= 0.5;
        }
        last_above = Some(is_above);
    }
    0.5 * (low.0 + high.0)
}

/// Sample positions within a pixel: the standard ones of the graphics APIs.
pub fn sample_positions(samples: u32) -> &'static [DVec2] {
    const ONE: [DVec2; 1] = [DVec2::new(0.5, 0.5)];
    const FOUR: [DVec2; 4] = [
        DVec2::new(0.375, 0.125),
        DVec2::new(0.875, 0.375),
        DVec2::new(0.125, 0.625),
        DVec2::new(0.625, 0.875),
    ];
    match samples {
        1 => &ONE,
        4 => &FOUR,
        _ => panic!("1 or 4 samples"),
    }
}

/// Where the rays of a picture meet a surface.
pub struct Cast {
    figure: Figure,
    pose: Pose,
    size_px: UVec2,
    terrain: Terrain,
    /// Sample after sample, row after row: start, direction, and distance along the view axis.
    rays: Vec<(DVec3, DVec3, Option<f64>)>,
}

impl Cast {
    pub fn new(
        figure: &Figure,
        pose: &Pose,
        size_px: UVec2,
        samples: u32,
        terrain: Terrain,
    ) -> Self {
        let any_range = DepthRange::ReversedInfinite { near_m: 1.0 };
        let lens = Lens::new(figure, pose, size_px, any_range);
        let places: Vec<DVec2> = sample_positions(samples)
            .iter()
            .flat_map(|&offset| {
                (0..size_px.y).flat_map(move |y| {
                    (0..size_px.x).map(move |x| DVec2::new(f64::from(x), f64::from(y)) + offset)
                })
            })
            .collect();
        let rays: Vec<(DVec3, DVec3, Option<f64>)> = places
            .into_par_iter()
            .map(|at_px| {
                let (origin_m, ray) = (lens.origin_m(at_px), lens.ray(at_px));
                (origin_m, ray, terrain.hit(figure, origin_m, ray))
            })
            .collect();
        assert!(
            rays.iter().any(|(.., hit)| hit.is_some()),
            "{pose:?} sees nothing but sky"
        );
        Self {
            figure: *figure,
            pose: *pose,
            size_px,
            terrain,
            rays,
        }
    }
}

impl Cast {
    /// Distance along the view axis of the nearest surface.
    pub fn nearest_m(&self) -> f64 {
        let seen = self.rays.iter().filter_map(|(.., hit)| *hit);
        seen.fold(f64::INFINITY, f64::min)
    }
}

/// The host's depth buffer, and the surface points that it holds.
pub struct Surface {
    figure: Figure,
    pub lens: Lens,
    pub range: DepthRange,
    pub terrain: Terrain,
    /// Sample after sample, row after row: stored depth.
    pub depths: Vec<f32>,
    /// The surface point, ECEF; none in the sky.
    pub points_m: Vec<Option<DVec3>>,
}

/// How the depth range follows from the view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DepthKind {
    /// Reversed infinite, near 0.01 m … 1 m; in parallel views reversed finite.
    Reversed,
    /// Standard with planes a factor of two before and behind what is seen.
    Standard,
    /// Reversed with planes a factor of two before and behind what is seen.
    ReversedFinite,
    /// The standard one in 24 bits.
    Standard24,
    /// The reversed finite one in 24 bits.
    Reversed24,
    /// A logarithm that starts at the eye, up to 10^9 m, in floats and in 24 bits.
    Logarithmic,
    Logarithmic24,
    /// One that starts at the near plane.
    FromNear,
}

impl DepthKind {
    fn steps(self) -> DepthSteps {
        match self {
            Self::Standard24 | Self::Reversed24 | Self::Logarithmic24 => DepthSteps::Bits24,
            _ => DepthSteps::Float,
        }
    }

    fn range(self, cast: &Cast) -> DepthRange {
        let seen = || cast.rays.iter().filter_map(|(.., hit)| *hit);
        let nearest_m = seen().fold(f64::INFINITY, f64::min);
        let farthest_m = seen().fold(f64::NEG_INFINITY, f64::max);
        let (near_m, far_m) = if cast.pose.parallel_m.is_some() {
            let margin_m = 100.0 + 0.5 * (farthest_m - nearest_m);
            (nearest_m - margin_m, farthest_m + margin_m)
        } else {
            (0.5 * nearest_m, 2.0 * farthest_m)
        };
        let close_m = (0.1 * nearest_m).clamp(0.01, 1.0);
        match self {
            Self::Reversed if cast.pose.parallel_m.is_none() => {
                DepthRange::ReversedInfinite { near_m: close_m }
            }
            Self::Reversed | Self::ReversedFinite | Self::Reversed24 => {
                DepthRange::ReversedFinite { near_m, far_m }
            }
            Self::Logarithmic | Self::Logarithmic24 => {
                DepthRange::Logarithmic(LogDepth::new(close_m, 1e9))
            }
            Self::FromNear => DepthRange::Logarithmic(LogDepth::from_near(close_m, far_m)),
            Self::Standard | Self::Standard24 => DepthRange::StandardFinite { near_m, far_m },
        }
    }
}

impl Surface {
    pub fn new(cast: &Cast, kind: DepthKind) -> Self {
        Self::stored(cast, kind.range(cast), kind.steps())
    }

    /// A surface in a depth buffer of any range.
    pub fn stored(cast: &Cast, range: DepthRange, steps: DepthSteps) -> Self {
        let mut lens = Lens::new(&cast.figure, &cast.pose, cast.size_px, range);
        lens.steps = steps;
        let depths: Vec<f32> = cast
            .rays
            .iter()
            .map(|(.., hit)| hit.map_or(range.cleared(), |t| lens.stored_depth(t)))
            .collect();
        let points_m = cast
            .rays
            .iter()
            .zip(&depths)
            .map(|(&(origin_m, ray, hit), &depth)| {
                // Over terrain the surface is what the buffer holds, over the bare ellipsoid the hit.
                let t = match cast.terrain {
                    Terrain::Bare | Terrain::Ceiling => hit?,
                    _ => hit.map(|_| lens.distance_m(depth))?,
                };
                Some(origin_m + ray * t)
            })
            .collect();
        Self {
            figure: cast.figure,
            lens,
            range,
            terrain: cast.terrain,
            depths,
            points_m,
        }
    }

    pub fn depth_format(&self) -> wgpu::TextureFormat {
        match self.lens.steps {
            DepthSteps::Float => wgpu::TextureFormat::Depth32Float,
            DepthSteps::Bits24 => wgpu::TextureFormat::Depth24Plus,
        }
    }

    pub fn figure(&self) -> &Figure {
        &self.figure
    }

    pub fn size_px(&self) -> UVec2 {
        self.lens.size_px
    }

    pub fn samples(&self) -> u32 {
        (self.depths.len() / self.pixel_count()) as u32
    }

    pub fn pixel_count(&self) -> usize {
        (self.size_px().x * self.size_px().y) as usize
    }

    /// Whether a pixel touches the sky or a step in depth (DESIGN of the gates: left out).
    pub fn at_discontinuity(&self, pixel: usize) -> bool {
        let (width, height) = (self.size_px().x as i64, self.size_px().y as i64);
        let (x, y) = (pixel as i64 % width, pixel as i64 / width);
        let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
        let mut nearest_m = f64::INFINITY;
        let mut farthest_m = f64::NEG_INFINITY;
        for (x, y) in around.filter(|&(x, y)| x >= 0 && y >= 0 && x < width && y < height) {
            for sample in 0..self.samples() as usize {
                let index = sample * self.pixel_count() + (y * width + x) as usize;
                if self.points_m[index].is_none() {
                    return true;
                }
                let distance_m = self.lens.distance_m(self.depths[index]);
                nearest_m = nearest_m.min(distance_m);
                farthest_m = farthest_m.max(distance_m);
            }
        }
        let step_m = if self.lens.parallel {
            50.0 * self.lens.pixel_m()
        } else {
            0.3 * nearest_m
        };
        matches!(self.terrain, Terrain::Rough | Terrain::Deep) && farthest_m - nearest_m > step_m
    }
}
