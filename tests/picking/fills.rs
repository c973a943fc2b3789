//! What is found, and in which order.

use std::slice::from_ref;

use glam::UVec2;
use globefill::{
    CountTechnique, EdgeKind, Ellipsoid, FrameStats, LonLat, PickedFill, Polygon, Region, Zone,
    countries::Dataset, wgpu,
};

use crate::{
    common::{
        camera::Pose,
        headless::{gpu, gpu_without},
        oracle::{Oracle, Scratch},
        surface::{DepthKind, Terrain},
        zone_oracle::ZoneOracle,
    },
    host::{
        CENTRE, Host, SIZE, SKY, TECHNIQUES, circle, circles, compare, disk, mountains, surface,
    },
};

fn countries() -> Vec<Region> {
    let countries = Dataset::Countries110m.countries();
    countries.into_iter().map(|it| it.region).collect()
}

/// Countries below and above a wide circle: the third of them with the greater z-index lies above.
fn compare_countries(host: &mut Host<'_>, technique: CountTechnique) {
    let regions = countries();
    let oracle = Oracle::new(&regions, Ellipsoid::WGS84);
    let land = host.insert(&regions);
    let circle = Zone::circle(LonLat::new(18.0, 40.0), 2.1e6);
    let zone = host.insert(&[circle.clone().into()]);
    for fill in (0..regions.len() as u32).step_by(3) {
        host.restyle(land, fill, |style| style.z_index = 7);
    }
    let stats = host.draw();
    assert_eq!(stats.technique, technique);
    let around = ZoneOracle::new(&circle, Ellipsoid::WGS84);
    let judge = |at: LonLat| {
        let mut fills: Vec<PickedFill> = oracle
            .containing(at, &mut Scratch::default())
            .into_iter()
            .map(|fill| PickedFill { mesh: land, fill })
            .collect();
        assert!(fills.len() < 2, "countries are disjoint");
        if around.contains(at) {
            let above = fills.first().is_some_and(|country| country.fill % 3 == 0);
            fills.insert(
                usize::from(above),
                PickedFill {
                    mesh: zone,
                    fill: 0,
                },
            );
        }
        fills
    };
    let (stacks, pixels) = compare(host, &judge, 5);
    println!("{stacks} stacks of fills at {pixels} pixels");
    assert!(stacks > 20 && pixels > 800, "{stacks} at {pixels}");
    let drawn_again = host.draw();
    let still = FrameStats {
        upload_bytes: 0,
        ..stats
    };
    assert_eq!(drawn_again, still, "picking costs frames nothing");
}

#[test]
fn countries_and_a_circle_are_found_as_by_the_oracle() {
    let Some(gpu) = gpu() else { return };
    for count in TECHNIQUES {
        let mut host = Host::new(gpu, disk(1, DepthKind::Reversed), count);
        compare_countries(&mut host, count);
    }
}

#[test]
fn multisampled_hosts_are_asked_about_their_first_sample() {
    let Some(gpu) = gpu() else { return };
    for count in TECHNIQUES {
        let mut host = Host::new(gpu, disk(4, DepthKind::Reversed), count);
        compare_countries(&mut host, count);
    }
}

#[test]
fn of_samples_that_differ_the_first_answers() {
    let Some(gpu) = gpu() else { return };
    let (region, oracle) = circle(CENTRE, 2e6);
    for count in TECHNIQUES {
        let mut host = Host::new(gpu, disk(4, DepthKind::Reversed), count);
        let mesh = host.insert(from_ref(&region));
        host.draw();
        let surface = &host.surface;
        let outside_m = |pixel: UVec2, sample: usize| {
            let index = (pixel.y * SIZE.x + pixel.x) as usize;
            let point_m = surface.points_m[sample * surface.pixel_count() + index]?;
            Some(oracle.outside_m(surface.figure().geodetic(point_m).0))
        };
        // A pixel is some 140 km wide, where it is not seen aslant.
        let pixels: Vec<UVec2> = (0..SIZE.y)
            .flat_map(|y| (0..SIZE.x).map(move |x| UVec2::new(x, y)))
            .filter(|&pixel| {
                let samples = [0, 1, 2, 3].map(|sample| outside_m(pixel, sample));
                samples[0].is_some_and(|first_m| {
                    let differs = |it: &f64| (*it < 0.0) != (first_m < 0.0);
                    first_m.abs() > 5e3 && samples.iter().flatten().any(differs)
                })
            })
            .collect();
        let inside = |pixel| outside_m(pixel, 0).is_some_and(|first_m| first_m < 0.0);
        let insides = pixels.iter().filter(|&&pixel| inside(pixel)).count();
        assert!(insides > 10 && pixels.len() - insides > 10, "{insides}");
        for (&pixel, picked) in pixels.iter().zip(host.pick(&pixels)) {
            let expected = inside(pixel).then_some(PickedFill { mesh, fill: 0 });
            assert_eq!(picked, Vec::from_iter(expected), "at {pixel}");
        }
    }
}

#[test]
fn depth_with_a_far_plane_answers_alike() {
    let Some(gpu) = gpu() else { return };
    let mut host = Host::new(gpu, disk(1, DepthKind::Standard), CountTechnique::Winding);
    compare_countries(&mut host, CountTechnique::Winding);
}

#[test]
fn where_half_floats_have_no_room_the_stencil_answers() {
    let Some(poorer) = gpu_without(wgpu::Features::FLOAT32_BLENDABLE) else {
        return;
    };
    let mut host = Host::new(
        &poorer,
        disk(1, DepthKind::Reversed),
        CountTechnique::Winding,
    );
    compare_countries(&mut host, CountTechnique::Stencil);
}

#[test]
fn where_refined_walls_have_no_room_the_stencil_answers() {
    let Some(poorer) = gpu_without(wgpu::Features::FLOAT32_BLENDABLE) else {
        return;
    };
    // What is drawn from afar fits half floats; finer walls close to the eye do not.
    let radius_m = 8e4;
    let (region, oracle) = circle(CENTRE, radius_m);
    let far = disk(1, DepthKind::Reversed);
    let mut host = Host::new(&poorer, far, CountTechnique::Winding);
    let mesh = host.insert(&[region]);
    assert_eq!(host.draw().technique, CountTechnique::Winding);
    let judge = |at| {
        let inside = oracle.contains(at);
        let fills = inside.then_some(PickedFill { mesh, fill: 0 });
        fills.into_iter().collect()
    };
    let rim = oracle.go(CENTRE, 60.0, radius_m);
    let pose = Pose::nadir(rim.lon_deg, rim.lat_deg, 100.0).turned(150.0, -20.0);
    host.surface = surface(pose, 1, Terrain::Bare, DepthKind::Reversed);
    assert_eq!(host.draw().technique, CountTechnique::Stencil);
    let (stacks, pixels) = compare(&host, &judge, 7);
    assert!(stacks == 2 && pixels > 500, "{stacks} at {pixels}");
}

/// Three overlapping fills in the order `top_down` where they all are.
fn compare_circles(host: &Host<'_>, top_down: [PickedFill; 3], ring_of: &[PickedFill; 3]) {
    let circles = circles();
    let judge = |at| {
        let mut fills = top_down.to_vec();
        fills.retain(|fill| {
            let ring = ring_of.iter().position(|it| it == fill);
            circles[ring.expect("a circle")].1.contains(at)
        });
        fills
    };
    let (stacks, pixels) = compare(host, &judge, 11);
    assert!(stacks >= 4 && pixels > 500, "{stacks} at {pixels}");
}

#[test]
fn overlapping_fills_come_topmost_first() {
    let Some(gpu) = gpu() else { return };
    let surfaces = [
        || disk(1, DepthKind::Reversed),
        || disk(4, DepthKind::Standard),
        mountains,
    ];
    let orders = [
        ([0, 0, 0], [2, 1, 0]),
        ([5, -3, 1], [0, 2, 1]),
        ([i32::MIN, i32::MAX, 0], [1, 2, 0]),
        ([4, 4, 3], [1, 0, 2]),
    ];
    let regions = circles().map(|(region, _)| region);
    for make in &surfaces {
        for count in TECHNIQUES {
            let mut host = Host::new(gpu, make(), count);
            let mesh = host.insert(&regions);
            let fill = |fill| PickedFill { mesh, fill };
            for (z_indices, top_down) in orders {
                for (index, z_index) in (0..).zip(z_indices) {
                    host.restyle(mesh, index, |style| style.z_index = z_index);
                }
                assert_eq!(host.draw().technique, count);
                compare_circles(&host, top_down.map(fill), &[0, 1, 2].map(fill));
            }
        }
    }
}

#[test]
fn fills_of_two_meshes_are_told_apart() {
    let Some(gpu) = gpu() else { return };
    let [small, middle, large] = circles().map(|(region, _)| region);
    for count in TECHNIQUES {
        let mut host = Host::new(gpu, disk(1, DepthKind::Reversed), count);
        // A mesh that is gone: numbers of meshes are not their places.
        let gone = host.insert(from_ref(&large));
        let first = host.insert(&[small.clone(), large.clone()]);
        let second = host.insert(from_ref(&middle));
        host.renderer.remove(gone).expect("it is there");
        let small = PickedFill {
            mesh: first,
            fill: 0,
        };
        let large = PickedFill {
            mesh: first,
            fill: 1,
        };
        let middle = PickedFill {
            mesh: second,
            fill: 0,
        };
        let ring_of = [small, middle, large];
        host.draw();
        compare_circles(&host, [middle, large, small], &ring_of);
        host.restyle(first, 0, |style| style.z_index = 1);
        host.draw();
        compare_circles(&host, [small, middle, large], &ring_of);
    }
}

#[test]
fn what_is_not_painted_is_not_found() {
    let Some(gpu) = gpu() else { return };
    let regions = circles().map(|(region, _)| region);
    for count in TECHNIQUES {
        let mut host = Host::new(gpu, disk(1, DepthKind::Reversed), count);
        let mesh = host.insert(&regions);
        let fill = |fill| PickedFill { mesh, fill };
        host.restyle(mesh, 2, |style| style.visible = false);
        host.draw();
        assert_eq!(host.pick_at(CENTRE), [fill(1), fill(0)]);
        host.restyle(mesh, 1, |style| style.opacity = 0.0);
        host.draw();
        assert_eq!(host.pick_at(CENTRE), [fill(0)]);
        // Nothing there, sky, and nothing drawn at all.
        assert_eq!(host.pick_at(LonLat::new(11.0, -20.0)), []);
        assert_eq!(host.pick(&[SKY]), [[]]);
        host.restyle(mesh, 0, |style| style.visible = false);
        assert_eq!(host.draw().layers, 0);
        assert_eq!(host.pick_at(CENTRE), []);
        host.restyle(mesh, 2, |style| style.visible = true);
        host.draw();
        assert_eq!(host.pick_at(CENTRE), [fill(2)]);
    }
}

#[test]
fn a_fill_that_overlaps_itself_is_found_once() {
    let Some(gpu) = gpu() else { return };
    let square = |west: f64| Polygon {
        shell: [(0.0, 40.0), (10.0, 40.0), (10.0, 50.0), (0.0, 50.0)]
            .map(|(lon_deg, lat_deg)| LonLat::new(west + lon_deg, lat_deg))
            .to_vec(),
        holes: vec![],
    };
    let twice = Region {
        polygons: vec![square(4.0), square(8.0)],
        edges: EdgeKind::Straight,
        ..Default::default()
    };
    let (below, _) = circle(CENTRE, 2e6);
    for count in TECHNIQUES {
        let mut host = Host::new(gpu, disk(1, DepthKind::Reversed), count);
        let mesh = host.insert(&[below.clone(), twice.clone()]);
        host.draw();
        let [under, over] = [0, 1].map(|fill| PickedFill { mesh, fill });
        assert_eq!(host.pick_at(LonLat::new(11.0, 45.0)), [over, under]);
        assert_eq!(host.pick_at(LonLat::new(6.0, 45.0)), [over, under]);
    }
}
