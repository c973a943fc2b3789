//! Where patterns lie: in f64 once, and for every eye as the differences that map.wgsl continues from.

use glam::{DVec2, DVec3};

use crate::{
    ellipsoid::Ellipsoid, extents::Extents, frame::reference::Reference, geodetic::LonLat,
};

/// Where a pattern lies, whatever the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PatternPlace {
    /// On the map about an anchor.
    Map(MapPlace),
    /// On longitudes and latitudes.
    Angles(AnglePlace),
}

/// A pattern on the ellipsoid seen from the antipode −A of an anchor A, on A's tangent plane.
///
/// The ray from −A through F meets that plane at X − A = −2A + s (F + A), s = 2 A·N / ((F + A)·N), with
/// N the normal at A. Along a tangent e that is ((F + A)·e − 2 A·e D) / D with the nearness
/// D = (F + A)·N / (2 A·N): a quotient of linear functions, 1 : 1 at A.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MapPlace {
    anchor_ecef_m: DVec3,
    normal: DVec3,
    /// Tangents along u and v, divided by the metres that a unit takes.
    u_per_m: DVec3,
    v_per_m: DVec3,
    /// u and v at the anchor.
    at_anchor: DVec2,
    repeats: bool,
}

/// A picture across longitudes and down latitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AnglePlace {
    middle_lon_rad: f64,
    /// Geodetic or geocentric, as `stretch` says.
    middle_lat_rad: f64,
    /// The latitude of a foot point is the angle of its distance from the axis and of z times this.
    stretch: f64,
    /// How much u, and v, change with longitude and with latitude, per radian.
    u_per_rad: DVec2,
    v_per_rad: DVec2,
}

/// `Placed` of style.wgsl; see there.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct Placed {
    pub u: [f32; 4],
    pub v: [f32; 4],
    pub fall: [f32; 4],
    pub phase: [u32; 4],
}

impl PatternPlace {
    pub(crate) fn seen_from(&self, reference: &Reference) -> Placed {
        match self {
            Self::Map(place) => place.seen_from(reference),
            Self::Angles(place) => place.seen_from(reference),
        }
    }
}

impl MapPlace {
    /// A pattern that repeats, with a line or dot on the anchor; `unit_m` are the metres that u and v
    /// count there. v runs `turned_rad` clockwise from north, u to the right of it.
    pub(crate) fn repeating(
        ellipsoid: &Ellipsoid,
        anchor: LonLat,
        turned_rad: f64,
        unit_m: DVec2,
    ) -> Self {
        Self::new(ellipsoid, anchor, turned_rad, unit_m, true)
    }

    /// A picture of `size_m` about `center`, with u to the right and v down.
    pub(crate) fn picture(
        ellipsoid: &Ellipsoid,
        center: LonLat,
        turned_rad: f64,
        size_m: DVec2,
    ) -> Self {
        let up = Self::new(ellipsoid, center, turned_rad, size_m, false);
        Self {
            v_per_m: -up.v_per_m,
            at_anchor: DVec2::splat(0.5),
            ..up
        }
    }

    fn new(
        ellipsoid: &Ellipsoid,
        anchor: LonLat,
        turned_rad: f64,
        unit_m: DVec2,
        repeats: bool,
    ) -> Self {
        let normal = ellipsoid.normal(anchor);
        let (sin_lon, cos_lon) = anchor.lon_deg.to_radians().sin_cos();
        let east = DVec3::new(-sin_lon, cos_lon, 0.0);
        let north = normal.cross(east);
        let (sin, cos) = turned_rad.sin_cos();
        Self {
            anchor_ecef_m: ellipsoid.ecef(anchor, 0.0),
            normal,
            u_per_m: (east * cos - north * sin) / unit_m.x,
            v_per_m: (north * cos + east * sin) / unit_m.y,
            at_anchor: DVec2::ZERO,
            repeats,
        }
    }

    fn seen_from(&self, reference: &Reference) -> Placed {
        let foot_m = reference.foot_ecef_m;
        let lifted_m = self.anchor_ecef_m.dot(self.normal);
        let fall_per_m = self.normal / (2.0 * lifted_m);
        // At the antipode there is no map; the eye's foot may lie there while nothing of it is seen.
        let nearness = (foot_m + self.anchor_ecef_m).dot(fall_per_m).max(1e-9);
        let axis = |per_m: DVec3| {
            let leaning = self.anchor_ecef_m.dot(per_m);
            let from_anchor =
                ((foot_m + self.anchor_ecef_m).dot(per_m) - 2.0 * leaning * nearness) / nearness;
            let gradient = per_m - (from_anchor + 2.0 * leaning) * fall_per_m;
            (from_anchor, gradient)
        };
        let (u, u_gradient) = axis(self.u_per_m);
        let (v, v_gradient) = axis(self.v_per_m);
        let [u_whole, u_fraction] = fixed(u + self.at_anchor.x, self.repeats);
        let [v_whole, v_fraction] = fixed(v + self.at_anchor.y, self.repeats);
        Placed {
            u: padded(u_gradient, nearness),
            v: padded(v_gradient, 0.0),
            fall: padded(fall_per_m, 0.0),
            phase: [u_whole, u_fraction, v_whole, v_fraction],
        }
    }
}

impl AnglePlace {
    /// A picture over `extents`, `repeats` times across and down, turned clockwise about their middle;
    /// on geocentric latitudes if `spherical`.
    pub(crate) fn new(
        ellipsoid: &Ellipsoid,
        extents: Extents,
        spherical: bool,
        turned_rad: f64,
        repeats: DVec2,
    ) -> Self {
        let ratio_squared = (ellipsoid.a_m / ellipsoid.b_m).powi(2);
        let latitude_rad = |lat_deg: f64| {
            let (sin, cos) = lat_deg.to_radians().sin_cos();
            if spherical {
                sin.atan2(ratio_squared * cos)
            } else {
                lat_deg.to_radians()
            }
        };
        let [south_rad, north_rad] = [extents.south_deg, extents.north_deg].map(latitude_rad);
        let width_rad = extents.width_deg().to_radians();
        let height_rad = north_rad - south_rad;
        let (sin, cos) = turned_rad.sin_cos();
        Self {
            middle_lon_rad: extents.west_deg.to_radians() + 0.5 * width_rad,
            middle_lat_rad: 0.5 * (south_rad + north_rad),
            stretch: if spherical { 1.0 } else { ratio_squared },
            // Turned in the frame of the extents: a quarter turn exchanges width and height.
            u_per_rad: DVec2::new(cos / width_rad, -sin / height_rad) * repeats.x,
            v_per_rad: DVec2::new(-sin / width_rad, -cos / height_rad) * repeats.y,
        }
    }

    fn seen_from(&self, reference: &Reference) -> Placed {
        let foot = reference.foot_ecef_m;
        let lat_rad = (foot.z * self.stretch).atan2(foot.x.hypot(foot.y));
        let turn = std::f64::consts::TAU;
        // At a pole zeros may be negative; map.wgsl takes the longitude for 0.
        let foot_lon_rad = if foot.x == 0.0 && foot.y == 0.0 {
            0.0
        } else {
            foot.y.atan2(foot.x)
        };
        let turned_rad = foot_lon_rad - self.middle_lon_rad;
        let lon_rad = turned_rad - turn * (turned_rad / turn).round();
        let [whole, fraction] = fixed(0.5, false);
        Placed {
            u: [lon_rad, lat_rad - self.middle_lat_rad, self.stretch, 1.0].map(|part| part as f32),
            v: [
                self.u_per_rad.x,
                self.u_per_rad.y,
                self.v_per_rad.x,
                self.v_per_rad.y,
            ]
            .map(|part| part as f32),
            fall: [0.0, 0.0, 0.0, 1.0],
            phase: [whole, fraction, whole, fraction],
        }
    }
}

/// Whole and fraction of a coordinate, in steps of 2⁻³², two's complement. Coordinates that repeat are
/// taken modulo 2³², others end there.
fn fixed(coordinate: f64, repeats: bool) -> [u32; 2] {
    let whole = coordinate.floor();
    // A fraction that rounds to 1 is the greatest there is.
    let fraction = ((coordinate - whole) * 2f64.powi(32)) as u32;
    let whole = if repeats {
        whole.rem_euclid(2f64.powi(32)) as u32
    } else {
        (whole as i32) as u32
    };
    [whole, fraction]
}

fn padded(vector: DVec3, last: f64) -> [f32; 4] {
    vector.extend(last).as_vec4().to_array()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WGS84: Ellipsoid = Ellipsoid::WGS84;

    /// Coordinates in f64, as the shader forms them.
    fn coordinates(placed: &Placed, from_foot_m: DVec3) -> DVec2 {
        let vector = |[x, y, z, _]: [f32; 4]| glam::Vec3::new(x, y, z).as_dvec3();
        let nearness = f64::from(placed.u[3]) + vector(placed.fall).dot(from_foot_m);
        let fixed = |whole: u32, fraction: u32| {
            f64::from(whole as i32) + f64::from(fraction) * 2f64.powi(-32)
        };
        let [u_whole, u_fraction, v_whole, v_fraction] = placed.phase;
        DVec2::new(
            fixed(u_whole, u_fraction) + vector(placed.u).dot(from_foot_m) / nearness,
            fixed(v_whole, v_fraction) + vector(placed.v).dot(from_foot_m) / nearness,
        )
    }

    #[test]
    fn the_map_is_true_at_its_anchor_and_one_from_every_eye() {
        let anchor = LonLat::new(8.0, 47.0);
        let place = MapPlace::repeating(&WGS84, anchor, 0.3, DVec2::new(1.0, 2.0));
        let at = |position: LonLat| WGS84.ecef(position, 0.0);
        let near = WGS84.ecef(LonLat::new(8.001, 47.0005), 0.0);
        let seen = |eye: LonLat, point: DVec3| {
            let reference = Reference::new(WGS84, WGS84.ecef(eye, 1000.0));
            coordinates(&place.seen_from(&reference), point - reference.foot_ecef_m)
        };
        let there = seen(anchor, at(anchor));
        assert!(there.length() < 1e-6, "{there}");
        // 75.9 m east and 55.6 m north, turned by 0.3 rad; v counts two metres.
        let way = near - at(anchor);
        let east = DVec3::Z.cross(WGS84.normal(anchor)).normalize();
        let north = WGS84.normal(anchor).cross(east);
        let (e, n) = (way.dot(east), way.dot(north));
        let (sin, cos) = 0.3_f64.sin_cos();
        let expected = DVec2::new(e * cos - n * sin, (e * sin + n * cos) / 2.0);
        let there = seen(LonLat::new(9.0, 46.0), near);
        // The far eye's gradients are rounded to single precision.
        assert!((there - expected).length() < 0.02, "{there} {expected}");
        let far = at(LonLat::new(-120.0, -20.0));
        let one = seen(LonLat::new(-119.0, -20.0), far);
        let other = seen(LonLat::new(-120.0, -21.0), far);
        assert!((one - other).length() < 0.1, "{one} {other}");
    }

    #[test]
    fn whole_and_fraction_wrap_where_patterns_repeat() {
        assert_eq!(fixed(-0.25, true), [u32::MAX, 3 << 30]);
        assert_eq!(fixed(2f64.powi(32) + 1.5, true), [1, 1 << 31]);
        assert_eq!(fixed(-0.25, false), [-1_i32 as u32, 3 << 30]);
        assert_eq!(fixed(1e30, false), [i32::MAX as u32, 0]);
        assert_eq!(fixed(1.0 - 1e-17, false)[0], 1);
    }

    #[test]
    fn extents_span_the_picture_across_the_antimeridian() {
        let extents = Extents {
            west_deg: 170.0,
            south_deg: -20.0,
            east_deg: -170.0,
            north_deg: -10.0,
        };
        let place = AnglePlace::new(&WGS84, extents, false, 0.0, DVec2::ONE);
        let eye = |lon_deg, lat_deg| {
            let eye_m = WGS84.ecef(LonLat::new(lon_deg, lat_deg), 10.0);
            let placed = place.seen_from(&Reference::new(WGS84, eye_m));
            let [lon, lat, ..] = placed.u.map(f64::from);
            let [a, b, c, d] = placed.v.map(f64::from);
            DVec2::new(0.5 + a * lon + b * lat, 0.5 + c * lon + d * lat)
        };
        let expected = [
            (170.0, -10.0, DVec2::ZERO),
            (-170.0, -20.0, DVec2::ONE),
            (180.0, -15.0, DVec2::splat(0.5)),
        ];
        for (lon_deg, lat_deg, uv) in expected {
            assert!((eye(lon_deg, lat_deg) - uv).length() < 1e-6);
        }
    }
}
