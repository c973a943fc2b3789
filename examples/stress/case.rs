//! What is meshed, and the course of one case.

use std::{fmt, path::PathBuf, time::Instant};

use clap::ValueEnum;
use globefill::{
    EdgeKind, FillMesh, Inside, Locator, MeshOptions, Region, geo_json::regions_from_geojson,
};

use crate::{
    judge, plane,
    process::{cpu_seconds, peak_bytes},
    report::Report,
    synthetic::{self, Edges, Shape},
};

/// Which side of a file's shells is inside.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Orientation {
    /// The finite side on the plane of longitude and latitude, however the ring winds.
    Plane,
    /// [`Inside::Smaller`].
    Smaller,
    /// [`Inside::LeftOfRing`].
    Left,
}

impl Orientation {
    fn apply(self, region: &mut Region) {
        region.inside = match self {
            Self::Smaller => Inside::Smaller,
            Self::Plane | Self::Left => Inside::LeftOfRing,
        };
        if matches!(self, Self::Plane) {
            let shells = region.polygons.iter_mut().map(|polygon| &mut polygon.shell);
            shells
                .filter(|shell| plane::twice_area(shell) < 0.0)
                .for_each(|shell| shell.reverse());
        }
    }
}

impl fmt::Display for Orientation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Plane => "plane",
            Self::Smaller => "smaller",
            Self::Left => "left",
        })
    }
}

/// One input.
#[derive(Clone, Debug)]
pub enum Case {
    /// A GeoJSON file.
    File {
        path: PathBuf,
        orientation: Orientation,
    },
    /// A made shape of about so many vertices.
    Synthetic {
        shape: Shape,
        vertices: usize,
        edges: Edges,
    },
}

impl Case {
    /// The command line that stands for this case.
    pub fn arguments(&self) -> Vec<String> {
        match self {
            Self::File { path, orientation } => {
                let path = path.display().to_string();
                vec![path, "--orientation".into(), orientation.to_string()]
            }
            Self::Synthetic {
                shape,
                vertices,
                edges,
            } => vec![
                "--synthetic".into(),
                shape.to_string(),
                "--sizes".into(),
                vertices.to_string(),
                "--edges".into(),
                edges.to_string(),
            ],
        }
    }

    /// Whether `other` is the same shape in another size.
    pub fn grows_to(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Synthetic { shape, .. }, Self::Synthetic { shape: next, .. }) => shape == next,
            _ => false,
        }
    }

    /// Meshes and judges.
    pub fn run(&self, points: usize, only_build: bool) -> Result<Report, String> {
        let start = Instant::now();
        let regions = self.regions()?;
        let mut report = Report {
            parse_s: start.elapsed().as_secs_f64(),
            parse_peak_bytes: peak_bytes(),
            ..Report::of_input(&regions)
        };
        let (start, cpu_s) = (Instant::now(), cpu_seconds());
        let mesh = FillMesh::build(&regions, &MeshOptions::default())
            .map_err(|error| error.to_string())?;
        report.build_s = start.elapsed().as_secs_f64();
        report.build_cpu_s = cpu_seconds() - cpu_s;
        report.build_peak_bytes = peak_bytes();
        report.add_mesh(&mesh);
        if only_build {
            return Ok(report);
        }
        report.open_pieces = judge::open_pieces(&mesh);
        let start = Instant::now();
        let measured_m2: Vec<f64> = mesh
            .all_measures()
            .iter()
            .map(|fill| fill.area_m2)
            .collect();
        report.measures_s = start.elapsed().as_secs_f64();
        (report.area_error, report.area_bound) = judge::area_error(&mesh, &measured_m2);
        let start = Instant::now();
        let locator = Locator::new(&mesh);
        report.locator_s = start.elapsed().as_secs_f64();
        self.judge_points(&locator, &regions, points, &mut report);
        report.peak_bytes = peak_bytes();
        Ok(report)
    }

    fn regions(&self) -> Result<Vec<Region>, String> {
        match self {
            Self::File { path, orientation } => {
                let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
                let named = regions_from_geojson(&text).map_err(|error| error.to_string())?;
                let mut regions: Vec<Region> =
                    named.into_iter().map(|named| named.region).collect();
                regions
                    .iter_mut()
                    .for_each(|region| orientation.apply(region));
                Ok(regions)
            }
            Self::Synthetic {
                shape,
                vertices,
                edges,
            } => {
                let mut regions = synthetic::Figure::new(*shape, *vertices).regions();
                for region in &mut regions {
                    region.edges = EdgeKind::from(*edges);
                }
                Ok(regions)
            }
        }
    }

    /// Compares the locator with the shape's own formula, or with a plain even-odd test of all edges.
    fn judge_points(
        &self,
        locator: &Locator,
        regions: &[Region],
        points: usize,
        report: &mut Report,
    ) {
        let (places, expected) = match self {
            Self::Synthetic {
                shape, vertices, ..
            } => {
                let figure = synthetic::Figure::new(*shape, *vertices);
                let places = figure.places(points);
                let expected = places.iter().map(|&place| figure.fills_at(place)).collect();
                (places, expected)
            }
            Self::File { .. } => {
                let places = plane::places(regions, points);
                let expected = plane::fills_at(regions, &places);
                (places, expected)
            }
        };
        let start = Instant::now();
        let found: Vec<Vec<u32>> = places
            .iter()
            .map(|&place| locator.fills_at(place))
            .collect();
        report.query_us = start.elapsed().as_secs_f64() * 1e6 / places.len().max(1) as f64;
        report.points = places.len();
        report.points_inside = expected
            .iter()
            .filter(|fills: &&Vec<u32>| !fills.is_empty())
            .count();
        report.wrong_points = found.iter().zip(&expected).filter(|(a, b)| a != b).count();
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { path, .. } => match path.file_stem() {
                Some(stem) => write!(f, "{}", stem.to_string_lossy()),
                None => write!(f, "{}", path.display()),
            },
            Self::Synthetic {
                shape,
                vertices,
                edges: Edges::Straight,
            } => write!(f, "{shape} {vertices}"),
            Self::Synthetic {
                shape,
                vertices,
                edges,
            } => write!(f, "{edges} {shape} {vertices}"),
        }
    }
}
