//! Shapes of any size, whose inside is known by formula.
//!
//! All are made of stars on the plane of longitude and latitude: polygons whose vertices lie in order of
//! their angle about a centre, so that a point's angle tells the one edge that decides.

use std::{f64::consts::TAU, fmt};

use clap::ValueEnum;
use globefill::{EdgeKind, Inside, LonLat, Polygon, Region, Ring};

use crate::judge::mix;

/// What to make.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Shape {
    /// One ring, rough at all scales like a coast.
    Ring,
    /// One box with octagonal holes.
    Holes,
    /// The same holes, but one below the other on a meridian.
    Meridian,
    /// The same holes, but each in the one before.
    Nested,
    /// One multipolygon of rough rings of 100 vertices.
    Parts,
    /// Fills like slices of a pie: all meet in one vertex, and each shares its sides with two others.
    Pie,
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ring => "ring",
            Self::Holes => "holes",
            Self::Meridian => "meridian",
            Self::Nested => "nested",
            Self::Parts => "parts",
            Self::Pie => "pie",
        })
    }
}

/// How vertices are joined. The formulas that judge a shape are of straight edges: others lie a share
/// of their length beside them, and the long sides of boxes far away.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Edges {
    /// [`EdgeKind::Straight`].
    Straight,
    /// [`EdgeKind::Geodesic`].
    Geodesic,
    /// [`EdgeKind::Rhumb`].
    Rhumb,
}

impl From<Edges> for EdgeKind {
    fn from(edges: Edges) -> Self {
        match edges {
            Edges::Straight => Self::Straight,
            Edges::Geodesic => Self::Geodesic,
            Edges::Rhumb => Self::Rhumb,
        }
    }
}

impl fmt::Display for Edges {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Straight => "straight",
            Self::Geodesic => "geodesic",
            Self::Rhumb => "rhumb",
        })
    }
}

/// Numbers as good as random, always the same.
pub struct Chance(u64);

impl Chance {
    pub fn new(seed: u64) -> Self {
        Self(mix(seed))
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(1);
        low + (high - low) * (mix(self.0) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.between(0.0, count as f64) as usize).min(count - 1)
    }
}

/// Vertices about a centre at evenly spaced angles, counter-clockwise from east.
struct Star {
    centre: LonLat,
    radii_deg: Vec<f64>,
}

impl Star {
    /// A rough one: octaves of waves, each half as long as the last and 0.6 times as high.
    fn rough(centre: LonLat, radius_deg: f64, vertices: usize, chance: &mut Chance) -> Self {
        let octaves = (vertices / 4).max(1).ilog2();
        let waves: Vec<(f64, f64, f64)> = (0..=octaves)
            .map(|octave| {
                let height = 0.25 * 0.6_f64.powi(octave as i32) * chance.between(0.5, 1.0);
                (f64::from(1 << octave), height, chance.between(0.0, TAU))
            })
            .collect();
        let radius = |index: usize| {
            let angle = TAU * index as f64 / vertices as f64;
            let wave =
                |&(count, height, phase): &(f64, f64, f64)| height * (count * angle + phase).sin();
            radius_deg * (1.0 + waves.iter().map(wave).sum::<f64>())
        };
        Self {
            centre,
            radii_deg: (0..vertices).map(radius).collect(),
        }
    }

    fn vertex(&self, index: usize) -> LonLat {
        let index = index % self.radii_deg.len();
        let (sin, cos) = (TAU * index as f64 / self.radii_deg.len() as f64).sin_cos();
        let radius_deg = self.radii_deg[index];
        LonLat::new(
            self.centre.lon_deg + radius_deg * cos,
            self.centre.lat_deg + radius_deg * sin,
        )
    }

    fn ring(&self) -> Ring {
        (0..=self.radii_deg.len())
            .map(|index| self.vertex(index))
            .collect()
    }

    /// The vertex before a place's angle, if the place is inside.
    fn sector_of(&self, place: LonLat) -> Option<usize> {
        let (x, y) = (
            place.lon_deg - self.centre.lon_deg,
            place.lat_deg - self.centre.lat_deg,
        );
        let angle = y.atan2(x).rem_euclid(TAU);
        let index = (angle / TAU * self.radii_deg.len() as f64) as usize;
        let (a, b) = (self.vertex(index), self.vertex(index + 1));
        let left = (b.lon_deg - a.lon_deg) * (place.lat_deg - a.lat_deg)
            - (b.lat_deg - a.lat_deg) * (place.lon_deg - a.lon_deg);
        (left > 0.0).then_some(index)
    }
}

/// A shape, ready to be written as regions and to be asked.
pub struct Figure {
    shape: Shape,
    stars: Vec<Star>,
    /// Stars lie one to a cell of so many columns and rows.
    grid: (usize, usize),
}

/// West, south, east and north of all shapes, degrees.
const FRAME: [f64; 4] = [-70.0, -60.0, 130.0, 65.0];
const VERTICES_PER_HOLE: usize = 8;
const VERTICES_PER_PART: usize = 100;
/// A slice has so many vertices on each side and on its rim.
const VERTICES_PER_SIDE: usize = 33;

impl Figure {
    pub fn new(shape: Shape, vertices: usize) -> Self {
        let mut chance = Chance::new(1);
        let middle = LonLat::new(0.5 * (FRAME[0] + FRAME[2]), 0.5 * (FRAME[1] + FRAME[3]));
        let (count, corners) = match shape {
            Shape::Ring => (1, vertices),
            // A pie's rim: each slice has it and one of its sides for its own.
            Shape::Pie => (1, vertices / 3),
            Shape::Holes | Shape::Meridian | Shape::Nested => {
                (vertices / VERTICES_PER_HOLE, VERTICES_PER_HOLE)
            }
            Shape::Parts => (vertices / VERTICES_PER_PART, VERTICES_PER_PART),
        };
        if count == 1 && matches!(shape, Shape::Ring | Shape::Pie) {
            let star = match shape {
                Shape::Ring => Star::rough(middle, 30.0, corners, &mut chance),
                _ => {
                    let slices = (corners / VERTICES_PER_SIDE).max(3);
                    let radii_deg = vec![50.0; slices * VERTICES_PER_SIDE];
                    Star {
                        centre: middle,
                        radii_deg,
                    }
                }
            };
            return Self {
                shape,
                stars: vec![star],
                grid: (1, 1),
            };
        }
        if shape == Shape::Nested {
            let star = |index: usize| Star {
                centre: middle,
                radii_deg: vec![50.0 * (1.0 - index as f64 / count as f64); corners],
            };
            return Self {
                shape,
                stars: (0..count).map(star).collect(),
                grid: (1, 1),
            };
        }
        let columns = match shape {
            Shape::Meridian => 1,
            _ => ((count as f64).sqrt() as usize).max(1),
        };
        let grid = (columns, (count / columns).max(1));
        let width_deg = (FRAME[2] - FRAME[0]) / grid.0 as f64;
        let height_deg = (FRAME[3] - FRAME[1]) / grid.1 as f64;
        let star = |cell: usize| {
            let (column, row) = ((cell % grid.0) as f64, (cell / grid.0) as f64);
            let lon_deg = FRAME[0] + (column + chance.between(0.45, 0.55)) * width_deg;
            let lat_deg = FRAME[1] + (row + chance.between(0.45, 0.55)) * height_deg;
            // Waves reach 1.6 times the radius at most.
            let radius_deg = 0.24 * width_deg.min(height_deg) * chance.between(0.5, 1.0);
            let centre = LonLat::new(lon_deg, lat_deg);
            match shape {
                Shape::Holes | Shape::Meridian => Star {
                    centre,
                    radii_deg: vec![radius_deg; corners],
                },
                _ => Star::rough(centre, radius_deg, corners, &mut chance),
            }
        };
        let stars = (0..grid.0 * grid.1).map(star).collect();
        Self { shape, stars, grid }
    }

    pub fn regions(&self) -> Vec<Region> {
        match self.shape {
            Shape::Ring | Shape::Parts => {
                let part = |star: &Star| Polygon {
                    shell: star.ring(),
                    holes: Vec::new(),
                };
                vec![region(self.stars.iter().map(part).collect())]
            }
            Shape::Holes | Shape::Meridian | Shape::Nested => {
                let [west, south, east, north] = FRAME;
                // An edge takes the shorter way round, so the long sides need a vertex on their way.
                let middle = 0.5 * (west + east);
                let lower = [west, middle, east].map(|lon_deg| LonLat::new(lon_deg, south));
                let upper = [east, middle, west].map(|lon_deg| LonLat::new(lon_deg, north));
                let shell = [&lower[..], &upper, &lower[..1]].concat();
                let holes = self.stars.iter().map(Star::ring).collect();
                vec![region(vec![Polygon { shell, holes }])]
            }
            Shape::Pie => {
                let slices = self.stars[0].radii_deg.len() / VERTICES_PER_SIDE;
                let slice = |index: usize| Polygon {
                    shell: self.slice(index, slices),
                    holes: Vec::new(),
                };
                (0..slices)
                    .map(|index| region(vec![slice(index)]))
                    .collect()
            }
        }
    }

    fn slice(&self, index: usize, slices: usize) -> Ring {
        let star = &self.stars[0];
        let next = (index + 1) % slices;
        let side = |slice: usize, step: usize| {
            let tip = star.vertex(slice * VERTICES_PER_SIDE);
            let share = step as f64 / VERTICES_PER_SIDE as f64;
            let along = |from: f64, to: f64| from + share * (to - from);
            LonLat::new(
                along(star.centre.lon_deg, tip.lon_deg),
                along(star.centre.lat_deg, tip.lat_deg),
            )
        };
        let out = (0..VERTICES_PER_SIDE).map(|step| side(index, step));
        let rim = (0..VERTICES_PER_SIDE).map(|k| star.vertex(index * VERTICES_PER_SIDE + k));
        let tip = std::iter::once(star.vertex(next * VERTICES_PER_SIDE));
        let back = (0..VERTICES_PER_SIDE).rev().map(|step| side(next, step));
        out.chain(rim).chain(tip).chain(back).collect()
    }

    /// Places to ask about: all over the shapes and a little around.
    pub fn places(&self, count: usize) -> Vec<LonLat> {
        let mut chance = Chance::new(2);
        let place = |_| {
            let lon_deg = chance.between(FRAME[0] - 5.0, FRAME[2] + 5.0);
            LonLat::new(lon_deg, chance.between(FRAME[1] - 5.0, FRAME[3] + 5.0))
        };
        (0..count).map(place).collect()
    }

    /// The fills at a place that is farther from all edges than rounding.
    pub fn fills_at(&self, place: LonLat) -> Vec<u32> {
        let [west, south, east, north] = FRAME;
        let share = |x: f64, low: f64, high: f64| (x - low) / (high - low);
        let (x, y) = (
            share(place.lon_deg, west, east),
            share(place.lat_deg, south, north),
        );
        if !((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y)) {
            return Vec::new();
        }
        let column = (x * self.grid.0 as f64) as usize;
        let row = (y * self.grid.1 as f64) as usize;
        let sector = self.stars[row * self.grid.0 + column].sector_of(place);
        match self.shape {
            Shape::Ring | Shape::Parts => sector.map_or(Vec::new(), |_| vec![0]),
            // All nested ones but the first remove nothing more.
            Shape::Holes | Shape::Meridian | Shape::Nested => {
                sector.map_or(vec![0], |_| Vec::new())
            }
            Shape::Pie => {
                sector.map_or(Vec::new(), |index| vec![(index / VERTICES_PER_SIDE) as u32])
            }
        }
    }
}

/// Cells stay clear of each other, so the frame's share of a cell is its star's.
fn region(polygons: Vec<Polygon>) -> Region {
    Region {
        polygons,
        edges: EdgeKind::Straight,
        inside: Inside::Smaller,
        zones: Vec::new(),
    }
}
