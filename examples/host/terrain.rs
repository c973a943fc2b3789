//! Terrain on the GPU.

use std::ops::Range;

use globefill::{DepthConvention, Ellipsoid, HeightRange, wgpu, wgpu::util::DeviceExt};

use super::{
    camera::Eye,
    elevation::Elevation,
    gpu::Gpu,
    ground::{GroundPipeline, PICTURE, TargetFormat, UNIFORM},
    relief,
    terrain_mesh::{TerrainMesh, TerrainVertex, indices},
};

const SOURCE: &str = concat!(include_str!("host_view.wgsl"), include_str!("terrain.wgsl"));

/// The terrain that one camera sees.
pub struct Terrain {
    /// Between which heights all of it lies.
    pub heights: HeightRange,
    has_ground_beyond_grid: bool,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    /// Of every tile: its first vertex, and its triangles.
    draws: Vec<(i32, Range<u32>)>,
}

impl Terrain {
    pub fn new(gpu: &Gpu, ellipsoid: &Ellipsoid, elevation: &Elevation, eye: &Eye) -> Self {
        let seen = Seen::new(gpu, ellipsoid, elevation, eye);
        let (layout, group) = relief_group(gpu, ellipsoid, elevation);
        Self {
            heights: seen.heights,
            has_ground_beyond_grid: !elevation.is_whole_globe(),
            layout,
            group,
            vertices: seen.vertices,
            indices: seen.indices,
            draws: seen.draws,
        }
    }

    /// The same terrain as another camera sees it.
    pub fn look(&mut self, gpu: &Gpu, ellipsoid: &Ellipsoid, elevation: &Elevation, eye: &Eye) {
        let seen = Seen::new(gpu, ellipsoid, elevation, eye);
        self.heights = seen.heights;
        self.vertices = seen.vertices;
        self.indices = seen.indices;
        self.draws = seen.draws;
    }

    pub fn pipeline(
        &self,
        gpu: &Gpu,
        shared: &wgpu::BindGroupLayout,
        format: &TargetFormat,
        constants: &[(&str, f64)],
    ) -> wgpu::RenderPipeline {
        let beyond_grid = (
            "beyond_grid",
            f64::from(u8::from(self.has_ground_beyond_grid)),
        );
        GroundPipeline {
            label: "terrain",
            source: SOURCE,
            vertex: "terrain_vertex",
            fragment: "terrain_pixel",
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<TerrainVertex>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x2],
            })],
            groups: &[Some(shared), Some(&self.layout)],
            constants: &[constants, &[beyond_grid]].concat(),
            depth_compare: match format.convention {
                DepthConvention::Reversed => wgpu::CompareFunction::Greater,
                DepthConvention::Standard => wgpu::CompareFunction::Less,
            },
        }
        .create(&gpu.device, format)
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        // Below ground, or looking away from it, nothing is in sight, and empty buffers have no slice.
        if self.draws.is_empty() {
            return;
        }
        pass.set_bind_group(1, &self.group, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint16);
        for (first_vertex, triangles) in &self.draws {
            pass.draw_indexed(triangles.clone(), *first_vertex, 0..1);
        }
    }
}

/// What changes with the camera.
struct Seen {
    heights: HeightRange,
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    draws: Vec<(i32, Range<u32>)>,
}

impl Seen {
    fn new(gpu: &Gpu, ellipsoid: &Ellipsoid, elevation: &Elevation, eye: &Eye) -> Self {
        let mesh = TerrainMesh::new(ellipsoid, elevation, eye);
        let mut all_indices: Vec<u16> = Vec::new();
        let ranges: Vec<Range<u32>> = (0..16)
            .map(|coarser_sides| {
                let start = all_indices.len() as u32;
                all_indices.extend(indices(coarser_sides));
                start..all_indices.len() as u32
            })
            .collect();
        let mut vertices: Vec<TerrainVertex> = Vec::new();
        let mut draws = Vec::new();
        for tile in &mesh.tiles {
            let first = vertices.len() as i32;
            draws.push((first, ranges[tile.coarser_sides as usize].clone()));
            vertices.extend(&tile.vertices);
        }
        let buffer = |label, contents: &[u8], usage| {
            gpu.device
                .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: Some(label),
                    contents,
                    usage,
                })
        };
        Self {
            heights: mesh.heights,
            vertices: buffer(
                "terrain vertices",
                bytemuck::cast_slice(&vertices),
                wgpu::BufferUsages::VERTEX,
            ),
            indices: buffer(
                "terrain indices",
                bytemuck::cast_slice(&all_indices),
                wgpu::BufferUsages::INDEX,
            ),
            draws,
        }
    }
}

fn relief_group(
    gpu: &Gpu,
    ellipsoid: &Ellipsoid,
    elevation: &Elevation,
) -> (wgpu::BindGroupLayout, wgpu::BindGroup) {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let layout = gpu
        .device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("relief"),
            entries: &[entry(0, PICTURE), entry(1, UNIFORM)],
        });
    let picture = relief::picture(elevation, gpu.device.limits().max_texture_dimension_2d);
    let rows_m = elevation.step_deg().1.to_radians() * ellipsoid.a_m;
    let texel_m = rows_m * f64::from(elevation.size().y - 1) / f64::from(picture.size_px.y - 1);
    let uniform = gpu
        .device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("relief"),
            contents: bytemuck::bytes_of(&[texel_m as f32, 0.0, 0.0, 0.0]),
            usage: wgpu::BufferUsages::UNIFORM,
        });
    let picture = picture.upload(gpu, "relief", wgpu::TextureFormat::Rgba8UnormSrgb);
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("relief"),
        layout: &layout,
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&picture),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: uniform.as_entire_binding(),
            },
        ],
    });
    (layout, group)
}
