//! What a sensor sees around its boresight.

#[cfg(feature = "serde")]
mod written;

use std::{f64::consts::PI, sync::Arc};

use glam::DVec3;

use crate::error::SensorError;

/// Most corners of a [`FieldOfView::convex`].
pub const MAX_CORNERS: usize = 64;

/// The directions a sensor sees, in its own frame: components to the right, up and along the boresight.
///
/// Cheap to clone: corners are shared.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "written::Written", into = "written::Written")
)]
pub struct FieldOfView(pub(crate) Shape);

/// The kinds of field of view.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Shape {
    /// Directions between two angles from the boresight, radians; `inner_rad` is 0 for a full cone.
    Cone { inner_rad: f64, half_angle_rad: f64 },
    /// Directions inside all planes.
    Pyramid {
        /// Unit directions of the corners, in turn.
        corners: Arc<[DVec3]>,
        /// Unit normal, inward, of the plane through corner k and the next.
        inward: Arc<[DVec3]>,
    },
}

impl FieldOfView {
    /// All directions within `half_angle_rad` of the boresight, 0 … π (π: every direction).
    ///
    /// # Errors
    /// [`SensorError::HalfAngle`].
    pub fn conic(half_angle_rad: f64) -> Result<Self, SensorError> {
        Self::annular(0.0, half_angle_rad)
    }

    /// All directions between `inner_rad` and `half_angle_rad` from the boresight.
    ///
    /// # Errors
    /// [`SensorError::HalfAngle`] unless 0 ≤ `inner_rad` < `half_angle_rad` ≤ π.
    pub fn annular(inner_rad: f64, half_angle_rad: f64) -> Result<Self, SensorError> {
        // Written so that NaN fails.
        if !(half_angle_rad > 0.0 && half_angle_rad <= PI) {
            return Err(SensorError::HalfAngle(half_angle_rad));
        }
        if !(inner_rad >= 0.0 && inner_rad < half_angle_rad) {
            return Err(SensorError::HalfAngle(inner_rad));
        }
        Ok(Self(Shape::Cone {
            inner_rad,
            half_angle_rad,
        }))
    }

    /// A pyramid of four planes, tilted from the boresight by the half-angles `right_rad` to the right
    /// and left and `up_rad` up and down.
    ///
    /// # Errors
    /// [`SensorError::HalfAngle`] unless both lie between 0 and π/2, exclusively.
    pub fn rectangular(right_rad: f64, up_rad: f64) -> Result<Self, SensorError> {
        for angle_rad in [right_rad, up_rad] {
            if !(angle_rad > 0.0 && angle_rad < 0.5 * PI) {
                return Err(SensorError::HalfAngle(angle_rad));
            }
        }
        let (right, up) = (right_rad.tan(), up_rad.tan());
        Self::convex(&[
            DVec3::new(right, up, 1.0),
            DVec3::new(-right, up, 1.0),
            DVec3::new(-right, -up, 1.0),
            DVec3::new(right, -up, 1.0),
        ])
    }

    /// Number of planes that bound it; none bound a cone.
    pub(crate) fn plane_count(&self) -> usize {
        match &self.0 {
            Shape::Cone { .. } => 0,
            Shape::Pyramid { inward, .. } => inward.len(),
        }
    }

    /// The convex cone spanned by corner directions (right, up, boresight), of any length, given in
    /// turn, either way round. The boresight need not lie inside.
    ///
    /// # Errors
    /// [`SensorError::Corners`] unless there are 3 … [`MAX_CORNERS`]; [`SensorError::Corner`] with the
    /// first corner that is not finite, is no direction, equals another, is not convex, or lies
    /// 90° or more from the mean direction of all.
    pub fn convex(corners: &[DVec3]) -> Result<Self, SensorError> {
        let count = corners.len();
        if !(3..=MAX_CORNERS).contains(&count) {
            return Err(SensorError::Corners(count));
        }
        let corners: Arc<[DVec3]> = corners.iter().map(unit).collect();
        if let Some(corner) = corners.iter().position(|corner| !corner.is_finite()) {
            return Err(SensorError::Corner(corner));
        }
        let next = |k: usize| corners[(k + 1) % count];
        let middle: DVec3 = corners.iter().sum();
        let turn: f64 = (0..count)
            .map(|k| corners[k].cross(next(k)).dot(middle))
            .sum();
        // Twice the cross product of the two, without its cancellation where they are close.
        let plane = |k: usize| (corners[k] - next(k)).cross(corners[k] + next(k));
        let inward: Arc<[DVec3]> = (0..count)
            .map(|k| (plane(k) * turn.signum()).normalize())
            .collect();
        for k in 0..count {
            // Corners on one plane through the apex are allowed, up to rounding.
            let others = |normal: DVec3| corners.iter().all(|corner| corner.dot(normal) > -1e-12);
            let same = |other: &&DVec3| (corners[k] - **other).length() <= 1e-9;
            let distinct = corners.iter().filter(same).count() == 1;
            let ahead = corners[k].dot(middle) > 0.0;
            if !(distinct && inward[k].is_finite() && others(inward[k]) && ahead) {
                return Err(SensorError::Corner(k));
            }
        }
        Ok(Self(Shape::Pyramid { corners, inward }))
    }
}

/// A direction of length 1. What has that already, up to rounding, stays as it is, so that a field of
/// view made of its own corners is the same.
fn unit(direction: &DVec3) -> DVec3 {
    // Normalising leaves a square off by up to some 12 roundings.
    if (direction.length_squared() - 1.0).abs() <= 2e-15 {
        *direction
    } else {
        direction.normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_angles_and_corners_are_named() {
        for bad in [0.0, -0.1, 3.2, f64::NAN, f64::INFINITY] {
            assert!(FieldOfView::conic(bad).is_err(), "{bad}");
            assert!(FieldOfView::rectangular(0.1, bad).is_err(), "{bad}");
        }
        assert_eq!(
            FieldOfView::annular(0.3, 0.2),
            Err(SensorError::HalfAngle(0.3))
        );
        assert_eq!(FieldOfView::convex(&[]), Err(SensorError::Corners(0)));
        let square = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
        let corner = |(right, up)| DVec3::new(right, up, 1.0);
        let mut dented: Vec<_> = square.into_iter().map(corner).collect();
        assert!(FieldOfView::convex(&dented).is_ok());
        dented.insert(2, DVec3::new(-0.5, 0.0, 1.0));
        assert!(matches!(
            FieldOfView::convex(&dented),
            Err(SensorError::Corner(_))
        ));
        dented[2] = DVec3::new(f64::NAN, 0.0, 1.0);
        assert_eq!(FieldOfView::convex(&dented), Err(SensorError::Corner(2)));
        dented[2] = dented[1];
        assert!(FieldOfView::convex(&dented).is_err());
    }

    #[test]
    fn corners_may_be_given_either_way_round() {
        let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]
            .map(|(right, up)| DVec3::new(right, up, 1.0));
        let mut backwards = corners;
        backwards.reverse();
        for corners in [corners, backwards] {
            let Shape::Pyramid { inward, .. } = FieldOfView::convex(&corners).unwrap().0 else {
                panic!("corners make a pyramid");
            };
            assert!(inward.iter().all(|normal| normal.z > 0.0));
        }
    }
}
