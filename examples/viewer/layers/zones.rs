//! Threat zones: made up, and bounded by true curves.

use globefill::{HatchKind, LonLat, Region, Zone};

use super::fill_layer::{FillLayer, Look};

const LOOK: Look = Look {
    visible: true,
    opacity: 1.0,
    hatch: Some(HatchKind::Lines),
    spacing_px: 11.0,
    stroke_px: 2.0,
    z_index: 10,
};

/// Linear red and amber, in turn.
const COLORS: [[f32; 4]; 2] = [[0.85, 0.04, 0.03, 0.2], [1.0, 0.42, 0.02, 0.2]];

pub fn build() -> Result<FillLayer, String> {
    let at = LonLat::new;
    let route = vec![
        at(-5.0, 36.0),
        at(5.0, 38.5),
        at(12.0, 37.0),
        at(25.0, 34.5),
    ];
    let city = at(11.5755, 48.1372);
    let zones = [
        ("Battery, 150 km", Zone::circle(at(2.5, 46.8), 150e3)),
        ("Battery, 90 km", Zone::circle(at(13.2, 52.3), 90e3)),
        (
            "Ring, 200–400 km",
            Zone::annulus(at(30.0, 60.0), 200e3, 400e3),
        ),
        (
            "Radar sector",
            Zone::sector(at(20.0, 30.0), 50e3, 700e3, 100.0, 190.0),
        ),
        ("Corridor, 120 km", Zone::corridor(route, 120e3)),
        ("Guard, 60 m", Zone::circle(city, 60.0)),
        (
            "No flight, 1.5 km",
            Zone::circle(at(11.605, 48.152), 1_500.0),
        ),
        (
            "Radar, 1–3 km",
            Zone::annulus(at(11.535, 48.165), 1_000.0, 3_000.0),
        ),
        (
            "Approach",
            Zone::sector(at(11.55, 48.115), 500.0, 4_000.0, 95.0, 160.0),
        ),
    ];
    let named = zones.map(|(name, zone)| (name.to_owned(), Region::from(zone)));
    FillLayer::build("Threat zones", named.into(), LOOK, |mesh| {
        let colors = COLORS.iter().copied().cycle();
        colors.take(mesh.fills.len()).collect()
    })
    .map_err(|error| error.to_string())
}
