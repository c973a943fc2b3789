//! The geometry-shader algorithm of old, by vertex pulling: one stream of triples, each expanded on its own.

use globefill::wgpu::{self, util::DeviceExt};

use super::{eye_uniform, fill_faces, volume_sums::VolumeSums};
use crate::{
    canvas::Paint,
    host::gpu::Gpu,
    invocations::InvocationQueries,
    stage::Stage,
    technique::{Cost, Technique},
};

const SHADER: &str = include_str!("records.wgsl");
/// What a record becomes: two triangles.
const CORNERS: u32 = 6;

pub struct Records {
    sums: VolumeSums,
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    gpu_bytes: u64,
    records: u32,
}

impl Records {
    pub fn new(gpu: &Gpu, stage: &Stage, paint: Paint) -> Result<Self, String> {
        let sums = VolumeSums::new(gpu, stage, paint)?;
        let (vertices, records) = stream(stage);
        if records.len() as u64 * u64::from(CORNERS) > u64::from(u32::MAX) {
            return Err("more corners than a draw has".into());
        }
        let buffer = |contents: &[u8]| {
            gpu.device
                .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: Some("records"),
                    contents,
                    usage: wgpu::BufferUsages::STORAGE,
                })
        };
        let pipeline = sums.pipeline(gpu, SHADER, &[]);
        let vertices = buffer(bytemuck::cast_slice(&vertices));
        let stream = buffer(bytemuck::cast_slice(&records));
        Ok(Self {
            group: sums.group(gpu, &pipeline, &[&vertices, &stream]),
            sums,
            pipeline,
            gpu_bytes: vertices.size() + stream.size(),
            records: records.len() as u32,
        })
    }
}

/// Positions, and triples with their fill: caps (a, b, c), walls (a, b, b).
fn stream(stage: &Stage) -> (Vec<[f32; 4]>, Vec<[u32; 4]>) {
    let origin_m = eye_uniform::origin_m(stage);
    let (mut vertices, mut records) = (Vec::new(), Vec::new());
    for (fill, faces) in (0..).zip(fill_faces::all(&stage.mesh)) {
        let first = vertices.len() as u32;
        let placed = faces.vertices_m.iter();
        vertices.extend(placed.map(|&position_m| {
            let relative_m = (position_m - origin_m).as_vec3();
            relative_m.extend(0.0).to_array()
        }));
        let caps = faces.triangles.iter().copied();
        let walls = faces.edges.iter().map(|&[a, b]| [a, b, b]);
        records.extend(
            caps.chain(walls)
                .map(|[a, b, c]| [first + a, first + b, first + c, fill]),
        );
    }
    (vertices, records)
}

impl Technique for Records {
    fn draw(
        &mut self,
        gpu: &Gpu,
        stage: &Stage,
        queries: Option<&InvocationQueries>,
    ) -> Result<Cost, String> {
        let cost = self.sums.draw(gpu, stage, queries, |pass| {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.group, &[]);
            pass.draw(0..CORNERS * self.records, 0..1);
        })?;
        Ok(Cost {
            gpu_bytes: self.gpu_bytes,
            ..cost
        })
    }

    fn queries(&self) -> u32 {
        2
    }

    fn color(&self) -> &wgpu::Texture {
        &self.sums.canvas.targets.color
    }
}
