//! What moves.

use globefill::{Ellipsoid, FieldOfView, Pose, SensorError};

use crate::{
    circles::Circles,
    cli::{self, Arguments},
    colors::{self, Color},
    constellation::Constellation,
    elements, field_of_view, walker,
};

/// Sensors over time, all with the same field of view.
pub struct Scene {
    motion: Motion,
    pub field_of_view: FieldOfView,
    /// Seconds from frame to frame.
    step_s: f64,
}

enum Motion {
    Orbits(Constellation),
    Circles(Circles),
}

impl Scene {
    pub fn new(arguments: &Arguments, ellipsoid: &Ellipsoid) -> Result<Self, String> {
        let named = |error: SensorError| error.to_string();
        let (motion, field_of_view) = match arguments.scene {
            cli::Scene::Circles => {
                let circles = Circles::new(arguments.made(), arguments.height);
                let cone = FieldOfView::conic(circles.half_angle_rad()).map_err(named)?;
                (Motion::Circles(circles), cone)
            }
            cli::Scene::Orbits => {
                let mut elements = match &arguments.elements {
                    Some(path) => elements::read(path)?,
                    None => walker::elements(arguments)?,
                };
                elements.truncate(arguments.count.unwrap_or(usize::MAX));
                let constellation = Constellation::new(&elements, ellipsoid).map_err(|error| {
                    match &arguments.elements {
                        Some(path) => format!("{}: {error}", path.display()),
                        None => error,
                    }
                })?;
                let shape = field_of_view::new(arguments).map_err(named)?;
                (Motion::Orbits(constellation), shape)
            }
        };
        Ok(Self {
            motion,
            field_of_view,
            step_s: arguments.step,
        })
    }

    /// Where every sensor is in a frame; none for a satellite that is no longer, or not yet, in orbit.
    pub fn poses(&self, frame: i32) -> Vec<Option<Pose>> {
        match &self.motion {
            Motion::Orbits(constellation) => {
                constellation.poses(f64::from(frame) * self.step_s / 60.0)
            }
            Motion::Circles(circles) => circles.poses(frame).map(Some).collect(),
        }
    }

    /// A colour for every sensor, by its orbital plane; `opacity` is its alpha.
    pub fn colors(&self, opacity: f32) -> Vec<Color> {
        match &self.motion {
            Motion::Orbits(constellation) => constellation
                .nodes_rad
                .iter()
                .map(|&node_rad| colors::of_angle(node_rad, opacity))
                .collect(),
            Motion::Circles(circles) => vec![colors::RED; circles.len()],
        }
    }
}
