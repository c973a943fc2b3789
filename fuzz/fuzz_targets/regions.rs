//! One or two regions of nasty rings or zones, meshed and asked.

#![no_main]

use globefill::{EdgeKind, FillMesh, Inside, Region};
use globefill_fuzz::{
    laws,
    scene::{self, Stage},
    source::Source,
};
use libfuzzer_sys::fuzz_target;

fuzz_target!(init: globefill_fuzz::on_this_thread(), |bytes: &[u8]| {
    let mut source = Source::new(bytes);
    let stage = Stage::read(&mut source);
    let options = scene::options(&mut source);
    let asks = source.byte();
    let count = 1 + usize::from(asks & 1);
    let regions: Vec<Region> =
        (0..count).map(|_| scene::region(&mut source, &stage, &options.ellipsoid)).collect();
    globefill_fuzz::show(&options, &regions);
    let Ok(mesh) = FillMesh::build(&regions, &options) else {
        return;
    };
    laws::check(&mesh, &options);
    if scene::is_clear_of_poles(&regions) {
        laws::check_covering(&mesh, stage.probes());
    }
    if let [region] = &regions[..]
        && let Some(ring) = plane_ring(&stage, region)
    {
        laws::check_plane(&mesh, ring, stage.probes());
    }
    if asks & 6 == 6 {
        laws::check_answers(&mesh);
    }
});

/// The ring of a region that the plane can judge.
fn plane_ring<'a>(stage: &Stage, region: &'a Region) -> Option<&'a globefill::Ring> {
    let [polygon] = &region.polygons[..] else {
        return None;
    };
    let is_plain = polygon.holes.is_empty()
        && region.zones.is_empty()
        && region.edges == EdgeKind::Straight
        && region.inside == Inside::Smaller
        && !stage.goes_afar
        && stage.scale_deg > 1e-8;
    let is_tame = polygon.shell.iter().all(|vertex| {
        vertex.lat_deg.abs() < 80.0 && (vertex.lon_deg - stage.centre.lon_deg).abs() < 85.0
    });
    (is_plain && is_tame && stage.centre.lon_deg.abs() < 600.0).then_some(&polygon.shell)
}
