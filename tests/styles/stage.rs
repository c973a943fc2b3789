//! A renderer with one mesh, and what it draws over a surface.

use glam::{DVec2, DVec3, UVec2};
use globefill::{
    CountTechnique, Ellipsoid, FillMesh, FillStyle, LonLat, MeshId, MeshOptions, Region, Renderer,
    RendererOptions, View, Zone,
};

use crate::common::{
    camera::Pose,
    draw::{COLOR, Painted, paint},
    figure::Figure,
    headless::Gpu,
    surface::{Cast, DepthKind, Surface, Terrain},
};

pub fn figure() -> Figure {
    Figure::new(Ellipsoid::WGS84)
}

pub struct Stage<'a> {
    pub gpu: &'a Gpu,
    pub renderer: Renderer,
    pub options: RendererOptions,
    pub mesh: MeshId,
    pub view: View,
}

impl<'a> Stage<'a> {
    pub fn new(gpu: &'a Gpu, mesh: FillMesh, like: &Surface) -> Self {
        Self::counted(gpu, mesh, like, CountTechnique::Winding)
    }

    pub fn counted(gpu: &'a Gpu, mesh: FillMesh, like: &Surface, count: CountTechnique) -> Self {
        let options = RendererOptions {
            color_format: COLOR,
            depth_format: globefill::wgpu::TextureFormat::Depth32Float,
            depth: like.range.convention(),
            sample_count: like.samples(),
            count,
            ..Default::default()
        };
        let mut renderer = Renderer::new(&gpu.device, options).expect("the options are sound");
        let mesh = renderer.insert(mesh);
        Self {
            gpu,
            renderer,
            options,
            mesh,
            view: View::default(),
        }
    }

    pub fn set(&mut self, fill: u32, style: FillStyle) {
        let set = self.renderer.set_style(self.mesh, fill, style);
        set.expect("the style is sound");
    }

    pub fn draw(&mut self, surface: &Surface) -> Painted {
        self.draw_within(surface, 0.25)
    }

    /// With boundaries within `pixel_error` of the true ones.
    pub fn draw_within(&mut self, surface: &Surface, pixel_error: f64) -> Painted {
        let (renderer, view) = (&mut self.renderer, &mut self.view);
        paint(
            self.gpu,
            renderer,
            &self.options,
            view,
            surface,
            pixel_error,
        )
    }
}

/// A mesh of one fill that covers all that an eye above `at` can see.
pub fn ground(at: LonLat) -> FillMesh {
    built(&[Region::from(Zone::circle(at, 1.9e7))])
}

pub fn built(regions: &[Region]) -> FillMesh {
    FillMesh::build(regions, &MeshOptions::default()).expect("the regions are sound")
}

pub fn bare(pose: &Pose, size_px: UVec2) -> Surface {
    over(Terrain::Bare, pose, size_px)
}

pub fn over(terrain: Terrain, pose: &Pose, size_px: UVec2) -> Surface {
    let cast = Cast::new(&figure(), pose, size_px, 1, terrain);
    Surface::new(&cast, DepthKind::Reversed)
}

/// A pose that looks `share` of the way from nadir to the limb, but at most 70° from nadir; from far away
/// with so narrow a view that the globe fills the picture.
pub fn pose(at: LonLat, height_m: f64, share: f64) -> Pose {
    let limb_deg = (6.37e6 / (6.37e6 + height_m)).asin().to_degrees();
    let tilt_deg = (share * limb_deg).min(70.0);
    let pose = Pose::nadir(at.lon_deg, at.lat_deg, height_m).turned(33.0, tilt_deg - 90.0);
    Pose {
        fov_deg: (1.6 * limb_deg).min(60.0),
        ..pose
    }
}

/// Metres that a pixel in the middle of the picture spans across the line of sight.
pub fn pixel_m(surface: &Surface) -> f64 {
    let lens = &surface.lens;
    let middle_px = lens.size_px.as_dvec2() * 0.5;
    let origin_m = lens.origin_m(middle_px);
    let hit = surface
        .terrain
        .hit(surface.figure(), origin_m, lens.ray(middle_px));
    let distance_m = hit.expect("the middle shows the ground");
    let [here, beside] =
        [DVec2::ZERO, DVec2::X].map(|step| lens.point_m(middle_px + step, distance_m));
    here.distance(beside)
}

/// The surface point seen at a point of the picture.
pub fn point_at(surface: &Surface, at_px: DVec2) -> Option<DVec3> {
    let lens = &surface.lens;
    let (origin_m, ray) = (lens.origin_m(at_px), lens.ray(at_px));
    let t = surface.terrain.hit(surface.figure(), origin_m, ray)?;
    Some(origin_m + ray * t)
}

/// The middle of a pixel.
pub fn middle_px(surface: &Surface, pixel: usize) -> DVec2 {
    let width = surface.size_px().x as usize;
    DVec2::new((pixel % width) as f64, (pixel / width) as f64) + 0.5
}
