//! Any text: read as GeoJSON, refused with one line, or meshed where it is small.

#![no_main]

use globefill::{FillMesh, MeshOptions, Region, geo_json::regions_from_geojson};
use libfuzzer_sys::fuzz_target;

/// Texts with more vertices are read, not meshed.
const MOST_VERTICES: usize = 64;

fuzz_target!(
    init: globefill_fuzz::on_this_thread(),
    |bytes: &[u8]| {
        let Ok(text) = std::str::from_utf8(bytes) else {
            return;
        };
        let regions = match regions_from_geojson(text) {
            Ok(regions) => regions,
            Err(error) => {
                let message = error.to_string();
                assert!(!message.contains('\n') && message.len() < 2000, "{message:?}");
                return;
            }
        };
        let regions: Vec<Region> = regions.into_iter().map(|named| named.region).collect();
        let polygons = regions.iter().flat_map(|region| &region.polygons);
        let rings = polygons.flat_map(|polygon| polygon.holes.iter().chain([&polygon.shell]));
        if rings.map(Vec::len).sum::<usize>() <= MOST_VERTICES && is_narrow(&regions) {
            let _ = FillMesh::build(&regions, &MeshOptions { tolerance_m: 1e4, ..Default::default() });
        }
    }
);

/// Whether the rings are a few degrees wide: greater ones take milliseconds each, which the target
/// `regions` spends on them.
fn is_narrow(regions: &[Region]) -> bool {
    let polygons = regions.iter().flat_map(|region| &region.polygons);
    polygons
        .flat_map(|polygon| polygon.holes.iter().chain([&polygon.shell]))
        .all(|ring| {
            let spans = [
                ring.iter().map(|v| v.lon_deg).collect::<Vec<_>>(),
                ring.iter().map(|v| v.lat_deg).collect(),
            ];
            spans.iter().all(|span| {
                let low = span.iter().copied().fold(f64::INFINITY, f64::min);
                let high = span.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                !(high - low > 10.0 && high.abs() <= 1e3)
            })
        })
}
