//! Cap triangles that lie together, so that parts of wide pieces can be left out.

use glam::DVec3;

use crate::{ellipsoid::Ellipsoid, fill_mesh::Bounds};

/// Most triangles of a chunk: enough for a draw to be worth its while.
const CHUNK: usize = 48;

/// Triangles of a chunk in a row.
pub(super) struct Chunk {
    pub(super) triangle_count: u32,
    pub(super) bounds: Bounds,
}

/// Sorts triangles so that those in a row lie together, and says where each row of them lies. One row does
/// for few.
pub(super) fn chunk(
    ellipsoid: &Ellipsoid,
    triangles: &mut [[u32; 3]],
    position: impl Fn(u32) -> DVec3 + Copy,
    margin_m: f64,
) -> Vec<Chunk> {
    if triangles.len() > 2 * CHUNK {
        let middle_of =
            |corners: &[u32; 3]| -> DVec3 { corners.iter().map(|&c| position(c)).sum() };
        let middles = triangles.iter().map(middle_of);
        let least = middles.clone().fold(DVec3::INFINITY, DVec3::min);
        let most = middles.fold(DVec3::NEG_INFINITY, DVec3::max);
        let scale = 1023.0 / (most - least).max_element().max(1e-9);
        triangles.sort_by_cached_key(|corners| along_curve((middle_of(corners) - least) * scale));
    }
    let rows = triangles.chunks(if triangles.len() > 2 * CHUNK {
        CHUNK
    } else {
        2 * CHUNK
    });
    let chunk = |row: &[[u32; 3]]| Chunk {
        triangle_count: row.len() as u32,
        bounds: Bounds::around(
            ellipsoid,
            row.iter().flatten().map(|&c| position(c)),
            margin_m,
        ),
    };
    rows.map(chunk).collect()
}

/// Where a point of 0 … 1023 lies on the curve of Morton, which visits octants one after the other.
fn along_curve(point: DVec3) -> u32 {
    let spread = |number: f64| {
        (0..10).fold(0, |bits, bit| {
            bits | (number as u32 >> bit & 1) << (3 * bit)
        })
    };
    spread(point.x) | spread(point.y) << 1 | spread(point.z) << 2
}
