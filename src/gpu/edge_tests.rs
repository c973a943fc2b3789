//! The edge pass against boundaries measured in f64.

use glam::{DVec2, UVec2};
use rayon::prelude::*;

use crate::{
    EdgeKind, FillMesh, FillStyle,
    common::{
        camera::Pose,
        edge::TrueEdge,
        figure::Figure,
        headless::{Gpu, gpu},
        pair_mesh::Pair,
        scene::depth_texture,
        surface::{Cast, DepthKind, Surface, Terrain},
    },
    ellipsoid::Ellipsoid,
    frame::reference::Reference,
    frame::sight_uniform::SightUniform,
    frame::{
        code::Mantissa,
        edge_draws::{EdgeWants, LayerEdges},
        layers::{Layering, Styled},
        select::Selection,
        sight::Sight,
    },
    gpu::{
        count::Drawn,
        edge_pipelines::EdgePipelines,
        edge_view::{EdgeFrame, EdgeSubject, EdgeView, edge_cost},
        gpu_mesh::GpuMesh,
        pipelines::Pipelines,
        surface_binding::{SurfaceBinding, surface_layout},
    },
    options::{CountTechnique, Frame, HeightRange, RendererOptions},
    renderer::MeshId,
    view::{MeshView, Upload},
};

const SIZE: UVec2 = UVec2::new(112, 64);

/// A texel as stroke.wgsl decodes it.
#[derive(Clone, Copy, Debug)]
struct Texel {
    signed_m: f64,
    across_m: f64,
    along_m: f64,
    sides: [u32; 2],
    #[expect(dead_code, reason = "dashes are judged in pictures")]
    along: u32,
}

fn half(bits: u32) -> f64 {
    let (exponent, fraction) = (bits >> 10 & 31, f64::from(bits & 1023) / 1024.0);
    let magnitude = if exponent == 0 {
        fraction * 2f64.powi(-14)
    } else {
        (1.0 + fraction) * 2f64.powi(exponent as i32 - 15)
    };
    if bits & 0x8000 == 0 {
        magnitude
    } else {
        -magnitude
    }
}

fn decoded([x, y, z, w]: [u32; 4]) -> Option<Texel> {
    (z != 0).then(|| Texel {
        signed_m: f32::from_bits(x).into(),
        across_m: half(y & 0xffff).exp2(),
        along_m: half(y >> 16).exp2(),
        sides: [z & 0xffff, z >> 16],
        along: w,
    })
}

/// Draws the edges of both fills of a mesh, each asked for as far as `reach` says.
fn draw(
    gpu: &Gpu,
    mesh: &FillMesh,
    surface: &Surface,
    reach: [f32; 2],
    mirrored: bool,
) -> Vec<Option<Texel>> {
    let (device, queue) = (&gpu.device, &gpu.queue);
    let options = RendererOptions {
        depth: surface.range.convention(),
        sample_count: surface.samples(),
        ..Default::default()
    };
    let (_texture, depth) = depth_texture(gpu, surface, options.depth_format);
    let (min_m, max_m) = surface.terrain.range_m();
    let mut camera = surface.lens.camera();
    if mirrored {
        camera.clip_from_view.x_axis.x *= -1.0;
    }
    let frame = Frame {
        terrain: HeightRange { min_m, max_m },
        pixel_error: 0.0,
        host_pixel_error: 0.0,
        ..Frame::new(camera, surface.size_px())
    };
    let styles = vec![FillStyle::default(); mesh.fills.len()];
    let styled = [Styled {
        mesh,
        styles: &styles,
    }];
    let layering =
        Layering::assign(&styled, CountTechnique::Winding, Mantissa::Single).expect("fits");
    let layers: Vec<Option<LayerEdges>> = layering
        .layers
        .iter()
        .map(|layer| {
            let mut reaches = vec![reach; layer.fills.len() + 1];
            reaches[0] = [0.0; 2];
            Some(LayerEdges {
                code: layer.code,
                reaches,
            })
        })
        .collect();
    let sight = Sight::new(mesh.ellipsoid, mesh.sag_m, &frame, &options).expect("valid");
    let uploaded = GpuMesh::new(device, mesh);
    let slots = uploaded.edge_slots(device, mesh);
    let wants = EdgeWants {
        layers: &layers,
        slots: &slots.slots,
    };
    let selection = Selection::of(
        mesh,
        &layering.codes[0],
        layering.layers.len(),
        &sight,
        &wants,
    );
    let cost = edge_cost(&layers, std::iter::once(&selection));
    println!("{cost:?}, {} refined", selection.patch.chords.len());

    let pipelines = Pipelines::new(device, options);
    let stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
    let layout = surface_layout(device, options.sample_count, stages);
    let mut surface = SurfaceBinding::new(device);
    let reference = Reference::new(sight.ellipsoid, sight.eye_ecef_m);
    let uniform = SightUniform::new(&sight, &reference, options.depth, frame.size_px);
    surface.write(device, queue, &uniform);
    surface.bind(device, &layout, &depth);
    let mut edge_pipelines = EdgePipelines::new(device, &pipelines, &layout, options);
    let mut edges = EdgeView::default();
    let subject = EdgeSubject {
        id: MeshId(0),
        gpu: &uploaded,
        sight: &sight,
        selection: &selection,
    };
    let asked = EdgeFrame {
        size_px: frame.size_px,
        depth: options.depth,
        layers: &layers,
    };
    edges.prepare(device, queue, &mut edge_pipelines, &asked, &[subject]);
    let (again, replaced) = edges.prepare(device, queue, &mut edge_pipelines, &asked, &[subject]);
    assert_eq!((again, replaced), (0, false), "the same frame is free");
    let mut view = MeshView::new(device, &pipelines);
    let to = Upload {
        device,
        queue,
        pipelines: &pipelines,
        mesh: &uploaded,
    };
    view.upload(&to, &sight, selection);
    let mut encoder = device.create_command_encoder(&Default::default());
    let drawn = [Drawn {
        id: MeshId(0),
        gpu: &uploaded,
        view: &view,
    }];
    let surface = surface.group().expect("the depth was bound");
    edges.record(&edge_pipelines, &mut encoder, surface, &drawn);
    queue.submit([encoder.finish()]);
    let target = edges.target(0).expect("edges were asked for");
    read(gpu, target.texture())
        .into_iter()
        .map(decoded)
        .collect()
}

fn read(gpu: &Gpu, texture: &wgpu::Texture) -> Vec<[u32; 4]> {
    let size = texture.size();
    let row_bytes = (size.width * 16).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size: u64::from(row_bytes) * u64::from(size.height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row_bytes),
                rows_per_image: None,
            },
        },
        size,
    );
    gpu.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |result| {
        result.expect("the buffer can be mapped");
    });
    gpu.device
        .poll(wgpu::PollType::wait_indefinitely())
        .expect("the device answers");
    let bytes = buffer.get_mapped_range(..).expect("it is mapped");
    bytes
        .chunks_exact(row_bytes as usize)
        .flat_map(|row| {
            row.chunks_exact(16)
                .take(size.width as usize)
                .map(bytemuck::pod_read_unaligned)
        })
        .collect()
}

/// The true boundaries of a pair, with the ids on either side.
struct Truth {
    figure: Figure,
    edges: Vec<(TrueEdge, [u32; 2])>,
}

/// What is true of a pixel and one edge.
#[derive(Clone, Copy, Debug)]
struct Measured {
    signed_m: f64,
    /// Distance on the screen between the pixel's centre and the edge, drawn at the height of the ground
    /// there.
    off_px: f64,
    /// Metres a pixel, along the edge as it is seen.
    along_m: f64,
    sides: [u32; 2],
    /// Whether the nearest point is an end.
    at_end: bool,
}

impl Truth {
    fn new(pair: &Pair) -> Self {
        let figure = Figure::new(Ellipsoid::WGS84);
        let walks = [
            (pair.a, pair.b, [1, 2]),
            (pair.b, pair.left, [1, 0]),
            (pair.left, pair.a, [1, 0]),
            (pair.b, pair.right, [0, 2]),
            (pair.right, pair.a, [0, 2]),
        ];
        let edges = walks
            .into_iter()
            .flat_map(|(from, to, sides)| {
                TrueEdge::between(&figure, pair.kind, from, to)
                    .into_iter()
                    .map(move |edge| (edge, sides))
            })
            .collect();
        Self { figure, edges }
    }

    /// All edges, measured from a pixel; none in the sky.
    fn at(&self, surface: &Surface, pixel: usize) -> Option<Vec<Measured>> {
        let figure = &self.figure;
        let (foot, height_m) = figure.geodetic(surface.points_m[pixel]?);
        let foot_m = figure.ecef(foot, 0.0);
        let width = surface.size_px().x as usize;
        let centre_px = DVec2::new((pixel % width) as f64, (pixel / width) as f64) + 0.5;
        let measure = |(edge, sides): &(TrueEdge, [u32; 2])| {
            let (off_m, t) = edge.nearest(figure, foot_m);
            let ahead_m = |t: f64| figure.ecef(edge.point(figure, t), 0.0);
            let [before_m, after_m] = [(t - 1e-4).max(0.0), (t + 1e-4).min(1.0)].map(ahead_m);
            let left = figure.normal(foot).cross(after_m - before_m);
            // On the screen: Newton's method from the nearest point on the ground.
            let project = |t: f64| {
                let at_m = figure.ecef(edge.point(figure, t), height_m);
                let (at_px, distance_m) = surface.lens.project(at_m);
                (distance_m > 0.0).then_some(at_px)
            };
            let step = (0.01 * off_m / edge.radius_m).clamp(1e-9, 1e-3);
            let per_t = |t: f64| Some((project(t + step)? - project(t - step)?) / (2.0 * step));
            let on_screen = (0..30).try_fold(t, |t, _| {
                let way_px = per_t(t)?;
                let change = (centre_px - project(t)?).dot(way_px) / way_px.length_squared();
                Some((t + change).clamp(0.0, 1.0))
            });
            let off_px = on_screen
                .and_then(|t| Some((centre_px - project(t)?).length()))
                .unwrap_or(f64::INFINITY);
            let along_m = on_screen.and_then(per_t).map_or(f64::NAN, |way_px| {
                let t = on_screen.unwrap_or(t);
                ahead_m(t + step).distance(ahead_m(t - step)) / (2.0 * step) / way_px.length()
            });
            Measured {
                signed_m: off_m * (foot_m - ahead_m(t)).dot(left).signum(),
                off_px,
                along_m,
                sides: *sides,
                at_end: [Some(t), on_screen]
                    .into_iter()
                    .flatten()
                    .any(|t| !(1e-7..=1.0 - 1e-7).contains(&t)),
            }
        };
        Some(self.edges.iter().map(measure).collect())
    }
}

/// The worst of a picture.
#[derive(Debug, Default)]
struct Worst {
    compared: u32,
    /// Of those, pixels whose distance is none of the true edges'; not judged further.
    outliers: u32,
    signed_px: f64,
    /// Of the distance on the screen.
    screen_px: f64,
    /// Of that where less than 3 px.
    near_px: f64,
    along_ratio: f64,
    missing: u32,
    strangers: u32,
    wrong_sides: u32,
    not_nearest: u32,
}

fn compare(truth: &Truth, surface: &Surface, texels: &[Option<Texel>], reach: [f32; 2]) -> Worst {
    let pixels: Vec<(Option<Vec<Measured>>, &Option<Texel>)> = texels
        .par_iter()
        .enumerate()
        .map(|(pixel, texel)| (truth.at(surface, pixel), texel))
        .collect();
    let mut worst = Worst::default();
    let reach = reach.map(f64::from);
    for (pixel, (measured, texel)) in pixels.iter().enumerate() {
        match (measured, texel) {
            (None, texel) => worst.strangers += u32::from(texel.is_some()),
            _ if near_sky(surface, pixel) => {}
            (Some(edges), None) => {
                let [metres, px] = reach;
                let within = |edge: &Measured| {
                    let on_screen = metres == 0.0 && edge.off_px < px;
                    !edge.at_end && (on_screen || edge.signed_m.abs() < metres)
                };
                worst.missing += u32::from(edges.iter().any(within));
            }
            (Some(edges), Some(texel)) => worst.judge(edges, texel, reach),
        }
    }
    worst
}

/// Whether a pixel lies so near to the limb that the ground within reach is not level.
fn near_sky(surface: &Surface, pixel: usize) -> bool {
    const NEAR_PX: i64 = 12;
    let [width, height] = surface.size_px().as_i64vec2().to_array();
    let (x, y) = (pixel as i64 % width, pixel as i64 / width);
    (-1..=1).any(|dx| {
        (-1..=1).any(|dy| {
            let (x, y) = (x + dx * NEAR_PX, y + dy * NEAR_PX);
            let inside = (0..width).contains(&x) && (0..height).contains(&y);
            inside && surface.points_m[(y * width + x) as usize].is_none()
        })
    })
}

impl Worst {
    fn judge(&mut self, edges: &[Measured], texel: &Texel, [metres, px]: [f64; 2]) {
        // The texel tells of one of the edges: of that whose distance it has.
        let off_m = |edge: &&Measured| (edge.signed_m.abs() - texel.signed_m.abs()).abs();
        let edge = edges
            .iter()
            .min_by(|a, b| off_m(a).total_cmp(&off_m(b)))
            .expect("there are edges");
        // Where an end is near on the screen, what is nearest there and on the ground differ.
        let ends = |edge: &Measured| edge.at_end && edge.off_px < px + 3.0;
        if edge.at_end || edge.off_px.is_infinite() || edges.iter().any(ends) {
            return;
        }
        self.compared += 1;
        let signed_px = off_m(&edge) / texel.across_m;
        let allowed_px = if edge.off_px < 3.0 {
            1.0 / 16.0
        } else {
            1.0 / 8.0
        };
        if signed_px > allowed_px {
            self.outliers += 1;
            return;
        }
        self.signed_px = self.signed_px.max(signed_px);
        let flipped = texel.signed_m.signum() != edge.signed_m.signum()
            && edge.signed_m.abs() > 0.05 * texel.across_m;
        let twins = edges
            .iter()
            .filter(|twin| off_m(twin) < 0.05 * texel.across_m);
        self.wrong_sides += u32::from((texel.sides != edge.sides || flipped) && twins.count() == 1);
        if metres == 0.0 {
            let off_px = texel.signed_m.abs() / texel.across_m;
            let wrong_px = (off_px - edge.off_px).abs();
            self.screen_px = self.screen_px.max(wrong_px);
            self.strangers += u32::from(edge.off_px > px + 1.2);
            // Level ground is a fair guess of curved ground that is not too far.
            let nearer = |other: &Measured| !other.at_end && other.off_px < (off_px - 0.3).min(3.0);
            self.not_nearest += u32::from(edges.iter().any(nearer));
            if edge.off_px < 3.0 {
                self.near_px = self.near_px.max(wrong_px);
                let ratio = (texel.along_m / edge.along_m).ln().abs();
                self.along_ratio = self.along_ratio.max(ratio);
            }
        }
    }
}

/// Draws with both depth conventions and judges; answers what failed.
fn check(
    gpu: &Gpu,
    pair: &Pair,
    pose: Pose,
    terrain: Terrain,
    samples: u32,
    reach: [f32; 2],
) -> Vec<String> {
    let mut failed = Vec::new();
    let truth = Truth::new(pair);
    let mesh = pair.mesh();
    let cast = |samples| Cast::new(&truth.figure, &pose, SIZE, samples, terrain);
    let centres = cast(1);
    for depth in [DepthKind::Reversed, DepthKind::Standard] {
        let expected = Surface::new(&centres, depth);
        let drawn = Surface::new(&cast(samples), depth);
        let texels = draw(gpu, &mesh, &drawn, reach, false);
        let worst = compare(&truth, &expected, &texels, reach);
        let view = format!(
            "{:?} from {} m, pitch {}, {terrain:?}, {samples} samples, reach {reach:?}, {depth:?}",
            pair.kind, pose.height_m, pose.pitch_deg
        );
        println!("{view}: {worst:?}");
        let wrong = worst.missing + worst.strangers + worst.wrong_sides + worst.not_nearest;
        if worst.compared < 100
            || worst.near_px >= 1.0 / 16.0
            || 500 * worst.outliers > worst.compared
            || wrong > 0
        {
            failed.push(format!("{view}: {worst:?}"));
        }
    }
    failed
}

fn pair(kind: EdgeKind, length_deg: f64) -> Pair {
    Pair::about(kind, 10.0, 47.0, 60.0, length_deg)
}

/// Views of the middle of the common edge, from beside it.
fn views(pair: &Pair, height_m: f64) -> [Pose; 3] {
    let figure = Figure::new(Ellipsoid::WGS84);
    let common = &TrueEdge::between(&figure, pair.kind, pair.a, pair.b)[0];
    let middle = common.point(&figure, 0.5);
    let aside_deg = (0.2 * height_m / 111_000.0).min(5.0);
    let pose = Pose::nadir(middle.lon_deg + aside_deg, middle.lat_deg, height_m);
    let fov_deg = if height_m > 1e6 { 30.0 } else { 60.0 };
    let pose = Pose { fov_deg, ..pose };
    [pose, pose.turned(290.0, -35.0), pose.turned(200.0, -12.0)]
}

#[test]
fn distances_are_those_to_the_true_boundary() {
    let Some(gpu) = gpu() else { return };
    let mut failed = Vec::new();
    for (kind, height_m, length_deg) in [
        (EdgeKind::Geodesic, 10.0, 1.0),
        (EdgeKind::Rhumb, 1e3, 1.0),
        (EdgeKind::Straight, 1e5, 2.0),
        (EdgeKind::Geodesic, 2e7, 25.0),
    ] {
        let pair = pair(kind, length_deg);
        let poses = if height_m < 1e5 { 3 } else { 1 };
        for pose in &views(&pair, height_m)[..poses] {
            failed.extend(check(gpu, &pair, *pose, Terrain::Bare, 1, [0.0, 6.0]));
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// Fails: 10 of 1594 and 6 of 617 pixels hold a distance that is none of the true edges', up to 1.7 px off;
/// all of them lie more than 3 px from an edge. Why is not known.
#[test]
#[ignore = "known to fail in less than 1 % of the pixels"]
fn distances_are_true_in_oblique_views_from_a_hundred_kilometres() {
    let Some(gpu) = gpu() else { return };
    let pair = pair(EdgeKind::Straight, 2.0);
    let mut failed = Vec::new();
    for pose in &views(&pair, 1e5)[1..] {
        failed.extend(check(gpu, &pair, *pose, Terrain::Bare, 1, [0.0, 6.0]));
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn metres_samples_and_terrain_are_measured_alike() {
    let Some(gpu) = gpu() else { return };
    let pair = pair(EdgeKind::Geodesic, 1.0);
    let mut failed = Vec::new();
    let [nadir, oblique, _] = views(&pair, 1e3);
    failed.extend(check(gpu, &pair, nadir, Terrain::Bare, 4, [0.0, 4.0]));
    failed.extend(check(gpu, &pair, nadir, Terrain::Bare, 1, [100.0, 0.0]));
    failed.extend(check(gpu, &pair, oblique, Terrain::Bare, 1, [100.0, 0.0]));
    let raised = Pose {
        height_m: 5e3,
        ..nadir
    };
    let plateau = Terrain::Plateau { height_m: 4e3 };
    failed.extend(check(gpu, &pair, raised, plateau, 1, [0.0, 4.0]));
    assert!(failed.is_empty(), "{failed:#?}");
}

/// A mirrored projection draws the same prisms: as many pixels have edges as without.
#[test]
fn mirrored_projections_show_edges_too() {
    let Some(gpu) = gpu() else { return };
    let pair = pair(EdgeKind::Geodesic, 1.0);
    let [pose, ..] = views(&pair, 1e3);
    let figure = Figure::new(Ellipsoid::WGS84);
    // Looking straight down from the same height all over, depth is the same when mirrored.
    let surface = Surface::new(
        &Cast::new(&figure, &pose, SIZE, 1, Terrain::Bare),
        DepthKind::Reversed,
    );
    let [plain, mirrored] = [false, true].map(|mirrored| {
        let texels = draw(gpu, &pair.mesh(), &surface, [0.0, 4.0], mirrored);
        texels.iter().flatten().count()
    });
    assert!(
        plain > 100 && plain.abs_diff(mirrored) < plain / 50,
        "{plain} and {mirrored}"
    );
}
