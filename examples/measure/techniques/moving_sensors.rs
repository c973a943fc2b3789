//! The crate's sensors: over each other in any order, and moving.

use globefill::{
    Extrusion, Pose, Renderer, RendererOptions, Sensor, SensorId, SensorStyle, View, wgpu,
};

use crate::{
    canvas::{Canvas, Paint},
    host::gpu::Gpu,
    invocations::InvocationQueries,
    scene::Sensors,
    stage::Stage,
    technique::{Cost, Technique},
};

const COLOR: [f32; 4] = [0.9, 0.4, 0.1, 0.3];

pub struct MovingSensors {
    canvas: Canvas,
    renderer: Renderer,
    view: View,
    sensors: Sensors,
    ids: Vec<SensorId>,
    /// Frames drawn.
    frame: u32,
}

impl MovingSensors {
    pub fn new(gpu: &Gpu, stage: &Stage, paint: Paint) -> Result<Self, String> {
        let sensors = stage
            .scene
            .sensors
            .clone()
            .ok_or("there are no sensors in this scene")?;
        if paint == Paint::Numbers {
            return Err("sensors lie over each other and have no numbers".into());
        }
        let canvas = Canvas::new(gpu, stage, paint)?;
        let options = RendererOptions {
            color_format: canvas.targets.format.color,
            depth_format: canvas.targets.format.depth,
            depth: canvas.targets.format.convention,
            ..Default::default()
        };
        let mut renderer =
            Renderer::new(&gpu.device, options).map_err(|error| error.to_string())?;
        let style = SensorStyle {
            color: COLOR,
            ..Default::default()
        };
        let ids = (0..sensors.feet.len())
            .map(|index| {
                let sensor = Sensor {
                    extrusion: Extrusion::Normal,
                    ..Sensor::new(
                        pose(stage, &sensors, index, 0),
                        sensors.field_of_view.clone(),
                    )
                };
                renderer.sensors_mut().insert(sensor, style)
            })
            .collect::<Result<_, _>>()
            .map_err(|error| error.to_string())?;
        Ok(Self {
            canvas,
            renderer,
            view: View::default(),
            sensors,
            ids,
            frame: 0,
        })
    }

    fn advance(&mut self, stage: &Stage) -> Result<(), String> {
        self.frame += 1;
        if self.sensors.step_deg == 0.0 {
            return Ok(());
        }
        for (index, &id) in self.ids.iter().enumerate() {
            let pose = pose(stage, &self.sensors, index, self.frame);
            let moved = self.renderer.sensors_mut().set_pose(id, pose);
            moved.map_err(|error| error.to_string())?;
        }
        Ok(())
    }
}

fn pose(stage: &Stage, sensors: &Sensors, index: usize, frame: u32) -> Pose {
    let mut foot = sensors.feet[index];
    foot.lon_deg += sensors.step_deg * f64::from(frame);
    let apex_ecef_m = stage.ellipsoid.ecef(foot, sensors.height_m);
    Pose::nadir(&stage.ellipsoid, apex_ecef_m)
}

impl Technique for MovingSensors {
    fn draw(
        &mut self,
        gpu: &Gpu,
        stage: &Stage,
        queries: Option<&InvocationQueries>,
    ) -> Result<Cost, String> {
        self.advance(stage)?;
        let targets = &self.canvas.targets;
        let mut encoder = self.canvas.begin(gpu, stage);
        let stats = self
            .renderer
            .prepare(&gpu.queue, &mut self.view, &stage.frame)
            .map_err(|error| error.to_string())?;
        self.renderer
            .count(&mut self.view, &mut encoder, &targets.depth_view);
        {
            let mut pass = targets.fill_pass(&mut encoder, self.canvas.load());
            if let Some(queries) = queries {
                pass.begin_pipeline_statistics_query(&queries.set, 0);
            }
            self.renderer.resolve(&self.view, &mut pass);
            if queries.is_some() {
                pass.end_pipeline_statistics_query();
            }
        }
        if let Some(queries) = queries {
            queries.resolve(&mut encoder);
        }
        gpu.run(encoder)?;
        Ok(Cost {
            draws: stats.draws + stats.dispatches,
            passes: stats.passes + 1,
            upload_bytes: stats.upload_bytes,
            gpu_bytes: stats.gpu_bytes,
            count: None,
        })
    }

    fn queries(&self) -> u32 {
        1
    }

    fn color(&self) -> &wgpu::Texture {
        &self.canvas.targets.color
    }
}
