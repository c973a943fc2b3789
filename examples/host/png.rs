//! Pictures as PNG.

use std::io::Cursor;

use glam::UVec2;
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};

/// PNG of 8-bit RGB; alpha is dropped, the host's frame is opaque.
pub fn rgb(size_px: UVec2, rgba: &[u8]) -> Result<Vec<u8>, String> {
    let (pixels, _) = rgba.as_chunks::<4>();
    let rgb: Vec<u8> = pixels
        .iter()
        .flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
        .collect();
    encode(size_px, &rgb, ExtendedColorType::Rgb8)
}

/// PNG of samples of a kind, row after row.
pub fn encode(size_px: UVec2, samples: &[u8], color: ExtendedColorType) -> Result<Vec<u8>, String> {
    let mut file = Cursor::new(Vec::new());
    PngEncoder::new(&mut file)
        .write_image(samples, size_px.x, size_px.y, color)
        .map_err(|error| format!("cannot encode a PNG: {error}"))?;
    Ok(file.into_inner())
}
