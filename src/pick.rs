//! Which fills a pixel shows: what the GPU wrote, and what it meant when it was asked.

use std::{fmt, sync::Arc};

use crate::{
    frame::layer_set::LayerSet,
    frame::layers::{Layering, MAX_LAYERS},
    renderer::MeshId,
};

/// A fill that covers a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PickedFill {
    /// The mesh, as [`Renderer::insert`](crate::Renderer::insert) named it. It may have been removed
    /// since the frame was prepared.
    pub mesh: MeshId,
    /// Index of its region in the mesh.
    pub fill: u32,
}

/// The question that [`Renderer::read_fills`](crate::Renderer::read_fills) asked the GPU, to be kept
/// until the answer is there.
///
/// It remembers the fills of the frame it asks about, so whatever happens to styles and meshes in
/// between, the answer is that frame's.
#[derive(Clone)]
pub struct Pick {
    layering: Arc<Layering>,
    /// In the order of the layering.
    meshes: Arc<[MeshId]>,
    /// The layers in which there was anything.
    shown: LayerSet,
}

impl Pick {
    /// Bytes of an answer: four for each layer there can be.
    pub const BYTES: u64 = 4 * MAX_LAYERS as u64;

    pub(crate) fn new(layering: Arc<Layering>, meshes: impl Iterator<Item = MeshId>) -> Self {
        Self {
            layering,
            meshes: meshes.collect(),
            shown: LayerSet::default(),
        }
    }

    /// The same question to the layers that show anything.
    pub(crate) fn asking(&self, shown: LayerSet) -> Self {
        Self {
            shown,
            ..self.clone()
        }
    }

    /// The layers that are asked, in the order of the answers. That of a mixture holds no ids.
    pub(crate) fn layers(&self) -> impl Iterator<Item = usize> {
        let layers = 0..self.layering.layers.len();
        layers.filter(|&layer| self.shown.contains(layer))
    }

    /// The fills that cover the pixel, the topmost first, each once; none where nothing is filled.
    ///
    /// `answer` is what the buffer holds from the offset that was given, [`Pick::BYTES`] long. More
    /// bytes than that are not looked at; fewer are no answer, and name no fills.
    pub fn fills(&self, answer: &[u8]) -> Vec<PickedFill> {
        let mut fills = Vec::new();
        let ids = answer
            .get(..Self::BYTES as usize)
            .unwrap_or_default()
            .chunks_exact(4)
            .map(|id| u32::from_le_bytes([id[0], id[1], id[2], id[3]]));
        let mut below: Vec<(usize, u32)> = self.layers().zip(ids).collect();
        below.reverse();
        for (layer, id) in below {
            // Pieces of one fill may overlap, and lie in several layers.
            if let Some(fill) = self.named(layer, id)
                && !fills.contains(&fill)
            {
                fills.push(fill);
            }
        }
        fills
    }

    fn named(&self, layer: usize, id: u32) -> Option<PickedFill> {
        let index = id.checked_sub(1)?;
        let of = self.layering.layers.get(layer)?.fills.get(index as usize)?;
        Some(PickedFill {
            mesh: *self.meshes.get(of.mesh)?,
            fill: of.fill,
        })
    }
}

impl fmt::Debug for Pick {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Pick")
            .field("layers", &self.layering.layers.len())
            .field("meshes", &self.meshes)
            .finish()
    }
}
