//! The transfer functions of sRGB (IEC 61966-2-1), by table.

use std::sync::LazyLock;

/// Buckets of an octave: in the uppermost, 68 codes wide, and so in all others, no bucket meets two
/// borders between codes.
const BUCKETS_LOG2: u32 = 8;
/// Buckets start at 2⁻¹³, below which light is code 0.
const LEAST_EXPONENT: u32 = 127 - 13;
const FIRST_BUCKET: u32 = LEAST_EXPONENT << BUCKETS_LOG2;
const BUCKETS: usize = 13 << BUCKETS_LOG2;

/// The tables of both directions.
pub(super) struct Srgb {
    /// Linear light of each code.
    linear: [f32; 256],
    /// The light from which on a code is nearer, in codes, than the one before.
    from: [f32; 256],
    /// The code at the lower end of each bucket.
    bucket_codes: [u8; BUCKETS],
}

impl Srgb {
    /// The tables, made once.
    pub(super) fn tables() -> &'static Self {
        static TABLES: LazyLock<Srgb> = LazyLock::new(Srgb::new);
        &TABLES
    }

    fn new() -> Self {
        let mut tables = Self {
            linear: std::array::from_fn(|code| linear(code as f64 / 255.0) as f32),
            from: std::array::from_fn(|code| match code {
                0 => 0.0,
                _ => linear((code as f64 - 0.5) / 255.0) as f32,
            }),
            bucket_codes: [0; BUCKETS],
        };
        for (bucket, code) in (FIRST_BUCKET..).zip(&mut tables.bucket_codes) {
            let lower_end = f32::from_bits(bucket << (23 - BUCKETS_LOG2));
            *code = (tables.from.partition_point(|&from| from <= lower_end) - 1) as u8;
        }
        tables
    }

    /// Linear light, 0 … 1, of a code.
    pub(super) fn decode(&self, code: u8) -> f32 {
        self.linear[usize::from(code)]
    }

    /// The code nearest, in codes, to linear light.
    pub(super) fn encode(&self, light: f32) -> u8 {
        if light >= 1.0 {
            return 255;
        }
        // A sign would be the greatest bit of the bucket.
        let bucket = (light.max(0.0).to_bits() >> (23 - BUCKETS_LOG2)).checked_sub(FIRST_BUCKET);
        let Some(bucket) = bucket else { return 0 };
        let code = self.bucket_codes[bucket as usize];
        let is_next = self
            .from
            .get(usize::from(code) + 1)
            .is_some_and(|&from| light >= from);
        code + u8::from(is_next)
    }
}

/// Linear light of an encoded value, both 0 … 1.
fn linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The inverse as the standard writes it.
    fn encoded(light: f64) -> f64 {
        if light <= 0.003_130_8 {
            12.92 * light
        } else {
            1.055 * light.powf(1.0 / 2.4) - 0.055
        }
    }

    #[test]
    fn codes_survive() {
        let srgb = Srgb::tables();
        for code in 0..=255 {
            assert_eq!(srgb.encode(srgb.decode(code)), code);
        }
    }

    #[test]
    fn light_gets_the_nearest_code() {
        let srgb = Srgb::tables();
        // Every 97th float from below the least bucket up to 1.
        for bits in (f32::to_bits(1e-6)..=f32::to_bits(1.0)).step_by(97) {
            let light = f32::from_bits(bits);
            let exact = 255.0 * encoded(f64::from(light));
            let code = f64::from(srgb.encode(light));
            assert!((code - exact).abs() <= 0.5 + 1e-4, "{light} {code} {exact}");
        }
        for (light, code) in [(-1.0, 0), (0.0, 0), (1.0, 255), (2.0, 255), (f32::NAN, 0)] {
            assert_eq!(srgb.encode(light), code);
        }
    }
}
