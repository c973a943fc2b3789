//! What layers take of the picture.

use std::collections::BTreeMap;

use super::{MeshId, Resident, prepare::Selected};
use crate::frame::window::Window;

/// What may be seen of the surface within `reach_m` of what is drawn in a layer.
pub(super) fn layer_window(
    meshes: &BTreeMap<MeshId, Resident>,
    selections: &[Selected],
    layer: usize,
    reach_m: f64,
) -> Window {
    let windows = selections
        .iter()
        .map(|selected| mesh_window(meshes, selected, layer, reach_m));
    windows.fold(Window::EMPTY, Window::joined)
}

fn mesh_window(
    meshes: &BTreeMap<MeshId, Resident>,
    selected: &Selected,
    layer: usize,
    reach_m: f64,
) -> Window {
    let sight = &selected.sight;
    let codes = &selected.selection.layers[layer].codes[1..];
    let pieces = meshes[&selected.id].mesh.pieces.iter().zip(codes);
    let mut window = Window::EMPTY;
    for (piece, _) in pieces.filter(|&(_, &code)| code != 0) {
        let reached = sight.window_of(&piece.bounds, reach_m);
        // One that reaches behind the eye may be all the same beside the picture.
        if !reached.is_full() || reach_m > 0.0 || !sight.outside_side_plane(&piece.bounds) {
            window = window.joined(reached);
        }
        if window.is_full() {
            break;
        }
    }
    window.common(sight.globe_window())
}
