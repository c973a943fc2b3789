//! How the fills of a layer look, as resolve_styled.wgsl reads it.

use crate::{
    error::RendererError,
    frame::edge_draws::LayerEdges,
    frame::layers::{FillOf, Layer, Styled},
    frame::placed::PatternPlace,
    gpu::filled_buffer::FilledBuffer as _,
    gpu::image_arrays::{ImageArrays, ImageSlot},
    hatch::HatchKind,
    image_fill::{ImageFill, Placement, Wrap},
    length::Length,
    stroke::{Align, Stroke},
    style::{Blend, Fade, FillStyle, Pattern, Ramp, premultiplied},
};

/// What a layer's styles need, a bit for each; as in style.wgsl.
pub(crate) type Needs = u32;
pub(crate) const LINES: Needs = 1;
pub(crate) const ACROSS: Needs = 2;
pub(crate) const DOTS: Needs = 4;
pub(crate) const CHECKER: Needs = 8;
pub(crate) const TILES: Needs = 16;
pub(crate) const CLAMPED: Needs = 32;
pub(crate) const REPEATED: Needs = 64;
pub(crate) const ANGLES: Needs = 128;
pub(crate) const FADES: Needs = 256;
pub(crate) const STROKES: Needs = 512;
pub(crate) const SMOOTH: Needs = 1024;

/// Kinds of patterns; as in style.wgsl.
const KIND_PLAIN: u32 = 0;
const KIND_LINES: u32 = 1;
const KIND_CROSS: u32 = 2;
const KIND_DOTS: u32 = 3;
const KIND_CHECKER: u32 = 4;
const KIND_TILES: u32 = 5;
const KIND_PICTURE: u32 = 6;

/// `Style` of style.wgsl; see there.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct StyleRecord {
    pub color: [f32; 4],
    pub highlight: [f32; 4],
    pub ink: [f32; 4],
    pub stroke: [f32; 4],
    pub pattern: [u32; 4],
    pub hatch: [f32; 4],
    pub fade: [f32; 4],
    pub fade_sine: [f32; 4],
    pub stroke_size: [f32; 4],
    pub dash_share: f32,
    pub align: u32,
    pub wrap: u32,
    pub unused: u32,
}

/// Styles of one layer.
pub(crate) struct StyleTable {
    pub styles: wgpu::Buffer,
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
            let mut record = StyleRecord::new(style, slot);
            if let Some(place) = place {
                record.pattern[1] = places.len() as u32;
                places.push(place);
            }
            records.push(record);
            slots.push(slot);
        }
        if needs == 0 {
            return None;
        }
        let mut arrays: Vec<u32> = slots.iter().flatten().map(|slot| slot.array).collect();
        arrays.sort_unstable();
        arrays.dedup();
        if arrays.is_empty() {
            arrays.push(0);
        }
        for (record, slot) in records.iter_mut().zip(slots) {
            // Whatever shows no image is drawn with the first array.
            record.pattern[3] = slot.map_or(arrays[0], |slot| slot.array);
        }
        Some(Self {
            styles: device.filled_buffer(&wgpu::util::BufferInitDescriptor {
                label: Some("globefill styles"),
                contents: bytemuck::cast_slice(&records),
                usage: wgpu::BufferUsages::STORAGE,
            }),
            needs,
            arrays,
        })
    }
}

fn image_of(style: &FillStyle) -> Option<crate::image::ImageId> {
    style.pattern.and_then(|pattern| pattern.image())
}

fn needs_of(style: &FillStyle) -> Needs {
    let pattern = match style.pattern {
        None => 0,
        Some(Pattern::Hatch(hatch)) => match hatch.kind {
            HatchKind::Lines => LINES,
            HatchKind::Cross => LINES | ACROSS,
            HatchKind::Dots => DOTS | ACROSS,
            HatchKind::Checker => CHECKER | ACROSS,
            HatchKind::Image(_) => TILES,
        },
        Some(Pattern::Image(image)) => {
            let wrap = match image.wrap {
                Wrap::Clip | Wrap::Clamp => CLAMPED,
                Wrap::Repeat => REPEATED,
            };
            match image.placement {
                Placement::Local { .. } => wrap,
                Placement::Geodetic(_) | Placement::Spherical(_) => wrap | ANGLES,
            }
        }
    };
    let fades = if style.fade == Fade::default() {
        0
    } else {
        FADES
    };
    let strokes = if style.stroke.is_some() { STROKES } else { 0 };
    pattern | fades | strokes
}

impl StyleRecord {
    fn new(style: &FillStyle, image: Option<ImageSlot>) -> Self {
        let mut record = Self {
            color: premultiplied(style.color),
            highlight: premultiplied(style.highlight),
            pattern: [KIND_PLAIN, 0, 0, 0],
            hatch: [0.0, 0.0, 1.0, style.opacity],
            fade: [0.0; 4],
            fade_sine: [0.0; 4],
            ..bytemuck::Zeroable::zeroed()
        };
        record.set_fade(&style.fade);
        record.fade_sine[2] = match style.blend {
            Blend::Alpha => 1.0,
            Blend::Additive => 0.0,
        };
        match &style.pattern {
            Some(Pattern::Hatch(hatch)) => {
                record.ink = premultiplied(hatch.color);
                record.pattern[0] = match hatch.kind {
                    HatchKind::Lines => KIND_LINES,
                    HatchKind::Cross => KIND_CROSS,
                    HatchKind::Dots => KIND_DOTS,
                    HatchKind::Checker => KIND_CHECKER,
                    HatchKind::Image(_) => KIND_TILES,
                };
                record.hatch[0] = hatch.share;
                record.hatch[1] = metres_or_pixels(hatch.spacing)[1];
                record.hatch[2] = image.map_or(1.0, |slot| slot.tall);
            }
            Some(Pattern::Image(image)) => record.set_picture(image),
            None => {}
        }
        if let Some(slot) = image {
            record.pattern[2] = slot.layer;
        }
        if let Some(stroke) = &style.stroke {
            record.set_stroke(stroke);
        }
        record
    }

    fn set_picture(&mut self, image: &ImageFill) {
        self.pattern[0] = KIND_PICTURE;
        self.ink = [image.opacity; 4];
        self.wrap = match image.wrap {
            Wrap::Clip => 0,
            Wrap::Clamp => 1,
            Wrap::Repeat => 2,
        };
    }

    fn set_fade(&mut self, fade: &Fade) {
        // Where nothing fades, the share is 1 everywhere: (x + 1) · huge.
        let ramp = |ramp: Option<Ramp>| match ramp {
            Some(Ramp { full, gone }) => [gone, 1.0 / (full - gone)],
            None => [-1.0, 1e9],
        };
        let sines = fade.angle_rad.map(|Ramp { full, gone }| Ramp {
            full: full.sin(),
            gone: gone.sin(),
        });
        let [distance, pixel, sine] = [fade.distance_m, fade.pixel_m, sines].map(ramp);
        self.fade = [distance[0], distance[1], pixel[0], pixel[1]];
        self.fade_sine[..2].copy_from_slice(&sine);
    }

    fn set_stroke(&mut self, stroke: &Stroke) {
        self.stroke = premultiplied(stroke.color);
        let [width_m, width_px] = metres_or_pixels(stroke.width);
        let dash = stroke.dash.map(|dash| metres_or_pixels(dash.period));
        let [period_m, period_px] = dash.unwrap_or_default();
        self.stroke_size = [width_m, width_px, period_m, period_px];
        self.dash_share = stroke.dash.map_or(1.0, |dash| dash.share);
        self.align = match stroke.align {
            Align::Inner => 0,
            Align::Center => 1,
            Align::Outer => 2,
        };
    }
}

/// A length in its unit, with 0 in the other.
pub(crate) fn metres_or_pixels(length: Length) -> [f32; 2] {
    match length {
        Length::Metres(metres) => [metres, 0.0],
        Length::Pixels(pixels) => [0.0, pixels],
    }
}
