//! The sensors of a renderer.

use std::sync::atomic::{AtomicU64, Ordering};

use indexmap::IndexMap;
use rustc_hash::FxBuildHasher;

use crate::{
    coverage::{self, CoverageColors},
    ellipsoid::Ellipsoid,
    error::SensorError,
    field_of_view::{FieldOfView, Shape},
    geodetic::LonLat,
    sensor::{Aim, Extrusion, Pose, Sensor},
};

/// Names a sensor in a [`SensorSet`]; no two sensors of a process have the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SensorId(u64);

/// How a footprint looks.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct SensorStyle {
    /// Red, green, blue, alpha, 0 … 1, not premultiplied, as in
    /// [`FillStyle::color`](crate::FillStyle::color). An alpha above 0.99 is drawn as 0.99.
    pub color: [f32; 4],
    /// Whether the footprint is drawn, and counted in the coverage.
    pub visible: bool,
}

impl Default for SensorStyle {
    fn default() -> Self {
        Self {
            color: [0.2, 0.7, 1.0, 0.35],
            visible: true,
        }
    }
}

/// What is shown of the sensors.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum SensorDisplay {
    /// Every footprint in its colour, whatever their order: each is a filter that lets 1 − α of the
    /// light through, so n equal footprints have the opacity 1 − (1 − α)ⁿ, as if drawn one over the
    /// other. Where colours differ they mix in the ratio of the optical depths −ln(1 − α): the colour
    /// of many thin sheets in random order.
    #[default]
    Blended,
    /// How many sensors cover each point.
    Coverage(CoverageColors),
}

/// The sensors of a [`Renderer`](crate::Renderer), on one ellipsoid.
///
/// Inserting, changing and removing take well below a microsecond and no memory beyond the set's own;
/// the next [`prepare`](crate::Renderer::prepare) shows it.
#[derive(Debug)]
pub struct SensorSet {
    ellipsoid: Ellipsoid,
    entries: IndexMap<SensorId, Entry, FxBuildHasher>,
    display: SensorDisplay,
    version: Version,
}

/// Which set, and when it was last changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Version {
    /// Stamp of when the set was made.
    pub set: u64,
    /// Stamp of the last change.
    pub changed: u64,
}

#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub sensor: Sensor,
    pub style: SensorStyle,
    /// Stamp of the last change of what is at this place in the order of the set.
    pub changed: u64,
}

/// Stamps are unique in a process, so that sets can be exchanged and identifiers not be confused.
fn stamp() -> u64 {
    static LAST: AtomicU64 = AtomicU64::new(1);
    LAST.fetch_add(1, Ordering::Relaxed)
}

impl Default for SensorSet {
    fn default() -> Self {
        Self::new(Ellipsoid::WGS84)
    }
}

impl SensorSet {
    /// No sensors, above an ellipsoid.
    pub fn new(ellipsoid: Ellipsoid) -> Self {
        Self {
            ellipsoid,
            entries: IndexMap::default(),
            display: SensorDisplay::default(),
            version: Version {
                set: stamp(),
                changed: stamp(),
            },
        }
    }

    /// The ellipsoid that the sensors look at.
    pub fn ellipsoid(&self) -> Ellipsoid {
        self.ellipsoid
    }

    /// Number of sensors.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Adds a sensor.
    ///
    /// # Errors
    /// [`SensorError`] if there cannot be such a sensor above this ellipsoid.
    pub fn insert(&mut self, sensor: Sensor, style: SensorStyle) -> Result<SensorId, SensorError> {
        sensor.aim(&self.ellipsoid)?;
        coverage::check(&style.color)?;
        let changed = self.change();
        let id = SensorId(changed);
        let entry = Entry {
            sensor,
            style,
            changed,
        };
        self.entries.insert(id, entry);
        Ok(id)
    }

    /// Removes a sensor.
    ///
    /// # Errors
    /// [`SensorError::NoSuchSensor`].
    pub fn remove(&mut self, id: SensorId) -> Result<Sensor, SensorError> {
        let (index, _, entry) = self
            .entries
            .swap_remove_full(&id)
            .ok_or(SensorError::NoSuchSensor)?;
        let now = self.change();
        // The last one now stands in its place.
        if let Some((_, moved)) = self.entries.get_index_mut(index) {
            moved.changed = now;
        }
        Ok(entry.sensor)
    }

    /// Removes all sensors.
    pub fn clear(&mut self) {
        self.entries.clear();
        self.change();
    }

    /// A sensor and its style.
    pub fn get(&self, id: SensorId) -> Option<(&Sensor, &SensorStyle)> {
        self.entries
            .get(&id)
            .map(|entry| (&entry.sensor, &entry.style))
    }

    /// All sensors, in no order that means anything.
    pub fn iter(&self) -> impl Iterator<Item = (SensorId, &Sensor, &SensorStyle)> {
        self.entries
            .iter()
            .map(|(&id, entry)| (id, &entry.sensor, &entry.style))
    }

    /// Moves and turns a sensor.
    ///
    /// # Errors
    /// [`SensorError`]; the sensor then stays as it was.
    pub fn set_pose(&mut self, id: SensorId, pose: Pose) -> Result<(), SensorError> {
        let ellipsoid = self.ellipsoid;
        self.update(id, |entry| {
            let before = std::mem::replace(&mut entry.sensor.pose, pose);
            entry
                .sensor
                .aim(&ellipsoid)
                .map(|_| ())
                .inspect_err(|_| entry.sensor.pose = before)
        })
    }

    /// Replaces a sensor.
    ///
    /// # Errors
    /// [`SensorError`]; the sensor then stays as it was.
    pub fn set_sensor(&mut self, id: SensorId, sensor: Sensor) -> Result<(), SensorError> {
        sensor.aim(&self.ellipsoid)?;
        self.update(id, |entry| {
            entry.sensor = sensor;
            Ok(())
        })
    }

    /// Changes how a sensor's footprint looks.
    ///
    /// # Errors
    /// [`SensorError::NoSuchSensor`], [`SensorError::Color`]; the style then stays as it was.
    pub fn set_style(&mut self, id: SensorId, style: SensorStyle) -> Result<(), SensorError> {
        coverage::check(&style.color)?;
        self.update(id, |entry| {
            entry.style = style;
            Ok(())
        })
    }

    /// What is shown of the sensors.
    pub fn display(&self) -> &SensorDisplay {
        &self.display
    }

    /// Changes what is shown of the sensors.
    pub fn set_display(&mut self, display: SensorDisplay) {
        if self.display != display {
            self.display = display;
            self.change();
        }
    }

    /// The sensors that cover the point `height_m` above `position`, visible or not: exact up to
    /// rounding in f64.
    pub fn covering(&self, position: LonLat, height_m: f64) -> impl Iterator<Item = SensorId> + '_ {
        self.entries.iter().filter_map(move |(&id, entry)| {
            entry
                .aim(&self.ellipsoid)
                .covers(position, height_m)
                .then_some(id)
        })
    }

    fn update(
        &mut self,
        id: SensorId,
        change: impl FnOnce(&mut Entry) -> Result<(), SensorError>,
    ) -> Result<(), SensorError> {
        let entry = self.entries.get_mut(&id).ok_or(SensorError::NoSuchSensor)?;
        change(entry)?;
        let now = stamp();
        entry.changed = now;
        self.version.changed = now;
        Ok(())
    }

    fn change(&mut self) -> u64 {
        self.version.changed = stamp();
        self.version.changed
    }

    /// Which set it is, and as of when.
    pub(crate) fn version(&self) -> Version {
        self.version
    }

    /// Number of visible sensors.
    pub(crate) fn visible_count(&self) -> usize {
        self.entries
            .values()
            .filter(|entry| entry.style.visible)
            .count()
    }

    /// What drawing all of them needs.
    pub(crate) fn needs(&self) -> Needs {
        self.entries
            .values()
            .fold(Needs::default(), |needs, entry| needs.and(&entry.sensor))
    }

    /// Number of planes of all fields of view.
    pub(crate) fn plane_count(&self) -> usize {
        let views = self
            .entries
            .values()
            .map(|entry| &entry.sensor.field_of_view);
        views.map(FieldOfView::plane_count).sum()
    }

    /// The sensor at a place in the order of the set.
    pub(crate) fn entry(&self, index: usize) -> &Entry {
        &self.entries[index]
    }
}

/// What shaders must be able to do for the sensors of a set; the rest is compiled away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Needs {
    pub apexes: bool,
    pub inner_cones: bool,
    pub corners: bool,
    pub elevations: bool,
}

impl Needs {
    fn and(self, sensor: &Sensor) -> Self {
        let (inner, corners) = match sensor.field_of_view.0 {
            Shape::Cone { inner_rad, .. } => (inner_rad > 0.0, false),
            Shape::Pyramid { .. } => (false, true),
        };
        Self {
            apexes: self.apexes || sensor.extrusion == Extrusion::Apex,
            inner_cones: self.inner_cones || inner,
            corners: self.corners || corners,
            elevations: self.elevations || sensor.min_elevation_rad.is_some(),
        }
    }
}

impl Entry {
    pub(crate) fn aim(&self, ellipsoid: &Ellipsoid) -> Aim<'_> {
        self.sensor
            .aim(ellipsoid)
            .expect("checked when it was inserted")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sensor(lon_deg: f64) -> Sensor {
        let apex_ecef_m = Ellipsoid::WGS84.ecef(LonLat::new(lon_deg, 10.0), 5e5);
        let pose = Pose::nadir(&Ellipsoid::WGS84, apex_ecef_m);
        Sensor::new(pose, FieldOfView::conic(0.5).unwrap())
    }

    #[test]
    fn what_takes_the_place_of_a_removed_sensor_has_changed() {
        let mut set = SensorSet::default();
        let ids: Vec<SensorId> = (0..4)
            .map(|k| {
                set.insert(sensor(f64::from(k)), SensorStyle::default())
                    .unwrap()
            })
            .collect();
        let before = set.version().changed;
        set.remove(ids[1]).unwrap();
        assert_eq!(set.remove(ids[1]), Err(SensorError::NoSuchSensor));
        let changed: Vec<bool> = (0..3).map(|k| set.entry(k).changed > before).collect();
        assert_eq!(changed, [false, true, false]);
        assert_eq!(set.get(ids[3]).unwrap().0, &sensor(3.0));
    }

    #[test]
    fn a_refused_change_leaves_the_sensor_as_it_was() {
        let mut set = SensorSet::default();
        let id = set.insert(sensor(0.0), SensorStyle::default()).unwrap();
        let before = set.version().changed;
        let underground = Pose {
            apex_ecef_m: glam::DVec3::X,
            ..sensor(0.0).pose
        };
        assert_eq!(
            set.set_pose(id, underground),
            Err(SensorError::ApexBelowSurface)
        );
        let garish = SensorStyle {
            color: [f32::INFINITY; 4],
            visible: true,
        };
        assert!(set.set_style(id, garish).is_err());
        assert_eq!(
            set.get(id).unwrap(),
            (&sensor(0.0), &SensorStyle::default())
        );
        assert_eq!(set.version().changed, before);
    }

    #[test]
    fn the_sensors_above_a_point_are_found() {
        let mut set = SensorSet::default();
        let near = set.insert(sensor(20.0), SensorStyle::default()).unwrap();
        set.insert(sensor(40.0), SensorStyle::default()).unwrap();
        let covering: Vec<SensorId> = set.covering(LonLat::new(21.0, 10.0), 0.0).collect();
        assert_eq!(covering, [near]);
    }
}
