//! How much may be summed at a pixel: bounds for what is drawn, tile by tile of what it takes of the picture.

use glam::DVec2;

use crate::{
    fill_mesh::FillMesh, frame::select::LayerDraws, frame::sight::Sight, frame::window::Window,
};

/// Tiles along each side of the window that holds all.
const TILES: usize = 32;
/// Rows have one more, which takes what ends at the window's edge.
const ROW: usize = TILES + 1;

/// Tiles are no smaller than a share of this, of a picture that is 2 wide: a pixel or more, of most pictures.
const LEAST_SIZE: f64 = 0.05;
/// How far, in tiles, what is drawn may reach beyond a window: more than 1/256 px.
const ROOM: f64 = 1e-2;

/// Faces that may lie over each other, with the windows that hold them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Burden {
    shares: Vec<Share>,
}

/// Some faces within a window, and the optical depth that each adds or takes.
#[derive(Clone, Copy, Debug)]
struct Share {
    corners: [DVec2; 2],
    faces: f64,
    depth: f64,
}

impl Burden {
    /// Adds faces of so much optical depth each, of which none leaves the window.
    pub(crate) fn add(&mut self, window: Window, faces: usize, depth: f64) {
        let corners = window.common(Window::FULL).corners();
        if corners[0].cmple(corners[1]).all() && depth > 0.0 {
            self.shares.push(Share {
                corners,
                faces: faces as f64,
                depth,
            });
        }
    }

    /// Adds what is drawn of a mesh in a layer. `difference` tells what a face adds between two codes.
    pub(crate) fn add_draws(
        &mut self,
        draws: &LayerDraws,
        mesh: &FillMesh,
        sight: &Sight,
        difference: impl Fn(u32, u32) -> f64,
    ) {
        let code_of = |side: Option<u32>| side.map_or(0, |piece| draws.codes[piece as usize + 1]);
        let mut add = |bounds, faces, depth| {
            if !sight.outside_side_plane(bounds) && !sight.is_flat_over(bounds) {
                self.add(sight.window_of(bounds, 0.0), faces, depth);
            }
        };
        for run in &draws.caps {
            for chunk in run.chunks(mesh) {
                let depth = difference(code_of(Some(chunk.piece)), 0);
                let faces = chunk.triangle_count as usize * run.instances().len();
                add(&chunk.bounds, faces, depth);
            }
        }
        let weight = |arc: usize| {
            let arc = &mesh.arcs[arc];
            difference(code_of(arc.left), code_of(arc.right))
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
        let least = |at: DVec2, share: &Share| at.min(share.corners[0]);
        let greatest = |at: DVec2, share: &Share| at.max(share.corners[1]);
        let from = self.shares.iter().fold(DVec2::INFINITY, least);
        let to = self.shares.iter().fold(DVec2::NEG_INFINITY, greatest);
        let per_tile = TILES as f64 / (to - from).max(DVec2::splat(LEAST_SIZE));
        // By tile: what begins there less what has ended, along rows and columns alike.
        let mut changes = vec![[DVec2::ZERO; ROW]; ROW];
        for share in &self.shares {
            // Rasterisers move vertices a little.
            let tile = |at: f64, room: f64| ((at + room).max(0.0) as usize).min(TILES - 1);
            let [left, below] = ((share.corners[0] - from) * per_tile)
                .to_array()
                .map(|at| tile(at, -ROOM));
            let [right, above] = ((share.corners[1] - from) * per_tile)
                .to_array()
                .map(|at| tile(at, ROOM) + 1);
            let added = DVec2::new(share.faces, share.faces * share.depth);
            changes[below][left] += added;
            changes[below][right] -= added;
            changes[above][left] -= added;
            changes[above][right] += added;
        }
        let mut columns = [DVec2::ZERO; ROW];
        let mut most = DVec2::ZERO;
        for row in changes {
            let mut here = DVec2::ZERO;
            for (column, change) in columns.iter_mut().zip(row) {
                *column += change;
                here += *column;
                most = most.max(here);
            }
        }
        most.into()
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
        for size in [1.0, 0.01] {
            let spheres: Vec<(DVec3, f64, usize)> = (0..300)
                .map(|k| {
                    let part = |step: f64| (f64::from(k) * step).fract();
                    let (x, y) = (3.0 * part(0.618) - 1.5, 3.0 * part(0.414) - 1.5);
                    let at = DVec3::new(size * x, size * y, -1.0);
                    (at, size * 0.3 * part(0.732), 1 + k as usize % 7)
                })
                .collect();
            let mut burden = Burden::default();
            for &(at, radius_m, faces) in &spheres {
                burden.add(window(at, radius_m), faces, 0.5);
            }
            let (faces, depth) = burden.most();
            let mut found = 0;
            for x in -50..=50 {
                for y in -50..=50 {
                    let (x, y) = (size * f64::from(x) / 50.0, size * f64::from(y) / 50.0);
                    let over = spheres.iter().filter(|(at, radius_m, _)| {
                        at.distance(DVec3::new(x, y, -1.0)) < *radius_m
                    });
                    found = found.max(over.map(|&(_, _, faces)| faces).sum());
                }
            }
            let found = found as f64;
            assert!(faces >= found && (depth - 0.5 * faces).abs() < 1e-9);
            assert!(faces < 2.5 * found, "{faces} {found}");
        }
    }

    #[test]
    fn what_is_beside_the_picture_adds_nothing() {
        let mut burden = Burden::default();
        burden.add(window(DVec3::new(3.0, 0.0, -1.0), 0.5), 9, 1.0);
        burden.add(Window::EMPTY, 9, 1.0);
        assert_eq!(burden.most(), (0.0, 0.0));
        burden.add(Window::FULL, 9, 0.5);
        assert_eq!(burden.most(), (9.0, 4.5));
    }
}
