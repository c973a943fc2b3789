//! Random sensors, the same every time.

use std::f64::consts::PI;

use globefill::{Ellipsoid, FieldOfView, LonLat, Pose, Sensor, glam::DVec3};

/// SplitMix64.
pub struct Draws(pub u64);

impl Draws {
    /// Evenly from `low` to `high`.
    pub fn real(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let unit = ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64;
        low + (high - low) * unit
    }

    pub fn log(&mut self, low: f64, high: f64) -> f64 {
        self.real(low.ln(), high.ln()).exp()
    }

    pub fn below(&mut self, count: usize) -> usize {
        self.real(0.0, count as f64) as usize
    }

    pub fn direction(&mut self) -> DVec3 {
        let (z, turn) = (self.real(-1.0, 1.0), self.real(-PI, PI));
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * turn.cos(), across * turn.sin(), z)
    }
}

/// What a sensor sees, as the test gave it.
#[derive(Clone, Debug)]
pub enum View {
    Annular(f64, f64),
    Rectangular(f64, f64),
    Convex(Vec<DVec3>),
}

#[derive(Clone, Debug)]
pub struct Case {
    pub ellipsoid: Ellipsoid,
    pub view: View,
    pub sensor: Sensor,
}

impl Case {
    pub fn new(
        ellipsoid: Ellipsoid,
        pose: Pose,
        view: View,
        min_elevation_rad: Option<f64>,
    ) -> Self {
        let field_of_view = match &view {
            View::Annular(inner, outer) => FieldOfView::annular(*inner, *outer),
            View::Rectangular(right, up) => FieldOfView::rectangular(*right, *up),
            View::Convex(corners) => FieldOfView::convex(corners),
        };
        let mut sensor = Sensor::new(pose, field_of_view.unwrap());
        sensor.min_elevation_rad = min_elevation_rad;
        Self {
            ellipsoid,
            view,
            sensor,
        }
    }
}

/// From low aircraft to beyond the Moon, on ellipsoids as flat and as long as are supported.
pub fn case(number: u64) -> Case {
    let mut draws = Draws(number.wrapping_mul(0x1234_5678_9abc_def1) + 1);
    let (ellipsoid, pose) = pose(&mut draws);
    let limb_rad = (ellipsoid.b_m / pose.apex_ecef_m.length()).min(1.0).asin();
    let scale_rad = match draws.below(4) {
        0 => draws.log(1e-5, 3.0),
        1 => draws.real(0.0, PI),
        _ => limb_rad * draws.log(0.02, 3.0),
    };
    let view = view(&mut draws, scale_rad);
    Case::new(ellipsoid, pose, view, min_elevation_rad(&mut draws))
}

fn pose(draws: &mut Draws) -> (Ellipsoid, Pose) {
    let flattened = |flattening: f64| Ellipsoid {
        a_m: 6.4e6,
        b_m: 6.4e6 * (1.0 - flattening),
    };
    let ellipsoid = [
        Ellipsoid::WGS84,
        Ellipsoid::WGS84,
        Ellipsoid::MARS,
        Ellipsoid::MOON,
        flattened(0.02),
        flattened(-0.02),
    ][draws.below(6)];
    let lat_deg = [-90.0, 90.0, 0.0, draws.real(-90.0, 90.0)][draws.below(12).min(3)];
    let position = LonLat::new(draws.real(-180.0, 180.0), lat_deg);
    let height_m = if draws.below(20) == 0 {
        1e9
    } else {
        draws.log(100.0, 4e8)
    };
    let mut pose = Pose::nadir(&ellipsoid, ellipsoid.ecef(position, height_m));
    let limb_rad = (ellipsoid.b_m / pose.apex_ecef_m.length()).min(1.0).asin();
    let tilt_rad = match draws.below(4) {
        0 => 0.0,
        1 => limb_rad * draws.real(0.9, 1.1),
        2 => limb_rad * draws.real(0.0, 1.5),
        _ => draws.real(0.0, PI),
    };
    let up = draws.direction();
    let across = pose.boresight.cross(up).normalize();
    pose.boresight = pose.boresight * tilt_rad.cos() + across * tilt_rad.sin();
    pose.up = up;
    (ellipsoid, pose)
}

/// Fields of view whose edges touch the horizon, or miss that by little, or have corners on it.
pub fn touching(number: u64) -> Case {
    let mut draws = Draws(number.wrapping_mul(0x1234_5678_9abc_def1) + 7);
    let (ellipsoid, pose) = pose(&mut draws);
    let least_rad = [None, min_elevation_rad(&mut draws)][draws.below(2)];
    let all = Case::new(ellipsoid, pose, View::Annular(0.0, PI), least_rad);
    let footprint = all.sensor.footprint(&ellipsoid).unwrap();
    let edge = &footprint.loops[0].edges[0];
    let (ahead, right) = (pose.boresight, pose.boresight.cross(pose.up).normalize());
    let axes = [right, right.cross(ahead), ahead];
    let direction = |t: f64| {
        let line = (edge.ecef_m(t.rem_euclid(1.0)) - pose.apex_ecef_m).normalize();
        DVec3::from_array(axes.map(|axis| axis.dot(line)))
    };
    if draws.below(4) == 0 {
        let mut corners = vec![direction(draws.real(0.0, 0.3))];
        corners.push(direction(draws.real(0.35, 0.6)));
        corners.push(direction(draws.real(0.65, 1.0)));
        let inner = draws.below(3);
        corners[inner] = [corners[inner], corners.iter().sum()][draws.below(2)];
        if FieldOfView::convex(&corners).is_ok() {
            return Case::new(ellipsoid, pose, View::Convex(corners), least_rad);
        }
    }
    let off_rad = |t: f64| direction(t).truncate().length().atan2(direction(t).z);
    let tilt_rad = |t: f64| direction(t).y.atan2(direction(t).z);
    let miss = [0.0, draws.log(1e-16, 1e-2), -draws.log(1e-16, 1e-2)][draws.below(3)];
    let sign = [1.0, -1.0][draws.below(2)];
    let touch_rad =
        |angle_rad: &dyn Fn(f64) -> f64| sign * greatest(&|t| sign * angle_rad(t)) * (1.0 + miss);
    let (off_rad, tilt_rad) = (touch_rad(&off_rad), touch_rad(&tilt_rad).abs());
    let view = match draws.below(4) {
        0 if off_rad < PI => View::Annular(0.0, off_rad),
        1 if off_rad < PI => View::Annular(off_rad * draws.real(0.1, 0.9), off_rad),
        2 if off_rad < 3.0 => View::Annular(off_rad, draws.real(off_rad, PI)),
        _ => View::Rectangular(draws.log(0.1, 1.5), tilt_rad.clamp(1e-6, 1.57)),
    };
    Case::new(ellipsoid, pose, view, least_rad)
}

/// The greatest value of a function of 0 … 1 that is smooth and closes.
fn greatest(value: &dyn Fn(f64) -> f64) -> f64 {
    let best = (0..64).map(|step| f64::from(step) / 64.0);
    let best = best.max_by(|&one, &other| value(one).total_cmp(&value(other)));
    let (mut low, mut high) = (best.unwrap() - 1.0 / 64.0, best.unwrap() + 1.0 / 64.0);
    for _ in 0..60 {
        let [one, other] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
        if value(one) < value(other) {
            low = one;
        } else {
            high = other;
        }
    }
    value(0.5 * (low + high))
}

fn view(draws: &mut Draws, scale_rad: f64) -> View {
    let mut angle = |most: f64| (scale_rad * draws.log(0.05, 1.5)).clamp(1e-6, most);
    match (angle(PI), angle(1.57), angle(1.57)) {
        (outer, ..) if draws.below(4) == 0 => View::Annular(0.0, outer),
        (outer, ..) if draws.below(3) == 0 => View::Annular(outer * draws.real(0.01, 0.99), outer),
        (_, right, up) if draws.below(2) == 0 => View::Rectangular(right, up),
        (_, right, up) => {
            // Corners on an ellipse beside the boresight, some nearly on the line of their neighbours.
            let (right, up) = (right.min(1.4).tan(), up.min(1.4).tan());
            let middle = DVec3::new(
                right * draws.real(-2.0, 2.0),
                up * draws.real(-2.0, 2.0),
                1.0,
            );
            let count = 3 + draws.below(8);
            let mut turn = draws.real(0.0, 1.0);
            let mut corners: Vec<_> = (0..count)
                .map(|_| {
                    turn += draws.real(0.3, 1.7) / count as f64 * PI;
                    middle + DVec3::new(right * turn.cos(), up * turn.sin(), 0.0)
                })
                .collect();
            if draws.below(3) == 0 {
                corners.insert(1, 0.5 * (corners[0] + corners[1]));
            }
            if draws.below(2) == 0 {
                corners.reverse();
            }
            // Slivers of a microradian may not be convex to rounding.
            if FieldOfView::convex(&corners).is_ok() {
                View::Convex(corners)
            } else {
                View::Rectangular(right.atan(), up.atan())
            }
        }
    }
}

fn min_elevation_rad(draws: &mut Draws) -> Option<f64> {
    match draws.below(10) {
        0..5 => None,
        5 => Some(draws.real(-1.0, 0.0)),
        6 => Some(draws.log(1e-6, 0.1)),
        7 => Some(0.5 * PI - draws.log(1e-5, 0.1)),
        8 => Some(0.0),
        _ => Some(draws.real(0.0, 1.5)),
    }
}
