//! GeoJSON that a person opened.

use globefill::geo_json::regions_from_geojson;

use super::fill_layer::{FillLayer, Look};
use crate::host::palette;

const LOOK: Look = Look {
    visible: true,
    opacity: 1.0,
    hatch: None,
    spacing_px: 12.0,
    stroke_px: 2.0,
    z_index: 20,
};

/// Reads and meshes a GeoJSON text; errors name the file and what is wrong where.
pub fn build(file: &str, text: &str) -> Result<FillLayer, String> {
    let named = |error: &dyn std::error::Error| format!("{file}: {error}");
    let regions = regions_from_geojson(text).map_err(|error| named(&error))?;
    let regions = regions.into_iter().enumerate().map(|(index, read)| {
        let name = read.name.or(read.id);
        (
            name.unwrap_or_else(|| format!("Feature {index}")),
            read.region,
        )
    });
    FillLayer::build(file, regions.collect(), LOOK, palette::colors).map_err(|error| named(&error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bad_file_is_an_error_that_names_it() {
        let error = build("bad.geojson", "{ not json").err().unwrap();
        assert!(error.starts_with("bad.geojson: "), "{error}");
    }
}
