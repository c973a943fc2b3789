//! The countries of the world.

use globefill::countries::Dataset;

use super::fill_layer::{FillLayer, Look};
use crate::host::palette;

const LOOK: Look = Look {
    visible: true,
    opacity: 0.75,
    hatch: None,
    spacing_px: 12.0,
    stroke_px: 1.0,
    z_index: 0,
};

pub fn build() -> Result<FillLayer, String> {
    let countries = Dataset::Countries50m.countries().into_iter();
    let named = countries.map(|country| (country.name.to_owned(), country.region));
    FillLayer::build("Countries", named.collect(), LOOK, palette::colors)
        .map_err(|error| error.to_string())
}
