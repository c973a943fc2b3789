//! The records of all sensors of one view, encoded where they or the camera changed.

use rayon::prelude::*;

use crate::{
    frame::reference::Reference,
    frame::sensor_record::{SensorRecord, plane_count, planes_of, weight_scale},
    sensor_set::SensorSet,
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
    /// Stamp of the set when it was last encoded.
    encoded: u64,
}

impl SensorRecords {
    /// Brings the records up to date.
    pub(crate) fn update(&mut self, set: &SensorSet, reference: Reference) {
        let weight_scale = weight_scale(set.len());
        let moved = self.reference != Some(reference) || self.weight_scale != weight_scale;
        if !moved && self.encoded == set.changed() {
            return;
        }
        let seen = if moved { 0 } else { self.encoded };
        self.first_planes.clear();
        let mut plane_total = 0;
        for index in 0..set.len() {
            self.first_planes.push(plane_total);
            plane_total += plane_count(set.entry(index)) as u32;
        }
        self.records.resize(set.len(), SensorRecord::default());
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
        self.encoded = set.changed();
    }

    /// Optical depth of one unit of weight.
    pub(crate) fn depth_per_weight(&self) -> f64 {
        1.0 / self.weight_scale
    }
}
