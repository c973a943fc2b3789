//! globefill beside other middleware: countries with their names on them, which glyphon draws in the
//! pass that the fills are resolved in. Writes out/labels.png.
//!
//! Both crates borrow the host's device, queue and pass. The fills come first; what is drawn after
//! `resolve` stays unfilled.

#[path = "host/mod.rs"]
mod host;
#[path = "labels/names.rs"]
mod names;

use std::path::Path;

use glam::UVec2;
use globefill::{
    DepthConvention, Ellipsoid, FillMesh, FillStyle, Frame, LonLat, MeshOptions, Region, Renderer,
    RendererOptions, Stroke, View, countries::Dataset, wgpu,
};
use host::{
    camera::{Eye, Shot, Viewpoint},
    gpu::Gpu,
    ground::{Ground, TargetFormat},
    output::Outputs,
    palette, png,
    targets::Targets,
};
use names::Names;

const SIZE: UVec2 = UVec2::new(1280, 720);
const SAMPLES: u32 = 4;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ellipsoid = Ellipsoid::WGS84;
    let gpu = Gpu::open()?;
    let shot = Shot {
        fov_deg: 45.0,
        size_px: SIZE,
        depth: DepthConvention::Reversed,
    };
    let viewpoint = Viewpoint {
        foot: LonLat::new(14.0, 36.0),
        height_m: 3.5e6,
        heading_deg: 0.0,
        pitch_deg: -70.0,
    };
    let eye = Eye::above(&ellipsoid, None, &viewpoint, shot);
    let ground = Ground::new(&gpu, &ellipsoid, None, &eye)?;
    let format = TargetFormat {
        color: wgpu::TextureFormat::Rgba8UnormSrgb,
        depth: wgpu::TextureFormat::Depth32Float,
        convention: DepthConvention::Reversed,
        sample_count: SAMPLES,
    };
    let targets = Targets::new(&gpu, SIZE, format, eye.clear_depth())?;
    let pipelines = ground.pipelines(&gpu, &format);

    let countries = Dataset::Countries50m.countries();
    let regions: Vec<Region> = countries.iter().map(|it| it.region.clone()).collect();
    let mesh = FillMesh::build(&regions, &MeshOptions::default())?;
    let (mut renderer, mut view) = fills(&gpu, &format, mesh)?;
    let mut names = Names::new(&gpu, &format)?;
    names.place(&countries, &ellipsoid, &eye)?;
    names.prepare(&gpu, SIZE)?;

    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    targets.draw_ground(&mut encoder, &ground, &pipelines, false);
    let frame = Frame::new(eye.camera, SIZE);
    renderer.prepare(&gpu.queue, &mut view, &frame)?;
    renderer.count(&mut view, &mut encoder, &targets.depth_view);
    let mut pass = targets.fill_pass(&mut encoder, wgpu::LoadOp::Load);
    renderer.resolve(&view, &mut pass);
    names.render(&mut pass)?;
    drop(pass);
    gpu.run(encoder)?;

    let path = Path::new("out/labels.png");
    let texels = gpu.read_texture(&targets.color)?;
    let mut outputs = Outputs::default();
    outputs.add(path, png::rgb(SIZE, &texels)?);
    outputs.write()?;
    println!("{}: {} names", path.display(), names.len());
    Ok(())
}

/// A renderer with the countries, each in a colour of its own.
fn fills(
    gpu: &Gpu,
    format: &TargetFormat,
    mesh: FillMesh,
) -> Result<(Renderer, View), Box<dyn std::error::Error>> {
    let options = RendererOptions {
        color_format: format.color,
        depth_format: format.depth,
        depth: format.convention,
        sample_count: format.sample_count,
        ..Default::default()
    };
    let mut renderer = Renderer::new(&gpu.device, options)?;
    let colors = palette::colors(&mesh);
    let mesh = renderer.insert(mesh);
    for (fill, color) in (0..).zip(colors) {
        let style = FillStyle {
            color,
            stroke: Some(Stroke {
                color: [1.0, 1.0, 1.0, 0.7],
                ..Default::default()
            }),
            ..Default::default()
        };
        renderer.set_style(mesh, fill, style)?;
    }
    Ok((renderer, View::default()))
}
