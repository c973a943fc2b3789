//! The closed curves that bound a field of view, as directions from the apex.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::{
    arc_set::ArcSet,
    course::{ConeArc, Course, SectionArc},
    edge::FootprintEdge,
    horizon::Horizon,
    pyramid::Pyramid,
    trig_series::TrigSeries,
};
use crate::{field_of_view::Shape, footprint::FootprintBound, sensor::Aim};

/// A closed curve of directions, walked with the field of view on the left: seen from the apex as from
/// outside the ellipsoid. Places on it are named by a station, 0 … [`Rim::length`].
#[derive(Clone, Debug)]
pub(super) enum Rim {
    Cone(Cone),
    Pyramid(Pyramid),
}

/// A circular cone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cone {
    /// Right, up and boresight, in ECEF.
    axes: [DVec3; 3],
    half_angle_rad: f64,
    /// Whether the field of view lies inside it.
    outer: bool,
}

impl Rim {
    /// The curves of a field of view, those that have shrunk to a point left out.
    pub(super) fn of(aim: &Aim, horizon: &Horizon) -> Vec<Self> {
        let axes = aim.ecef_from_sensor;
        match aim.shape {
            &Shape::Cone {
                inner_rad,
                half_angle_rad,
            } => [(half_angle_rad, true), (inner_rad, false)]
                .into_iter()
                .filter(|(angle_rad, _)| *angle_rad > 0.0 && *angle_rad < PI)
                .map(|(half_angle_rad, outer)| {
                    Self::Cone(Cone {
                        axes: [axes.x_axis, axes.y_axis, axes.z_axis],
                        half_angle_rad,
                        outer,
                    })
                })
                .collect(),
            Shape::Pyramid { corners, inward } => {
                vec![Self::Pyramid(Pyramid::new(&axes, corners, inward, horizon))]
            }
        }
    }

    /// The parts of the horizon on its left.
    pub(super) fn arcs_of(&self, horizon: &Horizon, lines_m: &[DVec3]) -> ArcSet {
        match self {
            Self::Cone(cone) => cone.arcs_of(horizon, lines_m),
            Self::Pyramid(pyramid) => pyramid.arcs_of(horizon, lines_m),
        }
    }

    /// Stations once round.
    pub(super) fn length(&self) -> f64 {
        match self {
            Self::Cone(_) => TAU,
            Self::Pyramid(pyramid) => pyramid.sides.len() as f64,
        }
    }

    /// Where along it a direction on it lies.
    pub(super) fn station(&self, direction: DVec3) -> f64 {
        match self {
            Self::Cone(cone) => {
                let angle_rad = cone.axes[1]
                    .dot(direction)
                    .atan2(cone.axes[0].dot(direction));
                (cone.turn() * angle_rad).rem_euclid(TAU)
            }
            Self::Pyramid(pyramid) => pyramid.station(direction),
        }
    }

    /// The direction at a station, in ECEF.
    pub(super) fn direction(&self, station: f64) -> DVec3 {
        let station = station.rem_euclid(self.length());
        match self {
            Self::Cone(cone) => cone.direction(cone.turn() * station),
            Self::Pyramid(pyramid) => pyramid.direction(station),
        }
    }

    /// Whether a direction lies on its left.
    pub(super) fn holds(&self, direction: DVec3) -> bool {
        match self {
            Self::Cone(cone) => cone.depth_rad(direction) >= 0.0,
            Self::Pyramid(pyramid) => pyramid.holds(direction),
        }
    }

    /// A direction well on its left, or on its right.
    pub(super) fn well_inside(&self, left: bool) -> DVec3 {
        let sign = if left { 1.0 } else { -1.0 };
        match self {
            Self::Cone(cone) => sign * cone.turn() * cone.axes[2],
            Self::Pyramid(pyramid) => sign * pyramid.middle(),
        }
    }

    /// The edges of the footprint from one crossing of the horizon to the next, given as surface
    /// points in scaled coordinates with their stations.
    pub(super) fn edges_between(
        &self,
        horizon: &Horizon,
        from: (DVec3, f64),
        to: (DVec3, f64),
    ) -> Vec<FootprintEdge> {
        match self {
            Self::Cone(cone) => {
                let sweep = (to.1 - from.1).rem_euclid(TAU);
                let arc = cone.arc(horizon, from.1, sweep, horizon.is_limb());
                let radii_m = horizon.apex.radii_m;
                vec![FootprintEdge::new(
                    cone.bound(),
                    radii_m,
                    (from.0, to.0),
                    arc,
                )]
            }
            Self::Pyramid(pyramid) => pyramid.edges_between(horizon, from, to),
        }
    }

    /// The edges of the footprint once round.
    pub(super) fn all_edges(&self, horizon: &Horizon) -> Vec<FootprintEdge> {
        match self {
            Self::Cone(cone) => {
                let start = horizon.apex.hit(self.direction(0.0));
                let arc = cone.arc(horizon, 0.0, TAU, false);
                let radii_m = horizon.apex.radii_m;
                vec![FootprintEdge::new(
                    cone.bound(),
                    radii_m,
                    (start, start),
                    arc,
                )]
            }
            Self::Pyramid(pyramid) => pyramid.all_edges(horizon),
        }
    }
}

impl Cone {
    /// Which way round the boresight it is walked.
    fn turn(&self) -> f64 {
        if self.outer { 1.0 } else { -1.0 }
    }

    fn bound(&self) -> FootprintBound {
        if self.outer {
            FootprintBound::OuterCone
        } else {
            FootprintBound::InnerCone
        }
    }

    fn direction(&self, angle_rad: f64) -> DVec3 {
        let (sin, cos) = angle_rad.sin_cos();
        let (sin_half, cos_half) = self.half_angle_rad.sin_cos();
        self.axes[2] * cos_half + (self.axes[0] * cos + self.axes[1] * sin) * sin_half
    }

    /// How far a direction lies inside, radians.
    fn depth_rad(&self, direction: DVec3) -> f64 {
        let off_rad = self.axes[2]
            .cross(direction)
            .length()
            .atan2(self.axes[2].dot(direction));
        self.turn() * (self.half_angle_rad - off_rad)
    }

    /// The horizon crosses the cone between extremes of |b × L|² − sin²α·L², which is a short series
    /// and has a zero wherever the angle is α.
    fn arcs_of(&self, horizon: &Horizon, lines_m: &[DVec3]) -> ArcSet {
        let sin_squared = self.half_angle_rad.sin().powi(2);
        let samples: Vec<_> = lines_m
            .iter()
            .map(|line_m| {
                self.axes[2].cross(*line_m).length_squared() - sin_squared * line_m.length_squared()
            })
            .collect();
        let breaks_rad = TrigSeries::fit(&samples, 2 * horizon.degree()).monotone_pieces();
        ArcSet::where_positive(&breaks_rad, horizon.rounding_rad(lines_m), |angle_rad| {
            self.depth_rad(horizon.apex.line_m(horizon.unit(angle_rad)))
        })
    }

    fn arc(&self, horizon: &Horizon, station: f64, sweep: f64, ends_on_limb: bool) -> Course {
        let (sin_half, cos_half) = self.half_angle_rad.sin_cos();
        Course::Cone(Box::new(ConeArc::new(
            horizon.apex,
            [
                self.axes[0] * sin_half,
                self.axes[1] * sin_half,
                self.axes[2] * cos_half,
            ],
            (self.turn() * station, self.turn() * sweep),
            ends_on_limb,
        )))
    }
}

impl Pyramid {
    /// From one crossing to the next along the sides.
    fn edges_between(
        &self,
        horizon: &Horizon,
        from: (DVec3, f64),
        to: (DVec3, f64),
    ) -> Vec<FootprintEdge> {
        let count = self.sides.len();
        let side_of = |station: f64| (station as usize).min(count - 1);
        let (first, last) = (side_of(from.1), side_of(to.1));
        let wraps = last < first || (last == first && to.1 < from.1);
        let steps = (last + if wraps { count } else { 0 }) - first;
        (0..=steps)
            .map(|step| {
                let side = (first + step) % count;
                let start = if step == 0 { from.0 } else { self.corner(side) };
                let end = if step == steps {
                    to.0
                } else {
                    self.corner(side + 1)
                };
                self.edge(horizon, side, start, end)
            })
            .filter(|edge| edge.from != edge.to)
            .collect()
    }

    fn all_edges(&self, horizon: &Horizon) -> Vec<FootprintEdge> {
        (0..self.sides.len())
            .map(|side| self.edge(horizon, side, self.corner(side), self.corner(side + 1)))
            .filter(|edge| edge.from != edge.to)
            .collect()
    }

    fn edge(&self, horizon: &Horizon, side: usize, start: DVec3, end: DVec3) -> FootprintEdge {
        let side = &self.sides[side];
        let arc = SectionArc::between(&horizon.apex, side.inward, start, end);
        let bound = FootprintBound::Side(side.index);
        let radii_m = horizon.apex.radii_m;
        FootprintEdge::new(bound, radii_m, (start, end), Course::Section(arc))
    }
}
