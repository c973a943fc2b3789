//! Textures that the ground is coloured with.

use std::path::Path;

use glam::UVec2;
use globefill::wgpu;

use super::gpu::Gpu;

/// Texels along a side of the noise tile.
pub const DETAIL_SIDE: u32 = 256;

/// The world picture that comes with the source, equirectangular, north up.
const WORLD_PICTURE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/demo/earth.jpg");

/// Texels of a picture, four bytes each, row after row.
pub struct Picture {
    pub size_px: UVec2,
    pub rgba: Vec<u8>,
}

impl Picture {
    /// The world picture. The published package leaves it out: then a plain blue-green globe.
    pub fn world() -> Result<Self, String> {
        let path = Path::new(WORLD_PICTURE);
        if !path.exists() {
            eprintln!(
                "note: no world picture at {}, drawing a plain globe",
                path.display()
            );
            return Ok(Self {
                size_px: UVec2::ONE,
                rgba: vec![58, 92, 104, 255],
            });
        }
        let image = image::open(path)
            .map_err(|error| format!("{}: cannot read the picture: {error}", path.display()))?
            .into_rgba8();
        Ok(Self {
            size_px: UVec2::new(image.width(), image.height()),
            rgba: image.into_raw(),
        })
    }

    /// Periodic value noise, several octaves, mean about one half.
    pub fn detail() -> Self {
        let side = DETAIL_SIDE;
        let mut rgba = Vec::with_capacity((side * side * 4) as usize);
        for row in 0..side {
            for column in 0..side {
                let value = fractal_noise(column, row, side);
                let grey = (value * 255.0).round() as u8;
                rgba.extend_from_slice(&[grey, grey, grey, 255]);
            }
        }
        Self {
            size_px: UVec2::splat(side),
            rgba,
        }
    }

    /// Uploads the picture with all its smaller levels.
    pub fn upload(&self, gpu: &Gpu, label: &str, format: wgpu::TextureFormat) -> wgpu::TextureView {
        let level_count = self.size_px.max_element().ilog2() + 1;
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: extent(self.size_px),
            mip_level_count: level_count,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let mut level = Self {
            size_px: self.size_px,
            rgba: self.rgba.clone(),
        };
        for mip_level in 0..level_count {
            if mip_level > 0 {
                level = level.half();
            }
            gpu.queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    mip_level,
                    ..texture.as_image_copy()
                },
                &level.rgba,
                wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(level.size_px.x * 4),
                    rows_per_image: None,
                },
                extent(level.size_px),
            );
        }
        texture.create_view(&Default::default())
    }

    /// Half the size, each texel the mean of (up to) four.
    fn half(&self) -> Self {
        let size_px = (self.size_px / 2).max(UVec2::ONE);
        let texel = |column: u32, row: u32, channel: usize| {
            let (column, row) = (column.min(self.size_px.x - 1), row.min(self.size_px.y - 1));
            u32::from(self.rgba[(row * self.size_px.x + column) as usize * 4 + channel])
        };
        let mut rgba = Vec::with_capacity((size_px.x * size_px.y * 4) as usize);
        for row in 0..size_px.y {
            for column in 0..size_px.x {
                let (x, y) = (2 * column, 2 * row);
                for channel in 0..4 {
                    let sum = texel(x, y, channel)
                        + texel(x + 1, y, channel)
                        + texel(x, y + 1, channel)
                        + texel(x + 1, y + 1, channel);
                    rgba.push((sum / 4) as u8);
                }
            }
        }
        Self { size_px, rgba }
    }
}

pub fn extent(size_px: UVec2) -> wgpu::Extent3d {
    wgpu::Extent3d {
        width: size_px.x,
        height: size_px.y,
        depth_or_array_layers: 1,
    }
}

fn fractal_noise(column: u32, row: u32, side: u32) -> f64 {
    let mut value = 0.5;
    let mut weight = 0.5;
    for octave in 3..7 {
        let cells = 1 << octave;
        let at = |index: u32| f64::from(index * cells) / f64::from(side);
        value += weight * (lattice_noise(at(column), at(row), cells) - 0.5);
        weight *= 0.6;
    }
    value.clamp(0.0, 1.0)
}

fn lattice_noise(x: f64, y: f64, cells: u32) -> f64 {
    let corner = |dx: u32, dy: u32| hash((x as u32 + dx) % cells, (y as u32 + dy) % cells, cells);
    let smooth = |t: f64| t * t * (3.0 - 2.0 * t);
    let (u, v) = (smooth(x.fract()), smooth(y.fract()));
    let low = corner(0, 0) * (1.0 - u) + corner(1, 0) * u;
    let high = corner(0, 1) * (1.0 - u) + corner(1, 1) * u;
    low * (1.0 - v) + high * v
}

/// A number in 0 … 1 that looks random.
fn hash(x: u32, y: u32, salt: u32) -> f64 {
    let mut bits =
        x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ salt.wrapping_mul(0xC2B2_AE3D);
    bits = (bits ^ (bits >> 15)).wrapping_mul(0x2C1B_3C6D);
    bits = (bits ^ (bits >> 12)).wrapping_mul(0x297A_2D39);
    f64::from(bits ^ (bits >> 15)) / f64::from(u32::MAX)
}
