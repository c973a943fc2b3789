//! Several regions that share vertices and borders. Each fill is what it is when meshed alone.

#![no_main]

use globefill::{FillMesh, Inside, Locator, LonLat, Polygon, Region, RegionError};
use globefill_fuzz::{
    laws,
    scene::{KINDS, Stage, is_clear_of_poles, options},
    source::Source,
};
use libfuzzer_sys::fuzz_target;

const MOST_REGIONS: usize = 5;

fuzz_target!(init: globefill_fuzz::on_this_thread(), |bytes: &[u8]| {
    let mut source = Source::new(bytes);
    let stage = Stage::read(&mut source);
    let options = options(&mut source);
    let points = stage.ring(&mut source, 14);
    let kind = source.of(&KINDS);
    let mut regions = Vec::new();
    while !source.is_empty() && regions.len() < MOST_REGIONS {
        let kinds = source.byte();
        let ring = |source: &mut Source| -> Vec<LonLat> {
            let count = 3 + source.below(6);
            (0..count).map(|_| points[source.below(points.len())]).collect()
        };
        let shell = ring(&mut source);
        let holes = (0..(kinds >> 6) % 3).map(|_| ring(&mut source)).collect();
        regions.push(Region {
            polygons: vec![Polygon { shell, holes }],
            // Mostly of one kind, so that borders are common.
            edges: if kinds & 15 == 15 { source.of(&KINDS) } else { kind },
            inside: if kinds & 48 == 48 { Inside::LeftOfRing } else { Inside::Smaller },
            zones: Vec::new(),
        });
    }
    globefill_fuzz::show(&options, &regions);
    let alone: Vec<Result<FillMesh, RegionError>> =
        regions.iter().map(|region| FillMesh::build(std::slice::from_ref(region), &options)).collect();
    let mesh = match FillMesh::build(&regions, &options) {
        Ok(mesh) => mesh,
        Err(error) => {
            // It was the ellipsoid, or all together are too many.
            let is_no_region =
                matches!(error, RegionError::InvalidEllipsoid { .. } | RegionError::Limit(_));
            assert!(is_no_region || alone.iter().any(Result::is_err), "only together: {error}");
            return;
        }
    };
    laws::check(&mesh, &options);
    if !is_clear_of_poles(&regions) {
        return;
    }
    laws::check_covering(&mesh, stage.probes());
    let locator = Locator::new(&mesh);
    for (fill, alone) in (0..).zip(&alone) {
        let alone = alone.as_ref().expect("it was meshed among others");
        let own = Locator::new(alone);
        for probe in stage.probes() {
            let point = mesh.ellipsoid.ecef(probe.canonical(), 0.0);
            if !laws::is_near_boundary(&mesh, point) && !laws::is_near_boundary(alone, point) {
                assert_eq!(locator.contains(fill, probe), own.contains(0, probe), "fill {fill} at {probe:?}");
            }
        }
    }
});
