//! What the countries measure.

use std::f64::consts::PI;

use globefill::{
    Curve, FillMesh, Locator, LonLat, Outline, Region,
    countries::{Country, Dataset},
    glam::DVec3,
};

use crate::{build, common::figure::Figure, countries_50m};

fn countries(dataset: Dataset) -> (Vec<Country>, FillMesh) {
    let countries = dataset.countries();
    let regions: Vec<Region> = countries
        .iter()
        .map(|country| country.region.clone())
        .collect();
    let mesh = build(&regions);
    (countries, mesh)
}

/// −∮ q dλ over straight edges: what lies between a ring and the equator.
fn ring_area_m2(figure: &Figure, hemisphere_m2: f64, ring: &[LonLat]) -> f64 {
    // Gauss–Legendre with five nodes.
    const GAUSS: [(f64, f64); 5] = [
        (0.0, 0.568_888_888_888_888_9),
        (-0.538_469_310_105_683, 0.478_628_670_499_366_5),
        (0.538_469_310_105_683, 0.478_628_670_499_366_5),
        (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    // About the latitude of the first vertex, so that little cancels.
    let origin = figure.area_share(ring[0].lat_deg);
    ring.windows(2)
        .map(|pair| {
            let mean: f64 = GAUSS
                .iter()
                .map(|(node, weight)| {
                    let t = 0.5 + 0.5 * node;
                    let lat_deg = pair[0].lat_deg + t * (pair[1].lat_deg - pair[0].lat_deg);
                    0.5 * weight * (figure.area_share(lat_deg) - origin)
                })
                .sum();
            let mut turn_deg = pair[1].lon_deg - pair[0].lon_deg;
            if turn_deg.abs() > 180.0 && turn_deg.abs() < 360.0 {
                turn_deg -= 360.0 * turn_deg.signum();
            }
            -mean * turn_deg / 360.0 * hemisphere_m2
        })
        .sum()
}

#[test]
fn countries_have_the_area_between_their_edges_and_the_equator() {
    let (countries, mesh) = countries(Dataset::Countries110m);
    let figure = Figure::new(mesh.ellipsoid);
    let hemisphere_m2 = 0.5 * 510_065_621_724_088.44;
    let mut worst = 0.0_f64;
    for (fill, country) in countries.iter().enumerate() {
        // Sudan crosses itself; Antarctica has a pole.
        if ["Sudan", "Antarctica"].contains(&country.name) {
            continue;
        }
        let expected_m2: f64 = country
            .region
            .polygons
            .iter()
            .map(|polygon| {
                let area_m2 = |ring| ring_area_m2(&figure, hemisphere_m2, ring).abs();
                let holes_m2: f64 = polygon.holes.iter().map(|hole| area_m2(hole)).sum();
                area_m2(&polygon.shell) - holes_m2
            })
            .sum();
        let error = (mesh.area_m2(fill as u32) / expected_m2 - 1.0).abs();
        worst = worst.max(error);
        assert!(error < 1e-10, "{}: {error:e}", country.name);
    }
    println!("countries at 110m: relative error of areas up to {worst:e}");
}

/// The outline of all fills together: arcs with a piece on one side only.
fn union(mesh: &FillMesh) -> Outline<globefill::CurveOn> {
    let mut curves: Vec<Curve> = Vec::new();
    for arc in &mesh.arcs {
        let along = mesh.curves_along(arc);
        match (arc.left, arc.right) {
            (Some(_), None) => curves.extend(along),
            (None, Some(_)) => curves.extend(along.iter().map(|curve| curve.reversed())),
            _ => {}
        }
    }
    let curves = curves.iter().map(|curve| curve.on(&mesh.ellipsoid));
    Outline::new(mesh.ellipsoid, curves.collect())
}

#[test]
fn the_countries_together_have_the_sum_of_their_areas() {
    for (name, mesh) in [
        ("110m", &countries(Dataset::Countries110m).1),
        ("50m", &countries_50m().1),
    ] {
        let mut area_m2 = 0.0;
        let mut vector_area_m2 = DVec3::ZERO;
        let started = std::time::Instant::now();
        for fill in 0..mesh.fills.len() as u32 {
            let measures = mesh.measures(fill);
            area_m2 += measures.area_m2;
            vector_area_m2 += measures.vector_area_m2;
        }
        println!("{name}: all areas in {:?}", started.elapsed());
        let union = union(mesh).measures();
        let error = (area_m2 / union.area_m2 - 1.0).abs();
        assert!(error < 1e-11, "{error:e}");
        let error = (vector_area_m2 - union.vector_area_m2).length() / area_m2;
        assert!(error < 1e-11, "{error:e}");
        // Land without lakes, as Natural Earth draws it.
        assert!((area_m2 / 1.47e14 - 1.0).abs() < 0.02, "{area_m2}");
    }
}

#[test]
fn centroids_are_the_means_of_many_points() {
    let (countries, mesh) = countries(Dataset::Countries110m);
    let locator = Locator::new(&mesh);
    for name in [
        "Fiji",
        "Chile",
        "Russia",
        "Antarctica",
        "South Africa",
        "Canada",
    ] {
        let fill = countries.iter().position(|c| c.name == name).unwrap() as u32;
        let cap = mesh.bounding_cap(fill).unwrap();
        let axis = mesh.ellipsoid.normal(cap.centre);
        let (right, up) = axis.any_orthonormal_pair();
        let (mut normals, mut weights) = (DVec3::ZERO, 0.0);
        // Rings and spokes of equal steps about the centre.
        let (rings, spokes) = (300, 601);
        for ring in 0..rings {
            let off_rad = (f64::from(ring) + 0.5) / f64::from(rings) * cap.radius_rad;
            for spoke in 0..spokes {
                let turn = 2.0 * PI * f64::from(spoke) / f64::from(spokes);
                let across = right * turn.cos() + up * turn.sin();
                let normal = axis * off_rad.cos() + across * off_rad.sin();
                let position = LonLat::new(
                    normal.y.atan2(normal.x).to_degrees(),
                    normal.z.clamp(-1.0, 1.0).asin().to_degrees(),
                );
                if locator.contains(fill, position) {
                    let ground = mesh.ellipsoid.a_m.powi(2) * (1.0 - normal.z * normal.z)
                        + mesh.ellipsoid.b_m.powi(2) * normal.z * normal.z;
                    let weight = off_rad.sin() / (ground * ground);
                    normals += weight * normal;
                    weights += weight;
                }
            }
        }
        let centroid = mesh.ellipsoid.normal(mesh.centroid(fill).unwrap());
        let error_rad = centroid.angle_between(normals);
        assert!(
            weights > 0.0 && error_rad < 2e-3 * cap.radius_rad,
            "{name} {error_rad}"
        );
    }
}

#[test]
fn caps_hold_all_that_a_country_holds() {
    let (_, mesh) = countries(Dataset::Countries110m);
    let caps: Vec<_> = (0..mesh.fills.len() as u32)
        .map(|fill| mesh.bounding_cap(fill).unwrap())
        .collect();
    for arc in &mesh.arcs {
        let run = arc.first_vertex as usize..(arc.first_vertex + arc.vertex_count) as usize;
        for piece in [arc.left, arc.right].into_iter().flatten() {
            let cap = caps[mesh.pieces[piece as usize].fill as usize];
            for (vertex, position) in mesh.boundary[run.clone()]
                .iter()
                .zip(&mesh.vertices[run.clone()])
            {
                let curve = mesh.curves[vertex.curve as usize].on(&mesh.ellipsoid);
                let between = curve.ecef(0.5 * (vertex.t + 1.0));
                for point in [*position, between] {
                    let normal = mesh.ellipsoid.normal_at_surface(point);
                    let angle_rad = mesh.ellipsoid.normal(cap.centre).angle_between(normal);
                    assert!(angle_rad <= cap.radius_rad + 2e-8);
                }
            }
        }
    }
}
