//! Real countries and states, with their defects.

use std::collections::HashMap;

use globefill::{
    EdgeKind, Ellipsoid, FillMesh, RepairKind,
    countries::{Country, Dataset},
};

use crate::law::{build, countries, fill_area_m2, key, region_area_m2, smaller};

fn check_country_areas(countries: &[Country], mesh: &FillMesh) {
    for (index, country) in countries.iter().enumerate() {
        let expected_m2 = region_area_m2(&country.region);
        let found_m2 = fill_area_m2(mesh, index);
        let perimeter_m: f64 = country
            .region
            .polygons
            .iter()
            .flat_map(|polygon| std::iter::once(&polygon.shell).chain(&polygon.holes))
            .flat_map(|ring| ring.windows(2))
            .map(|pair| {
                Ellipsoid::WGS84
                    .ecef(pair[0], 0.0)
                    .distance(Ellipsoid::WGS84.ecef(pair[1], 0.0))
            })
            .sum();
        // No chord lies further beside its true edge than the tolerance.
        let bound_m2 = 5.0 * perimeter_m + 1e-6 * expected_m2;
        let error_m2 = (found_m2 - expected_m2).abs();
        assert!(
            error_m2 < bound_m2,
            "{}: {found_m2} for {expected_m2} m²",
            country.name
        );
    }
}

#[test]
fn countries_at_110m_are_closed_and_have_their_areas() {
    let (countries, mesh) = countries(Dataset::Countries110m);
    check_country_areas(&countries, &mesh);
    // Natural Earth's Sudan turns back on itself across its borders with Ethiopia and South Sudan.
    let name = |piece: u32| countries[mesh.pieces[piece as usize].fill as usize].name;
    let among = ["Sudan", "S. Sudan", "Ethiopia"];
    for &(a, b) in &mesh.overlaps {
        assert!(
            among.contains(&name(a)) && among.contains(&name(b)),
            "{} {}",
            name(a),
            name(b)
        );
    }
    let repaired = |kind: RepairKind| -> Vec<&str> {
        let found = mesh.repairs.iter().filter(|repair| repair.kind == kind);
        found
            .map(|repair| countries[repair.place.region].name)
            .collect()
    };
    assert_eq!(repaired(RepairKind::Crossing), ["Sudan"]);
    assert!(repaired(RepairKind::Seam).contains(&"Antarctica"));
}

#[test]
fn countries_at_50m_are_closed_disjoint_and_have_their_areas() {
    let (countries, mesh) = countries(Dataset::Countries50m);
    check_country_areas(&countries, &mesh);
    assert_eq!(mesh.overlaps, []);
    // The border is stored once: as many arcs have two sides as the atlas has borders and more.
    let named = |name: &str| {
        countries
            .iter()
            .position(|country| country.name == name)
            .unwrap()
    };
    let fill_of = |piece: Option<u32>| piece.map(|piece| mesh.pieces[piece as usize].fill as usize);
    let pair = [named("France"), named("Germany")];
    let common: Vec<_> = mesh
        .arcs
        .iter()
        .filter(|arc| {
            let sides = [fill_of(arc.left), fill_of(arc.right)];
            pair.iter().all(|&fill| sides.contains(&Some(fill)))
        })
        .collect();
    assert_eq!(common.len(), 1);
    let first = common[0].first_vertex as usize;
    let run = &mesh.vertices[first..first + common[0].vertex_count as usize];
    let border_m: f64 = run.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    assert!((300e3..450e3).contains(&border_m), "{border_m}");
    let mut seen: HashMap<([u64; 3], [u64; 3]), u32> = HashMap::new();
    for arc in &mesh.arcs {
        let first = arc.first_vertex as usize;
        for pair in mesh.vertices[first..first + arc.vertex_count as usize].windows(2) {
            let (a, b) = (key(pair[0]), key(pair[1]));
            let count = seen.entry((a.min(b), a.max(b))).or_default();
            *count += 1;
            assert_eq!(*count, 1, "a chord is stored once");
        }
    }
}

#[test]
fn states_of_the_us_are_closed_and_have_their_areas() {
    let (states, mesh) = countries(Dataset::UsStates);
    check_country_areas(&states, &mesh);
    assert_eq!(mesh.overlaps, []);
}

#[test]
fn antarctica_keeps_no_artificial_edge() {
    for dataset in [Dataset::Countries110m, Dataset::Countries50m] {
        let mesh = build(&[dataset.country("ATA").unwrap().region]);
        for (vertex, position) in mesh.boundary.iter().zip(&mesh.vertices) {
            let lat_deg = mesh.ellipsoid.geodetic(*position).0.lat_deg;
            // At 50m Natural Earth leaves out a disc of 120 m round the pole: that is an edge.
            let at_disc = (lat_deg + 89.998_925_8).abs() < 1e-6;
            assert!(lat_deg > -86.0 || at_disc, "{vertex:?} at {lat_deg}");
        }
        let south = mesh
            .pieces
            .iter()
            .filter(|piece| piece.bounds.axis.z < -0.9 && piece.bounds.radius_rad > 0.3);
        assert_eq!(south.count(), 1);
    }
}

#[test]
fn the_canadian_border_is_the_parallel() {
    let ring = [(-100.0, 45.0), (-97.0, 45.0), (-97.0, 49.0), (-100.0, 49.0)];
    let mesh = build(&[smaller(EdgeKind::Straight, &[&ring])]);
    let mut lowest_deg = 90.0_f64;
    for (index, vertex) in mesh.boundary.iter().enumerate() {
        let next = mesh
            .boundary
            .get(index + 1)
            .filter(|next| next.curve == vertex.curve);
        let curve = mesh.curves[vertex.curve as usize].on(&mesh.ellipsoid);
        let position = mesh.ellipsoid.geodetic(mesh.vertices[index]).0;
        if position.lat_deg > 48.9999 {
            assert!((position.lat_deg - 49.0).abs() < 1e-9);
            let middle = curve.lon_lat(0.5 * (vertex.t + next.map_or(1.0, |next| next.t)));
            if next.is_some() && curve.curve().from.lat_deg == curve.curve().to.lat_deg {
                lowest_deg = lowest_deg.min(middle.lat_deg);
            }
        }
    }
    assert_eq!(lowest_deg, 49.0);
}
