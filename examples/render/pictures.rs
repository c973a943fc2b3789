//! Encoders of what was measured: PNG and NumPy.

use glam::{DVec3, UVec2};
use image::ExtendedColorType;

use crate::host::png;

/// PNG of 8-bit grey.
pub fn png_grey8(size_px: UVec2, values: &[u8]) -> Result<Vec<u8>, String> {
    png::encode(size_px, values, ExtendedColorType::L8)
}

/// PNG of 16-bit grey.
pub fn png_grey16(size_px: UVec2, values: &[u16]) -> Result<Vec<u8>, String> {
    png::encode(
        size_px,
        bytemuck::cast_slice(values),
        ExtendedColorType::L16,
    )
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
