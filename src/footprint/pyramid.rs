//! The sides of a convex field of view as planes and arcs of directions.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec3};

use super::{arc_set::ArcSet, horizon::Horizon, trig_series::TrigSeries};

/// The plane between two corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    /// Which side of the field of view it is.
    pub index: usize,
    /// Unit normal, ECEF.
    pub inward: DVec3,
    /// Corner where it starts, unit, ECEF, and the unit vector at right angles to it towards the end.
    from: DVec3,
    along: DVec3,
    /// Angle from its start to its end.
    angle_rad: f64,
}

/// A convex cone of directions.
#[derive(Clone, Debug)]
pub(super) struct Pyramid {
    /// In turn, the inside on the left.
    pub sides: Vec<Side>,
    /// Where the corner at the start of each side hits the ground, in scaled coordinates; on the limb
    /// if it does not.
    corner_units: Vec<DVec3>,
}

/// A corner nearer, in radians, to the plane through its neighbours than this is none: corners are
/// admitted with dents of 10⁻¹² and rounding.
const FLAT_RAD: f64 = 2e-12;

impl Pyramid {
    pub(super) fn new(
        axes: &DMat3,
        corners: &[DVec3],
        inward: &[DVec3],
        horizon: &Horizon,
    ) -> Self {
        let count = corners.len();
        // Which way round the corners run.
        let backwards = corners[0].cross(corners[1]).dot(inward[0]) < 0.0;
        let turn: Vec<_> = (0..count)
            .map(|k| if backwards { count - 1 - k } else { k })
            .collect();
        let turn = without_flat(corners, turn);
        let sides: Vec<_> = (0..turn.len())
            .map(|k| {
                let (start, end) = (turn[k], turn[(k + 1) % turn.len()]);
                let index = if backwards { end } else { start };
                let next = (index + 1) % count;
                // A side whose corner went has the plane through the corners that stayed.
                let inward = if next == start || next == end {
                    inward[index]
                } else {
                    {
                        let normal = corners[start].cross(corners[end]).normalize();
                        normal * normal.dot(inward[index]).signum()
                    }
                };
                let [inward, from, to] =
                    [inward, corners[start], corners[end]].map(|vector| *axes * vector);
                let along = from.cross(inward);
                let angle_rad = to.dot(along).atan2(to.dot(from)).rem_euclid(TAU);
                Side {
                    index,
                    inward,
                    from,
                    along,
                    angle_rad,
                }
            })
            .collect();
        let corner_units = sides
            .iter()
            .map(|side| horizon.apex.hit(side.from))
            .collect();
        Self {
            sides,
            corner_units,
        }
    }

    /// Where the corner at the start of a side hits the ground.
    pub(super) fn corner(&self, side: usize) -> DVec3 {
        self.corner_units[side % self.sides.len()]
    }

    /// The parts of the horizon inside all planes.
    pub(super) fn arcs_of(&self, horizon: &Horizon, lines_m: &[DVec3]) -> ArcSet {
        let arcs = self.sides.iter().map(|side| {
            let samples: Vec<_> = lines_m
                .iter()
                .map(|line_m| side.inward.dot(*line_m))
                .collect();
            let breaks_rad = TrigSeries::fit(&samples, horizon.degree()).monotone_pieces();
            ArcSet::where_positive(&breaks_rad, horizon.rounding_rad(lines_m), |angle_rad| {
                let line_m = horizon.apex.line_m(horizon.unit(angle_rad));
                side.inward.dot(line_m) / line_m.length()
            })
        });
        ArcSet::common(&arcs.collect::<Vec<_>>())
    }

    pub(super) fn holds(&self, direction: DVec3) -> bool {
        self.sides
            .iter()
            .all(|side| side.inward.dot(direction) >= 0.0)
    }

    pub(super) fn middle(&self) -> DVec3 {
        self.sides.iter().map(|side| side.from).sum()
    }

    /// The number of the side and the fraction of its angle, of the side a direction lies nearest to.
    pub(super) fn station(&self, direction: DVec3) -> f64 {
        let direction = direction.normalize();
        let (mut nearest, mut least) = (0.0, f64::INFINITY);
        for (number, side) in self.sides.iter().enumerate() {
            let fraction = side.fraction(direction);
            // Not the plane alone: planes of neighbours may be all but one.
            let distance = (side.at(fraction) - direction).length();
            if distance < least {
                (nearest, least) = (number as f64 + fraction, distance);
            }
        }
        nearest
    }

    pub(super) fn direction(&self, station: f64) -> DVec3 {
        let side = (station as usize).min(self.sides.len() - 1);
        self.sides[side].at(station - side as f64)
    }
}

impl Side {
    /// Where along it a direction in its plane lies, 0 … 1.
    fn fraction(&self, direction: DVec3) -> f64 {
        let mut angle_rad = direction.dot(self.along).atan2(direction.dot(self.from));
        // Nearer to the end than to the start the short way round.
        if angle_rad < 0.5 * self.angle_rad - PI {
            angle_rad += TAU;
        }
        (angle_rad / self.angle_rad).clamp(0.0, 1.0)
    }

    fn at(&self, fraction: f64) -> DVec3 {
        let (sin, cos) = (fraction * self.angle_rad).sin_cos();
        self.from * cos + self.along * sin
    }
}

/// The corners, by number in turn, without those on the plane through their neighbours.
fn without_flat(corners: &[DVec3], turn: Vec<usize>) -> Vec<usize> {
    let mut kept = turn;
    let mut k = 0;
    while k < kept.len() && kept.len() > 3 {
        let count = kept.len();
        let [before, corner, after] =
            [k + count - 1, k, k + 1].map(|neighbour| corners[kept[neighbour % count]]);
        let plane = before.cross(after).normalize();
        if corner.dot(plane).abs() < FLAT_RAD {
            kept.remove(k);
        } else {
            k += 1;
        }
    }
    kept
}
