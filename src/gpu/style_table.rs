//! How the fills of a layer look, as resolve_styled.wgsl reads it.

use crate::{
    error::RendererError,
    frame::edge_draws::LayerEdges,
    frame::layers::{FillOf, Layer, Styled},
    frame::placed::{PatternPlace, Placed},
    gpu::filled_buffer::FilledBuffer as _,
    gpu::image_arrays::{ImageArrays, ImageSlot},
    gpu::style_record::{ARRAYS, Needs, SMOOTH, StyleRecord, metres_or_pixels, needs_of},
    stroke::Align,
    style::FillStyle,
};

/// Most styles of a layer, and most places of patterns, that shaders read as uniforms; as in
/// styles_uniform.wgsl.
pub(crate) const MOST_UNIFORM_STYLES: usize = 448;
pub(crate) const MOST_UNIFORM_PLACES: usize = 1024;
/// What buffers need to hold that are bound as uniforms.
pub(crate) const UNIFORM_STYLES_BYTES: u64 =
    (MOST_UNIFORM_STYLES * size_of::<StyleRecord>()) as u64;
pub(crate) const UNIFORM_PLACES_BYTES: u64 = (MOST_UNIFORM_PLACES * size_of::<Placed>()) as u64;

/// Styles of one layer.
pub(crate) struct StyleTable {
    /// As large as uniforms must be, at least.
    pub styles: wgpu::Buffer,
    /// Bytes of the styles.
    pub bytes: u64,
    /// Whether the styles are few enough for uniforms.
    pub few: bool,
    pub needs: Needs,
    /// The arrays of images that are drawn, one after the other; one at least.
    pub arrays: Vec<u32>,
}

/// What the tables of all layers are made from.
#[derive(Clone, Copy)]
pub(crate) struct StyleSource<'a> {
    pub styled: &'a [Styled<'a>],
    /// By mesh and fill: where the fill's pattern lies.
    pub places: &'a [&'a [Option<PatternPlace>]],
    pub images: Option<&'a ImageArrays>,
    /// Whether all edges are smooth.
    pub smooth: bool,
}

/// Most fills in a layer whose boundaries are measured: ids of both sides share 32 bits.
const MOST_EDGED: usize = 0xffff;
/// How far around boundaries smooth edges need them measured, pixels.
const SMOOTH_PX: f32 = 0.5;

/// The boundaries of a layer that strokes and smooth edges need.
pub(crate) fn edges_of(
    layer: &Layer,
    from: &StyleSource<'_>,
) -> Result<Option<LayerEdges>, RendererError> {
    let smooth_px = if from.smooth { SMOOTH_PX } else { 0.0 };
    let reach = |fill: &FillOf| {
        let style = &from.styled[fill.mesh].styles[fill.fill as usize];
        let Some(stroke) = &style.stroke else {
            return [0.0, smooth_px];
        };
        let share = match stroke.align {
            Align::Inner | Align::Outer => 1.0,
            Align::Center => 0.5,
        };
        let [metres, pixels] = metres_or_pixels(stroke.width);
        [share * metres, (share * pixels).max(smooth_px)]
    };
    let reaches: Vec<[f32; 2]> = std::iter::once([0.0; 2])
        .chain(layer.fills.iter().map(reach))
        .collect();
    if reaches.iter().all(|reach| *reach == [0.0; 2]) {
        return Ok(None);
    }
    let fills = layer.fills.len();
    if fills > MOST_EDGED {
        return Err(RendererError::TooManyFills { fills });
    }
    let code = layer.code;
    Ok(Some(LayerEdges { code, reaches }))
}

impl StyleTable {
    /// The table of a layer, or nothing where plain colours say all. Appends where its patterns lie to
    /// `places`.
    pub(crate) fn new(
        device: &wgpu::Device,
        layer: &Layer,
        from: &StyleSource<'_>,
        places: &mut Vec<PatternPlace>,
    ) -> Option<Self> {
        let looks = layer.fills.iter().map(|fill| {
            let (mesh, fill) = (fill.mesh, fill.fill as usize);
            (&from.styled[mesh].styles[fill], from.places[mesh][fill])
        });
        let mut needs = if from.smooth { SMOOTH } else { 0 };
        let mut records: Vec<StyleRecord> = Vec::new();
        let mut slots: Vec<Option<ImageSlot>> = Vec::new();
        for (style, place) in looks {
            needs |= needs_of(style);
            let slot = image_of(style).and_then(|image| from.images?.slot(image));
            let at = place.map_or(0, |_| places.len() as u32);
            records.push(StyleRecord::new(style, at, slot));
            places.extend(place);
            slots.push(slot);
        }
        if needs == 0 {
            return None;
        }
        for record in &records {
            needs |= record.needs();
        }
        let mut arrays: Vec<u32> = slots.iter().flatten().map(|slot| slot.array).collect();
        arrays.sort_unstable();
        arrays.dedup();
        if arrays.is_empty() {
            arrays.push(0);
        }
        if arrays.len() > 1 {
            needs |= ARRAYS;
        }
        for (record, slot) in records.iter_mut().zip(slots) {
            // Whatever shows no image is drawn with the first array.
            record.pattern[3] = slot.map_or(arrays[0], |slot| slot.array);
        }
        let bytes = size_of_val(&records[..]) as u64;
        let few = records.len() <= MOST_UNIFORM_STYLES;
        records.resize(
            records.len().max(MOST_UNIFORM_STYLES),
            bytemuck::Zeroable::zeroed(),
        );
        Some(Self {
            bytes,
            few,
            styles: device.filled_buffer(&wgpu::util::BufferInitDescriptor {
                label: Some("globefill styles"),
                contents: bytemuck::cast_slice(&records),
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::UNIFORM,
            }),
            needs,
            arrays,
        })
    }
}

fn image_of(style: &FillStyle) -> Option<crate::image::ImageId> {
    style.pattern.and_then(|pattern| pattern.image())
}
