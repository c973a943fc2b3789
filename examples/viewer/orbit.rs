//! The camera's way round the globe, in double precision: what is grabbed stays under the pointer.

use glam::{DMat3, DQuat, DVec2, DVec3};
use globefill::{Ellipsoid, LonLat};

use crate::host::camera::Viewpoint;

/// Heights that the camera stays within, metres: from eye level to the Moon.
const HEIGHTS_M: std::ops::RangeInclusive<f64> = 1.0..=4e8;
/// The camera never looks closer to the horizon than this.
const HIGHEST_PITCH_DEG: f64 = -1.0;
/// It stays this far away from the poles, where north is no direction.
const MOST_LAT_DEG: f64 = 89.9;
/// Part of its speed that the globe loses each second after it was let go, as a rate.
const FRICTION_PER_S: f64 = 3.5;

/// A lens: half the picture's width and height at distance 1 along the view axis, and its size in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picture {
    pub half_extent: DVec2,
    pub size_px: DVec2,
}

impl Picture {
    /// As many pixels, `fov_deg` from its upper to its lower edge.
    pub fn new(size_px: DVec2, fov_deg: f64) -> Self {
        let half_height = (0.5 * fov_deg.to_radians()).tan();
        Self {
            half_extent: DVec2::new(half_height * size_px.x / size_px.y, half_height),
            size_px,
        }
    }
}

/// A camera that a hand moves.
#[derive(Clone, Debug)]
pub struct Orbit {
    pub viewpoint: Viewpoint,
    ellipsoid: Ellipsoid,
    /// What the hand holds, ECEF.
    grabbed_m: Option<DVec3>,
    /// How fast the foot moves east and north, degrees a second.
    drift_deg_s: DVec2,
}

impl Orbit {
    pub fn new(viewpoint: Viewpoint) -> Self {
        Self {
            viewpoint,
            ellipsoid: Ellipsoid::WGS84,
            grabbed_m: None,
            drift_deg_s: DVec2::ZERO,
        }
    }

    /// Where the line of sight through a point of the picture meets the ellipsoid, ECEF metres.
    pub fn ground_at(&self, picture: &Picture, at_px: DVec2) -> Option<DVec3> {
        let eye_m = self.eye_m();
        let ndc = DVec2::new(2.0, -2.0) * at_px / picture.size_px + DVec2::new(-1.0, 1.0);
        let view = (ndc * picture.half_extent).extend(-1.0);
        first_hit(&self.ellipsoid, eye_m, self.ecef_from_view() * view)
    }

    /// Where a point of the ground is seen, pixels; none behind the camera or the horizon.
    pub fn pixel_of(&self, picture: &Picture, point_m: DVec3) -> Option<DVec2> {
        let eye_m = self.eye_m();
        let radii_m = self.ellipsoid.radii_m();
        let (eye, point) = (eye_m / radii_m, point_m / radii_m);
        let view = self.ecef_from_view().transpose() * (point_m - eye_m);
        if eye.dot(point) < 1.0 || view.z >= 0.0 {
            return None;
        }
        let ndc = view.truncate() / -view.z / picture.half_extent;
        Some((ndc * DVec2::new(0.5, -0.5) + 0.5) * picture.size_px)
    }

    /// Takes hold of the ground under the pointer.
    pub fn grab(&mut self, picture: &Picture, at_px: DVec2) {
        self.grabbed_m = self.ground_at(picture, at_px);
        self.drift_deg_s = DVec2::ZERO;
    }

    /// Brings what is held under the pointer, which took so long to get there.
    pub fn drag(&mut self, picture: &Picture, to_px: DVec2, seconds: f64) {
        let Some(grabbed_m) = self.grabbed_m else {
            return;
        };
        let before = self.viewpoint.foot;
        self.bring(picture, grabbed_m, to_px);
        let after = self.viewpoint.foot;
        let east_deg = (after.lon_deg - before.lon_deg + 540.0).rem_euclid(360.0) - 180.0;
        let moved_deg = DVec2::new(east_deg, after.lat_deg - before.lat_deg);
        let rate_deg_s = moved_deg / seconds.max(1e-3);
        self.drift_deg_s = self.drift_deg_s.lerp(rate_deg_s, 0.5);
    }

    /// Lets go; the globe drifts on.
    pub fn release(&mut self) {
        self.grabbed_m = None;
    }

    /// Stops at once.
    pub fn stop(&mut self) {
        self.grabbed_m = None;
        self.drift_deg_s = DVec2::ZERO;
    }

    /// Whether it moves without a hand.
    pub fn is_drifting(&self) -> bool {
        // A thousandth of the height a second is hardly seen.
        let slowest_deg_s = (1e-3 * self.viewpoint.height_m / self.ellipsoid.a_m).to_degrees();
        self.grabbed_m.is_none() && self.drift_deg_s.length() > slowest_deg_s
    }

    /// Drifts for so long.
    pub fn advance(&mut self, seconds: f64) {
        if !self.is_drifting() {
            return;
        }
        let slowed = (-FRICTION_PER_S * seconds).exp();
        let way_deg = self.drift_deg_s * (1.0 - slowed) / FRICTION_PER_S;
        self.drift_deg_s *= slowed;
        let foot = self.viewpoint.foot;
        self.stand(LonLat::new(
            foot.lon_deg + way_deg.x,
            foot.lat_deg + way_deg.y,
        ));
    }

    /// Multiplies the height; what is under the pointer stays there.
    pub fn zoom(&mut self, picture: &Picture, factor: f64, at_px: DVec2) {
        let held_m = self.ground_at(picture, at_px);
        let height_m = self.viewpoint.height_m * factor;
        self.viewpoint.height_m = height_m.clamp(*HEIGHTS_M.start(), *HEIGHTS_M.end());
        if let Some(held_m) = held_m {
            self.bring(picture, held_m, at_px);
        }
        self.drift_deg_s = DVec2::ZERO;
    }

    /// Turns round the ground in the middle of the picture, and tilts.
    pub fn tilt(&mut self, picture: &Picture, turn_deg: f64, rise_deg: f64) {
        self.drift_deg_s = DVec2::ZERO;
        let Some(pivot_m) = self.ground_at(picture, 0.5 * picture.size_px) else {
            // Nothing to turn round: look up or down.
            let pitch_deg = self.viewpoint.pitch_deg + rise_deg;
            self.viewpoint.pitch_deg = pitch_deg.clamp(-90.0, HIGHEST_PITCH_DEG);
            self.viewpoint.heading_deg = turned(self.viewpoint.heading_deg, turn_deg);
            return;
        };
        let distance_m = pivot_m.distance(self.eye_m());
        let axes = self.axes_at(self.ellipsoid.geodetic(pivot_m).0);
        let (heading_deg, pitch_deg) = self.aim_in(axes, self.forward());
        let pitch_deg = (pitch_deg + rise_deg).clamp(-89.999, HIGHEST_PITCH_DEG);
        let forward = axes * direction(turned(heading_deg, turn_deg), pitch_deg);
        let (foot, height_m) = self.ellipsoid.geodetic(pivot_m - distance_m * forward);
        let (heading_deg, pitch_deg) = self.aim_in(self.axes_at(foot), forward);
        self.viewpoint = Viewpoint {
            foot,
            height_m: height_m.clamp(*HEIGHTS_M.start(), *HEIGHTS_M.end()),
            heading_deg,
            pitch_deg,
        };
    }

    /// Moves by parts of the picture's height, to the right and up.
    pub fn pan(&mut self, picture: &Picture, parts: DVec2) {
        let middle_px = 0.5 * picture.size_px;
        if let Some(middle_m) = self.ground_at(picture, middle_px) {
            let by_px = DVec2::new(-parts.x, parts.y) * picture.size_px.y;
            self.bring(picture, middle_m, middle_px + by_px);
        }
        self.drift_deg_s = DVec2::ZERO;
    }

    /// Turns north up, looking straight down on what is in the middle.
    pub fn face_north(&mut self, picture: &Picture) {
        if let Some(middle_m) = self.ground_at(picture, 0.5 * picture.size_px) {
            self.viewpoint.height_m = middle_m.distance(self.eye_m());
            self.stand(self.ellipsoid.geodetic(middle_m).0);
        }
        self.viewpoint.heading_deg = 0.0;
        self.viewpoint.pitch_deg = -90.0;
        self.stop();
    }

    /// Moves the foot until a point of the ground is seen at a pixel, heading and height kept.
    fn bring(&mut self, picture: &Picture, point_m: DVec3, to_px: DVec2) {
        // Turning the globe by the angle between both points does it up to the change of direction of
        // north; what that leaves shrinks with each round.
        for _ in 0..30 {
            let Some(seen_m) = self.ground_at(picture, to_px) else {
                return;
            };
            let turn = turn_between(seen_m.normalize(), point_m.normalize());
            self.stand(self.ellipsoid.geodetic(turn * self.eye_m()).0);
            if seen_m.distance(point_m) < 1e-9 * self.viewpoint.height_m {
                return;
            }
        }
    }

    fn stand(&mut self, foot: LonLat) {
        let lon_deg = (foot.lon_deg + 540.0).rem_euclid(360.0) - 180.0;
        let lat_deg = foot.lat_deg.clamp(-MOST_LAT_DEG, MOST_LAT_DEG);
        self.viewpoint.foot = LonLat::new(lon_deg, lat_deg);
    }

    fn eye_m(&self) -> DVec3 {
        let viewpoint = &self.viewpoint;
        self.ellipsoid.ecef(viewpoint.foot, viewpoint.height_m)
    }

    /// East, north and up.
    fn axes_at(&self, foot: LonLat) -> DMat3 {
        let up = self.ellipsoid.normal(foot);
        let (sin_lon, cos_lon) = foot.lon_deg.to_radians().sin_cos();
        let east = DVec3::new(-sin_lon, cos_lon, 0.0);
        DMat3::from_cols(east, up.cross(east), up)
    }

    fn forward(&self) -> DVec3 {
        let viewpoint = &self.viewpoint;
        self.axes_at(viewpoint.foot) * direction(viewpoint.heading_deg, viewpoint.pitch_deg)
    }

    /// Heading and pitch of a direction; straight down, the heading is the camera's.
    fn aim_in(&self, axes: DMat3, forward: DVec3) -> (f64, f64) {
        let local = axes.transpose() * forward;
        let heading_deg = if local.truncate().length() > 1e-6 {
            local.x.atan2(local.y).to_degrees()
        } else {
            self.viewpoint.heading_deg
        };
        (heading_deg, local.z.clamp(-1.0, 1.0).asin().to_degrees())
    }

    fn ecef_from_view(&self) -> DMat3 {
        let viewpoint = &self.viewpoint;
        let axes = self.axes_at(viewpoint.foot);
        let right = axes * direction(viewpoint.heading_deg + 90.0, 0.0);
        let forward = self.forward();
        DMat3::from_cols(right, right.cross(forward), -forward)
    }
}

/// The shortest turn from one direction to another. glam's own takes small ones for none.
fn turn_between(from: DVec3, to: DVec3) -> DQuat {
    let axis = from.cross(to);
    let angle_rad = axis.length().atan2(from.dot(to));
    DQuat::from_scaled_axis(axis.normalize_or_zero() * angle_rad)
}

fn turned(heading_deg: f64, by_deg: f64) -> f64 {
    (heading_deg + by_deg).rem_euclid(360.0)
}

/// East, north and up parts of a direction.
fn direction(heading_deg: f64, pitch_deg: f64) -> DVec3 {
    let (sin_heading, cos_heading) = heading_deg.to_radians().sin_cos();
    let (sin_pitch, cos_pitch) = pitch_deg.to_radians().sin_cos();
    DVec3::new(sin_heading * cos_pitch, cos_heading * cos_pitch, sin_pitch)
}

/// Where a ray enters the ellipsoid, in coordinates in which that is the unit sphere.
fn first_hit(ellipsoid: &Ellipsoid, from_m: DVec3, ray: DVec3) -> Option<DVec3> {
    let radii_m = ellipsoid.radii_m();
    let (from, along) = (from_m / radii_m, (ray / radii_m).normalize());
    let distance = from.length();
    let half = from.dot(along);
    // |from|² − 1 without cancellation, close to the ground.
    let outside = (distance - 1.0) * (distance + 1.0);
    let root = half * half - outside;
    if root < 0.0 || half >= 0.0 {
        return None;
    }
    // The smaller root as a quotient: it keeps its digits.
    Some((from + along * (outside / (root.sqrt() - half))) * radii_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE_PX: DVec2 = DVec2::new(1280.0, 720.0);

    fn orbits() -> impl Iterator<Item = Orbit> {
        const AIMS: [(f64, f64); 3] = [(0.0, -90.0), (40.0, -50.0), (200.0, -80.0)];
        let of_height = |height_m: f64| {
            let near = height_m < 5e6;
            let aims = AIMS.into_iter();
            aims.filter(move |&(_, pitch_deg)| near || pitch_deg == -90.0)
                .map(move |(heading_deg, pitch_deg)| {
                    Orbit::new(Viewpoint {
                        foot: LonLat::new(179.9, -37.0),
                        height_m,
                        heading_deg,
                        pitch_deg,
                    })
                })
        };
        [3.0, 1e3, 1e6, 2e7, 3e8].into_iter().flat_map(of_height)
    }

    fn picture() -> Picture {
        Picture::new(SIZE_PX, 50.0)
    }

    /// A pixel that shows the ground, beside the middle.
    fn beside(orbit: &Orbit) -> DVec2 {
        let step = if orbit.viewpoint.height_m > 1e8 {
            3.0
        } else {
            100.0
        };
        0.5 * SIZE_PX + DVec2::new(step, 0.7 * step)
    }

    #[test]
    fn what_is_seen_at_a_pixel_is_seen_there() {
        for orbit in orbits() {
            let at_px = beside(&orbit);
            let ground_m = orbit
                .ground_at(&picture(), at_px)
                .expect("it shows the ground");
            let (_, height_m) = Ellipsoid::WGS84.geodetic(ground_m);
            assert!(height_m.abs() < 1e-6, "{orbit:?}: {height_m}");
            let back_px = orbit.pixel_of(&picture(), ground_m).expect("it is seen");
            assert!(back_px.distance(at_px) < 1e-3, "{orbit:?}: {back_px}");
        }
    }

    #[test]
    fn what_is_grabbed_stays_under_the_pointer() {
        for mut orbit in orbits() {
            let from_px = 0.5 * SIZE_PX;
            let held_m = orbit
                .ground_at(&picture(), from_px)
                .expect("it shows the ground");
            orbit.grab(&picture(), from_px);
            let to_px = beside(&orbit);
            orbit.drag(&picture(), to_px, 0.016);
            let seen_px = orbit.pixel_of(&picture(), held_m).expect("it is seen");
            assert!(
                seen_px.distance(to_px) < 0.01,
                "{orbit:?}: {seen_px} {to_px}"
            );
        }
    }

    #[test]
    fn zooming_keeps_what_is_under_the_pointer() {
        for mut orbit in orbits() {
            let at_px = beside(&orbit);
            let held_m = orbit
                .ground_at(&picture(), at_px)
                .expect("it shows the ground");
            for factor in [0.9, 0.9, 1.1] {
                orbit.zoom(&picture(), factor, at_px);
                let seen_px = orbit.pixel_of(&picture(), held_m).expect("it is seen");
                assert!(seen_px.distance(at_px) < 0.01, "{orbit:?}: {seen_px}");
            }
        }
    }

    #[test]
    fn tilting_turns_round_the_middle() {
        for mut orbit in orbits() {
            let middle_px = 0.5 * SIZE_PX;
            let pivot_m = orbit
                .ground_at(&picture(), middle_px)
                .expect("it shows the ground");
            let far_m = pivot_m.distance(orbit.eye_m());
            orbit.tilt(&picture(), 25.0, 10.0);
            let seen_px = orbit.pixel_of(&picture(), pivot_m).expect("it is seen");
            assert!(seen_px.distance(middle_px) < 0.05, "{orbit:?}: {seen_px}");
            assert!((pivot_m.distance(orbit.eye_m()) / far_m - 1.0).abs() < 0.3);
        }
    }

    #[test]
    fn it_drifts_on_and_comes_to_rest() {
        let mut orbit = orbits().next().expect("there is one");
        orbit.viewpoint.height_m = 1e6;
        orbit.grab(&picture(), 0.5 * SIZE_PX);
        orbit.drag(&picture(), beside(&orbit), 0.016);
        orbit.release();
        let start = orbit.viewpoint.foot;
        assert!(orbit.is_drifting());
        for _ in 0..1000 {
            orbit.advance(0.016);
        }
        assert!(!orbit.is_drifting() && orbit.viewpoint.foot != start);
    }

    #[test]
    fn heights_and_poles_are_not_crossed() {
        let mut orbit = Orbit::new(Viewpoint {
            foot: LonLat::new(0.0, 89.0),
            height_m: 1e6,
            heading_deg: 0.0,
            pitch_deg: -90.0,
        });
        for _ in 0..50 {
            orbit.pan(&picture(), DVec2::new(0.0, 0.3));
        }
        assert!(orbit.viewpoint.foot.lat_deg <= MOST_LAT_DEG);
        orbit.zoom(&picture(), 1e-9, 0.5 * SIZE_PX);
        assert_eq!(orbit.viewpoint.height_m, 1.0);
        orbit.zoom(&picture(), 1e12, 0.5 * SIZE_PX);
        assert_eq!(orbit.viewpoint.height_m, 4e8);
    }
}
