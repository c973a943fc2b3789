use rustc_hash::FxHashSet;

use super::*;

const DATASETS: [Dataset; 3] = [
    Dataset::Countries110m,
    Dataset::Countries50m,
    Dataset::UsStates,
];

fn rings(countries: &[Country]) -> impl Iterator<Item = &Ring> {
    countries
        .iter()
        .flat_map(|country| &country.region.polygons)
        .flat_map(|polygon| std::iter::once(&polygon.shell).chain(&polygon.holes))
}

fn bits(vertex: LonLat) -> [u64; 2] {
    [vertex.lon_deg.to_bits(), vertex.lat_deg.to_bits()]
}

/// The undirected edges of a country, by the bits of their ends.
fn edges(country: &Country) -> FxHashSet<[[u64; 2]; 2]> {
    rings(std::slice::from_ref(country))
        .flat_map(|ring| ring.windows(2))
        .map(|edge| {
            let mut ends = [bits(edge[0]), bits(edge[1])];
            ends.sort_unstable();
            ends
        })
        .collect()
}

#[test]
fn the_counts_are_the_sources() {
    let counts = DATASETS.map(|dataset| {
        let countries = dataset.countries();
        let vertices: usize = rings(&countries).map(|ring| ring.len() - 1).sum();
        (countries.len(), rings(&countries).count(), vertices)
    });
    assert_eq!(
        counts,
        [(177, 289, 10_365), (242, 1_632, 97_981), (56, 304, 14_148)]
    );
}

#[test]
fn rings_are_closed_and_in_range() {
    for dataset in DATASETS {
        let countries = dataset.countries();
        for ring in rings(&countries) {
            assert_eq!(bits(ring[0]), bits(ring[ring.len() - 1]), "{dataset:?}");
            assert!(ring.len() >= 4, "{dataset:?}: {ring:?}");
            assert!(
                ring.iter()
                    .all(|v| v.lon_deg.abs() <= 180.0 && v.is_valid()),
                "{dataset:?}: {ring:?}"
            );
        }
    }
}

#[test]
fn the_antimeridian_and_the_pole_are_exact() {
    let countries = Dataset::Countries110m.countries();
    let mut extremes = [0; 3];
    for vertex in rings(&countries).flatten() {
        extremes[0] += usize::from(vertex.lon_deg == 180.0);
        extremes[1] += usize::from(vertex.lon_deg == -180.0);
        extremes[2] += usize::from(vertex.lat_deg == -90.0);
    }
    assert!(extremes.iter().all(|&count| count > 0), "{extremes:?}");
}

#[test]
fn source_coordinates_are_kept() {
    // As printed from the shapefiles: Zimbabwe's first vertex of 50m, one of Fiji's of 110m.
    for (dataset, name, lon_deg, lat_deg) in [
        (
            Dataset::Countries50m,
            "Zimbabwe",
            31.287890625000017,
            -22.40205078125001,
        ),
        (
            Dataset::Countries110m,
            "Fiji",
            -179.79332010904864,
            -16.020882256741224,
        ),
    ] {
        let country = dataset.country(name).unwrap();
        let nearest = rings(std::slice::from_ref(&country))
            .flatten()
            .map(|v| (v.lon_deg - lon_deg).abs().max((v.lat_deg - lat_deg).abs()))
            .fold(f64::INFINITY, f64::min);
        assert!(nearest < 4e-13, "{name}: {nearest:e}");
    }
}

#[test]
fn neighbours_share_edges_bit_for_bit() {
    for (dataset, here, there, at_least) in [
        (Dataset::Countries110m, "France", "Germany", 3),
        (Dataset::Countries50m, "France", "Germany", 30),
        // An enclave: one arc, the ring of one and a hole of the other.
        (Dataset::Countries50m, "Lesotho", "South Africa", 50),
        (Dataset::UsStates, "California", "Nevada", 5),
    ] {
        let [here, there] = [here, there].map(|name| edges(&dataset.country(name).unwrap()));
        let shared = here.intersection(&there).count();
        assert!(shared >= at_least, "{dataset:?}: {shared} shared edges");
    }
    let lesotho = edges(&Dataset::Countries50m.country("LS").unwrap());
    let south_africa = edges(&Dataset::Countries50m.country("ZA").unwrap());
    assert!(lesotho.is_subset(&south_africa));
}

#[test]
fn names_and_codes_are_found_in_any_case() {
    for (dataset, names) in [
        (Dataset::UsStates, ["California", "CALIFORNIA", "ca", "06"]),
        (Dataset::Countries110m, ["France", "fr", "FRA", " france "]),
        (Dataset::Countries50m, ["Åland", "åland", "aland", "ÅLAND"]),
        (
            Dataset::Countries50m,
            [
                "Dem. Rep. Congo",
                "democratic republic of the congo",
                "CD",
                "cod",
            ],
        ),
    ] {
        let found = names.map(|name| dataset.country(name).map(|country| country.name));
        assert_eq!(found, [Some(names[0]); 4]);
    }
    assert_eq!(Dataset::UsStates.country("Atlantis"), None);
    assert_eq!(Dataset::Countries50m.country(""), None);
}

#[test]
fn names_and_codes_are_unique() {
    for dataset in DATASETS {
        let countries = dataset.countries();
        for (index, country) in countries.iter().enumerate() {
            let names = [country.name, country.long_name, country.long_code];
            for name in names.into_iter().chain(country.short_code) {
                let found = countries.iter().position(|other| other.is_called(name));
                assert_eq!(found, Some(index), "{dataset:?}: {name}");
            }
        }
    }
}

#[test]
fn a_damaged_file_is_refused() {
    let whole: &'static [u8] = include_bytes!("../../assets/boundaries/us-states-10m.arcs");
    assert!(decode(whole).is_some());
    assert!(decode(&whole[1..]).is_none());
    for length in (0..whole.len()).step_by(997) {
        assert!(decode(&whole[..length]).is_none(), "cut to {length} bytes");
    }
    // Bytes changed anywhere decode to something or to nothing, but never panic or hang.
    for at in (4..whole.len()).step_by(1511) {
        let mut damaged = whole.to_vec();
        damaged[at] ^= 0xff;
        let _ = decode(damaged.leak());
    }
}
