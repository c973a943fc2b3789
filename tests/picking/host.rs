//! A host that asks, and its judge.

use glam::UVec2;
use globefill::{
    CountTechnique, Ellipsoid, FillMesh, FillStyle, Frame, FrameStats, LonLat, MeshId, MeshOptions,
    Pick, PickedFill, Region, Renderer, RendererOptions, View, Zone, wgpu,
};

use crate::common::{
    camera::Pose,
    draw::{COLOR, paint},
    figure::Figure,
    headless::Gpu,
    surface::{Cast, DepthKind, Surface, Terrain},
    zone_oracle::ZoneOracle,
};

pub const SIZE: UVec2 = UVec2::new(160, 90);
pub const TECHNIQUES: [CountTechnique; 2] = [CountTechnique::Winding, CountTechnique::Stencil];
pub const CENTRE: LonLat = LonLat::new(11.0, 47.0);
/// Corner of a picture from [`disk`], where there is sky.
pub const SKY: UVec2 = UVec2::new(1, 1);

/// A host's surface with the sky around.
pub fn disk(samples: u32, depth: DepthKind) -> Surface {
    let mut pose = Pose::nadir(CENTRE.lon_deg, CENTRE.lat_deg, 2e7);
    pose.fov_deg = 35.0;
    surface(pose, samples, Terrain::Bare, depth)
}

/// Mountains seen aslant, down to the limb.
pub fn mountains() -> Surface {
    let pose = Pose::nadir(5.0, 22.0, 4e6).turned(15.0, -50.0);
    surface(pose, 1, Terrain::Rough, DepthKind::Reversed)
}

pub fn surface(pose: Pose, samples: u32, terrain: Terrain, depth: DepthKind) -> Surface {
    let figure = Figure::new(Ellipsoid::WGS84);
    Surface::new(&Cast::new(&figure, &pose, SIZE, samples, terrain), depth)
}

/// A renderer and what it draws over.
pub struct Host<'a> {
    pub gpu: &'a Gpu,
    pub surface: Surface,
    pub options: RendererOptions,
    pub renderer: Renderer,
    pub view: View,
}

impl<'a> Host<'a> {
    pub fn new(gpu: &'a Gpu, surface: Surface, count: CountTechnique) -> Self {
        let options = RendererOptions {
            color_format: COLOR,
            depth_format: wgpu::TextureFormat::Depth32Float,
            depth: surface.range.convention(),
            sample_count: surface.samples(),
            count,
            ..Default::default()
        };
        Self {
            gpu,
            surface,
            options,
            renderer: Renderer::new(&gpu.device, options).expect("the options are sound"),
            view: View::default(),
        }
    }

    pub fn insert(&mut self, regions: &[Region]) -> MeshId {
        let mesh = FillMesh::build(regions, &MeshOptions::default()).expect("sound regions");
        self.renderer.insert(mesh)
    }

    pub fn restyle(&mut self, mesh: MeshId, fill: u32, change: impl FnOnce(&mut FillStyle)) {
        let mut style = self.renderer.style(mesh, fill).expect("the fill exists");
        change(&mut style);
        let set = self.renderer.set_style(mesh, fill, style);
        set.expect("a sound style");
    }

    pub fn draw(&mut self) -> FrameStats {
        let (renderer, view) = (&mut self.renderer, &mut self.view);
        paint(self.gpu, renderer, &self.options, view, &self.surface, 0.0).stats
    }

    /// Prepares without counting.
    pub fn prepare(&mut self) {
        let frame = Frame::new(self.surface.lens.camera(), SIZE);
        let prepared = self
            .renderer
            .prepare(&self.gpu.queue, &mut self.view, &frame);
        prepared.expect("the frame can be drawn");
    }

    /// Answers for some pixels, read from one buffer that starts with room for another.
    pub fn pick(&self, pixels: &[UVec2]) -> Vec<Vec<PickedFill>> {
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

    pub fn pick_at(&self, place: LonLat) -> Vec<PickedFill> {
        let (at_px, _) = self
            .surface
            .lens
            .project(self.surface.figure().ecef(place, 0.0));
        self.pick(&[at_px.as_uvec2()]).remove(0)
    }
}

pub fn readable(gpu: &Gpu, size: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("answers"),
        size,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    })
}

pub fn read(gpu: &Gpu, buffer: &wgpu::Buffer) -> Vec<u8> {
    buffer.map_async(wgpu::MapMode::Read, .., |mapped| {
        mapped.expect("it can be read");
    });
    gpu.device
        .poll(wgpu::PollType::wait_indefinitely())
        .expect("the device answers");
    buffer.get_mapped_range(..).expect("it is mapped").to_vec()
}

/// Which of some fills contain a place, in any way that is not the crate's.
pub type Judge<'a> = dyn Fn(LonLat) -> Vec<PickedFill> + 'a;

/// The expected fills of each pixel's first sample.
pub fn expected(surface: &Surface, judge: &Judge<'_>) -> Vec<Vec<PickedFill>> {
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
pub fn compare(host: &Host<'_>, judge: &Judge<'_>, step: usize) -> (usize, usize) {
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

/// A circle and its judge.
pub fn circle(centre: LonLat, radius_m: f64) -> (Region, ZoneOracle) {
    let zone = Zone::circle(centre, radius_m);
    (
        zone.clone().into(),
        ZoneOracle::new(&zone, Ellipsoid::WGS84),
    )
}

/// Three circles that hold the centre, each reaching farther than the one before.
pub fn circles() -> [(Region, ZoneOracle); 3] {
    [1.0, 2.0, 3.0].map(|k| {
        let centre = LonLat::new(CENTRE.lon_deg + 2.0 * k, CENTRE.lat_deg);
        circle(centre, 1e6 * k)
    })
}
