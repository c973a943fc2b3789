//! Exact answers beside the pixels: what fills contain and measure, judged by other formulas.

#[path = "../common/mod.rs"]
mod common;

mod contains;
mod countries;
mod extents;
mod footprints;
mod outlines;
mod polygons;

use std::sync::OnceLock;

use globefill::{
    EdgeKind, FillMesh, Inside, LonLat, MeshOptions, Polygon, Region, countries::Dataset,
};

/// Points of the unit square, evenly spread and the same on every machine.
pub fn spread(count: usize) -> impl Iterator<Item = (f64, f64)> {
    (1..=count).map(|k| {
        let k = k as f64;
        (
            (k * 0.754_877_666_246_693).fract(),
            (k * 0.569_840_290_998_053).fract(),
        )
    })
}

/// Positions evenly spread over the sphere.
pub fn spread_positions(count: usize) -> impl Iterator<Item = LonLat> {
    spread(count).map(|(x, y)| LonLat::new(360.0 * x - 180.0, (2.0 * y - 1.0).asin().to_degrees()))
}

/// A region of one shell.
pub fn region(edges: EdgeKind, inside: Inside, shell: &[(f64, f64)]) -> Region {
    let shell = shell.iter().map(|&(lon, lat)| LonLat::new(lon, lat));
    Region {
        polygons: vec![Polygon {
            shell: shell.collect(),
            holes: Vec::new(),
        }],
        edges,
        inside,
        ..Default::default()
    }
}

/// The mesh of regions that are in order.
pub fn build(regions: &[Region]) -> FillMesh {
    FillMesh::build(regions, &MeshOptions::default()).unwrap()
}

/// The countries at 1:50 million and their mesh, built once.
pub fn countries_50m() -> &'static (Vec<Region>, FillMesh) {
    static BUILT: OnceLock<(Vec<Region>, FillMesh)> = OnceLock::new();
    BUILT.get_or_init(|| {
        let countries = Dataset::Countries50m.countries().into_iter();
        let regions: Vec<Region> = countries.map(|country| country.region).collect();
        let mesh = build(&regions);
        (regions, mesh)
    })
}
