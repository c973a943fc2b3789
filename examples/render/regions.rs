//! What is filled and how it is to look: regions from a file, or the embedded countries.

use std::path::Path;

use globefill::{Region, RegionError};

use crate::{
    cli::{Arguments, CountryScale},
    simplestyle,
    style::Look,
};

/// The regions and their looks, in input order.
pub fn read(arguments: &Arguments) -> Result<(Vec<Region>, Vec<Look>), String> {
    if arguments.regions.is_none() && arguments.style.ignore_properties {
        return Err("--ignore-properties needs --regions".into());
    }
    let styled_by_properties = arguments.regions.is_some() && !arguments.style.ignore_properties;
    let look = arguments.style.look(styled_by_properties)?;
    let (mut regions, looks) = match &arguments.regions {
        Some(path) => read_file(path, &look, styled_by_properties)?,
        None => {
            let regions = embedded(arguments.countries);
            let looks = vec![look; regions.len()];
            (regions, looks)
        }
    };
    for region in &mut regions {
        if let Some(edges) = arguments.edges {
            region.edges = edges.into();
        }
        if let Some(orientation) = arguments.orientation {
            region.inside = orientation.into();
        }
    }
    Ok((regions, looks))
}

/// The error of a region, with the file it came from.
pub fn describe(arguments: &Arguments, error: &RegionError) -> String {
    match &arguments.regions {
        Some(path) => format!("{}: {error}", path.display()),
        None => error.to_string(),
    }
}

fn read_file(
    path: &Path,
    look: &Look,
    styled_by_properties: bool,
) -> Result<(Vec<Region>, Vec<Look>), String> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| format!("{}: cannot read the regions: {error}", path.display()))?;
    let named = globefill::geo_json::regions_from_geojson(&text)
        .map_err(|error| format!("{}: {error}", path.display()))?;
    let directory = path.parent().unwrap_or(Path::new(""));
    let styled = named.into_iter().enumerate().map(|(feature, named)| {
        let mut look = look.clone();
        if styled_by_properties {
            look = simplestyle::with_properties(look, &named.properties, directory)
                .map_err(|error| format!("{}: feature {feature}: {error}", path.display()))?;
        }
        Ok((named.region, look))
    });
    styled.collect()
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
