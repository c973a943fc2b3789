//! The camera: it looks at a focus on the ground, from a distance.
//!
//! Everything is double precision, and dragging solves for the focus that keeps a ground point under the
//! pointer, so a step of the pointer is the same number of pixels at 1 m as from beyond GEO.

use glam::{DVec2, DVec3, UVec2};
use globefill::{DepthConvention, Ellipsoid, LonLat};

use crate::host::{
    camera::{Eye, Shot, Viewpoint},
    elevation::Elevation,
};

pub const NEAREST_M: f64 = 1.0;
/// The Moon's distance; geostationary orbit is at a tenth of it.
pub const FARTHEST_M: f64 = 4e8;
const FOV_DEG: f64 = 45.0;
/// Beyond it the horizon fills the picture and dragging makes no sense.
const MOST_TILT_DEG: f64 = 85.0;
/// The focus stays off the poles, where heading is undefined.
const MOST_LAT_DEG: f64 = 89.999;
/// Time in which the pace of a let-go globe falls to 1/e.
const GLIDE_S: f64 = 0.3;
/// Time in which all but 1/e of a wanted zoom is done.
const ZOOM_S: f64 = 0.08;
/// Slower than this part of the picture's height per second is standing still.
const STILL_PER_S: f64 = 2e-3;

/// Where the camera is and how it moves.
#[derive(Clone, Debug)]
pub struct Orbit {
    pub focus: LonLat,
    /// Height of the ground at the focus.
    pub ground_m: f64,
    /// From the focus to the eye.
    pub distance_m: f64,
    /// Clockwise from north.
    pub heading_deg: f64,
    /// 0 looks straight down.
    pub tilt_deg: f64,
    pub size_px: UVec2,
    /// Degrees of longitude and latitude per second, while gliding.
    glide_deg_s: DVec2,
    /// Logarithm of the distance that is still to be gone.
    zoom_left: f64,
    zoom_at_px: DVec2,
}

impl Orbit {
    pub fn new(size_px: UVec2) -> Self {
        Self {
            focus: LonLat::new(14.0, 26.0),
            ground_m: 0.0,
            distance_m: 1.75e7,
            heading_deg: 0.0,
            tilt_deg: 0.0,
            size_px,
            glide_deg_s: DVec2::ZERO,
            zoom_left: 0.0,
            zoom_at_px: size_px.as_dvec2() / 2.0,
        }
    }

    /// The eye as a viewpoint above the ellipsoid.
    pub fn viewpoint(&self) -> Viewpoint {
        let [east, north, up] = axes(self.focus);
        let (sin_heading, cos_heading) = self.heading_deg.to_radians().sin_cos();
        let (sin_tilt, cos_tilt) = self.tilt_deg.to_radians().sin_cos();
        let level = sin_heading * east + cos_heading * north;
        let right = cos_heading * east - sin_heading * north;
        let forward = sin_tilt * level - cos_tilt * up;
        let focus_m = Ellipsoid::WGS84.ecef(self.focus, self.ground_m);
        let (foot, height_m) = Ellipsoid::WGS84.geodetic(focus_m - self.distance_m * forward);
        let [east, north, up] = axes(foot);
        let level_part = DVec2::new(forward.dot(east), forward.dot(north)).length();
        Viewpoint {
            foot,
            height_m,
            heading_deg: (-right.dot(north)).atan2(right.dot(east)).to_degrees(),
            pitch_deg: forward.dot(up).atan2(level_part).to_degrees(),
        }
    }

    /// Stands where a viewpoint does; looking above the horizon becomes looking nearly along it.
    pub fn stand_at(&mut self, viewpoint: &Viewpoint) {
        self.stop();
        self.focus = viewpoint.foot;
        self.distance_m = viewpoint.height_m.clamp(NEAREST_M, FARTHEST_M);
        self.heading_deg = viewpoint.heading_deg;
        self.tilt_deg = 0.0;
        let tilt_deg = viewpoint.pitch_deg + 90.0;
        if tilt_deg <= 0.0 {
            return;
        }
        // The focus is where the view axis meets the ground, if it does.
        let shot = self.shot();
        let eye = Eye::above(&Ellipsoid::WGS84, None, viewpoint, shot);
        let axis = eye.camera.view_from_ecef.transpose() * DVec3::NEG_Z;
        if let Some(hit_m) = meet(eye.camera.eye_ecef_m, axis, self.ground_m) {
            self.focus = Ellipsoid::WGS84.geodetic(hit_m).0;
            self.distance_m = hit_m.distance(eye.camera.eye_ecef_m);
            let [east, north, up] = axes(self.focus);
            self.tilt_deg = (-axis.dot(up)).clamp(-1.0, 1.0).acos().to_degrees();
            self.heading_deg = axis.dot(east).atan2(axis.dot(north)).to_degrees();
        } else {
            self.tilt_deg = MOST_TILT_DEG;
        }
        self.tilt_deg = self.tilt_deg.min(MOST_TILT_DEG);
    }

    pub fn eye(&self, elevation: Option<&Elevation>) -> Eye {
        Eye::above(&Ellipsoid::WGS84, elevation, &self.viewpoint(), self.shot())
    }

    fn shot(&self) -> Shot {
        Shot {
            fov_deg: FOV_DEG,
            size_px: self.size_px,
            depth: DepthConvention::Reversed,
        }
    }

    /// The ground point under a pixel position, if it is on the globe.
    pub fn ground_at(&self, px: DVec2) -> Option<LonLat> {
        let eye = self.eye(None);
        let ndc = 2.0 * px / self.size_px.as_dvec2() - 1.0;
        let view = DVec3::new(ndc.x * eye.half_extent.x, -ndc.y * eye.half_extent.y, -1.0);
        let ray = eye.camera.view_from_ecef.transpose() * view;
        let hit_m = meet(eye.camera.eye_ecef_m, ray, self.ground_m)?;
        Some(Ellipsoid::WGS84.geodetic(hit_m).0)
    }

    /// Moves the focus until a ground point is under a pixel position; the heading stays.
    pub fn hold(&mut self, anchor: LonLat, px: DVec2) {
        let before = self.focus;
        for _ in 0..24 {
            let Some(at) = self.ground_at(px) else {
                self.focus = before;
                return;
            };
            let step = DVec2::new(
                wrap_deg(anchor.lon_deg - at.lon_deg),
                anchor.lat_deg - at.lat_deg,
            );
            self.shift(step);
            if step.abs().max_element() < 1e-13 {
                return;
            }
        }
    }

    /// Moves the focus by degrees.
    fn shift(&mut self, deg: DVec2) {
        self.focus = LonLat::new(
            wrap_deg(self.focus.lon_deg + deg.x),
            (self.focus.lat_deg + deg.y).clamp(-MOST_LAT_DEG, MOST_LAT_DEG),
        );
    }

    /// Moves over the ground by pixels, right and up in the picture.
    pub fn pan(&mut self, px: DVec2) {
        let m = px * self.metres_per_px();
        let (sin, cos) = self.heading_deg.to_radians().sin_cos();
        let east_m = cos * m.x + sin * m.y;
        let north_m = cos * m.y - sin * m.x;
        let degree_m = Ellipsoid::WGS84.a_m.to_radians();
        let shrink = self.focus.lat_deg.to_radians().cos().max(0.05);
        let deg = DVec2::new(east_m / (degree_m * shrink), north_m / degree_m);
        self.shift(deg.clamp(DVec2::splat(-60.0), DVec2::splat(60.0)));
    }

    /// Size of a pixel at the focus.
    pub fn metres_per_px(&self) -> f64 {
        2.0 * (FOV_DEG.to_radians() / 2.0).tan() * self.distance_m / f64::from(self.size_px.y)
    }

    pub fn turn(&mut self, heading_deg: f64, tilt_deg: f64) {
        self.heading_deg = wrap_deg(self.heading_deg + heading_deg);
        self.tilt_deg = (self.tilt_deg + tilt_deg).clamp(0.0, MOST_TILT_DEG);
    }

    /// Asks for a zoom about a pixel position, which [`advance`](Self::advance) carries out: steps > 0 go nearer.
    pub fn zoom(&mut self, steps: f64, px: DVec2) {
        self.zoom_left -= 0.25 * steps;
        self.zoom_at_px = px;
    }

    /// Zooms at once; the ground under the pixel position stays there.
    pub fn zoom_now(&mut self, logarithm: f64, px: DVec2) {
        let anchor = self.ground_at(px);
        self.distance_m = (self.distance_m * logarithm.exp()).clamp(NEAREST_M, FARTHEST_M);
        if let Some(anchor) = anchor {
            self.hold(anchor, px);
        }
    }

    /// Lets go of the globe, which turns on at the pace of its last step.
    pub fn let_go(&mut self, from: LonLat, seconds: f64) {
        let moved = DVec2::new(
            wrap_deg(self.focus.lon_deg - from.lon_deg),
            self.focus.lat_deg - from.lat_deg,
        );
        self.glide_deg_s = if seconds > 0.0 {
            moved / seconds
        } else {
            DVec2::ZERO
        };
    }

    pub fn stop(&mut self) {
        self.glide_deg_s = DVec2::ZERO;
        self.zoom_left = 0.0;
    }

    /// Glides and zooms on; false once all stands still.
    pub fn advance(&mut self, seconds: f64) -> bool {
        if self.zoom_left != 0.0 {
            let part = 1.0 - (-seconds / ZOOM_S).exp();
            let mut step = self.zoom_left * part;
            if self.zoom_left.abs() < 1e-3 {
                step = self.zoom_left;
            }
            self.zoom_left -= step;
            self.zoom_now(step, self.zoom_at_px);
        }
        if self.glide_deg_s != DVec2::ZERO {
            self.shift(self.glide_deg_s * GLIDE_S * (1.0 - (-seconds / GLIDE_S).exp()));
            self.glide_deg_s *= (-seconds / GLIDE_S).exp();
            let m_per_s = self.glide_deg_s.length() * Ellipsoid::WGS84.a_m.to_radians();
            if m_per_s < STILL_PER_S * f64::from(self.size_px.y) * self.metres_per_px() {
                self.glide_deg_s = DVec2::ZERO;
            }
        }
        self.is_moving()
    }

    pub fn is_moving(&self) -> bool {
        self.zoom_left != 0.0 || self.glide_deg_s != DVec2::ZERO
    }
}

/// Where a ray first meets the ground that lies so high everywhere.
fn meet(eye_m: DVec3, ray: DVec3, ground_m: f64) -> Option<DVec3> {
    let radii_m = Ellipsoid::WGS84.radii_m() + ground_m;
    let (from, along) = (eye_m / radii_m, ray / radii_m);
    let toward = -from.dot(along);
    let over = (from.length() - 1.0) * (from.length() + 1.0);
    // The discriminant by the cross product, which does not cancel near the ground.
    let discriminant = along.length_squared() - from.cross(along).length_squared();
    (toward > 0.0 && over > 0.0 && discriminant >= 0.0)
        .then(|| eye_m + ray * (over / (toward + discriminant.sqrt())))
}

/// East, north and up.
pub fn axes(at: LonLat) -> [DVec3; 3] {
    let (sin_lon, cos_lon) = at.lon_deg.to_radians().sin_cos();
    let (sin_lat, cos_lat) = at.lat_deg.to_radians().sin_cos();
    [
        DVec3::new(-sin_lon, cos_lon, 0.0),
        DVec3::new(-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat),
        DVec3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat),
    ]
}

fn wrap_deg(deg: f64) -> f64 {
    deg - 360.0 * (deg / 360.0).round()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn orbit(distance_m: f64, tilt_deg: f64, heading_deg: f64) -> Orbit {
        Orbit {
            focus: LonLat::new(10.0, 47.0),
            distance_m,
            tilt_deg,
            heading_deg,
            ..Orbit::new(UVec2::new(1280, 720))
        }
    }

    /// Where a ground point is in the picture, by the matrices that it is drawn with.
    fn projected_px(orbit: &Orbit, ground: LonLat) -> DVec2 {
        let eye = orbit.eye(None);
        let relative_m = Ellipsoid::WGS84.ecef(ground, 0.0) - eye.camera.eye_ecef_m;
        let view = eye.camera.view_from_ecef * relative_m;
        let clip = eye.camera.clip_from_view * view.extend(1.0);
        (DVec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * orbit.size_px.as_dvec2()
    }

    #[test]
    fn a_dragged_point_stays_under_the_pointer_from_1_m_to_the_moon() {
        for distance_m in [1.0, 10.0, 1e3, 1e5, 3e6, 2e7, 4.2e7, 4e8] {
            for (tilt_deg, heading_deg) in [(0.0, 0.0), (30.0, 75.0)] {
                let mut orbit = orbit(distance_m, tilt_deg, heading_deg);
                // The whole globe is 28 px wide from the Moon: a longer drag would leave it.
                let drag_px = if distance_m > 1e8 { 2.0 } else { 7.0 };
                let from = DVec2::new(641.0, 362.0);
                let to = from + DVec2::new(drag_px, -drag_px);
                assert!(orbit.ground_at(to).is_some(), "{to} is off the globe");
                let anchor = orbit.ground_at(from).unwrap();
                assert!((projected_px(&orbit, anchor) - from).length() < 0.01);
                orbit.hold(anchor, to);
                let off_px = (projected_px(&orbit, anchor) - to).length();
                assert!(
                    off_px < 0.02,
                    "{distance_m} m, tilt {tilt_deg}: {off_px} px"
                );
            }
        }
    }

    #[test]
    fn zoom_keeps_the_ground_under_the_pointer() {
        let mut orbit = orbit(2e7, 0.0, 0.0);
        let px = DVec2::new(700.0, 300.0);
        let anchor = orbit.ground_at(px).unwrap();
        orbit.zoom(40.0, px);
        while orbit.advance(0.016) {}
        assert!((orbit.distance_m / (2e7 * (-10.0_f64).exp()) - 1.0).abs() < 1e-9);
        let off_px = (projected_px(&orbit, anchor) - px).length();
        assert!(off_px < 0.05, "{off_px} px");
    }

    #[test]
    fn standing_at_a_viewpoint_gives_it_back() {
        let wanted: Viewpoint = "10.4,51.2,900000,20,-60".parse().unwrap();
        let mut orbit = orbit(1e6, 0.0, 0.0);
        orbit.stand_at(&wanted);
        let got = orbit.viewpoint();
        assert!((got.height_m - wanted.height_m).abs() < 1.0, "{got:?}");
        assert!(
            (got.foot.lat_deg - wanted.foot.lat_deg).abs() < 1e-3,
            "{got:?}"
        );
        assert!((got.pitch_deg - wanted.pitch_deg).abs() < 0.1, "{got:?}");
        assert!(
            (got.heading_deg - wanted.heading_deg).abs() < 0.2,
            "{got:?}"
        );
    }

    #[test]
    fn gliding_ends() {
        let mut orbit = orbit(1e6, 0.0, 0.0);
        orbit.let_go(LonLat::new(9.9, 47.0), 0.016);
        let steps = (0..1000).take_while(|_| orbit.advance(0.016)).count();
        assert!((1..999).contains(&steps), "{steps}");
    }
}
