//! The picture: ground, countries, footprints.

use std::time::Instant;

use globefill::{
    FieldOfView, FillMesh, Frame, FrameStats, Pose, Renderer, RendererOptions, Sensor,
    SensorDisplay, SensorId, SensorSet, SensorStyle, View, wgpu,
};

use crate::{
    cli::Arguments,
    colors::Color,
    country_layer::CountryLayer,
    host::{
        gpu::Gpu,
        ground::{Ground, GroundPipelines},
        targets::Targets,
        times::milliseconds_since,
    },
};

/// Targets, and a renderer that matches them.
pub struct Drawing {
    pub targets: Targets,
    pipelines: GroundPipelines,
    options: RendererOptions,
    countries: Option<CountryLayer>,
    renderer: Renderer,
    view: View,
    sensors: Vec<SensorId>,
}

/// What a frame cost.
pub struct Cost {
    /// Moving all sensors and preparing the frame.
    pub update_ms: f64,
    /// All that the CPU did until the frame was submitted, moving the sensors included.
    pub script_ms: f64,
    /// From moving the first sensor until the GPU was idle.
    pub frame_ms: f64,
    pub stats: FrameStats,
}

impl Drawing {
    pub fn new(gpu: &Gpu, ground: &Ground, targets: Targets) -> Result<Self, String> {
        let options = RendererOptions {
            color_format: targets.format.color,
            depth_format: targets.format.depth,
            depth: targets.format.convention,
            sample_count: targets.format.sample_count,
            ..Default::default()
        };
        Ok(Self {
            pipelines: ground.pipelines(gpu, &targets.format),
            targets,
            options,
            countries: None,
            renderer: Renderer::new(&gpu.device, options).map_err(|error| error.to_string())?,
            view: View::default(),
            sensors: Vec::new(),
        })
    }

    /// Draws the countries, to be laid beneath the footprints of every frame.
    pub fn set_countries(
        &mut self,
        gpu: &Gpu,
        ground: &Ground,
        frame: &Frame,
        mesh: FillMesh,
    ) -> Result<(), String> {
        let ground = (ground, &self.pipelines);
        let layer = CountryLayer::new(gpu, ground, &self.targets, self.options, frame, mesh)?;
        self.countries = Some(layer);
        Ok(())
    }

    /// What drawing the countries took.
    pub fn countries_ms(&self) -> Option<f64> {
        self.countries.as_ref().map(|layer| layer.drawn_ms)
    }

    /// Adds a sensor for every pose; those without one are hidden until they get one.
    pub fn insert_sensors(
        &mut self,
        arguments: &Arguments,
        field_of_view: &FieldOfView,
        poses: &[Option<Pose>],
    ) -> Result<(), String> {
        let Some(somewhere) = poses.iter().copied().flatten().next() else {
            return Err("none of the satellites can be propagated to the newest epoch".into());
        };
        let set = self.renderer.sensors_mut();
        for pose in poses {
            let sensor = Sensor {
                min_elevation_rad: arguments.min_elevation.map(f64::to_radians),
                extrusion: arguments.extrusion.into(),
                ..Sensor::new(pose.unwrap_or(somewhere), field_of_view.clone())
            };
            let style = SensorStyle {
                visible: pose.is_some(),
                ..Default::default()
            };
            let id = set
                .insert(sensor, style)
                .map_err(|error| error.to_string())?;
            self.sensors.push(id);
        }
        Ok(())
    }

    pub fn sensors(&self) -> &SensorSet {
        self.renderer.sensors()
    }

    pub fn set_colors(&mut self, colors: &[Color]) -> Result<(), String> {
        let set = self.renderer.sensors_mut();
        for (&id, &color) in self.sensors.iter().zip(colors) {
            let visible = set.get(id).is_some_and(|(_, style)| style.visible);
            set.set_style(id, SensorStyle { color, visible })
                .map_err(|error| error.to_string())?;
        }
        Ok(())
    }

    pub fn set_display(&mut self, display: SensorDisplay) {
        self.renderer.sensors_mut().set_display(display);
    }

    fn set_poses(&mut self, poses: &[Option<Pose>]) -> Result<(), String> {
        let set = self.renderer.sensors_mut();
        for (&id, &pose) in self.sensors.iter().zip(poses) {
            if let Some(pose) = pose {
                set.set_pose(id, pose).map_err(|error| error.to_string())?;
            }
            show(set, id, pose.is_some())?;
        }
        Ok(())
    }

    /// Draws the ground alone and waits for it.
    pub fn draw_ground(&self, gpu: &Gpu, ground: &Ground) -> Result<(), String> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.targets
            .draw_ground(&mut encoder, ground, &self.pipelines, true);
        gpu.run(encoder)
    }

    /// Moves every sensor, draws it all and waits for it.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        ground: &Ground,
        frame: &Frame,
        poses: &[Option<Pose>],
    ) -> Result<Cost, String> {
        let start = Instant::now();
        self.set_poses(poses)?;
        let stats = self
            .renderer
            .prepare(&gpu.queue, &mut self.view, frame)
            .map_err(|error| error.to_string())?;
        let update_ms = milliseconds_since(start);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.targets
            .draw_ground(&mut encoder, ground, &self.pipelines, false);
        self.renderer
            .count(&mut self.view, &mut encoder, &self.targets.depth_view);
        if let Some(countries) = &self.countries {
            countries.copy_to(&mut encoder, &self.targets.color);
        }
        self.renderer.resolve(
            &self.view,
            &mut self.targets.fill_pass(&mut encoder, wgpu::LoadOp::Load),
        );
        gpu.queue.submit([encoder.finish()]);
        let script_ms = milliseconds_since(start);
        gpu.wait()?;
        Ok(Cost {
            update_ms,
            script_ms,
            frame_ms: milliseconds_since(start),
            stats,
        })
    }
}

fn show(set: &mut SensorSet, id: SensorId, visible: bool) -> Result<(), String> {
    match set.get(id) {
        Some((_, &style)) if style.visible != visible => set
            .set_style(id, SensorStyle { visible, ..style })
            .map_err(|error| error.to_string()),
        _ => Ok(()),
    }
}
