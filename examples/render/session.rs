//! One run of the program: from the arguments to the finished files.

use std::{path::PathBuf, time::Instant};

use globefill::{Ellipsoid, FillMesh, FillStyle, Frame, MeshOptions, wgpu};
use serde_json::json;

use crate::{
    cli::Arguments,
    drawing::{Background, Drawing, Technique},
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
    style::{self, Images, Look},
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
    let (regions, looks) = regions::read(arguments)?;
    let image_files = style::files(&looks)?;
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
        looks,
        image_files,
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
    /// Of every fill.
    looks: Vec<Look>,
    /// What the looks show.
    image_files: Vec<PathBuf>,
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
            log_depth: None,
        }
    }

    /// Fills still have the default style.
    fn drawing(
        &self,
        color: wgpu::TextureFormat,
        sample_count: u32,
        background: Background,
        smooth_edges: bool,
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
        Drawing::new(
            &self.gpu,
            &self.ground,
            targets,
            background,
            self.mesh.clone(),
            Technique {
                count: self.arguments.count.into(),
                smooth_edges,
            },
        )
    }

    /// What the picture is drawn with; `smooth_edges` is part of the style.
    fn picture_drawing(&self, smooth_edges: bool) -> Result<Drawing, String> {
        self.drawing(
            wgpu::TextureFormat::Rgba8UnormSrgb,
            self.arguments.msaa,
            Background::Ground,
            smooth_edges,
        )
    }

    fn set_styles(
        &self,
        drawing: &mut Drawing,
        style: impl Fn(&Look, u32) -> FillStyle,
    ) -> Result<(), String> {
        (0..)
            .zip(&self.looks)
            .try_for_each(|(fill, look)| drawing.set_style(fill, style(look, fill)))
    }

    fn styled_drawing(&self, colors: &[[f32; 4]]) -> Result<Drawing, String> {
        let mut drawing = self.picture_drawing(self.arguments.style.smooth_edges)?;
        let mut images = Images::new();
        for path in &self.image_files {
            images.insert(path.clone(), drawing.insert_image(&self.gpu, path)?);
        }
        self.set_styles(&mut drawing, |look, fill| {
            look.style(colors[fill as usize], &images)
        })?;
        Ok(drawing)
    }

    /// The picture in plain colours, if it is not that already. A drawing of its own: styles that change
    /// from frame to frame would cost time themselves.
    fn solid_drawing(&self, colors: &[[f32; 4]]) -> Result<Option<Drawing>, String> {
        if !self.arguments.style.smooth_edges && self.looks.iter().all(Look::is_solid) {
            return Ok(None);
        }
        let mut drawing = self.picture_drawing(false)?;
        self.set_styles(&mut drawing, |look, fill| {
            look.solid_style(colors[fill as usize])
        })?;
        Ok(Some(drawing))
    }

    /// The picture that people look at, and the times it takes.
    fn draw_picture(&self, outputs: &mut Outputs) -> Result<(), String> {
        if self.arguments.out.is_none() && self.arguments.stats.is_none() {
            return Ok(());
        }
        self.progress.step("drawing the picture");
        let colors = palette::colors(&self.mesh);
        let mut drawing = self.styled_drawing(&colors)?;
        let frame = self.frame();
        let first = drawing.draw(&self.gpu, &self.ground, &frame, None)?;
        if let Some(path) = &self.arguments.out {
            let texels = self.gpu.read_texture(&drawing.targets.color)?;
            outputs.add(path, png::rgb(self.arguments.size, &texels)?);
        }
        let Some(path) = &self.arguments.stats else {
            return Ok(());
        };
        let mut solid = self.solid_drawing(&colors)?;
        self.progress.step("timing frames");
        self.progress.count(self.arguments.frames);
        let times = measure::times(
            &self.gpu,
            &self.ground,
            &mut drawing,
            solid.as_mut(),
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
            "level": first.level,
            "refined_chords": first.refined_chords,
            "layers": first.layers,
            "steady_upload_bytes": times.stats.upload_bytes,
            "vertex_invocations": invocations.as_ref().map(|counted| counted.vertex),
            "fragment_invocations": invocations.as_ref().map(|counted| counted.fragment),
            "frame_ms": times.frame_ms,
            "solid_ms": times.solid_ms,
            "style_extra_globes": times.style_extra_globes,
            "globe_ms": times.globe_ms,
            "frames": self.arguments.frames,
            "repairs": self.mesh.repairs.len(),
            "count": format!("{:?}", first.technique).to_lowercase(),
            "adapter": self.gpu.name,
        });
        outputs.add(path, format!("{stats:#}\n").into_bytes());
        Ok(())
    }

    /// Mask, identities and positions: one sample a pixel, no blending; of the looks only the order.
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
            false,
        )?;
        self.set_styles(&mut drawing, |look, fill| {
            measure::identity_style(fill, look.z_index)
        })?;
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
