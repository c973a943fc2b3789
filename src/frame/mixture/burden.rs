//! How much may be summed at a pixel: bounds for what is drawn, tile by tile of the picture.

use super::Mixture;
use crate::{
    fill_mesh::FillMesh, frame::select::LayerDraws, frame::sight::Sight, frame::window::Window,
};

/// Tiles along each side of the picture.
const TILES: usize = 16;
/// Rows have one more, which takes what ends at the picture's edge.
const ROW: usize = TILES + 1;

/// Numbers of faces, and the optical depths of them, that may lie over each tile.
#[derive(Clone, Debug)]
pub(crate) struct Burden {
    /// By tile: what begins there less what has ended, along rows and columns alike.
    changes: [(f64, f64); ROW * ROW],
}

impl Default for Burden {
    fn default() -> Self {
        Self {
            changes: [(0.0, 0.0); ROW * ROW],
        }
    }
}

impl Burden {
    /// Adds faces with so much optical depth altogether, of which none leaves the window.
    pub(crate) fn add(&mut self, window: Window, faces: f64, depth: f64) {
        let [least, greatest] = window.common(Window::FULL).corners();
        if least.cmpgt(greatest).any() {
            return;
        }
        // A rounding step of room on each side.
        let tile = |ndc: f64| ((0.5 * (ndc + 1.0) * TILES as f64) as usize).min(TILES - 1);
        let [left, below] = (least - 1e-4).to_array().map(tile);
        let [right, above] = (greatest + 1e-4).to_array().map(|ndc| tile(ndc) + 1);
        for (row, column, sign) in [
            (below, left, 1.0),
            (below, right, -1.0),
            (above, left, -1.0),
            (above, right, 1.0),
        ] {
            let change = &mut self.changes[row * ROW + column];
            change.0 += sign * faces;
            change.1 += sign * depth;
        }
    }

    /// Adds what is drawn of a mesh in the layer of a mixture.
    pub(crate) fn add_draws(
        &mut self,
        draws: &LayerDraws,
        mesh: &FillMesh,
        sight: &Sight,
        mixture: &Mixture,
    ) {
        let code_of = |side: Option<u32>| side.map_or(0, |piece| draws.codes[piece as usize + 1]);
        let mut add = |bounds, faces: usize, depth: f64| {
            if depth > 0.0 && !sight.outside_side_plane(bounds) {
                let faces = faces as f64;
                self.add(sight.window_of(bounds, 0.0), faces, faces * depth);
            }
        };
        for chunk in &mesh.cap_chunks {
            let depth = mixture.difference(code_of(Some(chunk.piece)), 0);
            add(&chunk.bounds, 2 * chunk.triangle_count as usize, depth);
        }
        let weight = |arc: usize| {
            let arc = &mesh.arcs[arc];
            mixture.difference(code_of(arc.left), code_of(arc.right))
        };
        for (index, arc) in mesh.arcs.iter().enumerate() {
            let faces = 2 * (arc.vertex_count as usize - 1);
            add(&arc.bounds, faces, weight(index));
        }
        for run in &draws.patches {
            let arc = run.arc as usize;
            add(&mesh.arcs[arc].bounds, run.indices.len() / 3, weight(arc));
        }
    }

    /// The most faces over a tile, and the most optical depth.
    pub(crate) fn most(&self) -> (f64, f64) {
        let mut above = [(0.0, 0.0); ROW];
        let mut most = (0.0_f64, 0.0_f64);
        for row in self.changes.chunks(ROW) {
            let mut here = (0.0, 0.0);
            for (above, change) in above.iter_mut().zip(row) {
                above.0 += change.0;
                above.1 += change.1;
                here.0 += above.0;
                here.1 += above.1;
                most = (most.0.max(here.0), most.1.max(here.1));
            }
        }
        most
    }
}

#[cfg(test)]
mod tests {
    use glam::{DMat4, DVec3};

    use super::*;

    /// A window of a lens that looks along −z.
    fn window(at: DVec3, radius_m: f64) -> Window {
        let mut lens = DMat4::IDENTITY;
        lens.z_axis.w = -1.0;
        lens.w_axis.w = 0.0;
        Window::of_sphere(&lens, at, radius_m)
    }

    /// What lies over points, one by one.
    #[test]
    fn no_pixel_has_more() {
        let spheres: Vec<(DVec3, f64, f64)> = (0..300)
            .map(|k| {
                let part = |step: f64| (f64::from(k) * step).fract();
                let at = DVec3::new(3.0 * part(0.618) - 1.5, 3.0 * part(0.414) - 1.5, -1.0);
                (at, 0.3 * part(0.732), 1.0 + f64::from(k % 7))
            })
            .collect();
        let mut burden = Burden::default();
        for &(at, radius_m, faces) in &spheres {
            burden.add(window(at, radius_m), faces, 0.5 * faces);
        }
        let (faces, depth) = burden.most();
        let mut found = 0.0_f64;
        for x in -50..=50 {
            for y in -50..=50 {
                let point = DVec3::new(f64::from(x) / 50.0, f64::from(y) / 50.0, -1.0);
                let over = spheres
                    .iter()
                    .filter(|(at, radius_m, _)| at.distance(point) < *radius_m);
                found = found.max(over.map(|&(_, _, faces)| faces).sum());
            }
        }
        assert!(faces >= found && (depth - 0.5 * faces).abs() < 1e-9);
        assert!(faces < 3.0 * found, "{faces} {found}");
    }

    #[test]
    fn what_is_beside_the_picture_adds_nothing() {
        let mut burden = Burden::default();
        burden.add(window(DVec3::new(3.0, 0.0, -1.0), 0.5), 9.0, 9.0);
        burden.add(Window::EMPTY, 9.0, 9.0);
        assert_eq!(burden.most(), (0.0, 0.0));
        burden.add(Window::FULL, 9.0, 4.0);
        assert_eq!(burden.most(), (9.0, 4.0));
    }
}
