//! Which boundaries the edge pass draws, and the pieces of those that were refined.

use std::ops::Range;

use glam::Vec4Swizzles as _;

use crate::{
    fill_mesh::{Arc, Bounds, FillMesh},
    frame::code::Code,
    frame::layers::PieceCode,
    frame::sight::Sight,
};

/// Steps in a metre along an arc; as in stroke.wgsl.
const STEPS_PER_M: f64 = 64.0;
/// Pixels may be that many times larger than `Sight::pixel`: off the axes, and where they are
/// oblong.
const LARGEST_PIXEL: f64 = 4.0;

/// The edges of a layer that are asked for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LayerEdges {
    /// The code of the layer.
    pub code: Code,
    /// By id, 0 for none: how far on both sides of a fill's boundary distances are asked for, metres
    /// and pixels, which add up; both 0 for fills that ask for none. One more than there are fills.
    pub reaches: Vec<[f32; 2]>,
}

/// The edges that are asked for of a mesh.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EdgeWants<'a> {
    /// By layer; may be empty for none at all.
    pub layers: &'a [Option<LayerEdges>],
    /// Every boundary slot; may be empty where no layer asks for edges.
    pub slots: &'a [EdgeSlot],
}

/// A boundary slot as the edge pass reads it.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct EdgeSlot {
    /// The arc of the chord that starts here, or [`Self::NO_CHORD`].
    pub arc: u32,
    /// Steps of 1/64 m from the start of the arc.
    pub along: u32,
}

impl EdgeSlot {
    /// As in edge.wgsl.
    pub(crate) const NO_CHORD: u32 = u32::MAX;
}

/// What the edge pass draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum EdgeInput {
    /// Prisms around stored chords.
    Chords,
    /// Prisms around the pieces of refined chords.
    Segments,
    /// Rectangles on the screen around stored chords that are far away.
    Flat,
}

impl EdgeInput {
    pub(crate) const ALL: [Self; 3] = [Self::Chords, Self::Segments, Self::Flat];

    /// Vertices that a chord takes.
    pub(crate) fn corners(self) -> u32 {
        match self {
            Self::Chords | Self::Segments => 14,
            Self::Flat => 4,
        }
    }

    /// Entry points of edge.wgsl and edge_flat.wgsl.
    pub(crate) fn entries(self) -> [&'static str; 2] {
        match self {
            Self::Chords => ["vs_chord", "fs_edge"],
            Self::Segments => ["vs_segment", "fs_edge"],
            Self::Flat => ["vs_flat", "fs_flat"],
        }
    }
}

/// Edges of one mesh in one layer.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct EdgeDraws {
    /// Boundary slots as runs of arcs, without refined chords. The last slot of a run starts no chord.
    pub chords: Vec<Range<u32>>,
    /// The same of arcs so far away that they are measured on the screen.
    pub flat: Vec<Range<u32>>,
    /// Pieces of refined chords: positions in [`Selection::segments`](super::select::Selection).
    pub segments: Vec<Range<u32>>,
}

impl EdgeDraws {
    /// Whether nothing is drawn.
    pub(crate) fn is_empty(&self) -> bool {
        self.chords.is_empty() && self.flat.is_empty() && self.segments.is_empty()
    }
}

/// How far the edges of each arc reach, in each layer.
pub(crate) struct ArcEdges {
    /// By layer, then by arc: whether they are drawn. Empty for layers without edges.
    wanted: Vec<Vec<bool>>,
    /// By arc: whether it is drawn at all and measured on the screen.
    flat: Vec<bool>,
}

/// Chords that are measured on the screen span no more than this share of their distance, nor do they with the
/// metres that they reach.
const FLAT_SHARE: f64 = 0.25;

impl ArcEdges {
    pub(crate) fn new(
        mesh: &FillMesh,
        shown: &[Option<PieceCode>],
        sight: &Sight,
        wants: &EdgeWants<'_>,
    ) -> Self {
        // By arc, over all layers that draw it: the most metres that its edges reach.
        let mut reaches_m: Vec<Option<f64>> = vec![None; mesh.arcs.len()];
        let in_layer = |(layer, edges): (usize, &Option<LayerEdges>)| match edges {
            Some(edges) => (mesh.arcs.iter().zip(&mut reaches_m))
                .map(|(arc, reach_m)| {
                    let reach = edges.reach_of(arc, layer, shown);
                    let seen = reach.is_seen(&arc.bounds, sight);
                    if seen {
                        *reach_m = Some(reach_m.unwrap_or(0.0).max(reach.metres));
                    }
                    seen
                })
                .collect(),
            None => Vec::new(),
        };
        let wanted: Vec<Vec<bool>> = wants.layers.iter().enumerate().map(in_layer).collect();
        let flat = |(arc, reach_m): (&Arc, &Option<f64>)| {
            reach_m.is_some_and(|reach_m| is_flat(mesh, arc, sight, reach_m))
        };
        Self {
            flat: mesh.arcs.iter().zip(&reaches_m).map(flat).collect(),
            wanted,
        }
    }

    /// Whether an arc is measured on the screen.
    pub(crate) fn flat(&self, arc: usize) -> bool {
        self.flat[arc]
    }

    /// Whether a layer draws the edges of an arc.
    pub(crate) fn wanted(&self, layer: usize, arc: usize) -> bool {
        let wanted = self.wanted.get(layer).and_then(|arcs| arcs.get(arc));
        wanted.is_some_and(|&wanted| wanted)
    }

    /// Whether no layer has edges.
    pub(crate) fn is_empty(&self) -> bool {
        self.wanted.iter().all(Vec::is_empty)
    }

    /// Whether any layer draws the edges of an arc.
    pub(crate) fn any(&self, arc: usize) -> bool {
        (0..self.wanted.len()).any(|layer| self.wanted(layer, arc))
    }
}

/// Whether an arc's edges, which reach `reach_m` besides what is asked for in pixels, may be measured on the
/// screen: nowhere are they displaced by more than the pixel budget.
///
/// Relief and sag displace them by half the relief, since the screen shows chords half way up, and by the
/// most that a chord lies below the ellipsoid. Pixels are those of the screen by definition. Metres, however,
/// are taken to be as large as they are at the chord's start, across it, and the nearest boundary on the
/// screen to be that on the ground, which displaces the outline of a reach by no
/// more than [`aslant_m`] and [`uneven_m`].
fn is_flat(mesh: &FillMesh, arc: &Arc, sight: &Sight, reach_m: f64) -> bool {
    let distance_m = sight.distance_to_m(&arc.bounds);
    let budget_m = sight.tolerance_m(distance_m);
    let half_relief_m = 0.5 * (sight.surface_m.1 - sight.surface_m.0);
    // What the vertices are not needed for.
    let aslant_m = aslant_m(reach_m, sight.least_sine(&arc.bounds));
    if half_relief_m + aslant_m > budget_m {
        return false;
    }
    let first = arc.first_vertex as usize;
    let chords = mesh.vertices[first..first + arc.vertex_count as usize].windows(2);
    let longest_squared = chords
        .map(|ends| ends[0].distance_squared(ends[1]))
        .fold(0.0, f64::max);
    let radius_m = mesh.ellipsoid.b_m;
    let sag_m = longest_squared / (8.0 * radius_m);
    let span_m = longest_squared.sqrt() + reach_m;
    // Parallel lines of sight show all of a chord at one scale.
    let level = sight.parallel || span_m <= FLAT_SHARE * distance_m;
    let nearness = if sight.parallel {
        0.0
    } else {
        1.0 / distance_m
    };
    let uneven_m = uneven_m(reach_m, span_m, nearness, 1.0 / radius_m);
    half_relief_m + sag_m + aslant_m + uneven_m <= budget_m && level
}

impl Sight {
    /// Lower bound of the sine of the angle at which lines of sight meet the ellipsoid's tangent planes in
    /// `bounds`; 0 where they may graze it.
    fn least_sine(&self, bounds: &Bounds) -> f64 {
        let radii_m = self.ellipsoid.radii_m();
        let middle_m = bounds.axis * radii_m;
        let up = (bounds.axis / radii_m).normalize();
        let from_eye_m = middle_m - self.eye_ecef_m;
        let (line, turning_rad) = if self.parallel {
            (self.clip_from_relative.transpose().z_axis.xyz(), 0.0)
        } else {
            let reach_m = bounds.radius_rad * radii_m.max_element();
            let share = reach_m / from_eye_m.length();
            (from_eye_m, share.min(1.0).asin())
        };
        // Normals turn by no more than angles in coordinates divided by the radii, and the flattening twice.
        let leaning = 1.0 + 2.0 * self.ellipsoid.flattening().abs();
        let middle_rad = (-line.normalize()).dot(up).clamp(-1.0, 1.0).asin();
        let least_rad = middle_rad - turning_rad - leaning * bounds.radius_rad;
        least_rad.max(0.0).sin()
    }
}

/// How far, metres across the line of sight, level ground seen at a slant displaces the outline of a reach
/// that is measured on the screen.
///
/// Parallel lines of sight show a circle of radius r on the ground as an ellipse with half axes r and r sin e.
/// What is within r of a boundary therefore holds all that appears within r sin e of it, and nothing that
/// appears farther than r. So does what is drawn: whichever chord is nearest on the screen, its metres show
/// as between sin e and 1 of a metre across the line of sight. Between the two outlines lie r (1 − sin e) at
/// most, whatever the boundary's shape; corners need that much.
fn aslant_m(reach_m: f64, least_sine: f64) -> f64 {
    reach_m * (1.0 - least_sine)
}

/// The same for scales that are not those at the chord's start, up to `span_m` away: metres appear smaller in
/// proportion to the distance, in themselves and as the chord's direction from the view axis changes, and
/// ground that is curved turns from its tangent plane. First order in `span_m` over either radius.
fn uneven_m(reach_m: f64, span_m: f64, nearness: f64, curvature: f64) -> f64 {
    reach_m * span_m * (2.0 * nearness + curvature)
}

impl EdgeDraws {
    pub(crate) fn runs(&self, input: EdgeInput) -> &[Range<u32>] {
        match input {
            EdgeInput::Chords => &self.chords,
            EdgeInput::Segments => &self.segments,
            EdgeInput::Flat => &self.flat,
        }
    }

    /// The instances of a run: a chord to each slot but the last, or a piece each.
    pub(crate) fn chords_of(&self, input: EdgeInput, run: &Range<u32>) -> Range<u32> {
        match input {
            EdgeInput::Segments => run.clone(),
            EdgeInput::Chords | EdgeInput::Flat => run.start..run.end - 1,
        }
    }
}

impl LayerEdges {
    fn reach_of(&self, arc: &Arc, layer: usize, shown: &[Option<PieceCode>]) -> Reach {
        let ids = [arc.left, arc.right].map(|side| {
            let code = side.and_then(|piece| shown[piece as usize]);
            code.filter(|code| code.layer == layer)
                .map_or(0, |code| id_of(&self.code, code.packed))
        });
        if ids[0] == ids[1] {
            return Reach::default();
        }
        let [a, b] = ids.map(|id| self.reaches[id as usize].map(f64::from));
        Reach {
            metres: a[0].max(b[0]),
            pixels: a[1].max(b[1]),
        }
    }
}

/// The id of a packed code; as in edge.wgsl.
fn id_of(code: &Code, packed: u32) -> u32 {
    packed.to_le_bytes()[..code.digits as usize]
        .iter()
        .rev()
        .fold(0, |id, &digit| id * code.base + u32::from(digit))
}

#[derive(Clone, Copy, Debug, Default)]
struct Reach {
    metres: f64,
    pixels: f64,
}

impl Reach {
    /// Whether some of what lies within reach of `bounds` may be seen.
    fn is_seen(self, bounds: &Bounds, sight: &Sight) -> bool {
        if self.metres.max(self.pixels) <= 0.0 {
            return false;
        }
        let (middle_m, radius_m) = sight.sphere(bounds);
        let radius_m = radius_m + self.metres;
        // On the screen, beside the picture: whatever the slant of the ground.
        let pixel_m = LARGEST_PIXEL * sight.pixel.at_m(middle_m.length() + radius_m);
        let margin_m = radius_m + (self.pixels + 1.0) * pixel_m;
        if sight.outside_m(middle_m) > margin_m {
            return false;
        }
        // On the ground: at the horizon pixels reach as far as it is curved.
        let radius_m = sight.ellipsoid.b_m;
        let falling_m = (2.0 * (self.pixels + 1.0) * pixel_m * radius_m).sqrt();
        let widened = Bounds {
            radius_rad: bounds.radius_rad + 1.1 * (self.metres + falling_m) / radius_m,
            ..*bounds
        };
        !sight.beyond_horizon(&widened)
    }
}

/// Every boundary slot, and how far along its arc it lies by the chords, which are shorter than the true
/// edge by less than 3·10⁻⁶ where they are as close to it as 5 m a 16 km.
pub(crate) fn edge_slots(mesh: &FillMesh) -> Vec<EdgeSlot> {
    let mut slots = Vec::with_capacity(mesh.boundary.len() + mesh.arcs.len());
    for (index, arc) in (0..).zip(&mesh.arcs) {
        let first = arc.first_vertex as usize;
        let mut along_m = 0.0;
        let mut last_m = mesh.vertices[first];
        for &vertex_m in &mesh.vertices[first..first + arc.vertex_count as usize] {
            along_m += vertex_m.distance(last_m);
            last_m = vertex_m;
            slots.push(EdgeSlot {
                arc: index,
                along: (along_m * STEPS_PER_M).round() as u32,
            });
        }
        // The last vertex starts no chord, nor does the break.
        if let Some(last) = slots.last_mut() {
            last.arc = EdgeSlot::NO_CHORD;
        }
        slots.push(EdgeSlot {
            arc: EdgeSlot::NO_CHORD,
            along: 0,
        });
    }
    slots
}

#[cfg(all(test, feature = "countries"))]
mod tests;
