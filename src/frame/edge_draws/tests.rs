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
    let layering = Layering::assign(&styled, Counting::Winding, Mantissa::Single).expect("fits");
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
                    let of_chord =
                        |chord: &&RefinedChord| (chord.arc, chord.vertex) == (index as u32, vertex);
                    let pieces = selection.patch.chords.iter().position(|c| of_chord(&c));
                    let as_pieces = pieces.map_or(0, |chord| {
                        let starts = &selection.segments.starts;
                        let range = starts[chord] as usize..starts[chord + 1] as usize;
                        let runs = draws.edges.segments.iter();
                        let drawn = runs
                            .filter(|run| !range.is_empty() && run.contains(&(range.start as u32)));
                        let drawn = drawn.count();
                        if drawn > 0 {
                            let ends = [vertex, vertex + 1]
                                .map(|vertex| encode(mesh.vertices[vertex as usize]));
                            let places = [first, first + 1].map(|slot| slots[slot as usize].along);
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

/// Looking along the ground and at the whole globe: no point of an arc is seen at less.
#[test]
fn no_vertex_is_seen_at_less_than_the_least_sine() {
    let mesh = countries();
    let (mut seen, mut tight) = (0, 0.0_f64);
    for height_m in [1e3, 1e5, 2e6, 3e7, 4e8] {
        let sight = looking_down(&mesh, LonLat::new(13.0, 48.5), height_m);
        for arc in &mesh.arcs {
            let least = sight.least_sine(&arc.bounds);
            let first = arc.first_vertex as usize;
            for &vertex_m in &mesh.vertices[first..first + arc.vertex_count as usize] {
                let to_eye = (sight.eye_ecef_m - vertex_m).normalize();
                let sine = to_eye.dot(mesh.ellipsoid.normal_at_surface(vertex_m));
                assert!(
                    sine.max(0.0) >= least - 1e-12,
                    "{height_m} m: {sine} < {least}"
                );
                seen += usize::from(least > 0.1);
                tight = tight.max(least / sine.max(1e-9));
            }
        }
    }
    assert!(seen > 1000 && tight > 0.99, "{seen} {tight}");
}

/// From 4 000 km at 6.4 km a pixel: as pixels strokes of any width are measured on the screen; as metres only
/// narrow ones right below the eye, where a metre appears alike in all directions.
#[test]
fn reaches_in_metres_are_measured_on_the_screen_only_from_straight_above() {
    let mesh = countries();
    let codes = Layering::assign(
        &[Styled {
            mesh: &mesh,
            styles: &vec![FillStyle::default(); mesh.fills.len()],
        }],
        Counting::Winding,
        Mantissa::Single,
    )
    .expect("fits");
    let slots = edge_slots(&mesh);
    let mut sight = looking_down(&mesh, LonLat::new(8.0, 49.5), 4e6);
    sight.pixel_error = 0.25;
    let flat = |reach: [f32; 2]| -> Vec<bool> {
        let layers: Vec<_> = (codes.layers.iter())
            .map(|layer| {
                let mut reaches = vec![reach; layer.fills.len() + 1];
                reaches[0] = [0.0; 2];
                Some(LayerEdges {
                    code: layer.code,
                    reaches,
                })
            })
            .collect();
        let wants = EdgeWants {
            layers: &layers,
            slots: &slots,
        };
        let edges = ArcEdges::new(&mesh, &codes.codes[0], &sight, &wants);
        (0..mesh.arcs.len()).map(|arc| edges.flat(arc)).collect()
    };
    let count = |flat: &[bool]| flat.iter().filter(|&&flat| flat).count();
    let pixels = flat([0.0, 40.0]);
    let [narrow, broad] = [3e3, 1e5].map(|metres| flat([metres, 0.0]));
    println!(
        "{} of {} arcs: {}, {}",
        count(&pixels),
        mesh.arcs.len(),
        count(&narrow),
        count(&broad)
    );
    assert!(count(&pixels) > count(&narrow) && count(&narrow) > 0);
    assert_eq!(count(&broad), 0);
    for (arc, _) in mesh.arcs.iter().zip(&narrow).filter(|(_, flat)| **flat) {
        let least = sight.least_sine(&arc.bounds);
        let budget_m = sight.tolerance_m(sight.distance_to_m(&arc.bounds));
        assert!(3e3 * (1.0 - least) <= budget_m, "{least}");
    }
}
