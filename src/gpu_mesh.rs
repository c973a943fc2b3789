//! A mesh on the GPU: written once, when inserted.

use wgpu::util::DeviceExt as _;

use crate::{fill_mesh::FillMesh, fixed_point::encode, select::slot};

/// In `arc_of`: a slot between two arcs; the same in extrude.wgsl.
const BREAK: u32 = u32::MAX;

/// Buffers of one mesh.
pub(crate) struct GpuMesh {
    /// Boundary slots, arc after arc with a break behind each, then the caps' interior vertices.
    pub vertices: wgpu::Buffer,
    /// The arc of each boundary slot.
    pub arc_of: wgpu::Buffer,
    /// Left and right piece of each arc, plus one.
    pub arcs: wgpu::Buffer,
    /// Vertex indices of the cap triangles.
    pub cap_indices: wgpu::Buffer,
}

impl GpuMesh {
    pub(crate) fn new(device: &wgpu::Device, mesh: &FillMesh) -> Self {
        let layout = SlotLayout::new(mesh);
        let buffer = |label, contents: &[u8], usage| {
            // Empty bindings are not allowed: a mesh without arcs still binds one word.
            let contents = if contents.is_empty() {
                &[0; 16]
            } else {
                contents
            };
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(label),
                contents,
                usage,
            })
        };
        let storage = wgpu::BufferUsages::STORAGE;
        let arcs: Vec<[u32; 2]> = mesh
            .arcs
            .iter()
            .map(|arc| [arc.left, arc.right].map(|piece| piece.map_or(0, |piece| piece + 1)))
            .collect();
        Self {
            vertices: buffer(
                "globefill vertices",
                bytemuck::cast_slice(&layout.vertices),
                storage,
            ),
            arc_of: buffer(
                "globefill arc of slot",
                bytemuck::cast_slice(&layout.arc_of),
                storage,
            ),
            arcs: buffer("globefill arcs", bytemuck::cast_slice(&arcs), storage),
            cap_indices: buffer(
                "globefill caps",
                bytemuck::cast_slice(&layout.cap_indices),
                wgpu::BufferUsages::INDEX,
            ),
        }
    }
}

impl FillMesh {
    /// Bytes that the mesh takes on the GPU: 16 a vertex, 4 more for its arc if on the boundary, 12 a
    /// cap triangle; 28 an arc, for its sides and the break behind it. Walls take none.
    pub fn gpu_bytes(&self) -> u64 {
        let slots = self.boundary.len() + self.arcs.len();
        let vertices = self.vertices.len() + self.arcs.len();
        (16 * vertices + 4 * slots + 8 * self.arcs.len() + 12 * self.cap_triangles.len()) as u64
    }
}

/// The mesh's vertices with a break behind each arc, so that one strip may run over many arcs.
struct SlotLayout {
    vertices: Vec<[i32; 4]>,
    arc_of: Vec<u32>,
    cap_indices: Vec<[u32; 3]>,
}

impl SlotLayout {
    fn new(mesh: &FillMesh) -> Self {
        let boundary_count = mesh.boundary.len();
        let slot_count = boundary_count + mesh.arcs.len();
        let mut vertices = Vec::with_capacity(mesh.vertices.len() + mesh.arcs.len());
        let mut arc_of = Vec::with_capacity(slot_count);
        let mut slot_of = Vec::with_capacity(boundary_count);
        for (index, arc) in (0..).zip(&mesh.arcs) {
            for vertex in arc.first_vertex..arc.first_vertex + arc.vertex_count {
                slot_of.push(slot(index, vertex));
                vertices.push(encode(mesh.vertices[vertex as usize]));
                arc_of.push(index);
            }
            vertices.push([0; 4]);
            arc_of.push(BREAK);
        }
        vertices.extend(mesh.vertices[boundary_count..].iter().copied().map(encode));
        let arc_count = mesh.arcs.len() as u32;
        let cap_indices = mesh
            .cap_triangles
            .iter()
            .map(|triangle| {
                triangle.map(|vertex| match slot_of.get(vertex as usize) {
                    Some(&slot) => slot,
                    None => vertex + arc_count,
                })
            })
            .collect();
        Self {
            vertices,
            arc_of,
            cap_indices,
        }
    }
}
