#[cfg(feature = "images")]
mod files;

use super::*;

/// Numbers that look random, the same ones every time (SplitMix64).
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    pub(super) fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    pub(super) fn bytes(&mut self, count: usize) -> Vec<u8> {
        (0..count).map(|_| self.next() as u8).collect()
    }
}

fn decoded(code: u8) -> f64 {
    let encoded = f64::from(code) / 255.0;
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}

fn codes(light: f64) -> f64 {
    255.0
        * if light <= 0.003_130_8 {
            12.92 * light
        } else {
            1.055 * light.powf(1.0 / 2.4) - 0.055
        }
}

/// A picture in linear light times alpha, in f64.
struct Light {
    width: usize,
    height: usize,
    texels: Vec<[f64; 4]>,
}

impl Light {
    fn new(width: u32, height: u32, rgba: &[u8]) -> Self {
        let light = |texel: &[u8]| {
            let alpha = f64::from(texel[3]) / 255.0;
            let [red, green, blue] = [0, 1, 2].map(|channel| decoded(texel[channel]) * alpha);
            [red, green, blue, alpha]
        };
        Self {
            width: width as usize,
            height: height as usize,
            texels: rgba.chunks(4).map(light).collect(),
        }
    }

    /// The next level: each texel of the finer one counts by the area that it has in common with the
    /// coarser.
    fn next(&self) -> Self {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let common = |fine: usize, sides: (usize, usize), coarse: usize| {
            let scale = sides.0 as f64 / sides.1 as f64;
            let start = (coarse as f64 * scale).max(fine as f64);
            let end = ((coarse + 1) as f64 * scale).min((fine + 1) as f64);
            (end - start).max(0.0) / scale
        };
        let mut texels = Vec::new();
        for y in 0..height {
            for x in 0..width {
                let mut sum = [0.0; 4];
                for fine_y in 0..self.height {
                    let down = common(fine_y, (self.height, height), y);
                    if down == 0.0 {
                        continue;
                    }
                    for fine_x in 0..self.width {
                        let area = down * common(fine_x, (self.width, width), x);
                        let texel = self.texels[fine_y * self.width + fine_x];
                        sum = std::array::from_fn(|part| sum[part] + area * texel[part]);
                    }
                }
                texels.push(sum);
            }
        }
        Self {
            width,
            height,
            texels,
        }
    }
}

/// Asserts that an image is the area average, level by level, to the rounding of its codes.
fn check_levels(width: u32, height: u32, rgba: &[u8]) {
    let image = Image::from_rgba8(width, height, rgba).unwrap();
    let mut light = Light::new(width, height, rgba);
    for (index, level) in image.levels().iter().enumerate() {
        let size = UVec2::new(light.width as u32, light.height as u32);
        assert_eq!(level.size, size, "level {index} of {width} × {height}");
        assert_eq!(level.texels.len(), light.texels.len());
        for (stored, exact) in level.texels.iter().zip(&light.texels) {
            for part in 0..4 {
                let exact = match part {
                    3 => 255.0 * exact[3],
                    _ => codes(exact[part]),
                };
                let error = (f64::from(stored[part]) - exact).abs();
                assert!(
                    error <= 0.5 + 1e-3,
                    "level {index} of {width} × {height}: {stored:?} for {exact}"
                );
            }
        }
        light = light.next();
    }
    let last = image.levels().last().unwrap();
    assert_eq!(last.size, UVec2::ONE);
    let count = width.max(height).ilog2() as usize + 1;
    assert_eq!(image.levels().len(), count);
}

#[test]
fn levels_are_area_averages_for_any_size() {
    let mut random = Random(1);
    let sizes = [1, 2, 3, 4, 5, 6, 7, 9, 13, 16, 31, 33];
    for width in sizes {
        for height in sizes {
            check_levels(width, height, &random.bytes(4 * (width * height) as usize));
        }
    }
    for (width, height) in [(1, 257), (255, 2), (101, 63), (1000, 3)] {
        check_levels(width, height, &random.bytes(4 * (width * height) as usize));
    }
}

#[test]
fn opaque_texels_stay_what_they_are() {
    let mut rgba = Random(2).bytes(4 * 37 * 21);
    rgba.chunks_mut(4).for_each(|texel| texel[3] = 255);
    let image = Image::from_rgba8(37, 21, &rgba).unwrap();
    assert_eq!(image.levels()[0].texels.as_flattened(), rgba);
    assert_eq!((image.width(), image.height()), (37, 21));
}

#[test]
fn constant_images_are_constant_at_all_levels() {
    let mut random = Random(3);
    for (width, height) in [(64, 64), (127, 41), (1, 300), (333, 5)] {
        for _ in 0..20 {
            let mut texel = random.bytes(4);
            texel[3] |= 0x80;
            let rgba = texel.repeat((width * height) as usize);
            let image = Image::from_rgba8(width, height, &rgba).unwrap();
            let stored = image.levels()[0].texels[0];
            let mut all = image.levels().iter().flat_map(|level| &level.texels);
            assert!(all.all(|&texel| texel == stored), "{texel:?} {stored:?}");
        }
    }
}

#[test]
fn transparent_texels_do_not_bleed() {
    // Opaque blue beside a transparent red.
    let rgba = [[0, 0, 255, 255], [255, 0, 0, 0]].as_flattened().repeat(64);
    let image = Image::from_rgba8(16, 8, &rgba).unwrap();
    for level in image.levels() {
        assert!(level.texels.iter().all(|texel| texel[0] == 0));
    }
    // Half the light, half the alpha: undone, it is full blue.
    let half = image.levels().last().unwrap().texels[0];
    assert_eq!(half, [0, 0, 188, 128]);
}

#[test]
fn sizes_and_lengths_are_checked() {
    let empty = |width, height| ImageError::Empty { width, height };
    let too_large = |width, height| ImageError::TooLarge { width, height };
    let refused = |width, height| Image::from_rgba8(width, height, &[]).unwrap_err();
    assert_eq!(refused(0, 5), empty(0, 5));
    assert_eq!(refused(5, 0), empty(5, 0));
    assert_eq!(refused(0, 0), empty(0, 0));
    for (width, height) in [
        (16_385, 1),
        (1, 16_385),
        (16_384, 8_193),
        (u32::MAX, u32::MAX),
    ] {
        assert_eq!(refused(width, height), too_large(width, height));
    }
    for bytes in [0, 4, 23, 25, 28] {
        let error = Image::from_rgba8(3, 2, &vec![0; bytes]).unwrap_err();
        let (width, height) = (3, 2);
        let wrong = ImageError::WrongLength {
            width,
            height,
            bytes,
        };
        assert_eq!(error, wrong);
    }
    assert!(Image::from_rgba8(3, 2, &[0; 24]).is_ok());
    assert!(Image::from_rgba8(16_384, 1, &[0; 4 * 16_384]).is_ok());
}

#[test]
fn debug_is_short_and_clones_share() {
    let image = Image::from_rgba8(100, 50, &[7; 20_000]).unwrap();
    assert_eq!(format!("{image:?}"), "Image { width: 100, height: 50, .. }");
    assert!(Arc::ptr_eq(&image.levels, &image.clone().levels));
}

#[test]
fn texels_for_encoded_targets_are_encoded_colours_times_alpha() {
    let straight = [
        [255, 255, 255, 128],
        [200, 100, 0, 255],
        [90, 40, 250, 64],
        [9, 9, 9, 0],
    ];
    let image = Image::from_rgba8(4, 1, straight.as_flattened()).expect("sound");
    let encoded = image.levels()[0].encoded();
    for (encoded, straight) in encoded.iter().zip(straight) {
        let share = f64::from(straight[3]) / 255.0;
        for part in 0..3 {
            let wanted = f64::from(straight[part]) * share;
            let off = (f64::from(encoded[part]) - wanted).abs();
            assert!(off <= 1.5, "{encoded:?} {straight:?}");
        }
        assert_eq!(encoded[3], straight[3]);
    }
}
