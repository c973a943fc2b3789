//! A sensor as the GPU reads it: slacks at a reference point in f64, and their gradients.

use glam::DVec3;

use crate::{
    field_of_view::Shape,
    frame::optical_depth::optical_depth,
    frame::reference::Reference,
    frame::sight_uniform::padded,
    sensor::{Aim, Extrusion},
    sensor_set::{Entry, SensorStyle},
};

/// A slack that never decides, metres.
const NEVER: f32 = 1e30;

/// `Sensor` of sensor.wgsl; see there.
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct SensorRecord {
    pub axis: [f32; 4],
    pub across: [f32; 4],
    pub cone: [f32; 4],
    pub limb: [f32; 4],
    pub line: [f32; 4],
    pub rise: [f32; 4],
    pub weight: [u32; 4],
    pub planes: [u32; 4],
}

/// Units of weight per optical depth: a power of two such that sums up to `deepest`, the optical depth of
/// all sensors together, fit into 32 bits.
pub(crate) fn weight_scale(deepest: f64) -> f64 {
    // Half the range is left for rounding every weight up.
    2_f64.powf((2_f64.powi(31) / deepest.max(1.0)).log2().floor())
}

impl SensorRecord {
    /// The record of a sensor whose planes start at `first_plane`.
    pub(crate) fn new(
        entry: &Entry,
        reference: &Reference,
        weight_scale: f64,
        first_plane: usize,
    ) -> Self {
        if !entry.style.visible {
            return Self::nothing();
        }
        let aim = entry.aim(&reference.ellipsoid);
        let from_apex_m = from_apex_m(&aim, reference);
        let lift = match aim.extrusion {
            Extrusion::Normal => 0.0,
            Extrusion::Apex => lift_over_limb(&aim, reference),
        };
        let mut record = Self {
            line: padded(from_apex_m, aim.sin_min_elevation),
            weight: weight(&entry.style, weight_scale),
            planes: [
                first_plane as u32,
                entry.sensor.field_of_view.plane_count() as u32,
                0,
                0,
            ],
            ..Self::nothing()
        };
        record.set_cone(&aim, from_apex_m);
        record.set_limb(&aim, reference, from_apex_m, lift);
        record
    }

    /// Covers nothing.
    pub(crate) fn nothing() -> Self {
        Self {
            cone: [-NEVER, -NEVER, 0.0, 0.0],
            ..Self::default()
        }
    }

    fn set_cone(&mut self, aim: &Aim<'_>, from_apex_m: DVec3) {
        let &Shape::Cone {
            inner_rad,
            half_angle_rad,
        } = aim.shape
        else {
            self.cone = [NEVER, -NEVER, 0.0, 0.0];
            return;
        };
        let axis = aim.ecef_from_sensor.z_axis;
        let along_m = axis.dot(from_apex_m);
        let across_m = from_apex_m - along_m * axis;
        // Signed distance from the cone, positive inside.
        let slack_m = |(sin, cos): (f64, f64)| sin * along_m - cos * across_m.length();
        let outer = half_angle_rad.sin_cos();
        self.axis = padded(axis, outer.0);
        self.across = padded(across_m, outer.1);
        self.cone[0] = slack_m(outer) as f32;
        if inner_rad > 0.0 {
            let inner = inner_rad.sin_cos();
            self.cone[1] = slack_m(inner) as f32;
            self.cone[2] = inner.0 as f32;
            self.cone[3] = inner.1 as f32;
        }
    }

    fn set_limb(&mut self, aim: &Aim<'_>, at: &Reference, from_apex_m: DVec3, lift: f64) {
        let a_m = at.ellipsoid.a_m;
        let gradient = at.scaled(aim.apex_ecef_m) / a_m;
        let limb_m = |point_m: DVec3| gradient.dot(point_m) - a_m;
        let (slack_m, height_m) = match aim.extrusion {
            Extrusion::Normal => (limb_m(at.foot_ecef_m), 0.0),
            Extrusion::Apex => (limb_m(at.eye_ecef_m), at.eye_height_m),
        };
        let eye_lift_m = lift * at.outside_m.max(0.0).sqrt();
        self.limb = padded(gradient, slack_m);
        // n·(apex − foot) − height ≥ sine · distance, times |M · foot| / a.
        let elevation_m = limb_m(at.foot_ecef_m)
            - at.stretch * (height_m + aim.sin_min_elevation * from_apex_m.length());
        let from_apex = f32::from(u8::from(aim.extrusion == Extrusion::Apex));
        let lifted_m = (slack_m + eye_lift_m) as f32;
        self.rise = [elevation_m as f32, lift as f32, from_apex, lifted_m];
    }
}

/// The way from the apex to the point that slacks are taken at.
fn from_apex_m(aim: &Aim<'_>, reference: &Reference) -> DVec3 {
    let taken_at = match aim.extrusion {
        Extrusion::Normal => reference.foot_ecef_m,
        Extrusion::Apex => reference.eye_ecef_m,
    };
    taken_at - aim.apex_ecef_m
}

/// By how much the root of a point's outside lifts it over the limb: a point is seen if it is above
/// the plane of the limb by −√(outside of the apex · outside of the point) or more.
fn lift_over_limb(aim: &Aim<'_>, reference: &Reference) -> f64 {
    let apex = aim.apex_ecef_m / reference.ellipsoid.radii_m();
    ((apex.length_squared() - 1.0) * reference.ellipsoid.a_m).sqrt()
}

/// The planes of a sensor's field of view: inward normal, slack at the reference.
pub(crate) fn planes_of(entry: &Entry, reference: &Reference, planes: &mut Vec<[f32; 4]>) {
    let Shape::Pyramid { inward, .. } = &entry.sensor.field_of_view.0 else {
        return;
    };
    let aim = entry.aim(&reference.ellipsoid);
    let from_apex_m = from_apex_m(&aim, reference);
    planes.extend(inward.iter().map(|&normal| {
        let normal = aim.ecef_from_sensor * normal;
        padded(normal, normal.dot(from_apex_m))
    }));
}

/// Integer weights of a style.
fn weight(style: &SensorStyle, scale: f64) -> [u32; 4] {
    let [red, green, blue, alpha] = style.color;
    let depth = optical_depth(alpha) * scale;
    [red, green, blue, 1.0].map(|part| (f64::from(part) * depth).round() as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_weights_fit() {
        let opaque = SensorStyle {
            color: [1.0; 4],
            visible: true,
        };
        for sensors in [1_u32, 2, 3, 1000, 1 << 20] {
            let scale = weight_scale(f64::from(sensors) * optical_depth(opaque.color[3]));
            let weight = u64::from(weight(&opaque, scale)[3]);
            assert!(
                weight * u64::from(sensors) <= u64::from(u32::MAX),
                "{sensors}"
            );
        }
    }

    #[test]
    fn faint_sensors_are_not_lost_in_a_crowd() {
        let faint = SensorStyle {
            color: [0.3, 0.5, 0.7, 0.001],
            visible: true,
        };
        let scale = weight_scale(1e5 * optical_depth(faint.color[3]));
        let [red, _, _, depth] = weight(&faint, scale).map(f64::from);
        assert!((red / depth - 0.3).abs() < 1e-3, "{red} of {depth}");
    }
}
