//! A sensor: where it is, where it looks, what it sees.

use glam::{DMat3, DVec3};

use crate::{
    ellipsoid::Ellipsoid,
    error::SensorError,
    field_of_view::{FieldOfView, Shape},
    geodetic::LonLat,
};

/// Where a sensor is and how it is turned, in ECEF.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Pose {
    /// Position of the apex, metres. It must lie above the ellipsoid.
    pub apex_ecef_m: DVec3,
    /// Direction of the middle of the field of view, of any length.
    pub boresight: DVec3,
    /// Direction that fixes the turn about the boresight, of any length, not along it: the field of
    /// view's *up* is its part at right angles to the boresight. Cones ignore it.
    pub up: DVec3,
}

impl Pose {
    /// At `apex_ecef_m`, looking straight down along the geodetic normal, up towards north.
    pub fn nadir(ellipsoid: &Ellipsoid, apex_ecef_m: DVec3) -> Self {
        let (foot, _) = ellipsoid.geodetic(apex_ecef_m);
        let (sin_lon, cos_lon) = foot.lon_deg.to_radians().sin_cos();
        let (sin_lat, cos_lat) = foot.lat_deg.to_radians().sin_cos();
        Self {
            apex_ecef_m,
            boresight: -ellipsoid.normal(foot),
            up: DVec3::new(-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat),
        }
    }
}

/// Which points at a height above the ellipsoid a footprint covers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Extrusion {
    /// Those whose geodetic foot point the sensor sees on the bare ellipsoid: a footprint as on a map.
    #[default]
    Normal,
    /// Those in the field of view themselves, as far as the ellipsoid does not hide them: a line of
    /// sight that misses the ellipsoid still meets mountains behind its limb. Terrain hides nothing.
    Apex,
}

/// A sensor with a pose.
///
/// A point is seen if it lies in the field of view and
/// - above the ellipsoid, if the line of sight to it does not pass through the ellipsoid; below it, if
///   it lies on the near side of the plane of the limb (on the ellipsoid the two are the same);
/// - if the sensor stands there at least `min_elevation_rad` above the plane at right angles to the
///   geodetic normal.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Sensor {
    /// Where it is and how it is turned.
    pub pose: Pose,
    /// What it sees.
    pub field_of_view: FieldOfView,
    /// Least elevation of the sensor, radians, −π/2 … π/2, seen from a covered point; `None` for no
    /// limit but the limb.
    #[cfg_attr(feature = "serde", serde(default))]
    pub min_elevation_rad: Option<f64>,
    /// What is covered above and below the ellipsoid.
    #[cfg_attr(feature = "serde", serde(default))]
    pub extrusion: Extrusion,
}

impl Sensor {
    /// A sensor without a limit of elevation, with a footprint as on a map.
    pub fn new(pose: Pose, field_of_view: FieldOfView) -> Self {
        Self {
            pose,
            field_of_view,
            min_elevation_rad: None,
            extrusion: Extrusion::Normal,
        }
    }

    /// Whether the point `height_m` above `position` is covered. Exact up to rounding in f64.
    ///
    /// # Errors
    /// [`SensorError`] if the sensor cannot be.
    pub fn covers(
        &self,
        ellipsoid: &Ellipsoid,
        position: LonLat,
        height_m: f64,
    ) -> Result<bool, SensorError> {
        Ok(self.aim(ellipsoid)?.covers(position, height_m))
    }

    /// Checks the sensor and turns its field of view into ECEF.
    pub(crate) fn aim(&self, ellipsoid: &Ellipsoid) -> Result<Aim<'_>, SensorError> {
        let Pose {
            apex_ecef_m,
            boresight,
            up,
        } = self.pose;
        if !apex_ecef_m.is_finite() || apex_ecef_m.length_squared() > FARTHEST_M * FARTHEST_M {
            return Err(SensorError::Apex);
        }
        if !ellipsoid.is_supported() {
            return Err(SensorError::Ellipsoid);
        }
        let scaled = apex_ecef_m / ellipsoid.radii_m();
        let above = scaled.length_squared() - 1.0;
        // An apex on the surface has no limb.
        if above <= 1e-12 {
            return Err(SensorError::ApexBelowSurface);
        }
        let boresight = boresight.normalize();
        if !boresight.is_finite() {
            return Err(SensorError::Boresight);
        }
        let right = match self.field_of_view.0 {
            Shape::Cone { .. } => boresight.any_orthonormal_vector(),
            Shape::Pyramid { .. } => boresight.cross(up.normalize()),
        };
        if !right.is_finite() || right.length() < 1e-9 {
            return Err(SensorError::Up);
        }
        let right = right.normalize();
        let elevation_rad = self
            .min_elevation_rad
            .unwrap_or(-std::f64::consts::FRAC_PI_2);
        let range = -std::f64::consts::FRAC_PI_2..=std::f64::consts::FRAC_PI_2;
        if !range.contains(&elevation_rad) {
            return Err(SensorError::MinElevation(elevation_rad));
        }
        Ok(Aim {
            ellipsoid: *ellipsoid,
            apex_ecef_m,
            ecef_from_sensor: DMat3::from_cols(right, right.cross(boresight), boresight),
            shape: &self.field_of_view.0,
            sin_min_elevation: elevation_rad.sin(),
            extrusion: self.extrusion,
        })
    }
}

/// No apex is farther from the middle of the ellipsoid, metres.
const FARTHEST_M: f64 = 1e10;

/// A [`Sensor`] that was checked, turned into ECEF.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aim<'a> {
    pub ellipsoid: Ellipsoid,
    pub apex_ecef_m: DVec3,
    /// From (right, up, boresight). It mirrors: those three are left-handed.
    pub ecef_from_sensor: DMat3,
    pub shape: &'a Shape,
    /// −1 if there is no limit.
    pub sin_min_elevation: f64,
    pub extrusion: Extrusion,
}

impl Aim<'_> {
    /// Whether the point `height_m` above `position` is covered.
    pub(crate) fn covers(&self, position: LonLat, height_m: f64) -> bool {
        let normal = self.ellipsoid.normal(position);
        let foot_m = self.ellipsoid.surface_with_normal(normal);
        let point_m = match self.extrusion {
            Extrusion::Normal => foot_m,
            Extrusion::Apex => foot_m + normal * height_m,
        };
        let line_m = point_m - self.apex_ecef_m;
        let risen = -normal.dot(line_m) >= self.sin_min_elevation * line_m.length();
        risen && self.sees_past_limb(point_m, point_m == foot_m) && self.holds(line_m)
    }

    /// Whether the ellipsoid leaves a point to be seen.
    fn sees_past_limb(&self, point_m: DVec3, on_ellipsoid: bool) -> bool {
        // In coordinates divided by the radii the ellipsoid is the unit sphere, S the apex, P the point:
        // S·P = 1 is the plane of the limb, (S·P − 1)² = (S² − 1)(P² − 1) the cone of tangents.
        let radii_m = self.ellipsoid.radii_m();
        let (apex, point) = (self.apex_ecef_m / radii_m, point_m / radii_m);
        let above_plane = apex.dot(point) - 1.0;
        if on_ellipsoid {
            // The root of the rounding of P² − 1 would be decimetres.
            return above_plane >= 0.0;
        }
        let outside = (point.length_squared() - 1.0).max(0.0);
        above_plane >= 0.0 || above_plane * above_plane < (apex.length_squared() - 1.0) * outside
    }

    /// Whether a direction lies in the field of view.
    pub(crate) fn holds(&self, direction: DVec3) -> bool {
        match self.shape {
            &Shape::Cone {
                inner_rad,
                half_angle_rad,
            } => {
                let boresight = self.ecef_from_sensor.z_axis;
                let off_rad = boresight
                    .cross(direction)
                    .length()
                    .atan2(boresight.dot(direction));
                off_rad >= inner_rad && off_rad <= half_angle_rad
            }
            Shape::Pyramid { inward, .. } => {
                let direction = self.ecef_from_sensor.transpose() * direction;
                inward.iter().all(|normal| normal.dot(direction) >= 0.0)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(height_m: f64) -> Pose {
        let apex_ecef_m = Ellipsoid::WGS84.ecef(LonLat::new(30.0, 50.0), height_m);
        Pose::nadir(&Ellipsoid::WGS84, apex_ecef_m)
    }

    #[test]
    fn what_cannot_be_is_named() {
        let cone = FieldOfView::conic(0.3).unwrap();
        let square = FieldOfView::rectangular(0.3, 0.3).unwrap();
        let error =
            |pose, fov: &FieldOfView| Sensor::new(pose, fov.clone()).aim(&Ellipsoid::WGS84).err();
        let good = at(5e5);
        assert_eq!(error(good, &cone), None);
        assert_eq!(error(at(-10.0), &cone), Some(SensorError::ApexBelowSurface));
        let with = |change: fn(&mut Pose)| {
            let mut pose = good;
            change(&mut pose);
            pose
        };
        let nowhere = with(|pose| pose.apex_ecef_m.x = f64::NAN);
        assert_eq!(error(nowhere, &cone), Some(SensorError::Apex));
        let aimless = with(|pose| pose.boresight = DVec3::ZERO);
        assert_eq!(error(aimless, &cone), Some(SensorError::Boresight));
        let twisted = with(|pose| pose.up = pose.boresight);
        assert_eq!(error(twisted, &square), Some(SensorError::Up));
        assert_eq!(error(twisted, &cone), None);
    }

    #[test]
    fn right_up_and_boresight_are_where_they_say() {
        let square = FieldOfView::rectangular(0.3, 0.2).unwrap();
        let sensor = Sensor::new(at(5e5), square);
        let aim = sensor.aim(&Ellipsoid::WGS84).unwrap();
        // Looking down with up to the north, right is east.
        let east = DVec3::new(-30_f64.to_radians().sin(), 30_f64.to_radians().cos(), 0.0);
        assert!((aim.ecef_from_sensor.x_axis - east).length() < 1e-12);
        assert!((aim.ecef_from_sensor.y_axis - sensor.pose.up).length() < 1e-12);
        assert!((aim.ecef_from_sensor.z_axis - sensor.pose.boresight).length() < 1e-12);
    }

    #[test]
    fn mountains_are_seen_behind_the_limb_only_from_the_apex() {
        let mut sensor = Sensor::new(at(10_000.0), FieldOfView::conic(3.0).unwrap());
        // The limb is 357 km away; a summit of 5 km is seen for another 252 km.
        let behind = LonLat::new(30.0, 50.0 - 4.5);
        let farther = LonLat::new(30.0, 50.0 - 6.0);
        let covers = |sensor: &Sensor, position, height_m| {
            sensor
                .covers(&Ellipsoid::WGS84, position, height_m)
                .unwrap()
        };
        assert!(!covers(&sensor, behind, 5_000.0));
        sensor.extrusion = Extrusion::Apex;
        assert!(covers(&sensor, behind, 5_000.0));
        assert!(!covers(&sensor, behind, 100.0));
        assert!(!covers(&sensor, farther, 5_000.0));
        assert!(covers(&sensor, LonLat::new(30.0, 50.1), -400.0));
    }
}
