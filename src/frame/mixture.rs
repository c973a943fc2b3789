//! Unordered fills: what each adds to the sums that all of them share.

mod burden;

pub(crate) use burden::Burden;

use crate::{
    frame::code::Mantissa,
    frame::optical_depth::optical_depth,
    style::{FillStyle, over, premultiplied},
};

/// Weights are stored in 16 bits.
const MOST_UNITS: f64 = 65535.0;
/// The same where half floats add them up, one for each fill: 257 of them are finite.
const MOST_HALF_UNITS: f64 = 255.0;
/// Fewest units per optical depth that do: rounding one weight changes opacity by 1/512 at most, half a
/// step of 8 bits.
const LEAST_SCALE: f64 = 256.0;

/// The fills of all meshes that are mixed in no order. They are counted like those of a layer, but what is
/// summed are weights: optical depths, in integers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Mixture {
    /// By code less one: what is absorbed of all light, times red, green, blue and one.
    pub depths: Vec<[f64; 4]>,
}

impl Mixture {
    /// The optical depths of a style.
    pub(crate) fn depths_of(style: &FillStyle) -> [f64; 4] {
        let [red, green, blue, alpha] =
            over(premultiplied(style.highlight), premultiplied(style.color));
        let depth = optical_depth(alpha * style.opacity);
        let part = |part: f32| f64::from((part / alpha).clamp(0.0, 1.0)) * depth;
        [part(red), part(green), part(blue), depth]
    }

    /// Units of weight per optical depth, a power of two: as many as are exact while no more is added up
    /// at a pixel than `most`. Nothing if those are too few.
    pub(crate) fn scale(&self, most: &Burden, mantissa: Mantissa) -> Option<f64> {
        let (faces, depth) = most.most();
        let room = mantissa.limit() as f64 - faces - 1.0;
        let scale = power_below((room / depth).min(MOST_UNITS / self.deepest()));
        (scale >= LEAST_SCALE).then_some(scale)
    }

    /// The same where the stencil counts and every fill is added once.
    pub(crate) fn stencil_scale(&self, mantissa: Mantissa) -> f64 {
        let units = match mantissa {
            Mantissa::Half => MOST_HALF_UNITS,
            Mantissa::Single => MOST_UNITS,
        };
        power_below(units / self.deepest())
    }

    /// Weights by code, none for the first, as the extruder reads them.
    pub(crate) fn weights(&self, scale: f64) -> Vec<[u32; 2]> {
        let units = |depth: f64| (depth * scale).round() as u32;
        let packed = self.depths.iter().map(|depths| {
            let [red, green, blue, all] = depths.map(units);
            [red | green << 16, blue | all << 16]
        });
        std::iter::once([0; 2]).chain(packed).collect()
    }

    /// By how much the depths of two codes differ, in the component that differs most; code 0 has none.
    pub(crate) fn difference(&self, a: u32, b: u32) -> f64 {
        let [a, b] = [a, b].map(|code| match code.checked_sub(1) {
            Some(index) => self.depths[index as usize],
            None => [0.0; 4],
        });
        let parts = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        parts.fold(0.0, f64::max)
    }

    fn deepest(&self) -> f64 {
        self.depths
            .iter()
            .map(|depths| depths[3])
            .fold(0.0, f64::max)
    }
}

/// The greatest power of two that is not above `bound`, which is positive or infinite; 2¹⁶ at most.
fn power_below(bound: f64) -> f64 {
    2_f64.powf(bound.min(65536.0).log2().floor())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{frame::window::Window, style::Blend};

    fn style(color: [f32; 4]) -> FillStyle {
        FillStyle {
            color,
            blend: Blend::Unordered,
            ..Default::default()
        }
    }

    #[test]
    fn depths_add_up_as_filters_do() {
        let [a, b] = [0.3_f32, 0.6].map(|alpha| Mixture::depths_of(&style([1.0, 0.5, 0.0, alpha])));
        let both = 1.0 - (-(a[3] + b[3])).exp();
        assert!((both - (1.0 - 0.7 * 0.4)).abs() < 1e-6, "{both}");
        assert!((a[0] - a[3]).abs() < 1e-6 && (a[1] - 0.5 * a[3]).abs() < 1e-6 && a[2] == 0.0);
    }

    #[test]
    fn opacity_and_highlight_count() {
        let faded = FillStyle {
            opacity: 0.5,
            highlight: [0.0, 0.0, 1.0, 0.5],
            ..style([1.0, 0.0, 0.0, 0.5])
        };
        let [red, _, blue, all] = Mixture::depths_of(&faded);
        // Half blue over what remains of half red: 3/4 opaque, a third of that red.
        assert!((all + (1.0_f64 - 0.375).ln()).abs() < 1e-6);
        assert!((red / all - 1.0 / 3.0).abs() < 1e-6 && (blue / all - 2.0 / 3.0).abs() < 1e-6);
    }

    #[test]
    fn weights_fit_and_are_fine_enough() {
        for alpha in [0.001, 0.1, 0.5, 0.99, 1.0] {
            let mixture = Mixture {
                depths: vec![Mixture::depths_of(&style([1.0, 1.0, 0.2, alpha]))],
            };
            let mut light = Burden::default();
            light.add(Window::FULL, 100, mixture.deepest());
            let scale = mixture
                .scale(&light, Mantissa::Single)
                .expect("it has room");
            let [_, [_, high]] = mixture.weights(scale)[..] else {
                panic!("two codes")
            };
            let units = f64::from(high >> 16);
            let opacity = 1.0 - (-units / scale).exp();
            assert!((opacity - f64::from(alpha.min(0.99))).abs() < 1.0 / 512.0);
            assert!(units * 100.0 + 100.0 < f64::from(1 << 24));
            // Half floats hold some hundred of them, once each.
            let half = mixture.stencil_scale(Mantissa::Half);
            assert!(mixture.depths[0][3] * half <= MOST_HALF_UNITS);
        }
    }

    #[test]
    fn sums_that_would_be_too_coarse_are_refused() {
        let mixture = Mixture {
            depths: vec![[1.0; 4]],
        };
        let burden = |faces| {
            let mut burden = Burden::default();
            burden.add(Window::FULL, faces, 1.0);
            burden
        };
        assert!(mixture.scale(&burden(60_000), Mantissa::Single).is_some());
        assert!(mixture.scale(&burden(70_000), Mantissa::Single).is_none());
        assert!(mixture.scale(&burden(10), Mantissa::Half).is_none());
    }
}
