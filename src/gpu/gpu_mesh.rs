//! A mesh on the GPU: written once, when inserted.

use std::sync::OnceLock;

use crate::{
    fill_mesh::{Arc, FillMesh},
    frame::edge_draws::{EdgeSlot, edge_slots},
    frame::select::slot,
    gpu::filled_buffer::FilledBuffer as _,
    gpu::fixed_point::encode,
};

/// Slots that share a first arc in `arc_at`; the same in extrude.wgsl. No more arcs begin in a block than a
/// byte counts.
const BLOCK: usize = 64;
/// Set in a slot's byte where it is the break behind its arc; the same in extrude.wgsl.
const BREAK: u8 = 1 << 7;

/// Buffers of one mesh.
pub(crate) struct GpuMesh {
    /// Boundary slots, arc after arc with a break behind each, then the caps' interior vertices.
    pub vertices: wgpu::Buffer,
    /// The arc of every slot, in blocks.
    pub arc_at: wgpu::Buffer,
    /// Sides of each arc, then of the interior of each piece that has vertices there.
    pub arcs: wgpu::Buffer,
    /// Corners of the cap triangles: twice the vertex, and one more where the piece lies right of its arc.
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
        let interiors = mesh.interiors();
        let vertices = vertices_in_slots(mesh);
        let arcs = arc_records(mesh, &interiors);
        let arc_at = arc_at_slots(mesh, &interiors);
        let caps = cap_indices(mesh);
        Self {
            vertices: buffer(
                "globefill vertices",
                bytemuck::cast_slice(&vertices),
                storage,
            ),
            arc_at: buffer(
                "globefill arc at slot",
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
    /// Bytes that the mesh takes on the GPU, this level of detail alone: 17 a vertex, 12 a cap triangle, 25 an
    /// arc for its sides and the break behind it, 8 a piece with vertices in its interior, and 4 for every 64
    /// vertices. Walls take none.
    pub fn gpu_bytes(&self) -> u64 {
        let slots = self.vertices.len() + self.arcs.len();
        let arcs = size_of::<ArcRecord>() * (self.arcs.len() + self.interiors().len());
        let arc_at = (BLOCK + 4) * slots.div_ceil(BLOCK);
        (16 * slots + arcs + arc_at + 12 * self.cap_triangles.len()) as u64
    }

    /// The pieces that have vertices in their interior, in the order of these, and how many each.
    fn interiors(&self) -> Vec<(u32, u32)> {
        let boundary = self.boundary.len() as u32;
        let mut interiors = Vec::new();
        let mut found = boundary;
        for (index, piece) in (0..).zip(&self.pieces) {
            let triangles = self.triangles_of(piece).iter();
            let behind = triangles.flatten().max().map_or(0, |last| last + 1);
            if behind > found {
                interiors.push((index, behind - found));
                found = behind;
            }
        }
        interiors
    }
}

/// `Arc` of extrude.wgsl; see there.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct ArcRecord {
    pub left: u32,
    pub right: u32,
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

fn arc_records(mesh: &FillMesh, interiors: &[(u32, u32)]) -> Vec<ArcRecord> {
    let plus_one = |piece: Option<u32>| piece.map_or(0, |piece| piece + 1);
    let record = |arc: &Arc| ArcRecord {
        left: plus_one(arc.left),
        right: plus_one(arc.right),
    };
    let interior = |&(piece, _): &(u32, u32)| ArcRecord {
        left: piece + 1,
        right: 0,
    };
    let arcs = mesh.arcs.iter().map(record);
    arcs.chain(interiors.iter().map(interior)).collect()
}

/// For each block of slots its first arc and a byte a slot, as words.
fn arc_at_slots(mesh: &FillMesh, interiors: &[(u32, u32)]) -> Vec<u32> {
    let mut slots: Vec<(u32, u8)> = Vec::with_capacity(mesh.vertices.len() + mesh.arcs.len());
    for (index, arc) in (0..).zip(&mesh.arcs) {
        slots.extend((0..arc.vertex_count).map(|_| (index, 0)));
        slots.push((index, BREAK));
    }
    for (index, &(_, vertices)) in (mesh.arcs.len() as u32..).zip(interiors) {
        slots.extend((0..vertices).map(|_| (index, 0)));
    }
    let mut arc_at = Vec::with_capacity(slots.len() / 4 + slots.len() / BLOCK + 1);
    for block in slots.chunks(BLOCK) {
        let first = block[0].0;
        arc_at.push(first);
        let mut bytes = [0; BLOCK];
        for (byte, &(arc, is_break)) in bytes.iter_mut().zip(block) {
            *byte = (arc - first) as u8 | is_break;
        }
        arc_at.extend(bytes.as_chunks().0.iter().copied().map(u32::from_le_bytes));
    }
    arc_at
}

/// Corners of the cap triangles, with every boundary vertex moved behind the breaks before it.
fn cap_indices(mesh: &FillMesh) -> Vec<[u32; 3]> {
    let arcs = (0..).zip(&mesh.arcs);
    let slots: Vec<(u32, Option<u32>)> = arcs
        .flat_map(|(index, arc)| {
            let slots =
                slot(index, arc.first_vertex)..slot(index, arc.first_vertex + arc.vertex_count);
            slots.map(|slot| (slot, arc.right))
        })
        .collect();
    let arc_count = mesh.arcs.len() as u32;
    let corner = |vertex: u32, piece: u32| match slots.get(vertex as usize) {
        Some(&(slot, right)) => 2 * slot + u32::from(right == Some(piece)),
        None => 2 * (vertex + arc_count),
    };
    let of_pieces = (0..).zip(&mesh.pieces).flat_map(|(index, piece)| {
        let triangles = mesh.triangles_of(piece).iter();
        triangles.map(move |triangle| (index, triangle))
    });
    of_pieces
        .map(|(index, triangle)| triangle.map(|vertex| corner(vertex, index)))
        .collect()
}

#[cfg(all(test, feature = "countries"))]
mod tests;
