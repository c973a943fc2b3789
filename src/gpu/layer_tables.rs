//! Layers on the GPU: the tables by which sums become colours.

use std::sync::Arc;

use crate::{
    error::RendererError,
    frame::code::{Mantissa, PlaneSums},
    frame::edge_draws::LayerEdges,
    frame::layers::{Counting, Layer, Layering, Styled},
    frame::lens::LensKind,
    frame::mixture::{Burden, Mixture},
    frame::placed::PatternPlace,
    gpu::filled_buffer::FilledBuffer as _,
    gpu::pipelines::{Key, ResolveKey},
    gpu::planes::Planes,
    gpu::style_pipelines::StyleKey,
    gpu::style_table::{
        MOST_UNIFORM_PLACES, StyleSource, StyleTable, UNIFORM_PLACES_BYTES, UNIFORM_STYLES_BYTES,
        edges_of,
    },
    options::CountTechnique,
};

/// The layers of everything visible, with the tables of each that resolve reads.
pub(crate) struct LayerTables {
    /// Shared with those who asked which fills a pixel shows.
    pub layering: Arc<Layering>,
    /// Of all layers but that of a mixture.
    pub tables: Vec<LayerTable>,
    /// Of the layers that plain colours do not do for.
    pub styles: Vec<Option<StyleTable>>,
    /// Where their patterns lie.
    pub places: Vec<PatternPlace>,
    /// Of the layers with strokes or smooth edges: which boundaries are measured, how far around.
    pub edges: Vec<Option<LayerEdges>>,
    /// Bytes uploaded for the tables.
    pub bytes: u64,
    mantissa: Mantissa,
    /// Of what is added up even where the stencil counts.
    mixed_mantissa: Mantissa,
}

impl LayerTables {
    /// Assigns layers and uploads their tables; `mantissa` is that of targets that can be summed in.
    pub(crate) fn new(
        device: &wgpu::Device,
        from: &StyleSource<'_>,
        counting: Counting,
        mantissa: Mantissa,
    ) -> Result<Self, RendererError> {
        let layering = Arc::new(Layering::assign(from.styled, counting, mantissa)?);
        let mixed_mantissa = mantissa;
        // Where the stencil counts, nothing is summed and 32-bit targets need no blending.
        let mantissa = match layering.technique {
            CountTechnique::Winding => mantissa,
            CountTechnique::Stencil => {
                require(device.features(), wgpu::Features::DEPTH32FLOAT_STENCIL8)?;
                Mantissa::Single
            }
        };
        let tables: Vec<LayerTable> = layering
            .layers
            .iter()
            .map(|layer| LayerTable::new(device, layer, from.styled))
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
        let style_bytes = styles.iter().flatten().map(|table| table.bytes);
        let table_bytes = tables.iter().map(LayerTable::bytes);
        Ok(Self {
            bytes: table_bytes.chain(style_bytes).sum(),
            layering,
            styles,
            places,
            edges,
            tables,
            mantissa,
            mixed_mantissa,
        })
    }

    /// The pipeline that resolves a layer with styles from planes of their own: they are read as uniforms
    /// where they and all places are few.
    pub(crate) fn style_key(
        &self,
        device: &wgpu::Device,
        layer: usize,
        table: &StyleTable,
        lens: LensKind,
    ) -> StyleKey {
        let most_bytes = device.limits().max_uniform_buffer_binding_size;
        let fits = UNIFORM_STYLES_BYTES.max(UNIFORM_PLACES_BYTES) <= most_bytes;
        StyleKey {
            code: self.layering.layers[layer].code.shape(),
            needs: table.needs,
            lens,
            few: table.few && self.places.len() <= MOST_UNIFORM_PLACES && fits,
        }
    }

    /// Planes of each layer, with so many bits of checks in those of the ids.
    pub(crate) fn planes(&self, joined: &[u32]) -> Vec<Planes> {
        let layers = self.layering.layers.iter().zip(joined);
        let ordered = layers
            .map(|(layer, &joined)| Planes::new(layer.code.planes, self.mantissa).joined(joined));
        let mixture = self.layering.mixture.iter();
        ordered
            .chain(mixture.map(|_| Planes::of_weights(self.mixed_mantissa)))
            .collect()
    }

    /// How each layer is resolved that plain colours do for, with so many bits of checks in the planes of ids.
    pub(crate) fn resolved_by(&self, joined: &[u32]) -> Vec<Key> {
        let ordered = self.tables.iter().zip(joined).map(|(table, &joined)| {
            Key::Resolve(ResolveKey {
                code: table.key.code.joined(joined),
                ..table.key
            })
        });
        let mixture = self.layering.mixture.iter();
        ordered
            .chain(mixture.map(|_| Key::ResolveMixture))
            .collect()
    }

    /// Units of weight per optical depth by which a mixture is summed, if no pixel is given more than `most`;
    /// nothing if sums would not be exact.
    pub(crate) fn mixture_scale(&self, mixture: &Mixture, most: &Burden) -> Option<f64> {
        match self.layering.technique {
            CountTechnique::Winding => mixture.scale(most, self.mixed_mantissa),
            CountTechnique::Stencil => Some(mixture.stencil_scale(self.mixed_mantissa)),
        }
    }

    /// With how many bits of the check the sums of a layer fit into one plane, if `most` bounds their absolute
    /// values for so many; 0 if that is not proven.
    pub(crate) fn joined(&self, layer: usize, most: impl Fn(u32) -> f64) -> u32 {
        let summed = self.layering.technique == CountTechnique::Winding;
        if !summed {
            return 0;
        }
        let limit = self.mantissa.limit() as f64;
        let mut bits = self.layering.layers[layer].code.joined_bits();
        bits.find(|&bits| most(bits) < limit).unwrap_or(0)
    }

    /// Whether sums of at most `drawn[layer]` are exact.
    pub(crate) fn leave_room_for(&self, drawn: &[PlaneSums]) -> bool {
        self.layering.technique == CountTechnique::Stencil
            || drawn.iter().all(|sums| self.mantissa.holds(sums))
    }
}

/// `Layer` of layer.wgsl; see there.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct LayerHead {
    pub fills: u32,
    pub base: u32,
    pub digits: u32,
    pub planes: u32,
    pub check_bits: u32,
    /// Uniforms end at a multiple of 16 bytes.
    pub padding: [u32; 3],
}

/// How the sums of a layer are read, and the colours of its fills.
pub(crate) struct LayerTable {
    pub head: wgpu::Buffer,
    /// The first of them packed, if they can be.
    pub packed: wgpu::Buffer,
    pub colors: wgpu::Buffer,
    pub key: ResolveKey,
}

impl LayerTable {
    fn new(device: &wgpu::Device, layer: &Layer, styled: &[Styled<'_>]) -> Self {
        let head = LayerHead {
            fills: layer.code.fills,
            base: layer.code.base,
            digits: layer.code.digits,
            planes: layer.code.planes,
            check_bits: layer.code.check_bits,
            padding: [0; 3],
        };
        let colors: Vec<[f32; 4]> = layer
            .fills
            .iter()
            .map(|fill| styled[fill.mesh].styles[fill.fill as usize].solid_color())
            .collect();
        let packed = packed(&colors);
        let key = ResolveKey {
            code: layer.code.shape(),
            few: packed.is_some(),
        };
        let packed = packed.unwrap_or_else(|| vec![[0; 2]; MOST_PACKED]);
        let buffer = |label, contents, usage| {
            device.filled_buffer(&wgpu::util::BufferInitDescriptor {
                label: Some(label),
                contents,
                usage,
            })
        };
        let (uniform, storage) = (wgpu::BufferUsages::UNIFORM, wgpu::BufferUsages::STORAGE);
        Self {
            head: buffer("globefill layer", bytemuck::bytes_of(&head), uniform),
            packed: buffer("globefill packed", bytemuck::cast_slice(&packed), uniform),
            colors: buffer("globefill colors", bytemuck::cast_slice(&colors), storage),
            key,
        }
    }

    fn bytes(&self) -> u64 {
        self.head.size() + self.packed.size() + self.colors.size()
    }
}

/// Most colours that are packed; as in resolve.wgsl.
const MOST_PACKED: usize = 1024;

/// Colours in 16 bits a channel, as many as the uniform holds. Nothing if they are more, or if some channel
/// lies outside 0 … 1.
fn packed(colors: &[[f32; 4]]) -> Option<Vec<[u32; 2]>> {
    let ordinary = colors
        .as_flattened()
        .iter()
        .all(|channel| (0.0..=1.0).contains(channel));
    if colors.len() > MOST_PACKED || !ordinary {
        return None;
    }
    // Off by half a step at most: 1 / 131 070.
    let steps = |channel: f32| (f64::from(channel) * 65535.0).round() as u32;
    let mut packed: Vec<[u32; 2]> = colors
        .iter()
        .map(|color| {
            let [red, green, blue, alpha] = color.map(steps);
            [red | green << 16, blue | alpha << 16]
        })
        .collect();
    packed.resize(MOST_PACKED, [0; 2]);
    Some(packed)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_colors_are_off_by_half_a_step() {
        let channel = |k: usize| (k as f32 * 0.618_034).fract();
        let mut colors: Vec<[f32; 4]> = (0..1000)
            .map(|k| std::array::from_fn(|at| channel(4 * k + at)))
            .collect();
        colors.push([0.0, 1.0, 0.0, 1.0]);
        let found = packed(&colors).expect("they are few and ordinary");
        assert_eq!(found.len(), MOST_PACKED);
        for (color, [low, high]) in colors.iter().zip(found) {
            let steps = [low & 0xffff, low >> 16, high & 0xffff, high >> 16];
            for (&wanted, steps) in color.iter().zip(steps) {
                let off = f64::from(steps) / 65535.0 - f64::from(wanted);
                assert!(off.abs() <= 0.5001 / 65535.0, "{wanted} {steps}");
            }
        }
    }

    #[test]
    fn colors_that_are_many_or_too_bright_are_not_packed() {
        assert!(packed(&[[0.5; 4]; MOST_PACKED]).is_some());
        assert!(packed(&[[0.5; 4]; MOST_PACKED + 1]).is_none());
        for channel in [-0.1, 1.1] {
            assert!(packed(&[[0.5; 4], [0.0, channel, 0.0, 1.0]]).is_none());
        }
    }
}
