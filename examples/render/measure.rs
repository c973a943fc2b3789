//! What is measured: covered pixels, their fills, surface positions, times.

use std::time::Instant;

use globefill::{FillStyle, Frame, FrameStats};

use crate::{
    drawing::Drawing,
    host::{
        camera::Eye,
        gpu::Gpu,
        ground::Ground,
        times::{WARM_UP, median, milliseconds_since},
    },
};

/// An opaque colour that stands for a fill: its index counted from 1, in red and green.
pub fn identity_style(fill: u32, z_index: i32) -> FillStyle {
    let [low, high, ..] = (fill + 1).to_le_bytes();
    let channel = |byte: u8| f32::from(byte) / 255.0;
    FillStyle {
        color: [channel(low), channel(high), 0.0, 1.0],
        z_index,
        ..Default::default()
    }
}

/// The fill of every pixel, counted from 1; 0 for none.
pub fn identities(gpu: &Gpu, drawing: &Drawing) -> Result<Vec<u16>, String> {
    let texels = gpu.read_texture(&drawing.targets.color)?;
    let (pixels, _) = texels.as_chunks::<4>();
    Ok(pixels
        .iter()
        .map(|pixel| u16::from_le_bytes([pixel[0], pixel[1]]))
        .collect())
}

/// The surface point in the depth buffer at every pixel's centre; `None` for the sky.
pub fn positions(
    gpu: &Gpu,
    drawing: &Drawing,
    eye: &Eye,
) -> Result<Vec<Option<glam::DVec3>>, String> {
    let texels = gpu.read_texture(&drawing.targets.depth)?;
    let (depths, _) = texels.as_chunks::<4>();
    let width = eye.lens.size_px.x;
    Ok((0..)
        .zip(depths)
        .map(|(index, depth)| {
            eye.surface_ecef_m(index % width, index / width, f32::from_le_bytes(*depth))
        })
        .collect())
}

/// Median times of a frame.
pub struct Times {
    /// With fills: everything from `prepare` until the GPU is idle.
    pub frame_ms: f64,
    /// With fills of plain colours; `None` where all of them are.
    pub solid_ms: Option<f64>,
    /// The ground alone.
    pub globe_ms: f64,
    /// What styles cost beyond plain colours, in times of the ground alone: the median of the
    /// differences between frames drawn one after the other.
    pub style_extra_globes: Option<f64>,
    /// Of the last frame with fills.
    pub stats: FrameStats,
}

/// Draws `frames` frames with fills, as many without and, if there is a `solid` drawing, as many of it,
/// in turn: what slows the machine for a while slows them alike.
pub fn times(
    gpu: &Gpu,
    ground: &Ground,
    drawing: &mut Drawing,
    mut solid: Option<&mut Drawing>,
    frame: &Frame,
    frames: u32,
    mut progress: impl FnMut(),
) -> Result<Times, String> {
    let [mut with_fills, mut plain, mut without] = [const { Vec::new() }; 3];
    let mut stats = FrameStats::default();
    for index in 0..WARM_UP + frames {
        let start = Instant::now();
        drawing.draw_ground(gpu, ground)?;
        let ground_ms = milliseconds_since(start);
        let start = Instant::now();
        if let Some(solid) = &mut solid {
            solid.draw(gpu, ground, frame, None)?;
        }
        let solid_ms = milliseconds_since(start);
        let start = Instant::now();
        stats = drawing.draw(gpu, ground, frame, None)?;
        let frame_ms = milliseconds_since(start);
        if index >= WARM_UP {
            without.push(ground_ms);
            plain.push(solid_ms);
            with_fills.push(frame_ms);
        }
        progress();
    }
    let globe_ms = median(without);
    let pairs = with_fills.iter().zip(&plain);
    let extra_ms = median(pairs.map(|(styled, plain)| styled - plain).collect());
    Ok(Times {
        frame_ms: median(with_fills),
        solid_ms: solid.is_some().then(|| median(plain)),
        style_extra_globes: solid.map(|_| extra_ms / globe_ms),
        globe_ms,
        stats,
    })
}
