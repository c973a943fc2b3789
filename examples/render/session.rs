//! One run of the program: from the arguments to the finished files.

use std::{path::PathBuf, time::Instant};

use globefill::{Ellipsoid, FillMesh, FillStyle, Frame, MeshOptions, wgpu};
use serde_json::json;

use crate::{
    cli::Arguments,
    drawing::{Background, Drawing},
    host::{
        camera::{Eye, Shot},
        elevation::Elevation,
        gpu::Gpu,
        ground::{Ground, TargetFormat},
        output::{self, Outputs},
        palette, png,
        progress::Progress,
        targets::Targets,
    },
    measure, pictures, regions,
};

/// Runs the program.
pub fn run(arguments: &Arguments, progress: &Progress) -> Result<(), String> {
    let paths = output_paths(arguments)?;
    let ellipsoid = Ellipsoid::WGS84;
    progress.step("reading the terrain");
    let elevation = arguments
        .terrain
        .as_deref()
        .map(Elevation::read)
        .transpose()?;
    progress.step("meshing the regions");
    let start = Instant::now();
    let regions = regions::read(arguments)?;
    let mesh = FillMesh::build(
        &regions,
        &MeshOptions {
            ellipsoid,
            ..Default::default()
        },
    )
    .map_err(|error| regions::describe(arguments, &error))?;
    let build_ms = start.elapsed().as_secs_f64() * 1e3;
    if mesh.fills.len() > usize::from(u16::MAX)
        && (arguments.ids.is_some() || arguments.mask.is_some())
    {
        return Err("--ids and --mask can tell at most 65535 fills".into());
    }

    progress.step("opening the graphics adapter");
    let gpu = Gpu::open()?;
    let shot = Shot {
        fov_deg: arguments.fov,
        size_px: arguments.size,
        depth: arguments.depth.into(),
    };
    let eye = Eye::above(&ellipsoid, elevation.as_ref(), &arguments.camera, shot);
    progress.step("preparing the ground");
    let ground = Ground::new(&gpu, &ellipsoid, elevation.as_ref(), &eye)?;
    let work = Work {
        arguments,
        progress,
        gpu,
        eye,
        ground,
        mesh,
        build_ms,
    };
    let mut outputs = Outputs::default();
    work.draw_picture(&mut outputs)?;
    work.draw_measurements(&mut outputs)?;
    outputs.write()?;
    progress.finish();
    for path in paths {
        println!("{}", path.display());
    }
    Ok(())
}

/// The files to write, having checked that they can be.
fn output_paths(arguments: &Arguments) -> Result<Vec<PathBuf>, String> {
    let named = [
        &arguments.out,
        &arguments.mask,
        &arguments.ids,
        &arguments.positions,
        &arguments.stats,
    ];
    let paths: Vec<PathBuf> = named.into_iter().flatten().cloned().collect();
    for path in &paths {
        output::check_writable(path)?;
    }
    Ok(paths)
}

/// All that the drawings need.
struct Work<'a> {
    arguments: &'a Arguments,
    progress: &'a Progress,
    gpu: Gpu,
    eye: Eye,
    ground: Ground,
    mesh: FillMesh,
    build_ms: f64,
}

impl Work<'_> {
    fn frame(&self) -> Frame {
        Frame {
            camera: self.eye.camera,
            size_px: self.arguments.size,
            terrain: self.ground.heights(),
            pixel_error: self.arguments.pixel_error,
            host_pixel_error: 0.0,
        }
    }

    fn drawing(
        &self,
        color: wgpu::TextureFormat,
        sample_count: u32,
        background: Background,
        style: impl Fn(u32) -> FillStyle,
    ) -> Result<Drawing, String> {
        let format = TargetFormat {
            color,
            depth: wgpu::TextureFormat::Depth32Float,
            convention: self.arguments.depth.into(),
            sample_count,
        };
        let targets = Targets::new(
            &self.gpu,
            self.arguments.size,
            format,
            self.eye.clear_depth(),
        )?;
        let mut drawing = Drawing::new(
            &self.gpu,
            &self.ground,
            targets,
            background,
            self.mesh.clone(),
            self.arguments.count.into(),
        )?;
        for fill in 0..self.mesh.fills.len() as u32 {
            drawing.set_style(fill, style(fill))?;
        }
        Ok(drawing)
    }

    /// The picture that people look at, and the times it takes.
    fn draw_picture(&self, outputs: &mut Outputs) -> Result<(), String> {
        if self.arguments.out.is_none() && self.arguments.stats.is_none() {
            return Ok(());
        }
        self.progress.step("drawing the picture");
        let colors = palette::colors(&self.mesh);
        let mut drawing = self.drawing(
            wgpu::TextureFormat::Rgba8UnormSrgb,
            self.arguments.msaa,
            Background::Ground,
            |fill| FillStyle {
                color: colors[fill as usize],
                ..Default::default()
            },
        )?;
        let frame = self.frame();
        let first = drawing.draw(&self.gpu, &self.ground, &frame, None)?;
        if let Some(path) = &self.arguments.out {
            let texels = self.gpu.read_texture(&drawing.targets.color)?;
            outputs.add(path, png::rgb(self.arguments.size, &texels)?);
        }
        let Some(path) = &self.arguments.stats else {
            return Ok(());
        };
        self.progress.step("timing frames");
        self.progress.count(self.arguments.frames);
        let times = measure::times(
            &self.gpu,
            &self.ground,
            &mut drawing,
            &frame,
            self.arguments.frames,
            || self.progress.advance(),
        )?;
        let invocations = drawing.invocations(&self.gpu, &self.ground, &frame, first.passes)?;
        let stats = json!({
            "fills": first.fills,
            "drawn": first.drawn,
            "culled": first.culled,
            "build_ms": self.build_ms,
            "upload_bytes": first.upload_bytes,
            "gpu_bytes": first.gpu_bytes,
            "draws": first.draws,
            "vertices": first.vertices,
            "refined_chords": first.refined_chords,
            "layers": first.layers,
            "steady_upload_bytes": times.stats.upload_bytes,
            "vertex_invocations": invocations.as_ref().map(|counted| counted.vertex),
            "fragment_invocations": invocations.as_ref().map(|counted| counted.fragment),
            "frame_ms": times.frame_ms,
            "globe_ms": times.globe_ms,
            "frames": self.arguments.frames,
            "repairs": self.mesh.repairs.len(),
            "count": format!("{:?}", first.technique).to_lowercase(),
            "adapter": self.gpu.name,
        });
        outputs.add(path, format!("{stats:#}\n").into_bytes());
        Ok(())
    }

    /// Mask, identities and positions: one sample a pixel, no blending.
    fn draw_measurements(&self, outputs: &mut Outputs) -> Result<(), String> {
        let Arguments {
            mask,
            ids,
            positions,
            size,
            ..
        } = self.arguments;
        if mask.is_none() && ids.is_none() && positions.is_none() {
            return Ok(());
        }
        self.progress.step("drawing the measurements");
        let mut drawing = self.drawing(
            wgpu::TextureFormat::Rgba8Unorm,
            1,
            Background::Nothing,
            measure::identity_style,
        )?;
        drawing.draw(&self.gpu, &self.ground, &self.frame(), None)?;
        let identities = measure::identities(&self.gpu, &drawing)?;
        if let Some(path) = mask {
            let covered: Vec<u8> = identities
                .iter()
                .map(|&id| if id > 0 { 255 } else { 0 })
                .collect();
            outputs.add(path, pictures::png_grey8(*size, &covered)?);
        }
        if let Some(path) = ids {
            outputs.add(path, pictures::png_grey16(*size, &identities)?);
        }
        if let Some(path) = positions {
            let surface = measure::positions(&self.gpu, &drawing, &self.eye)?;
            outputs.add(path, pictures::npy_positions(*size, &surface));
        }
        Ok(())
    }
}
