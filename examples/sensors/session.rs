//! One run of the program: from the arguments to the finished files.

use std::{
    fs,
    path::{Path, PathBuf},
    time::Instant,
};

use globefill::{
    DepthConvention, Ellipsoid, FillMesh, Frame, MeshOptions, SensorDisplay, countries::Dataset,
    wgpu,
};
use serde_json::json;

use crate::{
    cli::Arguments,
    colors,
    drawing::Drawing,
    host::{
        camera::{Eye, Shot},
        elevation::Elevation,
        gpu::Gpu,
        ground::{Ground, TargetFormat},
        output::{self, Outputs},
        png,
        progress::Progress,
        targets::Targets,
        times::{WARM_UP, milliseconds_since},
    },
    measure::{Costs, Overlap},
    scene::Scene,
};

/// Runs the program.
pub fn run(arguments: &Arguments, progress: &Progress) -> Result<(), String> {
    if let Some(path) = &arguments.stats {
        output::check_writable(path)?;
    }
    let ellipsoid = Ellipsoid::WGS84;
    progress.step("placing the sensors");
    let scene = Scene::new(arguments, &ellipsoid)?;
    let elevation = arguments
        .terrain
        .as_deref()
        .map(Elevation::read)
        .transpose()?;
    progress.step("opening the graphics adapter");
    let gpu = Gpu::open()?;
    progress.step("preparing the ground");
    let shot = Shot {
        fov_deg: arguments.fov,
        size_px: arguments.size,
        depth: DepthConvention::Reversed,
    };
    let eye = Eye::above(&ellipsoid, elevation.as_ref(), &arguments.camera, shot);
    let ground = Ground::new(&gpu, &ellipsoid, elevation.as_ref(), &eye)?;
    let format = TargetFormat {
        color: wgpu::TextureFormat::Rgba8UnormSrgb,
        depth: wgpu::TextureFormat::Depth32Float,
        convention: shot.depth,
        sample_count: 1,
    };
    let targets = Targets::new(&gpu, arguments.size, format, eye.clear_depth())?;
    let frame = Frame {
        terrain: ground.heights(),
        host_pixel_error: 0.0,
        ..Frame::new(eye.camera, arguments.size)
    };
    let mut drawing = Drawing::new(&gpu, &ground, targets)?;
    if !arguments.no_countries {
        progress.step("meshing the countries");
        drawing.set_countries(&gpu, &ground, &frame, countries()?)?;
    }
    progress.step("measuring how deep footprints overlap");
    drawing.insert_sensors(arguments, &scene.field_of_view, &scene.poses(0))?;
    let overlap = Overlap::of(drawing.sensors());
    paint(arguments, &scene, &overlap, &mut drawing)?;

    if let Some(directory) = &arguments.out {
        fs::create_dir_all(directory)
            .map_err(|error| format!("{}: cannot make it: {error}", directory.display()))?;
    }
    let mut film = Film {
        arguments,
        progress,
        frame,
        gpu,
        ground,
        scene,
        drawing,
        costs: Costs::default(),
    };
    film.shoot()?;
    film.report(&overlap)
}

fn countries() -> Result<FillMesh, String> {
    let regions: Vec<_> = Dataset::Countries50m
        .countries()
        .into_iter()
        .map(|country| country.region)
        .collect();
    FillMesh::build(&regions, &MeshOptions::default()).map_err(|error| error.to_string())
}

/// Gives the sensors the colours that the command line asks for.
fn paint(
    arguments: &Arguments,
    scene: &Scene,
    overlap: &Overlap,
    drawing: &mut Drawing,
) -> Result<(), String> {
    let ramp = if arguments.coverage {
        Some(colors::coverage(overlap.most))
    } else {
        arguments.threshold.map(colors::threshold)
    };
    if let Some(ramp) = ramp {
        drawing.set_display(SensorDisplay::Coverage(
            ramp.map_err(|error| error.to_string())?,
        ));
    }
    let mut colors = scene.colors(colors::opacity(overlap.mean));
    if let Some(color) = arguments.color {
        colors.fill(color);
    }
    drawing.set_colors(&colors)
}

/// The frames in turn.
struct Film<'a> {
    arguments: &'a Arguments,
    progress: &'a Progress,
    frame: Frame,
    gpu: Gpu,
    ground: Ground,
    scene: Scene,
    drawing: Drawing,
    costs: Costs,
}

impl Film<'_> {
    fn shoot(&mut self) -> Result<(), String> {
        self.progress.step("drawing");
        self.progress.count(self.arguments.frames);
        // The frames before the first are like all others, but nobody looks at them.
        for index in -(WARM_UP as i32)..self.arguments.frames as i32 {
            let start = Instant::now();
            let poses = self.scene.poses(index);
            let propagation_ms = milliseconds_since(start);
            let start = Instant::now();
            self.drawing.draw_ground(&self.gpu, &self.ground)?;
            let globe_ms = milliseconds_since(start);
            let cost = self
                .drawing
                .draw(&self.gpu, &self.ground, &self.frame, &poses)?;
            if index < 0 {
                continue;
            }
            self.costs.propagation_ms.push(propagation_ms);
            self.costs.globe_ms.push(globe_ms);
            self.costs.frames.push(cost);
            if let Some(directory) = &self.arguments.out {
                self.save(&picture_path(directory, index))?;
            }
            self.progress.advance();
        }
        Ok(())
    }

    fn save(&self, path: &Path) -> Result<(), String> {
        let texels = self.gpu.read_texture(&self.drawing.targets.color)?;
        let mut outputs = Outputs::default();
        outputs.add(path, png::rgb(self.arguments.size, &texels)?);
        outputs.write()
    }

    /// Writes the stats, and says what there is to look at.
    fn report(&self, overlap: &Overlap) -> Result<(), String> {
        let sensors = self.drawing.sensors().len();
        if let Some(path) = &self.arguments.stats {
            let mut stats = self.costs.summary(sensors);
            stats["mean_overlap"] = json!(overlap.mean);
            stats["mode"] = json!(self.mode());
            stats["countries_ms"] = json!(self.drawing.countries_ms());
            stats["adapter"] = json!(self.gpu.name);
            let mut outputs = Outputs::default();
            outputs.add(path, format!("{stats:#}\n").into_bytes());
            outputs.write()?;
        }
        self.progress.finish();
        let visible = self
            .costs
            .frames
            .last()
            .map_or(0, |cost| cost.stats.sensors);
        if (visible as usize) < sensors {
            eprintln!("note: {visible} of {sensors} satellites are in orbit in the last frame");
        }
        if let Some(directory) = &self.arguments.out {
            for index in 0..self.arguments.frames as i32 {
                println!("{}", picture_path(directory, index).display());
            }
        }
        if let Some(path) = &self.arguments.stats {
            println!("{}", path.display());
        }
        Ok(())
    }

    /// What is shown of the footprints.
    fn mode(&self) -> &'static str {
        match self.arguments {
            Arguments { coverage: true, .. } => "coverage",
            Arguments {
                threshold: Some(_), ..
            } => "threshold",
            _ => "blended",
        }
    }
}

fn picture_path(directory: &Path, index: i32) -> PathBuf {
    directory.join(format!("frame-{index:04}.png"))
}
