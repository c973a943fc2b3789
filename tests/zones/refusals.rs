//! Typed errors.

use globefill::{Ellipsoid, FillMesh, MeshOptions, RegionError, Zone, ZoneError};

use crate::subjects::at;

fn refusal(zone: Zone) -> ZoneError {
    assert!(zone.check(&Ellipsoid::WGS84).is_err(), "{zone:?}");
    match FillMesh::build(&[zone.into()], &MeshOptions::default()) {
        Err(RegionError::Zone { error, .. }) => error,
        other => panic!("{:?}", other.map(|mesh| mesh.arcs.len())),
    }
}

#[test]
fn what_means_nothing_is_refused() {
    let here = at(10.0, 50.0);
    for radius_m in [f64::NAN, -1.0, 0.0, 1e-3, 1.99e7, f64::INFINITY] {
        assert!(matches!(
            refusal(Zone::circle(here, radius_m)),
            ZoneError::Range { .. }
        ));
        let width_m = 2.0 * radius_m;
        let line = vec![here, at(11.0, 50.0)];
        assert!(matches!(
            refusal(Zone::corridor(line, width_m)),
            ZoneError::Range { .. }
        ));
    }
    for position in [
        at(f64::NAN, 0.0),
        at(0.0, 91.0),
        at(0.0, f64::NAN),
        at(f64::INFINITY, 0.0),
    ] {
        assert!(matches!(
            refusal(Zone::circle(position, 1e3)),
            ZoneError::Position { .. }
        ));
        let line = vec![here, position];
        let error = refusal(Zone::corridor(line, 1e3));
        assert!(matches!(error, ZoneError::Position { point: 1, .. }));
    }
    let upside_down = Zone::annulus(here, 2e3, 1e3);
    assert!(matches!(refusal(upside_down), ZoneError::EmptyRange { .. }));
    assert!(matches!(
        refusal(Zone::annulus(here, -1.0, 1e3)),
        ZoneError::Range { .. }
    ));
    for (from_deg, to_deg) in [(f64::NAN, 1.0), (1.0, f64::INFINITY), (0.0, 1e-12)] {
        let sector = Zone::sector(here, 0.0, 1e3, from_deg, to_deg);
        assert!(matches!(refusal(sector), ZoneError::Azimuths { .. }));
    }
    assert_eq!(
        refusal(Zone::corridor(Vec::new(), 1e3)),
        ZoneError::NoPoints
    );
    let antipodal = vec![at(0.0, 10.0), at(90.0, 0.0), at(-90.1, 0.1)];
    assert_eq!(
        refusal(Zone::corridor(antipodal, 1e3)),
        ZoneError::AntipodalLeg { leg: 1 }
    );
}
