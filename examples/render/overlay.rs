//! What lies over a fill's colour, as it is named.

use std::path::{Path, PathBuf};

use globefill::HatchKind;

/// The greatest share that dots cover, see [`Hatch::share`].
const MOST_DOTS: f32 = 0.6;

/// What lies over a fill.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Overlay {
    /// Nothing: colour alone.
    #[default]
    Solid,
    /// Nothing, and no colour either: the stroke alone.
    Outline,
    /// A drawn pattern, not [`HatchKind::Image`].
    Hatch(HatchKind),
    /// An image, repeated.
    Pattern(PathBuf),
    /// An image that has its place.
    Image(PathBuf),
}

impl Overlay {
    /// Reads `hatch`, `image=FILE` and the others, `=` being the separator.
    pub fn parse(text: &str, separator: char) -> Result<Self, String> {
        let file = |name: &str| {
            let name = text.strip_prefix(name)?.strip_prefix(separator)?;
            (!name.is_empty()).then(|| PathBuf::from(name))
        };
        if let Some(path) = file("image") {
            return Ok(Self::Image(path));
        }
        if let Some(path) = file("pattern") {
            return Ok(Self::Pattern(path));
        }
        Ok(match text {
            "solid" => Self::Solid,
            "outline" => Self::Outline,
            "hatch" => Self::Hatch(HatchKind::Lines),
            "cross" => Self::Hatch(HatchKind::Cross),
            "dots" => Self::Hatch(HatchKind::Dots),
            "checker" => Self::Hatch(HatchKind::Checker),
            _ => {
                return Err(format!(
                    "expected solid, outline, hatch, cross, dots, checker, image{separator}FILE or \
                     pattern{separator}FILE"
                ));
            }
        })
    }

    /// The same with its file named relative to `directory`.
    pub fn within(self, directory: &Path) -> Self {
        match self {
            Self::Pattern(path) => Self::Pattern(directory.join(path)),
            Self::Image(path) => Self::Image(directory.join(path)),
            Self::Solid | Self::Outline | Self::Hatch(_) => self,
        }
    }

    /// Whether it asks which share of the surface is covered.
    pub fn has_share(&self) -> bool {
        matches!(
            self,
            Self::Hatch(HatchKind::Lines | HatchKind::Cross | HatchKind::Dots)
        )
    }

    /// Checks a share that lies within 0 … 1.
    pub fn check_share(&self, share: f32) -> Result<(), String> {
        if *self == Self::Hatch(HatchKind::Dots) && share > MOST_DOTS {
            return Err(format!("dots cover at most {MOST_DOTS}"));
        }
        Ok(())
    }

    /// The file it shows.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Pattern(path) | Self::Image(path) => Some(path),
            Self::Solid | Self::Outline | Self::Hatch(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overlays_by_name() {
        let image = |name: &str| Overlay::Image(PathBuf::from(name));
        for (text, separator, expected) in [
            ("solid", '=', Overlay::Solid),
            ("hatch", ':', Overlay::Hatch(HatchKind::Lines)),
            ("image=a=b.png", '=', image("a=b.png")),
            ("image:C:/a.png", ':', image("C:/a.png")),
            ("pattern=p.jpg", '=', Overlay::Pattern("p.jpg".into())),
        ] {
            assert_eq!(Overlay::parse(text, separator), Ok(expected), "{text}");
        }
        for text in ["", "image", "image=", "pattern:a", "Hatch", "hatch=3"] {
            assert!(Overlay::parse(text, '=').is_err(), "{text}");
        }
    }
}
