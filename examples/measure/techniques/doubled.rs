//! The vertex-shader algorithm of old: a vertex and an index buffer with both ends of every column.

use globefill::wgpu::{self, util::DeviceExt};

use super::{
    eye_uniform,
    fill_faces::{self, FillFaces},
    volume_sums::VolumeSums,
};
use crate::{
    canvas::Paint,
    host::gpu::Gpu,
    invocations::InvocationQueries,
    stage::Stage,
    technique::{Cost, Technique},
};

const SHADER: &str = include_str!("doubled.wgsl");

pub struct Doubled {
    sums: VolumeSums,
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    index_count: u32,
}

impl Doubled {
    pub fn new(gpu: &Gpu, stage: &Stage, paint: Paint) -> Result<Self, String> {
        let sums = VolumeSums::new(gpu, stage, paint)?;
        let (vertices, indices) = mesh(stage);
        let encoding = stage.settings.yardstick.encoding;
        let source = [encoding.source(), SHADER].concat();
        let pipeline = sums.pipeline(gpu, &source, &[Some(encoding.layout())]);
        let buffer = |contents: &[u8], usage| {
            gpu.device
                .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: Some("doubled"),
                    contents,
                    usage,
                })
        };
        Ok(Self {
            group: sums.group(gpu, &pipeline, &[]),
            sums,
            pipeline,
            vertices: buffer(bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX),
            index_count: indices.len() as u32,
            indices: buffer(bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX),
        })
    }
}

/// Vertices as the encoding stores them, and triangles.
fn mesh(stage: &Stage) -> (Vec<u32>, Vec<u32>) {
    let (origin_m, top_m) = (eye_uniform::origin_m(stage), eye_uniform::top_m(stage));
    let normal_scale = eye_uniform::normal_scale(stage);
    let encoding = stage.settings.yardstick.encoding;
    let (mut vertices, mut indices, mut first) = (Vec::new(), Vec::new(), 0);
    for (fill, faces) in (0..).zip(fill_faces::all(&stage.mesh)) {
        for &position_m in &faces.vertices_m {
            let raised_m = position_m + (position_m * normal_scale).normalize() * top_m;
            encoding.push(&mut vertices, position_m, origin_m, 2 * fill);
            encoding.push(&mut vertices, raised_m, origin_m, 2 * fill + 1);
        }
        indices.extend(corners(&faces).map(|corner| first + corner));
        first += 2 * faces.vertices_m.len() as u32;
    }
    (vertices, indices)
}

/// Triangles that face outwards; vertex k is at 2k below and at 2k + 1 above.
fn corners(faces: &FillFaces) -> impl Iterator<Item = u32> {
    let caps = faces.triangles.iter().flat_map(|&[a, b, c]| {
        let top = [a, b, c].map(|corner| 2 * corner + 1);
        let bottom = [a, c, b].map(|corner| 2 * corner);
        top.into_iter().chain(bottom)
    });
    let walls = faces.edges.iter().flat_map(|&[a, b]| {
        let [below, above] = [[2 * a, 2 * b], [2 * a + 1, 2 * b + 1]];
        [below[0], below[1], above[1], below[0], above[1], above[0]]
    });
    caps.chain(walls)
}

impl Technique for Doubled {
    fn draw(
        &mut self,
        gpu: &Gpu,
        stage: &Stage,
        queries: Option<&InvocationQueries>,
    ) -> Result<Cost, String> {
        let cost = self.sums.draw(gpu, stage, queries, |pass| {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.group, &[]);
            pass.set_vertex_buffer(0, self.vertices.slice(..));
            pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..self.index_count, 0, 0..1);
        })?;
        Ok(Cost {
            gpu_bytes: self.vertices.size() + self.indices.size(),
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

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use glam::DVec3;

    use super::*;

    /// A tetrahedron's worth: two caps that share an edge, and the four walls about them.
    #[test]
    fn volumes_are_closed() {
        let faces = FillFaces {
            vertices_m: vec![DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            edges: vec![[0, 1], [1, 2], [2, 3], [3, 0]],
        };
        let corners: Vec<u32> = corners(&faces).collect();
        let (triangles, rest) = corners.as_chunks::<3>();
        assert!(rest.is_empty() && triangles.len() == 2 * 2 + 4 * 2);
        let mut walks: HashMap<(u32, u32), i32> = HashMap::new();
        for [a, b, c] in triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *walks.entry((*from, *to)).or_default() += 1;
                *walks.entry((*to, *from)).or_default() -= 1;
            }
        }
        assert!(walks.values().all(|&sum| sum == 0));
    }
}
