//! The pieces of refined chords that the edge pass draws.

use std::ops::Range;

use glam::DVec3;

use crate::{
    frame::edge_draws::{ArcEdges, EdgeSlot, EdgeWants},
    frame::refine::{Patch, RefinedChord},
    frame::select::slot,
    gpu::fixed_point::FixedVertex,
};

/// A piece of a refined chord, as the edge pass reads it.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct EdgeSegment {
    pub ends: [FixedVertex; 2],
    pub arc: u32,
    /// Places of the ends along the arc.
    pub along: [u32; 2],
    pub padding: u32,
}

/// The pieces of the refined chords of one mesh whose edges are drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct EdgeSegments {
    pub pieces: Vec<EdgeSegment>,
    /// Where the pieces of each refined chord start; one entry more than there are chords, or none.
    pub(super) starts: Vec<u32>,
}

impl EdgeSegments {
    pub(crate) fn new(patch: &Patch, edges: &ArcEdges, wants: &EdgeWants<'_>) -> Self {
        let mut segments = Self::default();
        if edges.is_empty() {
            return segments;
        }
        segments.starts.push(0);
        for chord in &patch.chords {
            if edges.any(chord.arc as usize) {
                segments.add(patch, chord, wants.slots);
            }
            segments.starts.push(segments.pieces.len() as u32);
        }
        segments
    }

    fn add(&mut self, patch: &Patch, chord: &RefinedChord, slots: &[EdgeSlot]) {
        let points: Vec<FixedVertex> = patch.polyline(chord).collect();
        let first = slot(chord.arc, chord.vertex) as usize;
        let places = places_between(&points, slots[first].along, slots[first + 1].along);
        let pairs = points.windows(2).zip(places.windows(2));
        self.pieces.extend(pairs.map(|(ends, along)| EdgeSegment {
            ends: [ends[0], ends[1]],
            arc: chord.arc,
            along: [along[0], along[1]],
            padding: 0,
        }));
    }

    /// The pieces on the arcs that a layer draws.
    pub(crate) fn runs(&self, patch: &Patch, drawn: impl Fn(usize) -> bool) -> Vec<Range<u32>> {
        let mut runs: Vec<Range<u32>> = Vec::new();
        for (chord, ends) in patch.chords.iter().zip(self.starts.windows(2)) {
            if ends[0] == ends[1] || !drawn(chord.arc as usize) {
                continue;
            }
            match runs.last_mut() {
                Some(run) if run.end == ends[0] => run.end = ends[1],
                _ => runs.push(ends[0]..ends[1]),
            }
        }
        runs
    }
}

/// Places of the points of a polyline between two given ones, in proportion to its length.
fn places_between(points: &[FixedVertex], from: u32, to: u32) -> Vec<u32> {
    let mut along = 0.0;
    let lengths: Vec<f64> = std::iter::once(0.0)
        .chain(points.windows(2).map(|ends| {
            along += way_steps(ends[0], ends[1]).length();
            along
        }))
        .collect();
    let scale = f64::from(to.saturating_sub(from)) / along.max(f64::MIN_POSITIVE);
    lengths
        .into_iter()
        .map(|length| from + (length * scale).round() as u32)
        .collect()
}

/// From one vertex to another, in steps of the encoding.
fn way_steps(a: FixedVertex, b: FixedVertex) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|axis| {
        let fraction = |vertex: FixedVertex| (vertex[3] >> (10 * axis)) & 1023;
        f64::from(b[axis]) - f64::from(a[axis]) + f64::from(fraction(b) - fraction(a)) / 1024.0
    }))
}
