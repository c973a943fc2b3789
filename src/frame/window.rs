//! Rectangles of the picture that hold what is drawn.

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4, UVec2, Vec4Swizzles as _};

/// A rectangle in normalised device coordinates, −1 … 1 across the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Window {
    min: DVec2,
    max: DVec2,
}

impl Window {
    /// The whole picture.
    pub(crate) const FULL: Self = Self {
        min: DVec2::NEG_ONE,
        max: DVec2::ONE,
    };

    /// Nothing.
    pub(crate) const EMPTY: Self = Self {
        min: DVec2::INFINITY,
        max: DVec2::NEG_INFINITY,
    };

    /// What a sphere takes of the picture, or all of it if the sphere reaches the plane of the eye.
    /// `middle_m` is relative to the eye, along the axes that `clip_from_relative` is from.
    pub(crate) fn of_sphere(clip_from_relative: &DMat4, middle_m: DVec3, radius_m: f64) -> Self {
        let rows = clip_from_relative.transpose();
        let span = |row: DVec4| tangents(row, rows.w_axis, middle_m, radius_m);
        match (span(rows.x_axis), span(rows.y_axis)) {
            (Some(x), Some(y)) => Self {
                min: DVec2::new(x.0, y.0),
                max: DVec2::new(x.1, y.1),
            },
            _ => Self::FULL,
        }
    }

    /// What a cone about the eye takes of the picture. `from_ndc` makes lines of sight of points x, y, 1 of the
    /// picture; the cone holds those whose angle with the unit vector `axis` is at most acos `least_cos`, which
    /// is not negative.
    ///
    /// `axis` · v − `least_cos` |v| is concave in x and y, so that the cone takes an interval of each.
    pub(crate) fn of_cone(from_ndc: &DMat3, axis: DVec3, least_cos: f64) -> Self {
        let [right, up, ahead] = [from_ndc.x_axis, from_ndc.y_axis, from_ndc.z_axis];
        let spans = [(right, up), (up, right)].map(|(along, across)| {
            // By how much the cone holds the best point of a line across the picture.
            let held = |at: f64| {
                let start = ahead + along * at;
                let best = start + across * innermost(start, across, axis, least_cos);
                axis.dot(best) - least_cos * best.length()
            };
            interval(held)
        });
        match spans {
            [Some(x), Some(y)] => Self {
                min: DVec2::new(x.0, y.0),
                max: DVec2::new(x.1, y.1),
            },
            _ => Self::EMPTY,
        }
    }

    /// Its least and its greatest corner; without area, the first is not less than the second.
    pub(crate) fn corners(self) -> [DVec2; 2] {
        [self.min, self.max]
    }

    /// The smallest rectangle that holds both.
    pub(crate) fn joined(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// What both have in common.
    pub(crate) fn common(self, other: Self) -> Self {
        Self {
            min: self.min.max(other.min),
            max: self.max.min(other.max),
        }
    }

    /// The rectangle of whole pixels around it, `margin_px` wider on each side: least x and y, greatest x
    /// and y. One without area is a point.
    pub(crate) fn pixels(self, size_px: UVec2, margin_px: f64) -> [f32; 4] {
        let Self { min, max } = self.common(Self::FULL);
        if min.cmpgt(max).any() {
            return [0.0; 4];
        }
        let half_px = 0.5 * size_px.as_dvec2();
        // Half a pixel of room for rounding.
        let room = DVec2::splat(0.5 + margin_px);
        let least = ((min + 1.0) * half_px - room).floor() / half_px - 1.0;
        let greatest = ((max + 1.0) * half_px + room).ceil() / half_px - 1.0;
        let [left, below] = least.max(DVec2::NEG_ONE).as_vec2().to_array();
        let [right, above] = greatest.min(DVec2::ONE).as_vec2().to_array();
        [left, below, right, above]
    }
}

/// A window in the indices of a draw, as resolve.wgsl reads them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct WindowDraw {
    /// Of the first of four vertices: the least corner, in 2⁻¹⁵ of the picture, above two bits.
    pub vertex: u32,
    /// Of the instance: the greatest corner.
    pub instance: u32,
}

impl Window {
    /// Whether it holds the whole picture.
    pub(crate) fn is_full(self) -> bool {
        self.common(Self::FULL) == Self::FULL
    }

    /// The draw of all its pixels and `margin_px` around; nothing where it holds none of the picture.
    pub(crate) fn draw(self, size_px: UVec2, margin_px: f64) -> Option<WindowDraw> {
        let Self { min, max } = self.common(Self::FULL);
        if min.cmpgt(max).any() {
            return None;
        }
        let [left, below, right, above] = self.pixels(size_px, margin_px).map(f64::from);
        let steps = |ndc: f64| (ndc + 1.0) * 16384.0;
        let [left, below] = [left, below].map(|least| steps(least).floor().min(32767.0) as u32);
        let [right, above] = [right, above].map(|greatest| steps(greatest).ceil() as u32);
        Some(WindowDraw {
            vertex: left << 2 | below << 17,
            instance: right | above << 16,
        })
    }
}

/// The coordinates k at which the planes `row` · v = k `w_row` · v touch a sphere:
/// ((`row` − k `w_row`) · middle)² = radius² |`row` − k `w_row`|². None if the sphere reaches w = 0.
fn tangents(row: DVec4, w_row: DVec4, middle_m: DVec3, radius_m: f64) -> Option<(f64, f64)> {
    let squared = radius_m * radius_m;
    let middle = middle_m.extend(1.0);
    let (x, w) = (row.dot(middle), w_row.dot(middle));
    let (row, w_row) = (row.xyz(), w_row.xyz());
    let quadratic = w * w - squared * w_row.length_squared();
    if w <= 0.0 || quadratic <= 0.0 {
        return None;
    }
    let linear = x * w - squared * row.dot(w_row);
    let constant = x * x - squared * row.length_squared();
    let root = (linear * linear - quadratic * constant).max(0.0).sqrt();
    Some(((linear - root) / quadratic, (linear + root) / quadratic))
}

/// Where, −1 … 1, `axis` · v − `least_cos` |v| is greatest on the line v = `start` + k `along`.
fn innermost(start: DVec3, along: DVec3, axis: DVec3, least_cos: f64) -> f64 {
    let squared = along.length_squared();
    let rise = axis.dot(along);
    // With u from the foot of the line's perpendicular, |v|² = u² `squared` + `aside`.
    let foot = -start.dot(along) / squared;
    let aside = (start + along * foot).length_squared();
    let steepest = least_cos * least_cos * squared - rise * rise;
    if steepest <= 0.0 {
        return rise.signum();
    }
    let from_foot = rise * (aside / (squared * steepest)).sqrt();
    (foot + from_foot).clamp(-1.0, 1.0)
}

/// Bisections of half the picture: finer than its pixels by far.
const BISECTIONS: u32 = 24;

/// Where, −1 … 1, a concave function is not negative, or a little more; none if nowhere.
fn interval(function: impl Fn(f64) -> f64) -> Option<(f64, f64)> {
    let (mut low, mut high) = (-1.0, 1.0);
    // To where it is greatest, or first found not to be negative.
    let mut inside = [-1.0, 1.0].into_iter().find(|&at| function(at) >= 0.0);
    for _ in 0..2 * BISECTIONS {
        if inside.is_some() {
            break;
        }
        let (left, right) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        let (at_left, at_right) = (function(left), function(right));
        inside = if at_left >= 0.0 {
            Some(left)
        } else {
            (at_right >= 0.0).then_some(right)
        };
        if at_left < at_right {
            low = left;
        } else {
            high = right;
        }
    }
    let inside = inside?;
    let end = |outermost: f64| {
        if function(outermost) >= 0.0 {
            return outermost;
        }
        let (mut held, mut missed) = (inside, outermost);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (held + missed);
            if function(middle) >= 0.0 {
                held = middle;
            } else {
                missed = middle;
            }
        }
        missed
    };
    Some((end(-1.0), end(1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lens that is off its middle, turned about all axes.
    fn lens() -> DMat4 {
        let projection = DMat4::from_cols(
            DVec4::new(1.3, 0.0, 0.0, 0.0),
            DVec4::new(0.0, 2.1, 0.0, 0.0),
            DVec4::new(0.2, -0.1, 0.0, -1.0),
            DVec4::new(0.0, 0.0, 0.1, 0.0),
        );
        let rotation = DMat3::from_rotation_x(0.4) * DMat3::from_rotation_z(1.1);
        projection * DMat4::from_mat3(rotation)
    }

    #[test]
    fn windows_hold_spheres_closely() {
        let lens = lens();
        let back = lens.inverse();
        for (at, radius_m) in [
            (DVec3::new(0.1, 0.2, 0.3), 0.5),
            (DVec3::new(-0.5, 0.4, 0.2), 2.0),
        ] {
            // A point five metres down the view axis, or so.
            let ahead = back * DVec4::new(at.x, at.y, 0.02, 1.0);
            let middle_m = ahead.xyz() / ahead.w;
            let window = Window::of_sphere(&lens, middle_m, radius_m);
            let mut seen = Window::EMPTY;
            for step in 0..400 {
                for turn in 0..400 {
                    let (lat, lon) = (f64::from(step) / 400.0, f64::from(turn) / 400.0);
                    let (sin, cos) = (lat * std::f64::consts::PI).sin_cos();
                    let (east, north) = (lon * std::f64::consts::TAU).sin_cos();
                    let point_m = middle_m + radius_m * DVec3::new(sin * north, sin * east, cos);
                    let clip = lens * point_m.extend(1.0);
                    assert!(clip.w > 0.0);
                    let ndc = clip.xy() / clip.w;
                    seen = seen.joined(Window { min: ndc, max: ndc });
                }
            }
            let slack = (seen.min - window.min).min(window.max - seen.max);
            assert!(slack.min_element() > -1e-12, "{window:?} {seen:?}");
            assert!(slack.max_element() < 1e-3, "{window:?} {seen:?}");
        }
    }

    /// Seen at a slant, beside and behind the eye.
    #[test]
    fn windows_hold_cones_closely() {
        let lens = lens();
        let rows = lens.transpose();
        let rows = [rows.x_axis, rows.y_axis, rows.w_axis].map(|row| row.xyz().to_array());
        let from_ndc = DMat3::from_cols_array_2d(&rows).transpose().inverse();
        let mut cut = 0;
        for step in 0..300 {
            let turn = f64::from(step);
            let axis = from_ndc * DVec3::new(3.0 * turn.sin(), 2.0 * (1.7 * turn).cos(), 1.0);
            let axis = axis.normalize() * if step % 5 == 0 { -1.0 } else { 1.0 };
            let least_cos = (0.1 + 0.0047 * turn).cos();
            let window = Window::of_cone(&from_ndc, axis, least_cos);
            let mut seen = Window::EMPTY;
            for x in -100..=100 {
                for y in -100..=100 {
                    let ndc = DVec2::new(f64::from(x), f64::from(y)) / 100.0;
                    let ray = from_ndc * ndc.extend(1.0);
                    if axis.dot(ray) >= least_cos * ray.length() {
                        seen = seen.joined(Window { min: ndc, max: ndc });
                    }
                }
            }
            if seen == Window::EMPTY {
                let size = window.max - window.min;
                assert!(size.min_element() < 0.1, "{step}: {window:?}");
                continue;
            }
            let slack = (seen.min - window.min).min(window.max - seen.max);
            assert!(slack.min_element() >= 0.0, "{step}: {window:?} {seen:?}");
            // Between the points that were asked.
            assert!(slack.max_element() < 0.1, "{step}: {window:?} {seen:?}");
            cut += u32::from(!window.is_full());
        }
        assert!(cut > 100, "{cut} were smaller than the picture");
    }

    #[test]
    fn a_sphere_about_the_eye_takes_all() {
        let window = Window::of_sphere(&lens(), DVec3::new(0.1, 0.0, 0.0), 1.0);
        assert_eq!(window, Window::FULL);
        assert_eq!(window.pixels(UVec2::new(7, 5), 0.0), [-1.0, -1.0, 1.0, 1.0]);
    }

    #[test]
    fn draws_hold_windows() {
        let read = |draw: WindowDraw| {
            let least = [draw.vertex >> 2 & 0x7fff, draw.vertex >> 17];
            let greatest = [draw.instance & 0xffff, draw.instance >> 16];
            assert_eq!(draw.vertex & 3, 0);
            [least, greatest].map(|corner| corner.map(|steps| f64::from(steps) / 16384.0 - 1.0))
        };
        let size_px = UVec2::new(1280, 719);
        assert_eq!(Window::EMPTY.draw(size_px, 1.0), None);
        let full = Window::FULL.draw(size_px, 1.0).expect("it is seen");
        assert_eq!(read(full), [[-1.0; 2], [1.0; 2]]);
        for (min, max) in [
            ([-0.3, 0.2], [0.1, 0.9]),
            ([-3.0, -0.01], [-0.999, 0.01]),
            ([0.9999, 0.9999], [2.0, 2.0]),
        ] {
            let (min, max) = (DVec2::from(min), DVec2::from(max));
            let draw = Window { min, max }.draw(size_px, 1.0).expect("it is seen");
            let [least, greatest] = read(draw);
            for axis in 0..2 {
                let px = 2.0 / f64::from(size_px[axis]);
                let below = min[axis].max(-1.0) - least[axis];
                let above = greatest[axis] - max[axis].min(1.0);
                assert!(below >= px || least[axis] == -1.0, "{min} {max}");
                assert!(above >= px || greatest[axis] == 1.0, "{min} {max}");
                assert!(below.max(above) < 3.6 * px, "{min} {max}");
            }
        }
        let outside = Window {
            min: DVec2::new(1.1, 0.0),
            max: DVec2::new(1.2, 0.1),
        };
        assert_eq!(outside.draw(size_px, 1.0), None);
    }

    #[test]
    fn windows_grow_to_whole_pixels_within_the_picture() {
        let window = Window {
            min: DVec2::new(-0.1, 0.99),
            max: DVec2::new(0.1, 3.0),
        };
        let pixels = window.pixels(UVec2::new(20, 20), 0.0);
        assert_eq!(pixels, [-0.2, 0.9, 0.2, 1.0]);
        assert_eq!(Window::EMPTY.pixels(UVec2::ONE, 3.0), [0.0; 4]);
    }
}
