//! Satellites on circular orbits, and what their sensors see.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};
use globefill::{
    CoverageColors, Ellipsoid, Extrusion, FieldOfView, Pose, Renderer, Sensor, SensorDisplay,
    SensorId, SensorStyle,
};

/// Gravitational parameter of the Earth, m³/s² (EGM 96).
const MU_M3_S2: f64 = 3.986_004_418e14;
/// Of the Earth against the stars, 1/s.
const EARTH_RATE_RAD_S: f64 = 7.292_115e-5;
const HEIGHT_M: f64 = 780e3;
const INCLINATION_DEG: f64 = 70.0;
/// The golden section: orbits whose nodes it spreads never line up.
const GOLDEN: f64 = 0.618_033_988_749_895;
/// Most satellites.
pub const MOST: usize = 10_000;

/// What a sensor sees of the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Conic,
    Rectangular,
}

/// What the layer looks like; a change makes its sensors anew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    pub shown: bool,
    pub count: usize,
    pub shape: Shape,
    pub half_angle_deg: f64,
    pub extrusion: Extrusion,
    /// Whether it is shown how many see each point.
    pub coverage: bool,
}

/// The layer of satellites.
pub struct Satellites {
    pub look: Look,
    pub playing: bool,
    /// Seconds in orbit for each second of the clock.
    pub speed: f64,
    /// Since the start.
    seconds: f64,
    ids: Vec<SensorId>,
    /// What was last given to the renderer, and when.
    last: Option<(Look, f64)>,
}

impl Default for Satellites {
    fn default() -> Self {
        Self {
            look: Look {
                shown: true,
                count: 24,
                shape: Shape::Conic,
                half_angle_deg: 28.0,
                extrusion: Extrusion::Normal,
                coverage: false,
            },
            playing: true,
            speed: 60.0,
            seconds: 0.0,
            ids: Vec::new(),
            last: None,
        }
    }
}

impl Satellites {
    /// Whether anything moves.
    pub fn is_moving(&self) -> bool {
        self.playing && self.look.shown && self.look.count > 0
    }

    /// Lets the time of the clock pass.
    pub fn advance(&mut self, seconds: f64) {
        if self.is_moving() {
            self.seconds += seconds * self.speed;
        }
    }

    /// Gives the renderer what changed.
    pub fn restyle(&mut self, renderer: &mut Renderer) -> Result<(), String> {
        let now = (self.look, self.seconds);
        if self.last == Some(now) {
            return Ok(());
        }
        let looks_same = self.last.is_some_and(|(look, _)| look == self.look);
        self.last = Some(now);
        let result = if looks_same {
            self.move_all(renderer)
        } else {
            self.make_all(renderer)
        };
        result.map_err(|error| error.to_string())
    }

    fn move_all(&self, renderer: &mut Renderer) -> Result<(), globefill::SensorError> {
        let sensors = renderer.sensors_mut();
        for (index, &id) in self.ids.iter().enumerate() {
            sensors.set_pose(id, self.pose(index))?;
        }
        Ok(())
    }

    fn make_all(&mut self, renderer: &mut Renderer) -> Result<(), globefill::SensorError> {
        let look = self.look;
        let angle_rad = look.half_angle_deg.to_radians();
        let field_of_view = match look.shape {
            Shape::Conic => FieldOfView::conic(angle_rad)?,
            Shape::Rectangular => FieldOfView::rectangular(angle_rad, 0.5 * angle_rad)?,
        };
        let sensors = renderer.sensors_mut();
        sensors.clear();
        sensors.set_display(if look.coverage {
            SensorDisplay::Coverage(CoverageColors::ramp(
                [0.0; 4],
                &[
                    [0.05, 0.25, 0.75, 0.45],
                    [0.05, 0.7, 0.55, 0.6],
                    [0.95, 0.85, 0.15, 0.7],
                    [0.95, 0.15, 0.1, 0.75],
                ],
                8,
            )?)
        } else {
            SensorDisplay::Blended
        });
        self.ids.clear();
        let count = if look.shown { look.count.min(MOST) } else { 0 };
        // Many together stay as light as few.
        let alpha = (4.0 / (count as f32).sqrt()).clamp(0.06, 0.38);
        for index in 0..count {
            let sensor = Sensor {
                extrusion: look.extrusion,
                ..Sensor::new(self.pose(index), field_of_view.clone())
            };
            let style = SensorStyle {
                color: color(index, alpha),
                ..Default::default()
            };
            self.ids.push(sensors.insert(sensor, style)?);
        }
        Ok(())
    }

    /// Where a satellite is: it looks straight down, up along its track.
    fn pose(&self, index: usize) -> Pose {
        let radius_m = Ellipsoid::WGS84.a_m + HEIGHT_M;
        let rate_rad_s = (MU_M3_S2 / radius_m.powi(3)).sqrt();
        let node_rad = TAU * (index as f64 * GOLDEN).fract();
        let start_rad = TAU * (index as f64 * GOLDEN * 12.0).fract();
        let along_rad = start_rad + rate_rad_s * self.seconds;
        let orbit = DQuat::from_rotation_z(node_rad - EARTH_RATE_RAD_S * self.seconds)
            * DQuat::from_rotation_x(INCLINATION_DEG.to_radians());
        let (sin, cos) = along_rad.sin_cos();
        let apex_m = orbit * (radius_m * DVec3::new(cos, sin, 0.0));
        Pose {
            up: orbit * DVec3::new(-sin, cos, 0.0),
            ..Pose::nadir(&Ellipsoid::WGS84, apex_m)
        }
    }
}

/// Colours of neighbours in the list differ.
fn color(index: usize, alpha: f32) -> [f32; 4] {
    let turn = TAU as f32 * (index as f32 * GOLDEN as f32).fract();
    let part = |phase: f32| 0.45 + 0.4 * (turn + phase).cos();
    [part(0.0), part(4.19), part(2.09), alpha]
}
