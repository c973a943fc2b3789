//! One ring of many vertices: stars, combs, spirals and belts, with some vertices moved.

#![no_main]

use globefill::{FillMesh, Inside, LonLat, Region};
use globefill_fuzz::{
    laws,
    scene::{KINDS, Stage, is_clear_of_poles, options},
    source::Source,
};
use libfuzzer_sys::fuzz_target;

fuzz_target!(init: globefill_fuzz::on_this_thread(), |bytes: &[u8]| {
    let mut source = Source::new(bytes);
    let stage = Stage::read(&mut source);
    let options = options(&mut source);
    let shape = source.byte();
    let count = 3 + source.below(200);
    let (inner, turns) = (source.signed() / 127.0, f64::from(source.byte() & 7));
    let mut ring: Vec<LonLat> = (0..count)
        .map(|k| {
            let share = k as f64 / count as f64;
            let odd = k % 2 == 1;
            match shape & 3 {
                // A star, or a circle walked several times.
                0 => {
                    let reach = if odd { 8.0 * inner } else { 8.0 };
                    polar(&stage, reach, share * turns.max(1.0))
                }
                // A comb: long teeth, as thin as the count makes them.
                1 => stage.at(16.0 * share - 8.0, if odd { 8.0 * inner } else { 8.0 }),
                // A spiral out, and back on nearly the same way.
                2 => {
                    let out = if share < 0.5 { 2.0 * share } else { 2.0 - 2.0 * share };
                    let aside = if share < 0.5 { 0.0 } else { inner };
                    polar(&stage, 7.0 * out + aside, out * turns)
                }
                // Round the globe.
                _ => LonLat::new(360.0 * share - 180.0, stage.at(0.0, if odd { inner } else { 1.0 }).lat_deg),
            }
        })
        .collect();
    while !source.is_empty() {
        let moved = source.below(count);
        let step = [source.signed(), source.signed()].map(|x| x / 64.0);
        let aside = stage.scale_deg;
        let vertex = &mut ring[moved];
        vertex.lon_deg += step[0] * aside;
        vertex.lat_deg = (vertex.lat_deg + step[1] * aside).clamp(-90.0, 90.0);
    }
    let mut region = Region::ring(ring, KINDS[usize::from(shape >> 2) % 3]);
    if shape >> 6 == 3 {
        region.inside = Inside::LeftOfRing;
    }
    let regions = [region];
    globefill_fuzz::show(&options, &regions);
    if let Ok(mesh) = FillMesh::build(&regions, &options) {
        laws::check(&mesh, &options);
        if is_clear_of_poles(&regions) {
            laws::check_covering(&mesh, stage.probes());
        }
    }
});

fn polar(stage: &Stage, reach: f64, turns: f64) -> LonLat {
    let (sin, cos) = (turns * std::f64::consts::TAU).sin_cos();
    stage.at(reach * cos, reach * sin)
}
