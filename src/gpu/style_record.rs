//! How one fill looks, as style.wgsl reads it, and what shaders must be able to do for it.

use crate::{
    gpu::image_arrays::ImageSlot,
    hatch::HatchKind,
    image_fill::{Placement, Wrap},
    length::Length,
    stroke::{Align, Stroke},
    style::{Blend, Fade, FillStyle, Pattern, Ramp, over, premultiplied},
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
pub(crate) const ADDITIVE: Needs = 2048;
pub(crate) const MAPS: Needs = 4096;
pub(crate) const INKED: Needs = 8192;
pub(crate) const ARRAYS: Needs = 16384;
pub(crate) const SPHERES: Needs = 32768;
pub(crate) const TURNS: Needs = 65536;

/// Kinds of patterns; as in style.wgsl.
const KIND_PLAIN: u32 = 0;
const KIND_LINES: u32 = 1;
const KIND_CROSS: u32 = 2;
const KIND_DOTS: u32 = 3;
const KIND_CHECKER: u32 = 4;
const KIND_TILES: u32 = 5;
const KIND_PICTURE: u32 = 6;

/// Where the rest lies beside the kind; as in style.wgsl.
const WRAP_AT: u32 = 4;
const ALIGN_AT: u32 = 6;
const IS_ADDITIVE: u32 = 1 << 8;

/// `Style` of style.wgsl; see there.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct StyleRecord {
    pub pattern: [u32; 4],
    pub paper: [f32; 4],
    pub inked: [f32; 4],
    pub tint: [f32; 4],
    pub hatch: [f32; 4],
    pub fade: [f32; 4],
    pub fade_sine: [f32; 4],
    pub stroke: [f32; 4],
    pub stroke_size: [f32; 4],
}

/// What the shader must be able to do for a fill.
pub(crate) fn needs_of(style: &FillStyle) -> Needs {
    let pattern = match style.pattern {
        None => 0,
        Some(Pattern::Hatch(hatch)) => {
            let kind = match hatch.kind {
                HatchKind::Lines => LINES,
                HatchKind::Cross => LINES | ACROSS,
                HatchKind::Dots => DOTS | ACROSS,
                HatchKind::Checker => CHECKER | ACROSS,
                HatchKind::Image(_) => TILES,
            };
            kind | MAPS
        }
        Some(Pattern::Image(image)) => {
            let wrap = match image.wrap {
                Wrap::Clip | Wrap::Clamp => CLAMPED,
                Wrap::Repeat => REPEATED,
            };
            let turns = if image.rotation_rad == 0.0 { 0 } else { TURNS };
            match image.placement {
                Placement::Local { .. } => wrap | MAPS,
                Placement::Geodetic(_) => wrap | ANGLES | turns,
                Placement::Spherical(_) => wrap | ANGLES | SPHERES | turns,
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
    /// The record of a fill whose pattern lies at `place` and shows `image`.
    pub(crate) fn new(style: &FillStyle, place: u32, image: Option<ImageSlot>) -> Self {
        let mut record = Self {
            pattern: [KIND_PLAIN, place, 0, 0],
            paper: style.shown(premultiplied(style.color)),
            hatch: [0.0, 0.0, 1.0, style.opacity],
            ..bytemuck::Zeroable::zeroed()
        };
        record.set_fade(&style.fade);
        if let Some(pattern) = &style.pattern {
            record.set_pattern(style, pattern, image);
        }
        if let Some(stroke) = &style.stroke {
            record.set_stroke(stroke);
        }
        if style.blend == Blend::Additive {
            record.pattern[0] |= IS_ADDITIVE;
        }
        record
    }

    /// What the shader must be able to do for what the record holds.
    pub(crate) fn needs(&self) -> Needs {
        let additive = self.pattern[0] & IS_ADDITIVE != 0;
        let inked = self.tint != [0.0; 4] && self.inked != self.paper;
        [(additive, ADDITIVE), (inked, INKED)]
            .into_iter()
            .map(|(needed, bit)| if needed { bit } else { 0 })
            .sum()
    }

    fn set_pattern(&mut self, style: &FillStyle, pattern: &Pattern, image: Option<ImageSlot>) {
        let color = premultiplied(style.color);
        // What is left of an image, of its own opacity or colour.
        let tinted = |own: [f32; 4]| {
            let left = style.opacity * (1.0 - premultiplied(style.highlight)[3]);
            own.map(|part| part * left)
        };
        let (kind, tint) = match pattern {
            Pattern::Hatch(hatch) => {
                let ink = premultiplied(hatch.color);
                self.hatch[0] = hatch.share;
                self.hatch[1] = metres_or_pixels(hatch.spacing)[1];
                self.inked = style.shown(over(ink, color));
                match hatch.kind {
                    HatchKind::Lines => (KIND_LINES, None),
                    HatchKind::Cross => (KIND_CROSS, None),
                    HatchKind::Dots => (KIND_DOTS, None),
                    HatchKind::Checker => (KIND_CHECKER, None),
                    HatchKind::Image(_) => (KIND_TILES, Some(tinted(ink))),
                }
            }
            Pattern::Image(fill) => {
                let wrap = match fill.wrap {
                    Wrap::Clip => 0,
                    Wrap::Clamp => 1,
                    Wrap::Repeat => 2,
                };
                let kind = KIND_PICTURE | wrap << WRAP_AT;
                (kind, Some(tinted([fill.opacity; 4])))
            }
        };
        self.pattern[0] |= kind;
        if let Some(tint) = tint {
            self.tint = tint;
            self.inked = color;
        }
        if let Some(slot) = image {
            self.pattern[2] = slot.layer;
            self.hatch[2] = slot.tall;
        }
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
        self.fade_sine[2] = stroke.dash.map_or(1.0, |dash| dash.share);
        let align = match stroke.align {
            Align::Inner => 0,
            Align::Center => 1,
            Align::Outer => 2,
        };
        self.pattern[0] |= align << ALIGN_AT;
    }
}

/// A length in its unit, with 0 in the other.
pub(crate) fn metres_or_pixels(length: Length) -> [f32; 2] {
    match length {
        Length::Metres(metres) => [metres, 0.0],
        Length::Pixels(pixels) => [0.0, pixels],
    }
}
