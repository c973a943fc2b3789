//! Which fills are at a pixel: asked of the GPU, and of geometry in f64.

mod common;

use common::{
    camera::Pose,
    draw::{COLOR, paint},
    figure::Figure,
    headless::{Gpu, gpu, gpu_without},
    oracle::{Oracle, Scratch},
    surface::{Cast, DepthKind, Surface, Terrain},
    zone_oracle::ZoneOracle,
};
use glam::UVec2;
use globefill::{
    CountTechnique, EdgeKind, Ellipsoid, FillMesh, FillStyle, Frame, FrameStats, LonLat, MeshId,
    MeshOptions, Pick, PickedFill, Polygon, Region, Renderer, RendererError, RendererOptions, View,
    Zone, countries::Dataset, wgpu,
};

const SIZE: UVec2 = UVec2::new(160, 90);
const TECHNIQUES: [CountTechnique; 2] = [CountTechnique::Winding, CountTechnique::Stencil];
const CENTRE: LonLat = LonLat::new(11.0, 47.0);
/// Corner of a picture from [`disk`], where there is sky.
const SKY: UVec2 = UVec2::new(1, 1);

/// A host's surface with the sky around.
fn disk(samples: u32, depth: DepthKind) -> Surface {
    let mut pose = Pose::nadir(CENTRE.lon_deg, CENTRE.lat_deg, 2e7);
    pose.fov_deg = 35.0;
    surface(pose, samples, Terrain::Bare, depth)
}

/// Mountains seen aslant, down to the limb.
fn mountains() -> Surface {
    let pose = Pose::nadir(5.0, 22.0, 4e6).turned(15.0, -50.0);
    surface(pose, 1, Terrain::Rough, DepthKind::Reversed)
}

fn surface(pose: Pose, samples: u32, terrain: Terrain, depth: DepthKind) -> Surface {
    let figure = Figure::new(Ellipsoid::WGS84);
    Surface::new(&Cast::new(&figure, &pose, SIZE, samples, terrain), depth)
}

/// A renderer and what it draws over.
struct Host<'a> {
    gpu: &'a Gpu,
    surface: Surface,
    options: RendererOptions,
    renderer: Renderer,
    view: View,
}

impl<'a> Host<'a> {
    fn new(gpu: &'a Gpu, surface: Surface, count: CountTechnique) -> Self {
        let options = RendererOptions {
            color_format: COLOR,
            depth_format: wgpu::TextureFormat::Depth32Float,
            depth: surface.range.convention(),
            sample_count: surface.samples(),
            count,
        };
        Self {
            gpu,
            surface,
            options,
            renderer: Renderer::new(&gpu.device, options).expect("the options are sound"),
            view: View::default(),
        }
    }

    fn insert(&mut self, regions: &[Region]) -> MeshId {
        let mesh = FillMesh::build(regions, &MeshOptions::default()).expect("sound regions");
        self.renderer.insert(mesh)
    }

    fn restyle(&mut self, mesh: MeshId, fill: u32, change: impl FnOnce(&mut FillStyle)) {
        let mut style = self.renderer.style(mesh, fill).expect("the fill exists");
        change(&mut style);
        let set = self.renderer.set_style(mesh, fill, style);
        set.expect("a sound style");
    }

    fn draw(&mut self) -> FrameStats {
        let (renderer, view) = (&mut self.renderer, &mut self.view);
        paint(self.gpu, renderer, &self.options, view, &self.surface, 0.0).stats
    }

    /// Prepares without counting.
    fn prepare(&mut self) {
        let frame = Frame::new(self.surface.lens.camera(), SIZE);
        let prepared = self
            .renderer
            .prepare(&self.gpu.queue, &mut self.view, &frame);
        prepared.expect("the frame can be drawn");
    }

    /// Answers for some pixels, read from one buffer that starts with room for another.
    fn pick(&self, pixels: &[UVec2]) -> Vec<Vec<PickedFill>> {
        let answers = readable(self.gpu, Pick::BYTES * (pixels.len() as u64 + 1));
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let asked: Vec<(Pick, u64)> = (1..)
            .map(|k| k * Pick::BYTES)
            .zip(pixels)
            .map(|(offset, &pixel)| {
                let asked =
                    self.renderer
                        .read_fills(&self.view, &mut encoder, pixel, &answers, offset);
                (asked.expect("the pixel is in the picture"), offset)
            })
            .collect();
        self.gpu.queue.submit([encoder.finish()]);
        let bytes = read(self.gpu, &answers);
        asked
            .iter()
            .map(|(pick, offset)| pick.fills(&bytes[*offset as usize..]))
            .collect()
    }

    fn pick_at(&self, place: LonLat) -> Vec<PickedFill> {
        let (at_px, _) = self
            .surface
            .lens
            .project(self.surface.figure().ecef(place, 0.0));
        self.pick(&[at_px.as_uvec2()]).remove(0)
    }
}

fn readable(gpu: &Gpu, size: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("answers"),
        size,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    })
}

fn read(gpu: &Gpu, buffer: &wgpu::Buffer) -> Vec<u8> {
    buffer.map_async(wgpu::MapMode::Read, .., |mapped| {
        mapped.expect("it can be read");
    });
    gpu.device
        .poll(wgpu::PollType::wait_indefinitely())
        .expect("the device answers");
    buffer.get_mapped_range(..).expect("it is mapped").to_vec()
}

/// Which of some fills contain a place, in any way that is not the crate's.
type Judge<'a> = dyn Fn(LonLat) -> Vec<PickedFill> + 'a;

/// The expected fills of each pixel's first sample.
fn expected(surface: &Surface, judge: &Judge<'_>) -> Vec<Vec<PickedFill>> {
    let first_samples = &surface.points_m[..surface.pixel_count()];
    first_samples
        .iter()
        .map(|point_m| {
            let foot = point_m.map(|point_m| surface.figure().geodetic(point_m).0);
            foot.map_or_else(Vec::new, judge)
        })
        .collect()
}

/// Compares every `step`-th pixel whose surroundings all expect the same; answers how many distinct
/// stacks of fills were seen, and how many pixels were judged.
fn compare(host: &Host<'_>, judge: &Judge<'_>, step: usize) -> (usize, usize) {
    let expected = expected(&host.surface, judge);
    let at = |x: u32, y: u32| &expected[(y * SIZE.x + x) as usize];
    let pixels: Vec<UVec2> = (1..SIZE.y - 1)
        .flat_map(|y| (1..SIZE.x - 1).map(move |x| UVec2::new(x, y)))
        .filter(|&UVec2 { x, y }| {
            let around = (y - 1..=y + 1).flat_map(|v| (x - 1..=x + 1).map(move |u| (u, v)));
            around.into_iter().all(|(u, v)| at(u, v) == at(x, y))
        })
        .step_by(step)
        .collect();
    for (pixel, picked) in pixels.iter().zip(host.pick(&pixels)) {
        assert_eq!(&picked, at(pixel.x, pixel.y), "at {pixel}");
    }
    let mut seen: Vec<_> = pixels.iter().map(|pixel| at(pixel.x, pixel.y)).collect();
    seen.sort_by_key(|stack| format!("{stack:?}"));
    seen.dedup();
    (seen.len(), pixels.len())
}

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

/// A circle and its judge.
fn circle(centre: LonLat, radius_m: f64) -> (Region, ZoneOracle) {
    let zone = Zone::circle(centre, radius_m);
    (
        zone.clone().into(),
        ZoneOracle::new(&zone, Ellipsoid::WGS84),
    )
}

#[test]
fn where_refined_walls_have_no_room_the_stencil_answers() {
    let Some(poorer) = gpu_without(wgpu::Features::FLOAT32_BLENDABLE) else {
        return;
    };
    // Stored sums fit half floats; those of the small circle's finer walls do not.
    let radius_m = 1e4;
    let (mut region, oracle) = circle(CENTRE, radius_m);
    let elsewhere = Zone::circle(LonLat::new(30.0, 20.0), 6e4);
    region.zones.push(elsewhere);
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

/// Three circles that hold the centre, each reaching farther than the one before.
fn circles() -> [(Region, ZoneOracle); 3] {
    [1.0, 2.0, 3.0].map(|k| {
        let centre = LonLat::new(CENTRE.lon_deg + 2.0 * k, CENTRE.lat_deg);
        circle(centre, 1e6 * k)
    })
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
        let gone = host.insert(&[large.clone()]);
        let first = host.insert(&[small.clone(), large.clone()]);
        let second = host.insert(&[middle.clone()]);
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

#[test]
fn a_frame_is_answered_as_it_was_prepared() {
    let Some(gpu) = gpu() else { return };
    let [small, middle, large] = circles().map(|(region, _)| region);
    for count in TECHNIQUES {
        let mut host = Host::new(gpu, disk(1, DepthKind::Reversed), count);
        let below = host.insert(&[large.clone(), middle.clone()]);
        let above = host.insert(&[small.clone()]);
        let shown = [
            PickedFill {
                mesh: above,
                fill: 0,
            },
            PickedFill {
                mesh: below,
                fill: 1,
            },
            PickedFill {
                mesh: below,
                fill: 0,
            },
        ];
        host.draw();
        // Asked before, between and after changes, and read after all of them.
        let (at_px, _) = host
            .surface
            .lens
            .project(host.surface.points_m[80 + 45 * 160].expect("land"));
        let answers = readable(gpu, 3 * Pick::BYTES);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut picks = Vec::new();
        for step in 0..3_u32 {
            let offset = u64::from(step) * Pick::BYTES;
            let asked = host.renderer.read_fills(
                &host.view,
                &mut encoder,
                at_px.as_uvec2(),
                &answers,
                offset,
            );
            picks.push(asked.expect("the pixel is in the picture"));
            match step {
                0 => host.restyle(below, 0, |style| style.z_index = 9),
                1 => host.renderer.remove(below).expect("it is there"),
                _ => {}
            }
        }
        gpu.queue.submit([encoder.finish()]);
        host.insert(&circles().map(|(region, _)| region));
        host.draw();
        let bytes = read(gpu, &answers);
        for (pick, answer) in picks.iter().zip(bytes.chunks_exact(Pick::BYTES as usize)) {
            assert_eq!(pick.fills(answer), shown);
        }
        assert!(host.pick_at(CENTRE).len() == 4, "the next frame is another");
    }
}

#[test]
fn changes_between_prepare_and_count_leave_the_order() {
    let Some(gpu) = gpu() else { return };
    let [small, middle, large] = circles().map(|(region, _)| region);
    for count in TECHNIQUES {
        let mut host = Host::new(gpu, disk(1, DepthKind::Reversed), count);
        let removed = host.insert(&[middle.clone()]);
        let mesh = host.insert(&[small.clone(), large.clone()]);
        host.prepare();
        host.renderer.remove(removed).expect("it is there");
        host.restyle(mesh, 0, |style| style.z_index = 3);
        host.insert(&[middle.clone()]);
        let (_, depth) =
            common::scene::depth_texture(gpu, &host.surface, host.options.depth_format);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        host.renderer.count(&mut host.view, &mut encoder, &depth);
        gpu.queue.submit([encoder.finish()]);
        // What is gone cannot be counted; all else is as prepared.
        let fills = [1, 0].map(|fill| PickedFill { mesh, fill });
        assert_eq!(host.pick_at(CENTRE), fills);
    }
}

#[test]
fn views_are_asked_apart() {
    let Some(gpu) = gpu() else { return };
    let [small, _, large] = circles().map(|(region, _)| region);
    let mut host = Host::new(gpu, disk(1, DepthKind::Reversed), CountTechnique::Winding);
    let mesh = host.insert(&[small, large]);
    host.draw();
    let first = std::mem::take(&mut host.view);
    host.restyle(mesh, 1, |style| style.visible = false);
    host.draw();
    let fill = |fill| PickedFill { mesh, fill };
    assert_eq!(host.pick_at(CENTRE), [fill(0)]);
    host.view = first;
    assert_eq!(host.pick_at(CENTRE), [fill(1), fill(0)]);
}

#[test]
fn pixels_outside_the_frame_are_refused() {
    let Some(gpu) = gpu() else { return };
    let (region, _) = circle(CENTRE, 1e6);
    let mut host = Host::new(gpu, disk(1, DepthKind::Reversed), CountTechnique::Winding);
    host.insert(&[region]);
    let answers = readable(gpu, Pick::BYTES);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut refused = |host: &Host<'_>, pixel| {
        let asked = host
            .renderer
            .read_fills(&host.view, &mut encoder, pixel, &answers, 0);
        asked.err() == Some(RendererError::NoSuchPixel(pixel))
    };
    assert!(refused(&host, UVec2::ZERO), "nothing was prepared");
    host.draw();
    let last = SIZE - UVec2::ONE;
    assert!(!refused(&host, last));
    for pixel in [
        UVec2::new(SIZE.x, 0),
        UVec2::new(0, SIZE.y),
        SIZE,
        UVec2::MAX,
    ] {
        assert!(refused(&host, pixel), "{pixel}");
    }
}

#[test]
fn what_is_no_answer_names_no_fills() {
    let Some(gpu) = gpu() else { return };
    let (region, _) = circle(CENTRE, 1e6);
    let mut host = Host::new(gpu, disk(1, DepthKind::Reversed), CountTechnique::Winding);
    let mesh = host.insert(&[region]);
    host.draw();
    let answers = readable(gpu, Pick::BYTES);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let asked = host
        .renderer
        .read_fills(&host.view, &mut encoder, SKY, &answers, 0);
    let pick = asked.expect("the pixel is in the picture");
    let mut bytes = vec![0; Pick::BYTES as usize + 5];
    bytes[0] = 1;
    let found = [PickedFill { mesh, fill: 0 }];
    assert_eq!(pick.fills(&bytes), found);
    assert_eq!(pick.fills(&bytes[..Pick::BYTES as usize]), found);
    assert_eq!(pick.fills(&bytes[..Pick::BYTES as usize - 1]), []);
    assert_eq!(pick.fills(&[]), []);
    // Ids that no layer has.
    assert_eq!(pick.fills(&[0xff; Pick::BYTES as usize]), []);
}

#[test]
fn styles_can_be_asked_for() {
    let Some(gpu) = gpu() else { return };
    let (region, _) = circle(CENTRE, 1e6);
    let mut host = Host::new(gpu, disk(1, DepthKind::Reversed), CountTechnique::Winding);
    let mesh = host.insert(&[region.clone(), region]);
    let style = FillStyle {
        z_index: -4,
        ..Default::default()
    };
    host.renderer.set_style(mesh, 1, style).expect("sound");
    assert_eq!(host.renderer.style(mesh, 0), Ok(FillStyle::default()));
    assert_eq!(host.renderer.style(mesh, 1), Ok(style));
    let beyond = RendererError::NoSuchFill { fill: 2, fills: 2 };
    assert_eq!(host.renderer.style(mesh, 2), Err(beyond));
    host.renderer.remove(mesh).expect("it is there");
    assert_eq!(host.renderer.style(mesh, 0), Err(RendererError::NoSuchMesh));
}
