//! The vertex-shader algorithm of old: a vertex and an index buffer with both ends of every column.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
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

/// Metres from the origin; 2 · fill, + 1 at the top.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Vertex {
    position: [f32; 3],
    fill_and_end: u32,
}

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
        let layout = wgpu::VertexBufferLayout {
            array_stride: size_of::<Vertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Uint32],
        };
        let pipeline = sums.pipeline(gpu, SHADER, &[Some(layout)]);
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

fn mesh(stage: &Stage) -> (Vec<Vertex>, Vec<u32>) {
    let (origin_m, top_m) = (eye_uniform::origin_m(stage), eye_uniform::top_m(stage));
    let (mut vertices, mut indices) = (Vec::new(), Vec::new());
    for (fill, faces) in (0..).zip(fill_faces::all(&stage.mesh)) {
        let first = vertices.len() as u32;
        for &position_m in &faces.vertices_m {
            let raised_m = position_m + stage.ellipsoid.normal_at_surface(position_m) * top_m;
            let vertex = |position_m: DVec3, end: u32| Vertex {
                position: (position_m - origin_m).as_vec3().to_array(),
                fill_and_end: 2 * fill + end,
            };
            vertices.extend([vertex(position_m, 0), vertex(raised_m, 1)]);
        }
        indices.extend(corners(&faces).map(|corner| first + corner));
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
