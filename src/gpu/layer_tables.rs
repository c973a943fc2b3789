//! Layers on the GPU: the tables by which sums become colours.

use std::sync::Arc;

use crate::{
    error::RendererError,
    frame::code::{Mantissa, PlaneSums},
    frame::edge_draws::LayerEdges,
    frame::layers::{Layer, Layering, Styled},
    frame::placed::PatternPlace,
    gpu::filled_buffer::FilledBuffer as _,
    gpu::planes::Planes,
    gpu::style_table::{StyleSource, StyleTable, edges_of},
    options::CountTechnique,
};

/// The layers of everything visible, with the tables of each that resolve reads.
pub(crate) struct LayerTables {
    /// Shared with those who asked which fills a pixel shows.
    pub layering: Arc<Layering>,
    pub tables: Vec<wgpu::Buffer>,
    /// Of the layers that plain colours do not do for.
    pub styles: Vec<Option<StyleTable>>,
    /// Where their patterns lie.
    pub places: Vec<PatternPlace>,
    /// Of the layers with strokes or smooth edges: which boundaries are measured, how far around.
    pub edges: Vec<Option<LayerEdges>>,
    /// Bytes uploaded for the tables.
    pub bytes: u64,
    mantissa: Mantissa,
}

impl LayerTables {
    /// Assigns layers and uploads their tables; `mantissa` is that of targets that can be summed in.
    pub(crate) fn new(
        device: &wgpu::Device,
        from: &StyleSource<'_>,
        technique: CountTechnique,
        mantissa: Mantissa,
    ) -> Result<Self, RendererError> {
        let layering = Arc::new(Layering::assign(from.styled, technique, mantissa)?);
        // Where the stencil counts, nothing is summed and 32-bit targets need no blending.
        let mantissa = match layering.technique {
            CountTechnique::Winding => mantissa,
            CountTechnique::Stencil => {
                require(device.features(), wgpu::Features::DEPTH32FLOAT_STENCIL8)?;
                Mantissa::Single
            }
        };
        let tables: Vec<wgpu::Buffer> = layering
            .layers
            .iter()
            .map(|layer| table(device, layer, from.styled))
            .collect();
        let mut places = Vec::new();
        let styles: Vec<Option<StyleTable>> = layering
            .layers
            .iter()
            .map(|layer| StyleTable::new(device, layer, from, &mut places))
            .collect();
        let edges = layering
            .layers
            .iter()
            .map(|layer| edges_of(layer, from))
            .collect::<Result<_, _>>()?;
        let style_buffers = styles.iter().flatten().map(|table| &table.styles);
        Ok(Self {
            bytes: tables
                .iter()
                .chain(style_buffers)
                .map(wgpu::Buffer::size)
                .sum(),
            layering,
            styles,
            places,
            edges,
            tables,
            mantissa,
        })
    }

    /// Planes of each layer.
    pub(crate) fn planes(&self) -> Vec<Planes> {
        self.layering
            .layers
            .iter()
            .map(|layer| Planes::new(layer.code.planes, self.mantissa))
            .collect()
    }

    /// Whether sums stay exact with `refined[layer]` added to what is stored.
    pub(crate) fn leave_room_for(&self, refined: &[PlaneSums]) -> bool {
        self.layering.technique == CountTechnique::Stencil
            || self
                .layering
                .layers
                .iter()
                .zip(refined)
                .all(|(layer, refined)| {
                    let sums =
                        std::array::from_fn(|plane| layer.largest_sums[plane] + refined[plane]);
                    self.mantissa.holds(&sums)
                })
    }
}

/// The head of `Layer` in resolve.wgsl; premultiplied colours follow.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct LayerHead {
    pub fills: u32,
    pub base: u32,
    pub digits: u32,
    pub planes: u32,
    pub check_base: u32,
    /// Colours start at a multiple of 16 bytes.
    pub padding: [u32; 3],
}

fn table(device: &wgpu::Device, layer: &Layer, styled: &[Styled<'_>]) -> wgpu::Buffer {
    let head = LayerHead {
        fills: layer.code.fills,
        base: layer.code.base,
        digits: layer.code.digits,
        planes: layer.code.planes,
        check_base: layer.code.check_base,
        padding: [0; 3],
    };
    let mut bytes = bytemuck::bytes_of(&head).to_vec();
    for fill in &layer.fills {
        let style = &styled[fill.mesh].styles[fill.fill as usize];
        bytes.extend_from_slice(bytemuck::bytes_of(&style.solid_color()));
    }
    device.filled_buffer(&wgpu::util::BufferInitDescriptor {
        label: Some("globefill layer"),
        contents: &bytes,
        usage: wgpu::BufferUsages::STORAGE,
    })
}

/// Fails unless the device has what is needed.
pub(crate) fn require(
    features: wgpu::Features,
    needed: wgpu::Features,
) -> Result<(), RendererError> {
    if features.contains(needed) {
        Ok(())
    } else {
        Err(RendererError::MissingFeature(needed))
    }
}
