//! The part of the command line that says how fills look.

use clap::{Args, ValueEnum};
use globefill::{Align, Blend, Dash, Extents, Fade, Length, LonLat, Placement, Ramp, Wrap};

use crate::{
    css_color::CssColor,
    notation,
    overlay::Overlay,
    style::{HatchLook, ImageLook, Look, StrokeLook},
};

/// How fills look. Lengths are `12px`, `500m` or `50km`, colours as in CSS.
#[derive(Debug, Args)]
#[command(next_help_heading = "Style")]
pub struct StyleArguments {
    /// What lies over the fills' colours: solid (nothing), hatch, cross, dots, checker, image=FILE
    /// (laid over each fill's extents), pattern=FILE (repeated) or outline (no fill, the stroke alone)
    #[arg(long, value_name = "STYLE", default_value = "solid", value_parser = parse_overlay)]
    pub style: Overlay,
    /// Colour of the fills: #rgb, #rgba, #rrggbb, #rrggbbaa or a name; opaque unless it has an alpha.
    /// Default: a translucent palette by which neighbours differ
    #[arg(long, value_name = "COLOR")]
    pub color: Option<CssColor>,
    /// What fills and strokes are multiplied with, 0 … 1
    #[arg(long, value_name = "SHARE", default_value = "1", value_parser = notation::share,
        allow_hyphen_values = true)]
    pub opacity: f32,
    /// A colour over all of every fill, as if it were selected
    #[arg(long, value_name = "COLOR")]
    pub highlight: Option<CssColor>,
    /// How fills meet what is below: over it, or added to it like light
    #[arg(long, value_enum, default_value = "alpha")]
    pub blend: BlendName,
    /// Smooth the edges of fills
    #[arg(long)]
    pub smooth_edges: bool,
    /// Draw features of --regions all alike, whatever their properties (fill, fill-opacity, stroke,
    /// stroke-width, stroke-opacity as in simplestyle; fill-pattern, fill-pattern-color, -spacing,
    /// -share, -angle; stroke-align, stroke-dash, fill-z, fill-additive), which else win over these options
    #[arg(long)]
    pub ignore_properties: bool,

    /// Colour of lines, dots and squares; what a repeated image is multiplied with.
    /// Default: black, for images white
    #[arg(long, value_name = "COLOR", help_heading = "Pattern")]
    pub pattern_color: Option<CssColor>,
    /// From line to line, dot to dot, the side of a square, the width of a repeated image.
    /// Default: 12px, for images 64px
    #[arg(long, value_name = "LENGTH", value_parser = notation::length,
        allow_hyphen_values = true, help_heading = "Pattern")]
    pub spacing: Option<Length>,
    /// Share of the surface that lines or dots cover, 0 … 1; of dots at most 0.6. Default: 0.25
    #[arg(long, value_name = "SHARE", value_parser = notation::share,
        allow_hyphen_values = true, help_heading = "Pattern")]
    pub share: Option<f32>,
    /// Degrees clockwise from north. Default: 45 for hatch and cross, else 0
    #[arg(long, value_name = "DEG", value_parser = notation::angle_rad,
        allow_hyphen_values = true, help_heading = "Pattern")]
    pub angle: Option<f32>,
    /// Where the pattern is true, and what fills share one by. Default: the middle of each fill
    #[arg(long, value_name = "LON,LAT", value_parser = notation::lon_lat,
        allow_hyphen_values = true, help_heading = "Pattern")]
    pub anchor: Option<LonLat>,

    /// How an image lies: in proportion to longitudes and geodetic or geocentric latitudes, or on a
    /// map about --center. Default: geodetic
    #[arg(long, value_enum, help_heading = "Image")]
    pub mapping: Option<Mapping>,
    /// Degrees between which an image lies, eastwards from west. Default: the extents of each fill
    #[arg(long, value_name = "W,S,E,N", value_parser = notation::extents,
        allow_hyphen_values = true, help_heading = "Image")]
    pub extents: Option<Extents>,
    /// Middle of the image of --mapping local
    #[arg(long, value_name = "LON,LAT", value_parser = notation::lon_lat,
        allow_hyphen_values = true, help_heading = "Image")]
    pub center: Option<LonLat>,
    /// Width and height of the image of --mapping local, metres or with a unit
    #[arg(long, value_name = "W,H", value_parser = notation::size_m,
        allow_hyphen_values = true, help_heading = "Image")]
    pub image_size: Option<[f32; 2]>,
    /// What lies outside an image: the colour alone, the image's edge, the image again. Default: clip
    #[arg(long, value_enum, help_heading = "Image")]
    pub wrap: Option<WrapName>,
    /// Turns an image about its middle, degrees clockwise. Default: 0
    #[arg(long, value_name = "DEG", value_parser = notation::angle_rad,
        allow_hyphen_values = true, help_heading = "Image")]
    pub rotation: Option<f32>,
    /// How often an image stands in its place, across and down; see --wrap. Default: 1,1
    #[arg(long, value_name = "X,Y", value_parser = notation::counts,
        allow_hyphen_values = true, help_heading = "Image")]
    pub repeats: Option<[f32; 2]>,
    /// What an image's alpha is multiplied with, 0 … 1. Default: 1
    #[arg(long, value_name = "SHARE", value_parser = notation::share,
        allow_hyphen_values = true, help_heading = "Image")]
    pub image_opacity: Option<f32>,

    /// Colour of a line along the boundaries. Default: none, with --style outline the fill's
    #[arg(long, value_name = "COLOR", help_heading = "Stroke")]
    pub stroke: Option<CssColor>,
    /// Width of that line. Default: 2px
    #[arg(long, value_name = "LENGTH", value_parser = notation::length,
        allow_hyphen_values = true, help_heading = "Stroke")]
    pub stroke_width: Option<Length>,
    /// On which side of the boundary it lies. Default: inner
    #[arg(long, value_enum, help_heading = "Stroke")]
    pub stroke_align: Option<AlignName>,
    /// Dashes: from start to start, and the share that is drawn (0.5)
    #[arg(long, value_name = "PERIOD[,SHARE]", value_parser = notation::dash,
        allow_hyphen_values = true, help_heading = "Stroke")]
    pub dash: Option<Dash>,

    /// Distances from the eye where fills are full and where they are gone, metres or with a unit
    #[arg(long, value_name = "FULL,GONE", value_parser = notation::ramp_m,
        allow_hyphen_values = true, help_heading = "Fade")]
    pub fade_distance: Option<Ramp>,
    /// The same by what a pixel spans, metres or with a unit
    #[arg(long, value_name = "FULL,GONE", value_parser = notation::ramp_m,
        allow_hyphen_values = true, help_heading = "Fade")]
    pub fade_pixel: Option<Ramp>,
    /// The same by the angle of sight above the surface, degrees: 90 straight down, 0 at the limb
    #[arg(long, value_name = "FULL,GONE", value_parser = notation::ramp_rad,
        allow_hyphen_values = true, help_heading = "Fade")]
    pub fade_angle: Option<Ramp>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BlendName {
    Alpha,
    Add,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Mapping {
    Geodetic,
    Spherical,
    Local,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum WrapName {
    Clip,
    Clamp,
    Repeat,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum AlignName {
    Inner,
    Center,
    Outer,
}

impl From<BlendName> for Blend {
    fn from(blend: BlendName) -> Self {
        match blend {
            BlendName::Alpha => Self::Alpha,
            BlendName::Add => Self::Additive,
        }
    }
}

impl From<WrapName> for Wrap {
    fn from(wrap: WrapName) -> Self {
        match wrap {
            WrapName::Clip => Self::Clip,
            WrapName::Clamp => Self::Clamp,
            WrapName::Repeat => Self::Repeat,
        }
    }
}

impl From<AlignName> for Align {
    fn from(align: AlignName) -> Self {
        match align {
            AlignName::Inner => Self::Inner,
            AlignName::Center => Self::Center,
            AlignName::Outer => Self::Outer,
        }
    }
}

fn parse_overlay(text: &str) -> Result<Overlay, String> {
    Overlay::parse(text, '=')
}

impl StyleArguments {
    /// How every fill looks. `styled_by_properties` tells that properties may ask for other styles,
    /// so that options which this one does not use have a meaning.
    pub fn look(&self, styled_by_properties: bool) -> Result<Look, String> {
        self.check_share()?;
        if self.color.is_some() && self.style == Overlay::Outline {
            return Err("--color has no place in --style outline: it has --stroke".into());
        }
        if !styled_by_properties {
            self.check_use()?;
        }
        let usual = ImageLook::default();
        Ok(Look {
            overlay: self.style.clone(),
            rgb: self.color.map(|color| color.rgb),
            alpha: self.color.map(|color| color.alpha.unwrap_or(1.0)),
            hatch: HatchLook {
                color: self.pattern_color.map(|color| color.rgba(1.0)),
                spacing: self.spacing,
                share: self.share,
                angle_rad: self.angle,
                anchor: self.anchor,
            },
            image: ImageLook {
                placement: self.placement()?,
                wrap: self.wrap.map_or(usual.wrap, Wrap::from),
                rotation_rad: self.rotation.unwrap_or(usual.rotation_rad),
                repeats: self.repeats.unwrap_or(usual.repeats),
                opacity: self.image_opacity.unwrap_or(usual.opacity),
            },
            stroke: StrokeLook {
                is_drawn: self.has_stroke(),
                color: self.stroke.map(|color| color.rgba(1.0)),
                opacity: None,
                width: self.stroke_width,
                align: self.stroke_align.map_or(Align::default(), Align::from),
                dash: self.dash,
            },
            highlight: self.highlight.map_or([0.0; 4], |color| color.rgba(1.0)),
            opacity: self.opacity,
            fade: Fade {
                distance_m: self.fade_distance,
                pixel_m: self.fade_pixel,
                angle_rad: self.fade_angle,
            },
            blend: self.blend.into(),
            z_index: 0,
        })
    }

    fn has_stroke(&self) -> bool {
        self.stroke.is_some() || self.style == Overlay::Outline
    }

    fn placement(&self) -> Result<Placement, String> {
        if self.mapping == Some(Mapping::Local) {
            if self.extents.is_some() {
                return Err(
                    "--extents contradicts --mapping local, which has --center and --image-size"
                        .into(),
                );
            }
            return Ok(Placement::Local {
                center: self.center.ok_or("--mapping local needs --center")?,
                size_m: self
                    .image_size
                    .ok_or("--mapping local needs --image-size")?,
            });
        }
        if self.center.is_some() {
            return Err("--center needs --mapping local".into());
        }
        if self.image_size.is_some() {
            return Err("--image-size needs --mapping local".into());
        }
        Ok(match self.mapping {
            Some(Mapping::Spherical) => Placement::Spherical(self.extents),
            _ => Placement::Geodetic(self.extents),
        })
    }

    fn check_share(&self) -> Result<(), String> {
        match self.share {
            Some(share) => self
                .style
                .check_share(share)
                .map_err(|error| format!("--share: {error}")),
            None => Ok(()),
        }
    }

    /// Complains about an option that the style does not use.
    fn check_use(&self) -> Result<(), String> {
        let repeating = [
            ("--pattern-color", self.pattern_color.is_some()),
            ("--spacing", self.spacing.is_some()),
            ("--angle", self.angle.is_some()),
            ("--anchor", self.anchor.is_some()),
        ];
        let sharing = [("--share", self.share.is_some())];
        let placed = [
            ("--mapping", self.mapping.is_some()),
            ("--extents", self.extents.is_some()),
            ("--center", self.center.is_some()),
            ("--image-size", self.image_size.is_some()),
            ("--wrap", self.wrap.is_some()),
            ("--rotation", self.rotation.is_some()),
            ("--repeats", self.repeats.is_some()),
            ("--image-opacity", self.image_opacity.is_some()),
        ];
        let stroked = [
            ("--stroke-width", self.stroke_width.is_some()),
            ("--stroke-align", self.stroke_align.is_some()),
            ("--dash", self.dash.is_some()),
        ];
        let repeats = matches!(self.style, Overlay::Hatch(_) | Overlay::Pattern(_));
        let is_placed = matches!(self.style, Overlay::Image(_));
        check_group(
            repeats,
            "--style hatch, cross, dots, checker or pattern=FILE",
            &repeating,
        )?;
        check_group(
            self.style.has_share(),
            "--style hatch, cross or dots",
            &sharing,
        )?;
        check_group(is_placed, "--style image=FILE", &placed)?;
        check_group(self.has_stroke(), "--stroke or --style outline", &stroked)
    }
}

/// Complains about the first option that is given though nothing uses it.
fn check_group(is_used: bool, needed: &str, options: &[(&str, bool)]) -> Result<(), String> {
    match options.iter().find(|(_, is_given)| *is_given && !is_used) {
        Some((option, _)) => Err(format!("{option} needs {needed}")),
        None => Ok(()),
    }
}

#[cfg(test)]
#[path = "style_args_tests.rs"]
mod tests;
