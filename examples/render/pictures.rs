//! Encoders of what was drawn: PNG and NumPy.

use std::io::Cursor;

use glam::{DVec3, UVec2};
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};

/// PNG of 8-bit RGB; alpha is dropped, the host's frame is opaque.
pub fn png_rgb(size_px: UVec2, rgba: &[u8]) -> Result<Vec<u8>, String> {
    let (pixels, _) = rgba.as_chunks::<4>();
    let rgb: Vec<u8> = pixels
        .iter()
        .flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
        .collect();
    png(size_px, &rgb, ExtendedColorType::Rgb8)
}

/// PNG of 8-bit grey.
pub fn png_grey8(size_px: UVec2, values: &[u8]) -> Result<Vec<u8>, String> {
    png(size_px, values, ExtendedColorType::L8)
}

/// PNG of 16-bit grey.
pub fn png_grey16(size_px: UVec2, values: &[u16]) -> Result<Vec<u8>, String> {
    png(
        size_px,
        bytemuck::cast_slice(values),
        ExtendedColorType::L16,
    )
}

fn png(size_px: UVec2, samples: &[u8], color: ExtendedColorType) -> Result<Vec<u8>, String> {
    let mut file = Cursor::new(Vec::new());
    PngEncoder::new(&mut file)
        .write_image(samples, size_px.x, size_px.y, color)
        .map_err(|error| format!("cannot encode a PNG: {error}"))?;
    Ok(file.into_inner())
}

/// NumPy array (format 1.0) of float64, height × width × 3; NaN where there is no position.
pub fn npy_positions(size_px: UVec2, positions: &[Option<DVec3>]) -> Vec<u8> {
    let header = format!(
        "{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}, 3), }}",
        size_px.y, size_px.x
    );
    // The header, with its 10 bytes of magic and length, is padded to a multiple of 64.
    let padded = (10 + header.len() + 1).next_multiple_of(64) - 10;
    let mut file = Vec::with_capacity(10 + padded + positions.len() * 24);
    file.extend_from_slice(b"\x93NUMPY\x01\x00");
    file.extend_from_slice(&(padded as u16).to_le_bytes());
    file.extend_from_slice(header.as_bytes());
    file.resize(10 + padded - 1, b' ');
    file.push(b'\n');
    for position in positions {
        for number in position.unwrap_or(DVec3::NAN).to_array() {
            file.extend_from_slice(&number.to_le_bytes());
        }
    }
    file
}
