//! The 16-byte fixed-point vertex.
//!
//! Components are integers of 1/128 m plus 10-bit fractions of 2⁻¹⁷ m (7.6 µm, so 3.8 µm of rounding
//! an axis). A shader subtracts the eye exactly in integers; nothing depends on how floats round.

use glam::DVec3;

/// Steps of the integer part in a metre.
pub(crate) const STEPS_PER_M: f64 = 128.0;
/// Bits of the fraction below a step.
const FRACTION_BITS: u32 = 10;
const UNITS_PER_M: f64 = STEPS_PER_M * (1 << FRACTION_BITS) as f64;
/// The eye is clamped to this, metres an axis, so that differences to vertices fit 31 bits.
const EYE_LIMIT_M: f64 = 1e7;

/// A vertex as the GPU stores it: x, y, z in 1/128 m and the three fractions, x in the lowest bits.
pub(crate) type FixedVertex = [i32; 4];

/// Encodes an ECEF position, metres. Within ±6.77·10⁶ m an axis its difference to any clamped eye fits
/// 31 bits.
pub(crate) fn encode(ecef_m: DVec3) -> FixedVertex {
    let [x, y, z] = ecef_m.to_array().map(split);
    [
        x.0,
        y.0,
        z.0,
        x.1 | y.1 << FRACTION_BITS | z.1 << (2 * FRACTION_BITS),
    ]
}

fn split(component_m: f64) -> (i32, i32) {
    let units = (component_m * UNITS_PER_M).round() as i64;
    let fraction = units & ((1 << FRACTION_BITS) - 1);
    ((units >> FRACTION_BITS) as i32, fraction as i32)
}

/// The eye in the same units, and what they leave over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FixedEye {
    /// Steps of 1/128 m.
    pub steps: [i32; 3],
    /// Fractions of 2⁻¹⁷ m.
    pub fractions: [i32; 3],
    /// Encoded eye minus true eye, metres.
    pub remainder_m: DVec3,
}

impl FixedEye {
    pub(crate) fn new(eye_ecef_m: DVec3) -> Self {
        let clamped_m = eye_ecef_m.clamp(DVec3::splat(-EYE_LIMIT_M), DVec3::splat(EYE_LIMIT_M));
        let parts = clamped_m.to_array().map(split);
        let steps = parts.map(|part| part.0);
        let fractions = parts.map(|part| part.1);
        let encoded_m = DVec3::from_array(std::array::from_fn(|axis| {
            f64::from(steps[axis]) / STEPS_PER_M + f64::from(fractions[axis]) / UNITS_PER_M
        }));
        Self {
            steps,
            fractions,
            remainder_m: encoded_m - eye_ecef_m,
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::ellipsoid::Ellipsoid;

    fn decode_relative_m(vertex: FixedVertex, eye: &FixedEye) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|axis| {
            let steps = vertex[axis]
                .checked_sub(eye.steps[axis])
                .expect("no overflow");
            let fraction = (vertex[3] >> (10 * axis)) & 1023;
            let below = (fraction - eye.fractions[axis]) as f32 / 131_072.0;
            let above = steps as f32 / 128.0;
            f64::from(above + (below + eye.remainder_m[axis] as f32))
        }))
    }

    /// Points of the ellipsoid by the golden angle.
    fn surface_points_m(count: u32) -> impl Iterator<Item = DVec3> {
        (0..count).map(move |k| {
            let z = 1.0 - 2.0 * (f64::from(k) + 0.5) / f64::from(count);
            let (sin, cos) = (2.399_963_229_728_653 * f64::from(k)).sin_cos();
            let axis_distance = (1.0 - z * z).sqrt();
            Ellipsoid::WGS84.surface_with_normal(DVec3::new(
                axis_distance * cos,
                axis_distance * sin,
                z,
            ))
        })
    }

    /// The bound of the module's head: 3.8 µm an axis plus f32 rounding relative to the distance.
    #[test]
    fn relative_positions_stay_within_the_bound() {
        for scale_m in [0.1, 1.0, 100.0, 1e4, 1e6, 3e7, 4e8] {
            let bound_m = 3.9e-6 + 1.2e-7 * scale_m;
            let mut worst_m = 0.0_f64;
            for (k, vertex_m) in surface_points_m(2_000).enumerate() {
                // No round numbers: their differences would not be rounded.
                let way = DVec3::new(0.6123, -0.6345, 0.4721) * (1.0 + 1e-4 * (k as f64).sqrt());
                let eye_m = vertex_m + way * scale_m;
                let relative_m = decode_relative_m(encode(vertex_m), &FixedEye::new(eye_m));
                let error_m = (relative_m - (vertex_m - eye_m)).abs().max_element();
                worst_m = worst_m.max(error_m);
            }
            println!("{scale_m} m away: {worst_m:.2e} m an axis, bound {bound_m:.2e} m");
            assert!(worst_m < bound_m, "{scale_m} m away: {worst_m} m");
        }
    }

    /// Columns as extrude.wgsl raises them: the direction of a vertex's normal in single precision.
    #[test]
    fn columns_lean_by_a_few_roundings() {
        let ellipsoid = Ellipsoid::WGS84;
        let ratio = ((ellipsoid.a_m / ellipsoid.b_m).powi(2)) as f32;
        let mut worst_rad = 0.0_f64;
        for vertex_m in surface_points_m(20_000) {
            let [x, y, z, _] = encode(vertex_m);
            let normal = Vec3::new(x as f32, y as f32, z as f32 * ratio).normalize();
            let expected = ellipsoid.normal_at_surface(vertex_m);
            worst_rad = worst_rad.max(normal.as_dvec3().cross(expected).length());
        }
        println!("columns lean by up to {worst_rad:.1e} rad");
        // Of the coordinate, of the scale and its product, of the quotient: half an ulp each.
        assert!(worst_rad < 2e-7, "{worst_rad}");
    }
}
