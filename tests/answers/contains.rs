//! Which fills contain a point, judged by the oracle of the pixel tests.

use globefill::{EdgeKind, Ellipsoid, FillMesh, Inside, Locator, LonLat, Region};

use crate::{
    build,
    common::oracle::{Oracle, Scratch},
    countries_50m, region, spread, spread_positions,
};

/// Points `offset_m` to the left of the middle parts of curves, in longitude and latitude.
fn beside_curves(mesh: &FillMesh, every: usize, offset_m: f64) -> Vec<LonLat> {
    let curves = mesh.curves.iter().step_by(every).enumerate();
    curves
        .map(|(index, curve)| {
            let curve = curve.on(&mesh.ellipsoid);
            let t = 0.1 + 0.8 * (index as f64 * 0.618_033_988_749_895).fract();
            let (here_m, ahead_m) = (curve.ecef(t), curve.ecef(t + 1e-3));
            let up = mesh.ellipsoid.normal_at_surface(here_m);
            let left = up.cross(ahead_m - here_m).normalize();
            mesh.ellipsoid.geodetic(here_m + left * offset_m).0
        })
        .collect()
}

fn judge(regions: &[Region], mesh: &FillMesh, points: impl Iterator<Item = LonLat>) -> usize {
    let oracle = Oracle::new(regions, Ellipsoid::WGS84);
    let locator = Locator::new(mesh);
    let mut scratch = Scratch::default();
    let mut covered = 0;
    for point in points {
        let fills = locator.fills_at(point);
        assert_eq!(fills, oracle.containing(point, &mut scratch), "{point:?}");
        covered += fills.len();
        for fill in 0..mesh.fills.len().min(3) as u32 {
            assert_eq!(locator.contains(fill, point), fills.contains(&fill));
        }
    }
    covered
}

#[test]
fn countries_contain_what_the_oracle_says_down_to_millimetres() {
    let (regions, mesh) = countries_50m();
    let near = [1e-3, -1e-3, 2e-5, -2e-5]
        .into_iter()
        .flat_map(|offset_m| beside_curves(mesh, 11, offset_m));
    let covered = judge(regions, mesh, spread_positions(10_000).chain(near));
    assert!(covered > 10_000, "{covered}");
}

/// Shapes over poles, the antimeridian and more than a hemisphere, which overlap.
fn shapes(kind: EdgeKind) -> Vec<Region> {
    let polar = [(-170.0, 60.0), (-60.0, 70.0), (50.0, 65.0), (140.0, 75.0)];
    let south = [(150.0, -60.0), (40.0, -70.0), (-70.0, -65.0)];
    let pacific = [
        (160.0, -30.0),
        (-150.0, -20.0),
        (-140.0, 40.0),
        (170.0, 30.0),
    ];
    let at_pole = [(20.0, 50.0), (100.0, 55.0), (100.0, 90.0), (20.0, 90.0)];
    let over = [(10.0, 80.0), (10.0, 40.0), (-100.0, 35.0), (-170.0, 80.0)];
    let smaller = |shell: &[(f64, f64)]| region(kind, Inside::Smaller, shell);
    let left = |shell: &[(f64, f64)]| region(kind, Inside::LeftOfRing, shell);
    let backwards: Vec<_> = pacific.iter().rev().copied().collect();
    let mut regions = vec![
        smaller(&polar),
        smaller(&south),
        left(&backwards),
        smaller(&pacific),
        smaller(&at_pole),
        left(&over),
    ];
    let hole = [(-80.0, 80.0), (40.0, 82.0), (130.0, 84.0)];
    let hole = hole.map(|(lon, lat)| LonLat::new(lon, lat)).to_vec();
    regions[0].polygons[0].holes.push(hole);
    regions
}

#[test]
fn every_kind_of_edge_is_told_at_poles_and_antimeridian() {
    for kind in [EdgeKind::Straight, EdgeKind::Rhumb, EdgeKind::Geodesic] {
        let regions = shapes(kind);
        let mesh = build(&regions);
        let near = [1.0, -1.0, 1e-3, -1e-3]
            .into_iter()
            .flat_map(|offset_m| beside_curves(&mesh, 1, offset_m));
        let polar = spread(300).map(|(x, y)| LonLat::new(360.0 * x, 90.0 - 1e-3 * y * y));
        let covered = judge(
            &regions,
            &mesh,
            spread_positions(3_000).chain(near).chain(polar),
        );
        assert!(covered > 3_000, "{kind:?} {covered}");
    }
}

#[test]
fn as_many_points_lie_in_a_fill_as_its_area_holds() {
    let globe_m2 = 510_065_621_724_088.44;
    for kind in [EdgeKind::Straight, EdgeKind::Rhumb, EdgeKind::Geodesic] {
        let mesh = build(&shapes(kind));
        let locator = Locator::new(&mesh);
        let mut counts = vec![0; mesh.fills.len()];
        for point in spread_positions(10_000) {
            for fill in locator.fills_at(point) {
                counts[fill as usize] += 1;
            }
        }
        for (fill, count) in counts.into_iter().enumerate() {
            let share = mesh.area_m2(fill as u32) / globe_m2;
            // The points are even in geodetic latitude, the share is not: 0.3 %.
            let error = (f64::from(count) / 1e4 - share).abs();
            assert!(
                error < 0.005,
                "{kind:?} {fill}: {count} of 10 000 for {share}"
            );
        }
    }
}

#[test]
fn every_point_of_a_partition_lies_in_exactly_one_fill() {
    for kind in [EdgeKind::Straight, EdgeKind::Rhumb] {
        let mut regions = Vec::new();
        let (columns, rows) = (8, 6);
        let lon = |k: i32| f64::from(k) * 45.0 - 180.0;
        let lat = |k: i32| f64::from(k) * 30.0 - 90.0;
        for (k, j) in (0..columns).flat_map(|k| (0..rows).map(move |j| (k, j))) {
            let (west, east, south, north) = (lon(k), lon(k + 1), lat(j), lat(j + 1));
            let shell = [(west, south), (east, south), (east, north), (west, north)];
            regions.push(region(kind, Inside::Smaller, &shell));
        }
        let mesh = build(&regions);
        let locator = Locator::new(&mesh);
        // Nodes, points on every edge, and poles by many names.
        for k in 0..=64 {
            for j in 0..=48 {
                let point = LonLat::new(f64::from(k) * 5.625 - 180.0, f64::from(j) * 3.75 - 90.0);
                let fills = locator.fills_at(point);
                assert_eq!(fills.len(), 1, "{kind:?} {point:?} {fills:?}");
                let other = LonLat::new(point.lon_deg + 720.0, point.lat_deg);
                assert_eq!(locator.fills_at(other), fills);
            }
        }
        let sum_m2: f64 = (0..regions.len() as u32)
            .map(|fill| mesh.area_m2(fill))
            .sum();
        assert!((sum_m2 / 510_065_621_724_088.44 - 1.0).abs() < 1e-12);
    }
}

#[test]
fn no_vertex_of_the_countries_lies_in_two() {
    let (_, mesh) = countries_50m();
    assert_eq!(mesh.overlaps, []);
    let locator = Locator::new(mesh);
    let mut covered = 0;
    for curve in &mesh.curves {
        let fills = locator.fills_at(curve.from);
        assert!(fills.len() <= 1, "{curve:?} {fills:?}");
        covered += fills.len();
    }
    // A coast counts as land about half of the time.
    let share = covered as f64 / mesh.curves.len() as f64;
    assert!((0.5..0.8).contains(&share), "{share}");
}

#[test]
fn geodesic_neighbours_share_no_point_of_their_border() {
    // Eight triangles round a point, joined by geodesics.
    let rim: Vec<_> = (0..8)
        .map(|k| (f64::from(k) * 45.0).to_radians().sin_cos())
        .map(|(sin, cos)| (175.0 + 20.0 * sin, 50.0 + 15.0 * cos))
        .collect();
    let middle = (175.0, 50.0);
    let regions: Vec<Region> = (0..8)
        .map(|k| {
            let shell = [middle, rim[k], rim[(k + 1) % 8]];
            region(EdgeKind::Geodesic, Inside::Smaller, &shell)
        })
        .collect();
    let mesh = build(&regions);
    assert_eq!(mesh.overlaps, []);
    let locator = Locator::new(&mesh);
    for curve in mesh
        .curves
        .iter()
        .filter(|curve| [curve.from, curve.to].contains(&LonLat::new(middle.0, middle.1)))
    {
        let curve = curve.on(&mesh.ellipsoid);
        for k in 0..1000 {
            let t = 0.02 + 0.96 * f64::from(k) / 1000.0;
            assert_eq!(locator.fills_at(curve.lon_lat(t)).len(), 1, "{t}");
        }
    }
    assert_eq!(locator.fills_at(LonLat::new(middle.0, middle.1)).len(), 1);
}

#[test]
fn a_belt_is_the_smaller_side_of_its_two_parallels() {
    let belt = |inside, south: f64, north: f64| {
        let corners = [
            (-180.0, south),
            (180.0, south),
            (180.0, north),
            (-180.0, north),
        ];
        region(EdgeKind::Straight, inside, &corners)
    };
    let mut lake = belt(Inside::Smaller, -30.0, 20.0);
    let hole = [(10.0, 0.0), (20.0, 0.0), (15.0, 10.0)];
    let hole = hole.map(|(lon, lat)| LonLat::new(lon, lat));
    lake.polygons[0].holes.push(hole.to_vec());
    let regions = [
        belt(Inside::Smaller, -10.0, 10.0),
        belt(Inside::LeftOfRing, -10.0, 10.0),
        belt(Inside::Smaller, 40.0, 50.0),
        // Twice 13 % lie beyond.
        belt(Inside::Smaller, -60.0, 60.0),
        belt(Inside::LeftOfRing, -60.0, 60.0),
        lake,
    ];
    let mesh = build(&regions);
    judge(&regions, &mesh, spread_positions(2_000));
    let share = |fill| mesh.area_m2(fill) / 510_065_621_724_088.44;
    assert!((share(0) - 0.172_895_253_885_784).abs() < 1e-12);
    assert!((share(0) / share(1) - 1.0).abs() < 1e-12);
    assert!((share(3) + share(4) - 1.0).abs() < 1e-12);
}

#[test]
fn what_is_no_position_lies_nowhere() {
    let shell = [(0.0, 0.0), (10.0, 0.0), (5.0, 8.0)];
    let mesh = build(&[region(EdgeKind::Geodesic, Inside::Smaller, &shell)]);
    let locator = Locator::new(&mesh);
    for (lon_deg, lat_deg) in [
        (f64::NAN, 1.0),
        (1.0, f64::NAN),
        (5.0, 91.0),
        (f64::INFINITY, 0.0),
    ] {
        assert_eq!(locator.fills_at(LonLat::new(lon_deg, lat_deg)), [0; 0]);
        assert!(!locator.contains(0, LonLat::new(lon_deg, lat_deg)));
    }
    assert!(locator.contains(0, LonLat::new(5.0, 4.0)));
    assert!(!locator.contains(1, LonLat::new(5.0, 4.0)));
    let empty = Locator::new(&FillMesh::default());
    assert_eq!(empty.fills_at(LonLat::new(5.0, 4.0)), [0; 0]);
}
