//! GeoJSON that a person opened.

use globefill::{Region, geo_json::regions_from_geojson};

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

/// The regions of a file, with their names.
pub struct File {
    name: String,
    regions: Vec<(String, Region)>,
}

impl File {
    /// Reads a GeoJSON text; errors name the file and what is wrong where.
    pub fn parse(name: &str, text: &str) -> Result<Self, String> {
        let read = regions_from_geojson(text).map_err(|error| format!("{name}: {error}"))?;
        let named = read.into_iter().enumerate().map(|(index, read)| {
            let name = read.name.or(read.id);
            let name = name.unwrap_or_else(|| format!("Feature {index}"));
            (name, read.region)
        });
        Ok(Self {
            name: name.to_owned(),
            regions: named.collect(),
        })
    }

    /// How much there is to mesh.
    pub fn size(&self) -> String {
        let polygons = self.regions.iter().flat_map(|(_, region)| &region.polygons);
        let vertices: usize = polygons
            .map(|polygon| polygon.shell.len() + polygon.holes.iter().map(Vec::len).sum::<usize>())
            .sum();
        format!("{} regions, {vertices} vertices", self.regions.len())
    }

    /// Meshes the regions; errors name the file and the place.
    pub fn build(self) -> Result<FillLayer, String> {
        let named = |error| format!("{}: {error}", self.name);
        let layer = FillLayer::build(&self.name, self.regions, LOOK, palette::colors);
        let mut layer = layer.map_err(named)?;
        layer.can_be_closed = true;
        Ok(layer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bad_file_is_an_error_that_names_it() {
        let error = File::parse("bad.geojson", "{ not json").err().unwrap();
        assert!(error.starts_with("bad.geojson: "), "{error}");
    }
}
