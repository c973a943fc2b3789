//! Which boundaries the edge pass draws, and the pieces of those that were refined.

use std::ops::Range;

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
    /// By arc: whether it is measured on the screen.
    flat: Vec<bool>,
}

/// Chords that are measured on the screen span no more than this share of their distance.
const FLAT_SHARE: f64 = 0.25;

impl ArcEdges {
    pub(crate) fn new(
        mesh: &FillMesh,
        shown: &[Option<PieceCode>],
        sight: &Sight,
        wants: &EdgeWants<'_>,
    ) -> Self {
        let in_layer = |(layer, edges): (usize, &Option<LayerEdges>)| match edges {
            Some(edges) => mesh
                .arcs
                .iter()
                .map(|arc| {
                    edges
                        .reach_of(arc, layer, shown)
                        .is_seen(&arc.bounds, sight)
                })
                .collect(),
            None => Vec::new(),
        };
        let wanted: Vec<Vec<bool>> = wants.layers.iter().enumerate().map(in_layer).collect();
        let any = |arc: usize| wanted.iter().any(|arcs| arcs.get(arc) == Some(&true));
        let flat = |(index, arc)| any(index) && is_flat(mesh, arc, sight);
        Self {
            flat: mesh.arcs.iter().enumerate().map(flat).collect(),
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

/// Whether relief and sag show less than the pixel budget: half the relief, since the screen shows chords
/// half way up, and the most that a chord lies below the ellipsoid.
fn is_flat(mesh: &FillMesh, arc: &Arc, sight: &Sight) -> bool {
    let distance_m = sight.distance_to_m(&arc.bounds);
    let budget_m = sight.tolerance_m(distance_m);
    let half_relief_m = 0.5 * (sight.surface_m.1 - sight.surface_m.0);
    let first = arc.first_vertex as usize;
    let chords = mesh.vertices[first..first + arc.vertex_count as usize].windows(2);
    let longest_squared = chords
        .map(|ends| ends[0].distance_squared(ends[1]))
        .fold(0.0, f64::max);
    let sag_m = longest_squared / (8.0 * mesh.ellipsoid.b_m);
    // Parallel lines of sight show all of a chord at one scale.
    let level = sight.parallel || longest_squared.sqrt() <= FLAT_SHARE * distance_m;
    half_relief_m + sag_m <= budget_m && level
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
mod tests {
    use glam::{DMat3, DMat4, DVec4, UVec2};

    use super::*;
    use crate::{
        Ellipsoid, FillStyle, LonLat, MeshOptions,
        countries::Dataset,
        frame::{
            code::Mantissa,
            edge_segments::EdgeSegment,
            layers::{Counting, FillOf, Layering, Styled},
            refine::RefinedChord,
            select::{Selection, slot},
        },
        gpu::fixed_point::{FixedVertex, encode},
        options::{Camera, Frame, RendererOptions},
    };

    fn countries() -> FillMesh {
        let countries = Dataset::Countries110m.countries();
        let regions: Vec<_> = countries.into_iter().map(|c| c.region).collect();
        FillMesh::build(&regions, &MeshOptions::default()).expect("embedded data is sound")
    }

    fn looking_down(mesh: &FillMesh, at: LonLat, height_m: f64) -> Sight {
        let up = Ellipsoid::WGS84.normal(at);
        let right = up.any_orthonormal_vector();
        let scale = 1.0 / 30f64.to_radians().tan();
        let camera = Camera {
            eye_ecef_m: Ellipsoid::WGS84.ecef(at, height_m),
            view_from_ecef: DMat3::from_cols(right, up.cross(right), up).transpose(),
            clip_from_view: DMat4::from_cols(
                DVec4::new(scale, 0.0, 0.0, 0.0),
                DVec4::new(0.0, scale, 0.0, 0.0),
                DVec4::new(0.0, 0.0, 0.0, -1.0),
                DVec4::new(0.0, 0.0, 0.1 * height_m, 0.0),
            ),
        };
        let frame = Frame {
            pixel_error: 0.0,
            ..Frame::new(camera, UVec2::splat(720))
        };
        Sight::new(
            mesh.ellipsoid,
            mesh.sag_m,
            &frame,
            &RendererOptions::default(),
        )
        .expect("valid")
    }

    /// Every chord of an arc that is drawn is drawn once: as it is stored, or as pieces that lead from its
    /// first vertex to its last. Chords of arcs that ask for no edges are not drawn.
    #[test]
    fn chords_and_pieces_cover_each_arc_once() {
        let mesh = countries();
        let styles = vec![FillStyle::default(); mesh.fills.len()];
        let styled = [Styled {
            mesh: &mesh,
            styles: &styles,
        }];
        let layering =
            Layering::assign(&styled, Counting::Winding, Mantissa::Single).expect("fits");
        let slots = edge_slots(&mesh);
        let layers: Vec<_> = layering
            .layers
            .iter()
            .map(|layer| {
                // Every third fill asks for edges.
                let asks = |of: &FillOf| [0.0, if of.fill.is_multiple_of(3) { 4.0 } else { 0.0 }];
                let nothing = std::iter::once([0.0; 2]);
                Some(LayerEdges {
                    code: layer.code,
                    reaches: nothing.chain(layer.fills.iter().map(asks)).collect(),
                })
            })
            .collect();
        let wants = EdgeWants {
            layers: &layers,
            slots: &slots,
        };
        let (mut stored, mut refined, mut left_out) = (0, 0, 0);
        for (at, height_m) in [
            (LonLat::new(10.0, 50.0), 2e7),
            (LonLat::new(13.0, 48.5), 5e4),
            (LonLat::new(6.8, 49.2), 1_000.0),
        ] {
            let sight = looking_down(&mesh, at, height_m);
            let codes = &layering.codes[0];
            let selection = Selection::of(&mesh, layering.coded(0), &sight, &wants);
            let shown: Vec<_> = codes
                .iter()
                .zip(&mesh.pieces)
                .map(|(code, piece)| code.filter(|_| !sight.beyond_horizon(&piece.bounds)))
                .collect();
            let edges = ArcEdges::new(&mesh, &shown, &sight, &wants);
            for (layer, draws) in selection.layers.iter().enumerate() {
                for (index, arc) in mesh.arcs.iter().enumerate() {
                    for vertex in arc.first_vertex..arc.first_vertex + arc.vertex_count - 1 {
                        let first = slot(index as u32, vertex);
                        let as_stored = (draws.edges.chords.iter().chain(&draws.edges.flat))
                            .filter(|run| run.start <= first && first + 1 < run.end)
                            .count();
                        let of_chord = |chord: &&RefinedChord| {
                            (chord.arc, chord.vertex) == (index as u32, vertex)
                        };
                        let pieces = selection.patch.chords.iter().position(|c| of_chord(&c));
                        let as_pieces = pieces.map_or(0, |chord| {
                            let starts = &selection.segments.starts;
                            let range = starts[chord] as usize..starts[chord + 1] as usize;
                            let runs = draws.edges.segments.iter();
                            let drawn = runs.filter(|run| {
                                !range.is_empty() && run.contains(&(range.start as u32))
                            });
                            let drawn = drawn.count();
                            if drawn > 0 {
                                let ends = [vertex, vertex + 1]
                                    .map(|vertex| encode(mesh.vertices[vertex as usize]));
                                let places =
                                    [first, first + 1].map(|slot| slots[slot as usize].along);
                                assert_leads(&selection.segments.pieces[range], ends, places);
                            }
                            drawn
                        });
                        let asked = usize::from(edges.wanted(layer, index));
                        assert_eq!(as_stored + as_pieces, asked, "arc {index}, {height_m} m");
                        stored += as_stored;
                        refined += as_pieces;
                        left_out += 1 - asked;
                    }
                }
            }
        }
        assert!(
            stored > 100 && refined > 0 && left_out > 100,
            "{stored} {refined} {left_out}"
        );
    }

    fn assert_leads(pieces: &[EdgeSegment], ends: [FixedVertex; 2], places: [u32; 2]) {
        assert_eq!(pieces[0].ends[0], ends[0]);
        assert_eq!(pieces[pieces.len() - 1].ends[1], ends[1]);
        assert_eq!(pieces[0].along[0], places[0]);
        assert_eq!(pieces[pieces.len() - 1].along[1], places[1]);
        for pair in pieces.windows(2) {
            assert_eq!(pair[0].ends[1], pair[1].ends[0]);
            assert_eq!(pair[0].along[1], pair[1].along[0]);
            assert!(pair[0].along[0] <= pair[0].along[1]);
        }
    }
}
