//! Fingers on the globe: one drags it as a pointer does, two carry, stretch and turn it between them.

use glam::DVec2;
use globefill::LonLat;

use crate::{
    orbit::Orbit,
    viewer::{Button, Viewer},
};

/// Fingers closer together than this say nothing of scale and direction.
const LEAST_SPAN_PX: f64 = 8.0;

#[derive(Clone, Copy, Debug)]
struct Finger {
    id: u64,
    px: DVec2,
}

/// The fingers that went down on the globe; others are somebody else's.
#[derive(Clone, Debug, Default)]
pub struct Touches {
    fingers: Vec<Finger>,
    /// The ground between two of them, which stays there.
    anchor: Option<LonLat>,
}

impl Touches {
    /// Middle of two fingers and the way from one to the other.
    fn pair(&self) -> Option<(DVec2, DVec2)> {
        match self.fingers[..] {
            [a, b] => Some((0.5 * (a.px + b.px), b.px - a.px)),
            _ => None,
        }
    }

    fn grip(&mut self, orbit: &Orbit) {
        self.anchor = self.pair().and_then(|(middle, _)| orbit.ground_at(middle));
    }
}

impl Viewer {
    pub fn finger_down(&mut self, id: u64, px: DVec2, now_s: f64) {
        self.touches.fingers.push(Finger { id, px });
        match self.touches.fingers.len() {
            1 => {
                self.point(px, now_s);
                self.press(Button::Grab, px, now_s);
            }
            _ => {
                self.cancel_drag();
                self.touches.grip(&self.orbit);
            }
        }
    }

    pub fn finger_moved(&mut self, id: u64, px: DVec2, now_s: f64) {
        let before = self.touches.pair();
        let fingers = &mut self.touches.fingers;
        let Some(finger) = fingers.iter_mut().find(|finger| finger.id == id) else {
            return;
        };
        finger.px = px;
        if fingers.len() == 1 {
            self.point(px, now_s);
        }
        let (Some((_, from)), Some((middle, to))) = (before, self.touches.pair()) else {
            return;
        };
        if from.length().min(to.length()) > LEAST_SPAN_PX {
            self.orbit
                .zoom_now((from.length() / to.length()).ln(), middle);
            // The picture turns with the fingers: the camera the other way.
            self.orbit.turn(-from.angle_to(to).to_degrees(), 0.0);
        }
        if let Some(anchor) = self.touches.anchor {
            self.orbit.hold(anchor, middle);
        }
    }

    pub fn finger_up(&mut self, id: u64, now_s: f64) {
        let fingers = &mut self.touches.fingers;
        let before = fingers.len();
        fingers.retain(|finger| finger.id != id);
        match (before, &fingers[..]) {
            (1, []) => {
                self.release(now_s);
                self.leave();
            }
            // Whichever finger stays goes on dragging; it was no tap.
            (2, &[Finger { px, .. }]) => {
                self.point(px, now_s);
                self.press(Button::Grab, px, now_s);
                self.no_click();
            }
            _ => self.touches.grip(&self.orbit),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::UVec2;

    fn viewer() -> Viewer {
        let mut viewer = Viewer::new(UVec2::new(800, 600));
        viewer.orbit.stand_at(&"10,50,1000000".parse().unwrap());
        viewer
    }

    #[test]
    fn two_fingers_keep_the_ground_between_them_and_stretch_it() {
        let mut viewer = viewer();
        let (a, b) = (DVec2::new(300.0, 250.0), DVec2::new(400.0, 250.0));
        viewer.finger_down(7, a, 0.0);
        viewer.finger_down(9, b, 0.1);
        let between = viewer.orbit.ground_at(0.5 * (a + b)).unwrap();
        let distance_m = viewer.orbit.distance_m;
        // Twice as far apart, a quarter turn clockwise, and elsewhere.
        let middle = DVec2::new(420.0, 330.0);
        for step in 1..=20 {
            let share = f64::from(step) / 20.0;
            let turn = DVec2::from_angle(share * std::f64::consts::FRAC_PI_2);
            let half = turn.rotate(DVec2::X) * 50.0 * (1.0 + share);
            let at = (0.5 * (a + b)).lerp(middle, share);
            viewer.finger_moved(7, at - half, 0.1 * f64::from(step));
            viewer.finger_moved(9, at + half, 0.1 * f64::from(step));
        }
        assert!((viewer.orbit.distance_m / distance_m - 0.5).abs() < 1e-6);
        assert!((viewer.orbit.heading_deg + 90.0).abs() < 1e-6);
        let at = viewer.orbit.ground_at(middle).unwrap();
        let off_deg = (at.lon_deg - between.lon_deg).hypot(at.lat_deg - between.lat_deg);
        assert!(off_deg < 1e-6, "{off_deg}");
        viewer.finger_up(7, 3.0);
        viewer.finger_up(9, 3.0);
        assert!(
            viewer.picked.is_none() && viewer.pointer_px.is_none(),
            "it was no tap"
        );
    }

    #[test]
    fn fingers_that_did_not_go_down_on_the_globe_are_ignored() {
        let mut viewer = viewer();
        let before = viewer.orbit.clone();
        viewer.finger_moved(1, DVec2::new(100.0, 100.0), 0.0);
        viewer.finger_up(1, 0.1);
        assert_eq!(viewer.orbit.focus, before.focus);
        assert_eq!(viewer.orbit.distance_m, before.distance_m);
    }
}
