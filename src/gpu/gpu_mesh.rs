//! A mesh on the GPU: written once, when inserted.

use std::sync::OnceLock;

use crate::{
    fill_mesh::FillMesh,
    frame::edge_draws::{EdgeSlot, edge_slots},
    frame::select::slot,
    gpu::filled_buffer::FilledBuffer as _,
    gpu::fixed_point::encode,
};

/// Boundary slots that share an entry of `arc_at`; the same in extrude.wgsl.
const BLOCK: usize = 16;

/// Buffers of one mesh.
pub(crate) struct GpuMesh {
    /// Boundary slots, arc after arc with a break behind each, then the caps' interior vertices.
    pub vertices: wgpu::Buffer,
    /// The arc of the first slot of every block of boundary slots.
    pub arc_at: wgpu::Buffer,
    /// Sides and break of each arc.
    pub arcs: wgpu::Buffer,
    /// Vertex indices of the cap triangles.
    pub cap_indices: wgpu::Buffer,
    /// Made when edges are first wanted.
    edge_slots: OnceLock<EdgeSlots>,
}

/// Boundary slots as the edge pass reads them.
pub(crate) struct EdgeSlots {
    pub slots: Vec<EdgeSlot>,
    pub buffer: wgpu::Buffer,
}

impl GpuMesh {
    pub(crate) fn new(device: &wgpu::Device, mesh: &FillMesh) -> Self {
        let storage = wgpu::BufferUsages::STORAGE;
        let buffer = |label, contents: &[u8], usage| {
            // Empty bindings are not allowed: a mesh without arcs still binds one of each.
            let contents = if contents.is_empty() {
                &[0; 16]
            } else {
                contents
            };
            device.filled_buffer(&wgpu::util::BufferInitDescriptor {
                label: Some(label),
                contents,
                usage,
            })
        };
        let vertices = vertices_in_slots(mesh);
        let arcs = arc_records(mesh);
        let arc_at = arc_at_blocks(&arcs);
        let caps = cap_indices(mesh, &arcs, &arc_at);
        Self {
            vertices: buffer(
                "globefill vertices",
                bytemuck::cast_slice(&vertices),
                storage,
            ),
            arc_at: buffer(
                "globefill arc at block",
                bytemuck::cast_slice(&arc_at),
                storage,
            ),
            arcs: buffer("globefill arcs", bytemuck::cast_slice(&arcs), storage),
            cap_indices: buffer(
                "globefill caps",
                bytemuck::cast_slice(&caps),
                wgpu::BufferUsages::INDEX,
            ),
            edge_slots: OnceLock::new(),
        }
    }

    /// What the edge pass reads of `mesh`, which this is the upload of: 8 bytes a boundary vertex or arc,
    /// from the first call on.
    pub(crate) fn edge_slots(&self, device: &wgpu::Device, mesh: &FillMesh) -> &EdgeSlots {
        self.edge_slots.get_or_init(|| {
            let slots = edge_slots(mesh);
            let buffer = device.filled_buffer(&wgpu::util::BufferInitDescriptor {
                label: Some("globefill edge slots"),
                contents: if slots.is_empty() {
                    &[0; 8]
                } else {
                    bytemuck::cast_slice(&slots)
                },
                usage: wgpu::BufferUsages::STORAGE,
            });
            EdgeSlots { slots, buffer }
        })
    }

    /// The same, if edges were ever wanted.
    pub(crate) fn known_edge_slots(&self) -> Option<&EdgeSlots> {
        self.edge_slots.get()
    }
}

impl FillMesh {
    /// Bytes that the mesh takes on the GPU: 16 a vertex, 12 a cap triangle, 28 an arc for its sides
    /// and the break behind it, and 4 for every sixteen boundary vertices. Walls take none.
    pub fn gpu_bytes(&self) -> u64 {
        let slots = self.boundary.len() + self.arcs.len();
        let vertices = self.vertices.len() + self.arcs.len();
        let blocks = slots.div_ceil(BLOCK);
        let arcs = size_of::<ArcRecord>() * self.arcs.len();
        (16 * vertices + arcs + 4 * blocks + 12 * self.cap_triangles.len()) as u64
    }
}

/// `Arc` of extrude.wgsl; see there.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct ArcRecord {
    pub left: u32,
    pub right: u32,
    pub break_slot: u32,
}

/// The mesh's vertices with a break behind each arc, so that one strip may run over many arcs.
fn vertices_in_slots(mesh: &FillMesh) -> Vec<[i32; 4]> {
    let mut vertices = Vec::with_capacity(mesh.vertices.len() + mesh.arcs.len());
    for arc in &mesh.arcs {
        let first = arc.first_vertex as usize;
        let of_arc = &mesh.vertices[first..first + arc.vertex_count as usize];
        vertices.extend(of_arc.iter().copied().map(encode));
        vertices.push([0; 4]);
    }
    let interior = &mesh.vertices[mesh.boundary.len()..];
    vertices.extend(interior.iter().copied().map(encode));
    vertices
}

fn arc_records(mesh: &FillMesh) -> Vec<ArcRecord> {
    let plus_one = |piece: Option<u32>| piece.map_or(0, |piece| piece + 1);
    (0..)
        .zip(&mesh.arcs)
        .map(|(index, arc)| ArcRecord {
            left: plus_one(arc.left),
            right: plus_one(arc.right),
            break_slot: slot(index, arc.first_vertex + arc.vertex_count),
        })
        .collect()
}

fn arc_at_blocks(arcs: &[ArcRecord]) -> Vec<u32> {
    let slot_count = arcs.last().map_or(0, |arc| arc.break_slot as usize + 1);
    let mut arc = 0;
    (0..slot_count)
        .step_by(BLOCK)
        .map(|slot| {
            while (arcs[arc].break_slot as usize) < slot {
                arc += 1;
            }
            arc as u32
        })
        .collect()
}

/// Cap triangles with every boundary vertex moved behind the breaks before it.
fn cap_indices(mesh: &FillMesh, arcs: &[ArcRecord], arc_at: &[u32]) -> Vec<[u32; 3]> {
    let boundary_count = mesh.boundary.len() as u32;
    let arc_count = mesh.arcs.len() as u32;
    let moved = |vertex: u32| {
        if vertex >= boundary_count {
            return vertex + arc_count;
        }
        // The slot lies at or behind `vertex`: its arc is found from that block on.
        let mut arc = arc_at[vertex as usize / BLOCK];
        while arcs[arc as usize].break_slot <= slot(arc, vertex) {
            arc += 1;
        }
        slot(arc, vertex)
    };
    mesh.cap_triangles
        .iter()
        .map(|triangle| triangle.map(moved))
        .collect()
}
