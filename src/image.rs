//! Pictures that fills may show.

#[cfg(feature = "images")]
mod decode;
mod mip_chain;
mod srgb;
#[cfg(test)]
mod tests;

use std::{fmt, sync::Arc};

use glam::UVec2;

use self::srgb::Srgb;
use crate::error::ImageError;

/// Names an image in a [`Renderer`](crate::Renderer).
///
/// With the feature `serde` it is written as a number. That means something in the renderer that gave it
/// out, and in no other: write beside the styles which file each number was, insert the files on reading,
/// and exchange the numbers with [`FillStyle::map_image`](crate::FillStyle::map_image). A number that the
/// renderer does not know is refused there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ImageId(pub(crate) u32);

/// Most texels of an image along a side.
pub const MOST_PER_SIDE: u32 = 16_384;
/// Most texels of an image.
pub const MOST_TEXELS: u64 = 1 << 27;

/// A picture with its smaller copies (mip levels), ready for upload. Clones share the texels.
///
/// Eight bits a channel, colours in sRGB, the first row on top. Each level is the mean of the one above
/// it over exact areas, formed in linear light from colours times alpha.
///
/// **Texels** hold the colour times alpha, multiplied in linear light and then encoded as sRGB. A
/// filter averages stored values; were colours stored as they are, those of fully transparent texels,
/// which nobody ever saw, would bleed into the edges of what is opaque. Multiplying the encoded values
/// instead would darken half-transparent texels once the sampler decodes them.
///
/// Colour profiles (ICC, gamma) that a file carries are ignored: colours are taken for sRGB.
///
/// Memory: four bytes a texel and a third more for the levels; while it is made, as much again beside
/// what it is made from.
#[derive(Clone)]
pub struct Image {
    levels: Arc<[Level]>,
}

/// One size of an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Level {
    /// Texels across and down.
    pub(crate) size: UVec2,
    /// Red, green, blue and alpha, row by row from the top; colours as [`Image`] tells.
    pub(crate) texels: Vec<[u8; 4]>,
}

impl Level {
    /// The texels for targets that hold encoded colours: the encoded colours, times alpha.
    pub(crate) fn encoded(&self) -> Vec<[u8; 4]> {
        let tables = Srgb::tables();
        let texel = |&[red, green, blue, alpha]: &[u8; 4]| {
            let share = f32::from(alpha) / 255.0;
            let part = |code: u8| {
                let straight = tables.encode(tables.decode(code) / share.max(1.0 / 255.0));
                (f32::from(straight) * share).round() as u8
            };
            [part(red), part(green), part(blue), alpha]
        };
        self.texels.iter().map(texel).collect()
    }
}

impl Image {
    /// An image from red, green, blue and alpha, row by row from the top: sRGB colours that are not
    /// multiplied by alpha.
    ///
    /// # Errors
    /// A size of 0 or above [`MOST_PER_SIDE`] or [`MOST_TEXELS`]; a slice that is not
    /// 4·`width`·`height` long.
    pub fn from_rgba8(width: u32, height: u32, rgba: &[u8]) -> Result<Self, ImageError> {
        check_size(width, height)?;
        let (texels, rest) = rgba.as_chunks::<4>();
        let is_whole = rest.is_empty() && texels.len() as u64 == texel_count(width, height);
        if !is_whole {
            return Err(ImageError::WrongLength {
                width,
                height,
                bytes: rgba.len(),
            });
        }
        Ok(Self {
            levels: mip_chain::levels(UVec2::new(width, height), texels).into(),
        })
    }

    /// Texels across.
    pub fn width(&self) -> u32 {
        self.levels[0].size.x
    }

    /// Texels down.
    pub fn height(&self) -> u32 {
        self.levels[0].size.y
    }

    /// All sizes, the largest first, down to 1 × 1; each side is half of the one before, rounded down.
    pub(crate) fn levels(&self) -> &[Level] {
        &self.levels
    }
}

impl fmt::Debug for Image {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Image")
            .field("width", &self.width())
            .field("height", &self.height())
            .finish_non_exhaustive()
    }
}

fn texel_count(width: u32, height: u32) -> u64 {
    u64::from(width) * u64::from(height)
}

fn check_size(width: u32, height: u32) -> Result<(), ImageError> {
    if width == 0 || height == 0 {
        return Err(ImageError::Empty { width, height });
    }
    let fits = width.max(height) <= MOST_PER_SIDE && texel_count(width, height) <= MOST_TEXELS;
    if fits {
        Ok(())
    } else {
        Err(ImageError::TooLarge { width, height })
    }
}
