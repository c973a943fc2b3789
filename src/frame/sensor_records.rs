//! The records of all sensors of one view, encoded where they or the camera changed.

use rayon::prelude::*;

use crate::{
    frame::optical_depth::optical_depth,
    frame::reference::Reference,
    frame::sensor_record::{SensorRecord, planes_of, weight_scale},
    sensor_set::{SensorSet, Version},
};

/// Sensors encoded by one task: enough to be worth handing to another core.
const BATCH: usize = 512;

/// Records in the order of the set, kept from frame to frame.
#[derive(Default)]
pub(crate) struct SensorRecords {
    pub records: Vec<SensorRecord>,
    /// Inward normals and slacks, in the order of the records.
    pub planes: Vec<[f32; 4]>,
    /// Where each sensor's planes start.
    first_planes: Vec<u32>,
    reference: Option<Reference>,
    weight_scale: f64,
    /// Of which set, as of when.
    encoded: Option<Version>,
}

impl SensorRecords {
    /// Brings the records up to date.
    pub(crate) fn update(&mut self, set: &SensorSet, reference: Reference) {
        if self.reference == Some(reference) && self.encoded == Some(set.version()) {
            return;
        }
        self.first_planes.clear();
        let mut plane_total = 0;
        let mut deepest = 0.0;
        for index in 0..set.len() {
            let entry = set.entry(index);
            let planes = entry.sensor.field_of_view.plane_count() as u32;
            self.first_planes
                .push(if planes > 0 { plane_total } else { 0 });
            plane_total += planes;
            deepest += optical_depth(entry.style.color[3]);
        }
        let weight_scale = weight_scale(deepest);
        // What was encoded of this set, in this place, on this scale, is up to date.
        let seen = match self.encoded {
            Some(version)
                if version.set == set.version().set
                    && self.reference == Some(reference)
                    && self.weight_scale == weight_scale =>
            {
                version.changed
            }
            _ => 0,
        };
        self.records.resize(set.len(), SensorRecord::nothing());
        let first_planes = &self.first_planes;
        let encode = |(batch, records): (usize, &mut [SensorRecord])| {
            for (k, record) in records.iter_mut().enumerate() {
                let index = batch * BATCH + k;
                let (entry, first_plane) = (set.entry(index), first_planes[index]);
                if entry.changed > seen || record.planes[0] != first_plane {
                    *record =
                        SensorRecord::new(entry, &reference, weight_scale, first_plane as usize);
                }
            }
        };
        if set.len() > BATCH {
            self.records
                .par_chunks_mut(BATCH)
                .enumerate()
                .for_each(encode);
        } else {
            encode((0, &mut self.records));
        }
        self.planes.clear();
        if plane_total > 0 {
            for index in 0..set.len() {
                planes_of(set.entry(index), &reference, &mut self.planes);
            }
        }
        self.reference = Some(reference);
        self.weight_scale = weight_scale;
        self.encoded = Some(set.version());
    }

    /// Optical depth of one unit of weight.
    pub(crate) fn depth_per_weight(&self) -> f64 {
        1.0 / self.weight_scale
    }
}
