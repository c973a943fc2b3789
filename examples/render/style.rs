//! How a fill is to look, before there is a renderer: images by the names of their files.

use std::{collections::BTreeMap, path::PathBuf};

use globefill::{
    Align, Blend, Dash, Fade, FillStyle, Hatch, HatchKind, ImageFill, ImageId, Length, LonLat,
    Pattern, Placement, Stroke, Wrap,
};

use crate::overlay::Overlay;

/// The renderer's names of image files.
pub type Images = BTreeMap<PathBuf, ImageId>;

/// The width at which an image of one's own is repeated.
const IMAGE_SPACING: Length = Length::Pixels(64.0);

/// How a fill is to look. What is `None` has a default that depends on the rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    pub overlay: Overlay,
    /// Linear. None: the palette's.
    pub rgb: Option<[f32; 3]>,
    /// Of the colour. None: the palette's.
    pub alpha: Option<f32>,
    pub hatch: HatchLook,
    pub image: ImageLook,
    pub stroke: StrokeLook,
    pub highlight: [f32; 4],
    pub opacity: f32,
    pub fade: Fade,
    pub blend: Blend,
    pub z_index: i32,
}

/// How patterns repeat, if there is one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HatchLook {
    pub color: Option<[f32; 4]>,
    pub spacing: Option<Length>,
    pub share: Option<f32>,
    pub angle_rad: Option<f32>,
    pub anchor: Option<LonLat>,
}

/// Where an image lies, if there is one.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageLook {
    pub placement: Placement,
    pub wrap: Wrap,
    pub rotation_rad: f32,
    pub repeats: [f32; 2],
    pub opacity: f32,
}

/// How the boundary is drawn, if it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StrokeLook {
    pub is_drawn: bool,
    /// None: the fill's, opaque.
    pub color: Option<[f32; 4]>,
    /// None: the colour's alpha.
    pub opacity: Option<f32>,
    pub width: Option<Length>,
    pub align: Align,
    pub dash: Option<Dash>,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            overlay: Overlay::Solid,
            rgb: None,
            alpha: None,
            hatch: HatchLook::default(),
            image: ImageLook::default(),
            stroke: StrokeLook::default(),
            highlight: [0.0; 4],
            opacity: 1.0,
            fade: Fade::default(),
            blend: Blend::Alpha,
            z_index: 0,
        }
    }
}

impl Default for ImageLook {
    fn default() -> Self {
        Self {
            placement: Placement::Geodetic(None),
            wrap: Wrap::default(),
            rotation_rad: 0.0,
            repeats: [1.0; 2],
            opacity: 1.0,
        }
    }
}

impl Look {
    /// Whether it is a colour over the whole fill and nothing else.
    pub fn is_solid(&self) -> bool {
        self.overlay == Overlay::Solid && !self.stroke.is_drawn && self.fade == Fade::default()
    }

    /// The colour alone, as if [`is_solid`](Self::is_solid).
    pub fn solid_style(&self, palette: [f32; 4]) -> FillStyle {
        FillStyle {
            color: self.color(palette),
            z_index: self.z_index,
            ..Default::default()
        }
    }

    /// What the renderer is to draw, where a fill left alone would have the colour `palette`.
    /// `images` has every file of the look.
    pub fn style(&self, palette: [f32; 4], images: &Images) -> FillStyle {
        let color = self.color(palette);
        let pattern = match &self.overlay {
            Overlay::Solid | Overlay::Outline => None,
            Overlay::Hatch(kind) => Some(Pattern::Hatch(self.hatch.drawn(*kind))),
            Overlay::Pattern(path) => Some(Pattern::Hatch(self.hatch.repeated(images[path]))),
            Overlay::Image(path) => Some(Pattern::Image(self.image.placed(images[path]))),
        };
        FillStyle {
            color: match self.overlay {
                Overlay::Outline => [0.0; 4],
                _ => color,
            },
            pattern,
            highlight: self.highlight,
            stroke: self.stroke.is_drawn.then(|| self.stroke.drawn(color)),
            opacity: self.opacity,
            fade: self.fade,
            blend: self.blend,
            z_index: self.z_index,
            visible: true,
        }
    }

    fn color(&self, [red, green, blue, alpha]: [f32; 4]) -> [f32; 4] {
        let [red, green, blue] = self.rgb.unwrap_or([red, green, blue]);
        [red, green, blue, self.alpha.unwrap_or(alpha)]
    }
}

impl HatchLook {
    fn drawn(&self, kind: HatchKind) -> Hatch {
        let usual = Hatch::default();
        // Rows of dots and squares stand upright, lines lean.
        let angle_rad = match kind {
            HatchKind::Lines | HatchKind::Cross => usual.angle_rad,
            HatchKind::Dots | HatchKind::Checker | HatchKind::Image(_) => 0.0,
        };
        Hatch {
            kind,
            color: self.color.unwrap_or(usual.color),
            spacing: self.spacing.unwrap_or(usual.spacing),
            share: self.share.unwrap_or(usual.share),
            angle_rad: self.angle_rad.unwrap_or(angle_rad),
            anchor: self.anchor,
        }
    }

    fn repeated(&self, image: ImageId) -> Hatch {
        Hatch {
            // The image's colours are multiplied with it.
            color: self.color.unwrap_or([1.0; 4]),
            spacing: self.spacing.unwrap_or(IMAGE_SPACING),
            ..self.drawn(HatchKind::Image(image))
        }
    }
}

impl ImageLook {
    fn placed(&self, image: ImageId) -> ImageFill {
        ImageFill {
            image,
            placement: self.placement,
            wrap: self.wrap,
            rotation_rad: self.rotation_rad,
            repeats: self.repeats,
            opacity: self.opacity,
        }
    }
}

impl StrokeLook {
    pub fn drawn(&self, [red, green, blue, _]: [f32; 4]) -> Stroke {
        let usual = Stroke::default();
        let mut color = self.color.unwrap_or([red, green, blue, 1.0]);
        if let Some(opacity) = self.opacity {
            color[3] = opacity;
        }
        Stroke {
            color,
            width: self.width.unwrap_or(usual.width),
            align: self.align,
            dash: self.dash,
        }
    }
}

/// The files that the looks show, each once; the error tells one that is not there.
pub fn files(looks: &[Look]) -> Result<Vec<PathBuf>, String> {
    let mut files: Vec<PathBuf> = Vec::new();
    for path in looks.iter().filter_map(|look| look.overlay.file()) {
        files.push(path.to_owned());
    }
    files.sort();
    files.dedup();
    for path in &files {
        std::fs::File::open(path)
            .map_err(|error| format!("{}: cannot read the image: {error}", path.display()))?;
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PALETTE: [f32; 4] = [0.1, 0.2, 0.3, 0.5];

    #[test]
    fn without_options_it_is_the_palette() {
        let expected = FillStyle {
            color: PALETTE,
            ..Default::default()
        };
        assert_eq!(Look::default().style(PALETTE, &Images::new()), expected);
        assert_eq!(Look::default().solid_style(PALETTE), expected);
        assert!(Look::default().is_solid());
    }

    #[test]
    fn an_outline_has_the_colour_of_its_fill() {
        let look = Look {
            overlay: Overlay::Outline,
            stroke: StrokeLook {
                is_drawn: true,
                ..Default::default()
            },
            ..Default::default()
        };
        let style = look.style(PALETTE, &Images::new());
        assert_eq!(style.color[3], 0.0);
        assert_eq!(style.stroke.unwrap().color, [0.1, 0.2, 0.3, 1.0]);
        assert!(!look.is_solid());
        assert_eq!(look.solid_style(PALETTE).color, PALETTE);
    }
}
