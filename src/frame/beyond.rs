//! What lies so far beyond the horizon that volumes need no height there.
//!
//! A piece that reaches beyond the horizon is drawn as a whole, so that its volume stays closed. But where no
//! surface can be seen the volume may have any height. With tops as low as bottoms its faces are twice the same
//! triangles, facing opposite ways: they add nothing at any pixel, and need not be drawn.

use glam::DVec3;

use crate::{
    fill_mesh::{Bounds, FillMesh},
    frame::sight::Sight,
    gpu::fixed_point::{FixedVertex, STEPS_PER_M, encode},
};

/// Bits of 1/128 m that are ignored: what remains is 256 m.
const IGNORED_BITS: u32 = 15;
/// The length of `direction`: products of it and a vertex add up to less than 2³¹.
const LENGTH: f64 = 8191.0;
/// Room, radians, for tops that stand aside of their foot points.
const ROOM_RAD: f64 = 1e-3;

/// A half space: what it holds of the ellipsoid has tops as low as bottoms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Beyond {
    /// It holds vertices whose product with this, 256 m by 256 m, is less than the limit.
    pub direction: [i32; 3],
    pub limit: i32,
    /// Where the eye is, a unit vector in coordinates divided by the radii.
    eye: DVec3,
    /// Nothing nearer than this to there is held.
    from_rad: f64,
    /// All farther than this from there is held.
    all_from_rad: f64,
}

impl Beyond {
    /// What `sight` cannot see if faces are drawn whose edges are at most `edge_rad` long; none if it is
    /// nothing.
    pub(crate) fn of(sight: &Sight, edge_rad: f64) -> Option<Self> {
        let (eye, horizon_rad) = sight.horizon()?;
        // A face that has one of its vertices here has no point within the horizon.
        let from_rad = horizon_rad + edge_rad + ROOM_RAD;
        let radii_m = sight.ellipsoid.radii_m();
        let along = eye / radii_m;
        let limit_m = from_rad.cos() / along.length();
        let steps = STEPS_PER_M / f64::from(1 << IGNORED_BITS);
        // What rounding may add to a product or take from it: half of a part of the direction, one of the vertex.
        let off = 3_f64.sqrt() * (0.5 * radii_m.max_element() * steps + LENGTH) + 1.0;
        let all_from_cos = from_rad.cos() - 2.0 * off * along.length() / (steps * LENGTH);
        if from_rad >= std::f64::consts::PI || all_from_cos <= -1.0 {
            return None;
        }
        let direction = (along.normalize() * LENGTH).round();
        Some(Self {
            direction: direction.as_ivec3().to_array(),
            limit: (limit_m * steps * LENGTH - off).floor() as i32,
            eye,
            from_rad,
            all_from_rad: all_from_cos.acos() + 1e-6,
        })
    }

    /// Whether a vertex is held; the same in extrude.wgsl.
    fn holds(&self, vertex: FixedVertex) -> bool {
        let products = self.direction.iter().zip(&vertex);
        let sum: i32 = products.map(|(a, b)| a * (b >> IGNORED_BITS)).sum();
        sum < self.limit
    }

    /// Whether a surface point is held.
    pub(crate) fn holds_point(&self, ecef_m: DVec3) -> bool {
        self.holds(encode(ecef_m))
    }

    /// Whether all vertices in `bounds` are held.
    pub(crate) fn holds_all(&self, bounds: &Bounds) -> bool {
        self.eye.angle_between(bounds.axis) - bounds.radius_rad > self.all_from_rad
    }

    /// Whether some may be.
    pub(crate) fn holds_some(&self, bounds: &Bounds) -> bool {
        self.eye.angle_between(bounds.axis) + bounds.radius_rad > self.from_rad - 1e-6
    }
}

/// The longest edge of what is drawn of a mesh, radians in coordinates divided by the radii.
pub(crate) fn longest_edge_rad(mesh: &FillMesh) -> f64 {
    let radii_m = mesh.ellipsoid.radii_m();
    let squared = |a: u32, b: u32| {
        let [a, b] = [a, b].map(|vertex| mesh.vertices[vertex as usize]);
        ((a - b) / radii_m).length_squared()
    };
    let of_caps = mesh
        .cap_triangles
        .iter()
        .flat_map(|&[a, b, c]| [squared(a, b), squared(b, c), squared(c, a)]);
    let of_walls = mesh.arcs.iter().flat_map(|arc| {
        let chords = arc.first_vertex..arc.first_vertex + arc.vertex_count.saturating_sub(1);
        chords.map(|vertex| squared(vertex, vertex + 1))
    });
    let longest = of_caps.chain(of_walls).fold(0.0, f64::max).sqrt();
    2.0 * (0.5 * longest).min(1.0).asin()
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DMat4, DVec4, UVec2};

    use super::*;
    use crate::{
        Ellipsoid, LonLat,
        options::{Camera, Frame, HeightRange, RendererOptions},
    };

    const EDGE_RAD: f64 = 0.04;
    const HIGHEST_M: f64 = 9_000.0;
    const LOWEST_M: f64 = -500.0;

    /// Down from above a place, 60° across 720 pixels.
    fn sight(at: LonLat, height_m: f64, parallel: bool) -> Sight {
        let ellipsoid = Ellipsoid::WGS84;
        let up = ellipsoid.normal(at);
        let right = up.any_orthonormal_vector();
        let scale = 1.0 / 30_f64.to_radians().tan();
        let clip_from_view = if parallel {
            let scale = 1.0 / height_m;
            let depth = DVec4::new(0.0, 0.0, 1e-8, 0.0);
            let [x, y] = [DVec4::X * scale, DVec4::Y * scale];
            DMat4::from_cols(x, y, depth, DVec4::new(0.0, 0.0, 1.0, 1.0))
        } else {
            let [x, y] = [DVec4::X * scale, DVec4::Y * scale];
            DMat4::from_cols(x, y, DVec4::new(0.0, 0.0, 0.0, -1.0), DVec4::Z)
        };
        let camera = Camera {
            eye_ecef_m: ellipsoid.ecef(at, height_m),
            view_from_ecef: DMat3::from_cols(right, up.cross(right), up).transpose(),
            clip_from_view,
        };
        let frame = Frame {
            terrain: HeightRange {
                min_m: LOWEST_M,
                max_m: HIGHEST_M,
            },
            host_pixel_error: 0.0,
            ..Frame::new(camera, UVec2::splat(720))
        };
        Sight::new(ellipsoid, 0.0, &frame, &RendererOptions::default()).expect("valid")
    }

    /// Whether the ellipsoid of so much greater radii lies between two points.
    fn hides(lowest_m: f64, from_m: DVec3, to_m: DVec3) -> bool {
        let radii_m = Ellipsoid::WGS84.radii_m() + lowest_m;
        let (from, to) = (from_m / radii_m, to_m / radii_m);
        let along = to - from;
        let nearest = (-from.dot(along) / along.length_squared()).clamp(0.0, 1.0);
        (from + along * nearest).length() < 1.0
    }

    /// Where a great circle leads that starts at a place, all on a sphere.
    fn ahead(from: LonLat, bearing_rad: f64, angle_rad: f64) -> LonLat {
        let (sin_lat, cos_lat) = from.lat_deg.to_radians().sin_cos();
        let (sin, cos) = angle_rad.sin_cos();
        let lat_sin = sin_lat * cos + cos_lat * sin * bearing_rad.cos();
        let east = (bearing_rad.sin() * sin * cos_lat).atan2(cos - sin_lat * lat_sin);
        let lon_deg = from.lon_deg + east.to_degrees();
        LonLat::new(lon_deg, lat_sin.asin().to_degrees())
    }

    /// Seen from the eye, what is lowest hides all that is highest an edge before anything is held; but that is
    /// no farther than it must be.
    #[test]
    fn what_is_held_begins_an_edge_behind_what_can_be_seen() {
        let ellipsoid = Ellipsoid::WGS84;
        let at = LonLat::new(13.0, 47.0);
        for (height_m, parallel) in [
            (0.0, false),
            (2e3, false),
            (5e4, false),
            (9e5, false),
            (2e7, false),
            (4e8, false),
            (7e6, true),
        ] {
            let sight = sight(at, height_m, parallel);
            let beyond = Beyond::of(&sight, EDGE_RAD).expect("the eye is above");
            let far_m = if parallel { 1e13 } else { height_m };
            let eye_m = ellipsoid.ecef(at, far_m);
            for turn in 0..36 {
                let bearing_rad = 10_f64.to_radians() * f64::from(turn);
                let steps = (0..18_000).map(|step| 1e-2_f64.to_radians() * f64::from(step));
                let (mut seen_to_rad, mut held_from_rad) = (0.0, f64::INFINITY);
                for angle_rad in steps {
                    let place = ahead(at, bearing_rad, angle_rad);
                    if !hides(LOWEST_M, eye_m, ellipsoid.ecef(place, HIGHEST_M)) {
                        seen_to_rad = angle_rad;
                    }
                    if beyond.holds_point(ellipsoid.ecef(place, 0.0)) {
                        held_from_rad = held_from_rad.min(angle_rad);
                    }
                }
                let room_rad = held_from_rad - seen_to_rad - EDGE_RAD;
                // Divided by the radii, angles are others by up to the flattening.
                let most_rad = 0.02 + 0.007 * seen_to_rad;
                assert!(
                    room_rad > 0.0 && room_rad < most_rad,
                    "{room_rad} rad from {height_m} m"
                );
            }
        }
    }

    #[test]
    fn eyes_under_ground_hold_nothing() {
        let at = LonLat::new(-70.0, -20.0);
        for height_m in [-600.0, -5e3, -3e6] {
            assert_eq!(Beyond::of(&sight(at, height_m, false), EDGE_RAD), None);
        }
        // Nor do faces that reach round the globe.
        let sight = sight(at, 1e5, false);
        assert!(Beyond::of(&sight, EDGE_RAD).is_some());
        assert_eq!(Beyond::of(&sight, 3.0), None);
    }

    /// Over flat ground little is near enough; what is right below the eye is.
    #[test]
    fn rounding_holds_nothing_below_the_eye() {
        let ellipsoid = Ellipsoid::WGS84;
        for step in 0..2_000 {
            let turn = f64::from(step);
            let at = LonLat::new(180.0 * turn.sin(), 89.0 * (1.7 * turn).cos());
            let mut sight = sight(at, 0.5, false);
            sight.surface_m = (0.0, 0.0);
            sight.extrusion.bottom_m = 0.0;
            let sight = sight.with_horizon().flat_beyond(1e-9);
            let beyond = sight.beyond.expect("the eye is above");
            for bearing in [0.0, 2.0, 4.0] {
                let near = ahead(at, bearing, 1e-3);
                assert!(!beyond.holds_point(ellipsoid.ecef(near, 0.0)), "{at:?}");
            }
        }
    }

    #[test]
    fn bounds_are_held_if_their_points_are() {
        let ellipsoid = Ellipsoid::WGS84;
        let sight = sight(LonLat::new(100.0, 5.0), 3e5, false);
        let beyond = Beyond::of(&sight, EDGE_RAD).expect("the eye is above");
        let (mut all, mut none) = (0, 0);
        for step in 0..4_000 {
            let turn = f64::from(step);
            let middle = LonLat::new(100.0 + 60.0 * turn.sin(), 5.0 + 60.0 * (1.7 * turn).cos());
            let points = [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)].map(|(x, y)| {
                ellipsoid.ecef(LonLat::new(middle.lon_deg + x, middle.lat_deg + y), 0.0)
            });
            let bounds = Bounds::around(&ellipsoid, points.iter().copied(), 1.0);
            let held = points.map(|point_m| beyond.holds_point(point_m));
            if beyond.holds_all(&bounds) {
                assert_eq!(held, [true; 4]);
                all += 1;
            }
            if !beyond.holds_some(&bounds) {
                assert_eq!(held, [false; 4]);
                none += 1;
            }
        }
        assert!(all > 100 && none > 100, "{all} wholly, {none} not at all");
    }
}
