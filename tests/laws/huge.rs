//! Inputs of many vertices, rings, holes, parts and fills keep the laws, and answer as formulas do.
//!
//! Small here; the same in large, ignored as they take a minute and gigabytes:
//! `cargo test --release --test laws huge -- --ignored`. Times and memory: `examples/stress`.

use std::f64::consts::TAU;

use globefill::{EdgeKind, Inside, Locator, LonLat, Polygon, Region, Ring};

use crate::law::{KINDS, build, check_arcs, check_pieces_are_closed};

/// An irrational share of 1, another one for each number.
fn chance(seed: u32) -> f64 {
    (f64::from(seed) * 0.618_033_988_749_894_9 + 0.3).fract()
}

/// Vertices at even angles about a centre, counter-clockwise from east, on the lon/lat plane.
fn star(centre: (f64, f64), count: u32, radius_deg: impl Fn(u32) -> f64) -> Ring {
    let vertex = |k| {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(count)).sin_cos();
        LonLat::new(
            centre.0 + radius_deg(k) * cos,
            centre.1 + radius_deg(k) * sin,
        )
    };
    (0..count).map(vertex).collect()
}

/// Whether a star about `centre` contains a place: the edge at its angle tells.
fn star_contains(star: &Ring, centre: (f64, f64), place: (f64, f64)) -> bool {
    let angle = (place.1 - centre.1).atan2(place.0 - centre.0);
    let index = (angle.rem_euclid(TAU) / TAU * star.len() as f64) as usize;
    let (a, b) = (star[index % star.len()], star[(index + 1) % star.len()]);
    (b.lon_deg - a.lon_deg) * (place.1 - a.lat_deg)
        > (b.lat_deg - a.lat_deg) * (place.0 - a.lon_deg)
}

fn region(edges: EdgeKind, polygons: Vec<Polygon>) -> Region {
    Region {
        polygons,
        edges,
        inside: Inside::Smaller,
        zones: Vec::new(),
    }
}

fn polygon(shell: Ring, holes: Vec<Ring>) -> Polygon {
    Polygon { shell, holes }
}

/// Builds, checks the laws (all of them for small meshes) and asks the locator.
fn check(regions: &[Region], places: u32, fills_at: impl Fn((f64, f64)) -> Vec<u32>) {
    let vertices =
        |polygon: &Polygon| polygon.shell.len() + polygon.holes.iter().map(Vec::len).sum::<usize>();
    let polygons = regions.iter().flat_map(|region| &region.polygons);
    let mesh = if polygons.map(vertices).sum::<usize>() <= 20_000 {
        build(regions)
    } else {
        let mesh = globefill::FillMesh::build(regions, &Default::default()).unwrap();
        check_arcs(&mesh);
        check_pieces_are_closed(&mesh);
        mesh
    };
    assert_eq!(mesh.overlaps, []);
    assert_eq!(mesh.fills.len(), regions.len());
    for (fill, measures) in (0_u32..).zip(mesh.all_measures()) {
        if fill % 97 == 0 {
            assert_eq!(measures, mesh.measures(fill));
        }
    }
    let locator = Locator::new(&mesh);
    for k in 0..places {
        let place = (80.0 * chance(k) - 40.0, 80.0 * chance(k * k + 7) - 40.0);
        let found = locator.fills_at(LonLat::new(place.0, place.1));
        assert_eq!(found, fills_at(place), "{place:?}");
    }
}

/// A rough ring round (0, 0).
fn check_ring(count: u32) {
    let radius_deg = |k: u32| {
        let angle = TAU * f64::from(k) / f64::from(count);
        let wave =
            |octave: u32| 0.6_f64.powi(octave as i32) * (f64::from(3 << octave) * angle).sin();
        30.0 + 3.0 * (0..12).map(wave).sum::<f64>()
    };
    let ring = star((0.0, 0.0), count, radius_deg);
    let regions = [region(
        EdgeKind::Straight,
        vec![polygon(ring.clone(), Vec::new())],
    )];
    let fills_at = |place| match star_contains(&ring, (0.0, 0.0), place) {
        true => vec![0],
        false => Vec::new(),
    };
    check(&regions, 2_000, fills_at);
}

/// A box of ±40° with a grid of octagons: its holes, or parts of a multipolygon.
fn check_octagons(side: u32, are_holes: bool) {
    let step_deg = 80.0 / f64::from(side);
    let centre =
        |cell: (u32, u32)| [cell.0, cell.1].map(|k| (f64::from(k) + 0.5) * step_deg - 40.0);
    let octagon = |cell: (u32, u32)| {
        let [x, y] = centre(cell);
        let radius_deg = step_deg * (0.1 + 0.35 * chance(cell.0 * 31 + cell.1));
        star((x, y), 8, |_| radius_deg)
    };
    let cells = (0..side * side).map(|k| (k % side, k / side));
    let octagons: Vec<Ring> = cells.map(octagon).collect();
    let square = [(-40.0, -40.0), (40.0, -40.0), (40.0, 40.0), (-40.0, 40.0)];
    let square = square.map(|(x, y)| LonLat::new(x, y)).to_vec();
    let polygons = match are_holes {
        true => vec![polygon(square, octagons)],
        false => octagons
            .into_iter()
            .map(|shell| polygon(shell, Vec::new()))
            .collect(),
    };
    let fills_at = |place: (f64, f64)| {
        let cell = [place.0, place.1].map(|x| ((x + 40.0) / step_deg) as u32);
        let [x, y] = centre((cell[0], cell[1]));
        let is_in = star_contains(&octagon((cell[0], cell[1])), (x, y), place);
        match is_in != are_holes {
            true => vec![0],
            false => Vec::new(),
        }
    };
    check(&[region(EdgeKind::Straight, polygons)], 2_000, fills_at);
}

/// Slices of a pie about (0, 0): all meet in one vertex, and each shares its sides with two others.
fn check_pie(slices: u32, steps: u32, edges: EdgeKind) {
    let side = |slice: u32, step: u32| {
        let (sin, cos) = (TAU * f64::from(slice % slices) / f64::from(slices)).sin_cos();
        let radius_deg = 30.0 * f64::from(step) / f64::from(steps);
        LonLat::new(radius_deg * cos, radius_deg * sin)
    };
    let slice = |slice: u32| {
        let out = (0..=steps).map(|step| side(slice, step));
        let back = (1..=steps).rev().map(|step| side(slice + 1, step));
        region(edges, vec![polygon(out.chain(back).collect(), Vec::new())])
    };
    let regions: Vec<Region> = (0..slices).map(slice).collect();
    // Curved edges leave the plane's straight lines: asked in the middle of slices only.
    let fills_at = |place: (f64, f64)| {
        let angle = place.1.atan2(place.0).rem_euclid(TAU) / TAU;
        let index = (angle * f64::from(slices)) as u32;
        let rim =
            [side(index, steps), side(index + 1, steps)].map(|end| (end.lon_deg, end.lat_deg));
        let left = (rim[1].0 - rim[0].0) * (place.1 - rim[0].1)
            - (rim[1].1 - rim[0].1) * (place.0 - rim[0].0);
        if left > 0.0 { vec![index] } else { Vec::new() }
    };
    let places = if edges == EdgeKind::Straight {
        2_000
    } else {
        0
    };
    check(&regions, places, fills_at);
}

#[test]
fn a_huge_ring() {
    check_ring(10_000);
}

#[test]
fn many_holes_and_many_parts() {
    check_octagons(30, true);
    check_octagons(30, false);
}

#[test]
fn many_fills_meet_in_one_vertex() {
    for edges in KINDS {
        check_pie(300, 6, edges);
    }
}

#[test]
#[ignore = "a million vertices"]
fn a_huge_ring_in_large() {
    check_ring(1_000_000);
}

#[test]
#[ignore = "190 000 holes, then parts"]
fn many_holes_and_many_parts_in_large() {
    check_octagons(436, true);
    check_octagons(436, false);
}

#[test]
#[ignore = "20 000 fills"]
fn many_fills_meet_in_one_vertex_in_large() {
    check_pie(20_000, 6, EdgeKind::Straight);
}
