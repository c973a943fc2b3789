//! An image's smaller copies, by area.

use glam::{UVec2, Vec4};
use rayon::prelude::*;

use super::{Level, srgb::Srgb};

/// All levels of an image of straight sRGB texels, the largest first.
pub(super) fn levels(size: UVec2, straight: &[[u8; 4]]) -> Vec<Level> {
    let srgb = Srgb::tables();
    let texels = straight.par_iter().map(|&texel| multiplied(srgb, texel));
    let mut levels = vec![Level {
        size,
        texels: texels.collect(),
    }];
    if size == UVec2::ONE {
        return levels;
    }
    // From what was given, not from what was rounded after the multiplication.
    let mut light = halved(size, straight, |&texel| light_of(srgb, texel));
    let mut size = half(size);
    loop {
        levels.push(Level {
            size,
            texels: light
                .par_iter()
                .map(|&light| encoded(srgb, light))
                .collect(),
        });
        if size == UVec2::ONE {
            return levels;
        }
        light = halved(size, &light, |&light| light);
        size = half(size);
    }
}

/// The size of the next level.
fn half(size: UVec2) -> UVec2 {
    (size / 2).max(UVec2::ONE)
}

/// Linear light times alpha, and alpha.
fn light_of(srgb: &Srgb, [red, green, blue, alpha]: [u8; 4]) -> Vec4 {
    let [red, green, blue] = [red, green, blue].map(|code| srgb.decode(code));
    Vec4::new(red, green, blue, 1.0) * (f32::from(alpha) / 255.0)
}

/// As it is stored.
fn encoded(srgb: &Srgb, light: Vec4) -> [u8; 4] {
    let [red, green, blue] = [light.x, light.y, light.z].map(|part| srgb.encode(part));
    // `as` saturates.
    [red, green, blue, (255.0 * light.w).round() as u8]
}

/// A texel as it is stored.
fn multiplied(srgb: &Srgb, texel: [u8; 4]) -> [u8; 4] {
    match texel[3] {
        255 => texel,
        0 => [0; 4],
        _ => encoded(srgb, light_of(srgb, texel)),
    }
}

/// The next level: the mean of what each of its texels covers.
fn halved<T: Sync>(size: UVec2, texels: &[T], light: impl Fn(&T) -> Vec4 + Sync) -> Vec<Vec4> {
    let half = half(size);
    let width = size.x as usize;
    let mut means = vec![Vec4::ZERO; half.x as usize * half.y as usize];
    let rows = means.par_chunks_mut(half.x as usize).enumerate();
    // Each row of means: first the rows it covers become one, then the texels of that.
    rows.for_each_init(
        || vec![Vec4::ZERO; width],
        |blended, (y, means)| {
            let rows = Cover::of(size.y, y as u32);
            let row = |k: usize| &texels[(rows.first + k) * width..][..width];
            for (sum, texel) in blended.iter_mut().zip(row(0)) {
                *sum = rows.weights[0] * light(texel);
            }
            for k in 1..rows.count {
                for (sum, texel) in blended.iter_mut().zip(row(k)) {
                    *sum += rows.weights[k] * light(texel);
                }
            }
            for (x, mean) in means.iter_mut().enumerate() {
                *mean = Cover::of(size.x, x as u32).mean(blended);
            }
        },
    );
    means
}

/// What a texel covers of the level above, along one side: up to three texels, and their shares.
struct Cover {
    first: usize,
    count: usize,
    weights: [f32; 3],
}

impl Cover {
    /// That of texel `index` on a side whose level above has `side` texels.
    ///
    /// An odd side of 2m + 1 is shared by m texels of 2 + 1/m each: texel i covers a rest of (m − i)/m
    /// of the first, all of the second and the beginning, (i + 1)/m, of the third.
    fn of(side: u32, index: u32) -> Self {
        let first = 2 * index as usize;
        if side == 1 {
            let weights = [1.0, 0.0, 0.0];
            Self {
                first,
                count: 1,
                weights,
            }
        } else if side.is_multiple_of(2) {
            let weights = [0.5, 0.5, 0.0];
            Self {
                first,
                count: 2,
                weights,
            }
        } else {
            let (half, share) = (side / 2, 1.0 / side as f32);
            let weights = [half - index, half, index + 1].map(|part| part as f32 * share);
            Self {
                first,
                count: 3,
                weights,
            }
        }
    }

    fn mean(&self, texels: &[Vec4]) -> Vec4 {
        let covered = &texels[self.first..][..self.count];
        let shares = covered.iter().zip(self.weights);
        shares.map(|(&texel, weight)| texel * weight).sum()
    }
}
