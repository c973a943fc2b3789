//! Images whose texels tell where they are.

use glam::{DVec2, UVec2};
use globefill::{Image, Wrap};

/// Levels from texel to texel of the fine channels: up and down in ten texels.
pub const STEP: f64 = 51.0;

/// Red and green are waves along u and v, blue a ramp along both.
pub struct Ramps {
    size: UVec2,
    texels: Vec<[u8; 4]>,
}

impl Ramps {
    /// Sides are multiples of ten, so that the waves go on where the image is repeated.
    pub fn new(width: u32, height: u32) -> Self {
        assert!(width.is_multiple_of(10) && height.is_multiple_of(10));
        let wave = |k: u32| (STEP as u32 * (k % 10).min(10 - k % 10)) as u8;
        let ramp = |x: u32, y: u32| (128 * x / width + 127 * y / height) as u8;
        let texels = (0..height)
            .flat_map(|y| (0..width).map(move |x| [wave(x), wave(y), ramp(x, y), 255]))
            .collect();
        Self {
            size: UVec2::new(width, height),
            texels,
        }
    }

    pub fn image(&self) -> Image {
        Image::from_rgba8(self.size.x, self.size.y, self.texels.as_flattened()).expect("an image")
    }

    pub fn size(&self) -> DVec2 {
        self.size.as_dvec2()
    }

    /// Whether both waves are straight within `reach` texels of (u, v).
    pub fn is_straight(&self, uv: DVec2, reach: f64, wrap: Wrap) -> bool {
        let at = uv * self.size() - 0.5;
        let bend = |at: f64, side: f64| {
            let from_bend = (at / 5.0 - (at / 5.0).round()).abs() * 5.0;
            let is_within = (reach..side - 1.0 - reach).contains(&at);
            from_bend < reach || (wrap != Wrap::Repeat && !is_within)
        };
        !bend(at.x, self.size().x) && !bend(at.y, self.size().y)
    }

    /// Levels of red, green and blue at (u, v) between four texels.
    pub fn level(&self, uv: DVec2, wrap: Wrap) -> [f64; 3] {
        let at = uv * self.size() - 0.5;
        let first = at.floor();
        let share = at - first;
        let texel = |dx: f64, dy: f64| {
            let index = |at: f64, side: u32| {
                let last = f64::from(side - 1);
                match wrap {
                    Wrap::Repeat => at.rem_euclid(f64::from(side)),
                    Wrap::Clip | Wrap::Clamp => at.clamp(0.0, last),
                }
            };
            let x = index(first.x + dx, self.size.x) as usize;
            let y = index(first.y + dy, self.size.y) as usize;
            self.texels[y * self.size.x as usize + x]
        };
        let corners = [
            texel(0.0, 0.0),
            texel(1.0, 0.0),
            texel(0.0, 1.0),
            texel(1.0, 1.0),
        ];
        std::array::from_fn(|channel| {
            let [a, b, c, d] = corners.map(|texel| f64::from(texel[channel]));
            let upper = a + (b - a) * share.x;
            let lower = c + (d - c) * share.x;
            upper + (lower - upper) * share.y
        })
    }
}
