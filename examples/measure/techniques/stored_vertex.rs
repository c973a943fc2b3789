//! Vertices as each encoding stores them.

use glam::DVec3;
use globefill::wgpu::{VertexAttribute, VertexBufferLayout, VertexStepMode, vertex_attr_array};

use crate::settings::Encoding;

/// Fixed point: steps a metre, and how much finer fractions are.
const STEPS_PER_M: f64 = 128.0;
const FRACTIONS_PER_STEP: f64 = 1024.0;

const SINGLE: [VertexAttribute; 2] = vertex_attr_array![0 => Float32x3, 1 => Uint32];
const HIGH_LOW: [VertexAttribute; 3] =
    vertex_attr_array![0 => Float32x3, 1 => Uint32, 2 => Float32x3];
const FIXED: [VertexAttribute; 2] = vertex_attr_array![0 => Sint32x4, 1 => Uint32];

impl Encoding {
    /// Declarations of `Stored`, `relative` and `ecef`.
    pub fn source(self) -> &'static str {
        match self {
            Self::Plain | Self::Local => include_str!("stored_single.wgsl"),
            Self::HighLow => include_str!("stored_high_low.wgsl"),
            Self::Fixed => include_str!("stored_fixed.wgsl"),
        }
    }

    pub fn layout(self) -> VertexBufferLayout<'static> {
        let (words, attributes): (u64, &[VertexAttribute]) = match self {
            Self::Plain | Self::Local => (4, &SINGLE),
            Self::HighLow => (7, &HIGH_LOW),
            Self::Fixed => (5, &FIXED),
        };
        VertexBufferLayout {
            array_stride: 4 * words,
            step_mode: VertexStepMode::Vertex,
            attributes,
        }
    }

    /// Appends a vertex; `origin_m` is what single precision is relative to.
    pub fn push(self, words: &mut Vec<u32>, ecef_m: DVec3, origin_m: DVec3, fill_and_end: u32) {
        match self {
            Self::Plain | Self::Local => {
                words.extend((ecef_m - origin_m).to_array().map(single));
                words.push(fill_and_end);
            }
            Self::HighLow => {
                let (high, low) = high_low(ecef_m);
                words.extend(high.map(f32::to_bits));
                words.push(fill_and_end);
                words.extend(low.map(f32::to_bits));
            }
            Self::Fixed => {
                let (steps, [x, y, z]) = fixed(ecef_m);
                words.extend(steps.map(i32::cast_unsigned));
                words.push((x | y << 10 | z << 20).cast_unsigned());
                words.push(fill_and_end);
            }
        }
    }
}

fn single(metres: f64) -> u32 {
    (metres as f32).to_bits()
}

/// Two numbers of single precision that add up.
pub fn high_low(ecef_m: DVec3) -> ([f32; 3], [f32; 3]) {
    let high = ecef_m.as_vec3();
    (
        high.to_array(),
        (ecef_m - high.as_dvec3()).as_vec3().to_array(),
    )
}

/// Whole steps, and what is left of each in fractions of one.
pub fn fixed(ecef_m: DVec3) -> ([i32; 3], [i32; 3]) {
    let fractions = (ecef_m * STEPS_PER_M * FRACTIONS_PER_STEP).round();
    let steps = (fractions / FRACTIONS_PER_STEP).floor();
    let left = fractions - steps * FRACTIONS_PER_STEP;
    (steps.as_ivec3().to_array(), left.as_ivec3().to_array())
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACES_M: [DVec3; 2] = [
        DVec3::new(4_510_023.707_2, -795_238.4, -4_487_348.41),
        DVec3::new(-0.003, 6_378_137.0, 1e-6),
    ];

    /// Bounds: half of the last digit of each.
    #[test]
    fn encodings_keep_their_digits() {
        for place_m in PLACES_M {
            let (high, low) = high_low(place_m);
            let (steps, fractions) = fixed(place_m);
            for axis in 0..3 {
                let sum_m = f64::from(high[axis]) + f64::from(low[axis]);
                assert!((sum_m - place_m[axis]).abs() <= 0.25 * 2_f64.powi(-24));
                assert!((0..1024).contains(&fractions[axis]));
                let fixed_m =
                    f64::from(steps[axis]) / 128.0 + f64::from(fractions[axis]) / 131_072.0;
                assert!((fixed_m - place_m[axis]).abs() <= 0.5 / 131_072.0 + 1e-9);
            }
        }
    }

    #[test]
    fn vertices_fill_their_stride() {
        for encoding in [
            Encoding::Plain,
            Encoding::Local,
            Encoding::HighLow,
            Encoding::Fixed,
        ] {
            let mut words = Vec::new();
            encoding.push(&mut words, PLACES_M[0], DVec3::ZERO, 7);
            assert_eq!(4 * words.len() as u64, encoding.layout().array_stride);
        }
    }
}
