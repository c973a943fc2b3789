//! Which fills of a file contain a point: every edge asked, on the plane of longitude and latitude.
//!
//! Independent of the crate, and good for polygons that are cut at ±180° and whose inside is finite on
//! that plane, as RFC 7946 asks for.

use globefill::{LonLat, Region, Ring};

use crate::synthetic::Chance;

/// Points all over the globe, and as many close to vertices.
pub fn places(regions: &[Region], count: usize) -> Vec<LonLat> {
    let mut chance = Chance::new(7);
    let polygons = regions.iter().flat_map(|region| &region.polygons);
    let rings: Vec<&Ring> = polygons
        .flat_map(|polygon| std::iter::once(&polygon.shell).chain(&polygon.holes))
        .collect();
    (0..count)
        .map(|index| {
            if index % 2 == 0 {
                let lat_deg = chance.between(-1.0, 1.0).asin().to_degrees();
                return LonLat::new(chance.between(-180.0, 180.0), lat_deg);
            }
            let ring = rings[chance.below(rings.len())];
            let vertex = ring[chance.below(ring.len())];
            let [east, north] = [0; 2].map(|_| chance.between(-1e-3, 1e-3));
            let lon_deg = (vertex.lon_deg + east).clamp(-180.0, 180.0);
            LonLat::new(lon_deg, (vertex.lat_deg + north).clamp(-90.0, 90.0))
        })
        .collect()
}

/// Twice the area to the left of a ring.
pub fn twice_area(ring: &Ring) -> f64 {
    let edges = ring.iter().zip(ring.iter().cycle().skip(1));
    edges
        .map(|(a, b)| (a.lon_deg - b.lon_deg) * (a.lat_deg + b.lat_deg))
        .sum()
}

/// The fills at each place, ascending.
pub fn fills_at(regions: &[Region], places: &[LonLat]) -> Vec<Vec<u32>> {
    let mut fills: Vec<Vec<u32>> = vec![Vec::new(); places.len()];
    // By longitude, so that an edge finds those above or below it.
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_by(|&a, &b| places[a].lon_deg.total_cmp(&places[b].lon_deg));
    let mut crossings = vec![0_u32; places.len()];
    let mut touched = Vec::new();
    for (fill, region) in regions.iter().enumerate() {
        for polygon in &region.polygons {
            for ring in std::iter::once(&polygon.shell).chain(&polygon.holes) {
                for_each_crossing(ring, places, &order, |place| {
                    crossings[place] += 1;
                    touched.push(place);
                });
            }
            for place in touched.drain(..) {
                if std::mem::take(&mut crossings[place]) % 2 == 1 {
                    fills[place].push(fill as u32);
                }
            }
        }
    }
    for fills in &mut fills {
        fills.dedup();
    }
    fills
}

/// Calls `found` with every place due south of an edge, for each of these edges.
fn for_each_crossing(
    ring: &Ring,
    places: &[LonLat],
    order: &[usize],
    mut found: impl FnMut(usize),
) {
    for (index, a) in ring.iter().enumerate() {
        let b = &ring[(index + 1) % ring.len()];
        let (west, east) = if a.lon_deg < b.lon_deg {
            (a, b)
        } else {
            (b, a)
        };
        let lon_deg = |place: &usize| places[*place].lon_deg;
        let first = order.partition_point(|place| lon_deg(place) < west.lon_deg);
        let beyond = order[first..]
            .iter()
            .take_while(|place| lon_deg(place) < east.lon_deg);
        for &place in beyond {
            let share = (places[place].lon_deg - west.lon_deg) / (east.lon_deg - west.lon_deg);
            if west.lat_deg + share * (east.lat_deg - west.lat_deg) > places[place].lat_deg {
                found(place);
            }
        }
    }
}
