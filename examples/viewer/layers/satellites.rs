//! Satellites on circular orbits, and what they see.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use globefill::{
    CoverageColors, Ellipsoid, Extrusion, FieldOfView, Pose, Sensor, SensorDisplay, SensorError,
    SensorId, SensorSet, SensorStyle, coverage::CLEAR,
};

const MU_M3_S2: f64 = 3.986_004_418e14;
const EARTH_RATE_RAD_S: f64 = 7.292_115e-5;
/// Most sensors that the slider offers.
pub const MOST: usize = 10_000;

/// What a person can change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    pub visible: bool,
    pub count: usize,
    pub height_km: f64,
    pub inclination_deg: f64,
    pub half_angle_deg: f64,
    pub rectangular: bool,
    pub from_apex: bool,
    pub coverage: bool,
    pub opacity: f32,
}

/// A shell of satellites that moves.
pub struct Satellites {
    pub settings: Settings,
    pub playing: bool,
    /// Seconds of flight a second.
    pub speed: f64,
    pub time_s: f64,
    ids: Vec<SensorId>,
    shown: Option<(Settings, f64)>,
}

impl Default for Satellites {
    fn default() -> Self {
        Self {
            settings: Settings {
                visible: false,
                count: 60,
                height_km: 780.0,
                inclination_deg: 86.0,
                half_angle_deg: 50.0,
                rectangular: false,
                from_apex: false,
                coverage: false,
                opacity: 0.3,
            },
            playing: false,
            speed: 60.0,
            time_s: 0.0,
            ids: Vec::new(),
            shown: None,
        }
    }
}

impl Satellites {
    /// Flies on; false if nothing moves.
    pub fn advance(&mut self, seconds: f64) -> bool {
        let moves = self.playing && self.settings.visible;
        if moves {
            self.time_s += self.speed * seconds;
        }
        moves
    }

    /// Brings a sensor set up to date.
    pub fn sync(&mut self, sensors: &mut SensorSet) -> Result<(), SensorError> {
        let wanted = Some((self.settings, self.time_s));
        if self.shown == wanted {
            return Ok(());
        }
        let same_sensors = self.shown.is_some_and(|(shown, _)| shown == self.settings);
        self.shown = wanted;
        if same_sensors {
            for index in 0..self.ids.len() {
                sensors.set_pose(self.ids[index], self.pose(index))?;
            }
            return Ok(());
        }
        sensors.clear();
        self.ids.clear();
        let settings = self.settings;
        if !settings.visible {
            return Ok(());
        }
        let field_of_view = settings.field_of_view()?;
        for index in 0..settings.count {
            let mut sensor = Sensor::new(self.pose(index), field_of_view.clone());
            if settings.from_apex {
                sensor.extrusion = Extrusion::Apex;
            }
            let hue = index % settings.planes();
            let style = SensorStyle {
                color: settings.color(hue as f64 / settings.planes() as f64),
                visible: true,
            };
            self.ids.push(sensors.insert(sensor, style)?);
        }
        sensors.set_display(settings.display()?);
        Ok(())
    }

    /// Over the ground, up along the track.
    fn pose(&self, index: usize) -> Pose {
        let Settings {
            height_km,
            inclination_deg,
            count,
            ..
        } = self.settings;
        let planes = self.settings.planes();
        let (plane, slot) = (index % planes, index / planes);
        let in_plane = count.div_ceil(planes);
        let radius_m = Ellipsoid::WGS84.a_m + height_km * 1e3;
        let rate_rad_s = (MU_M3_S2 / radius_m.powi(3)).sqrt();
        let phase = (slot as f64 + 0.5 * (plane % 2) as f64) / in_plane as f64;
        let argument_rad = (TAU * phase + rate_rad_s * self.time_s) % TAU;
        let node_rad = (PI * plane as f64 / planes as f64 * self.settings.node_span()
            - EARTH_RATE_RAD_S * self.time_s)
            % TAU;
        let (sin_i, cos_i) = inclination_deg.to_radians().sin_cos();
        let toward_node = DVec3::new(node_rad.cos(), node_rad.sin(), 0.0);
        let across = DVec3::new(-node_rad.sin() * cos_i, node_rad.cos() * cos_i, sin_i);
        let (sin, cos) = argument_rad.sin_cos();
        let apex_ecef_m = radius_m * (cos * toward_node + sin * across);
        let velocity_m_s = radius_m * rate_rad_s * (cos * across - sin * toward_node);
        Pose {
            up: velocity_m_s - EARTH_RATE_RAD_S * DVec3::Z.cross(apex_ecef_m),
            ..Pose::nadir(&Ellipsoid::WGS84, apex_ecef_m)
        }
    }
}

impl Settings {
    fn planes(&self) -> usize {
        self.count.isqrt().max(1)
    }

    /// Polar shells spread their nodes over half a turn, others over a whole one.
    fn node_span(&self) -> f64 {
        if self.inclination_deg > 75.0 {
            1.0
        } else {
            2.0
        }
    }

    fn field_of_view(&self) -> Result<FieldOfView, SensorError> {
        let half_rad = self.half_angle_deg.to_radians();
        if self.rectangular {
            FieldOfView::rectangular(half_rad, half_rad * 0.5)
        } else {
            FieldOfView::conic(half_rad)
        }
    }

    fn display(&self) -> Result<SensorDisplay, SensorError> {
        if !self.coverage {
            return Ok(SensorDisplay::Blended);
        }
        let stops = [
            [0.06, 0.01, 0.09, 0.8],
            [0.02, 0.22, 0.27, 0.8],
            [0.12, 0.58, 0.13, 0.8],
            [0.98, 0.8, 0.02, 0.8],
        ];
        CoverageColors::ramp(CLEAR, &stops, 8).map(SensorDisplay::Coverage)
    }

    /// From blue by green to amber.
    fn color(&self, part: f64) -> [f32; 4] {
        let wave = |shift: f64| (0.5 + 0.45 * (TAU * (part + shift)).cos()) as f32;
        [
            0.6 * wave(0.5),
            0.3 + 0.6 * wave(0.2),
            wave(0.0),
            self.opacity,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_fly_at_their_height_and_along_their_track() {
        let mut satellites = Satellites::default();
        for index in 0..60 {
            satellites.time_s = 1000.0;
            let pose = satellites.pose(index);
            let off_m = pose.apex_ecef_m.length() - (Ellipsoid::WGS84.a_m + 780e3);
            assert!(off_m.abs() < 1e-3);
            satellites.time_s += 0.01;
            let step = (satellites.pose(index).apex_ecef_m - pose.apex_ecef_m) / 0.01;
            assert!((step - pose.up).length() < 0.1, "{step} {}", pose.up);
        }
    }
}
