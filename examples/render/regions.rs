//! What is filled: regions from a file, or the embedded countries.

use std::path::Path;

use globefill::{Region, RegionError};

use crate::cli::{Arguments, CountryScale};

/// The regions, in input order.
pub fn read(arguments: &Arguments) -> Result<Vec<Region>, String> {
    let mut regions = match &arguments.regions {
        Some(path) => read_file(path)?,
        None => embedded(arguments.countries),
    };
    for region in &mut regions {
        if let Some(edges) = arguments.edges {
            region.edges = edges.into();
        }
        if let Some(orientation) = arguments.orientation {
            region.inside = orientation.into();
        }
    }
    Ok(regions)
}

/// The error of a region, with the file it came from.
pub fn describe(arguments: &Arguments, error: &RegionError) -> String {
    match &arguments.regions {
        Some(path) => format!("{}: {error}", path.display()),
        None => error.to_string(),
    }
}

fn read_file(path: &Path) -> Result<Vec<Region>, String> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| format!("{}: cannot read the regions: {error}", path.display()))?;
    let named = globefill::geo_json::regions_from_geojson(&text)
        .map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(named.into_iter().map(|named| named.region).collect())
}

fn embedded(scale: CountryScale) -> Vec<Region> {
    let dataset = match scale {
        CountryScale::Scale110m => globefill::countries::Dataset::Countries110m,
        CountryScale::Scale50m => globefill::countries::Dataset::Countries50m,
    };
    dataset
        .countries()
        .into_iter()
        .map(|country| country.region)
        .collect()
}
