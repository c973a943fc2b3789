//! The terrain as triangles: eye-relative vertices of every tile that can be seen.

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3};
use globefill::{Ellipsoid, HeightRange, LonLat};
use rayon::prelude::*;

use super::{
    camera::Eye,
    elevation::Elevation,
    tiles::{CELLS, Cover, Side, Tile},
};

/// Coarsest level drawn.
const COARSEST: u32 = 2;

/// A tile is split until its width is at most this part of its distance.
const WIDTH_PER_DISTANCE: f64 = 1.0;

/// Single-precision vertices, depth values and their interpolation may err by this part of the distance.
const ROUNDING: f64 = 1e-6;

/// `Vertex` of `terrain.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct TerrainVertex {
    pub relative_m: [f32; 3],
    pub place: [f32; 2],
}

/// The vertices of one tile, row after row from the south-west corner.
pub struct TileMesh {
    pub vertices: Vec<TerrainVertex>,
    /// Sides to stitch: see [`indices`].
    pub coarser_sides: u32,
}

/// Everything of the terrain that one camera can see.
pub struct TerrainMesh {
    pub tiles: Vec<TileMesh>,
    /// Between which heights all of it lies.
    pub heights: HeightRange,
}

impl TerrainMesh {
    pub fn new(ellipsoid: &Ellipsoid, elevation: &Elevation, eye: &Eye) -> Self {
        let surface = Surface {
            ellipsoid,
            elevation,
            eye,
        };
        let cover = Cover::new(|tile| surface.is_too_large(tile));
        let drawn: Vec<_> = cover
            .tiles()
            .into_par_iter()
            .filter_map(|(tile, coarser_sides)| surface.mesh(&tile, coarser_sides))
            .collect();
        let bare = HeightRange::default();
        let heights = drawn
            .iter()
            .map(|(_, heights)| *heights)
            .reduce(union)
            .unwrap_or(bare);
        Self {
            tiles: drawn.into_iter().map(|(mesh, _)| mesh).collect(),
            heights,
        }
    }
}

fn union(a: HeightRange, b: HeightRange) -> HeightRange {
    HeightRange {
        min_m: a.min_m.min(b.min_m),
        max_m: a.max_m.max(b.max_m),
    }
}

struct Surface<'a> {
    ellipsoid: &'a Ellipsoid,
    elevation: &'a Elevation,
    eye: &'a Eye,
}

impl Surface<'_> {
    /// Height and position relative to the eye, metres.
    fn point(&self, position: LonLat) -> (f64, DVec3) {
        let position = position.canonical();
        let height_m = self.elevation.height_m(position);
        let ecef_m = self.ellipsoid.ecef(position, height_m);
        (height_m, ecef_m - self.eye.camera.eye_ecef_m)
    }

    fn is_too_large(&self, tile: &Tile) -> bool {
        if tile.level < COARSEST {
            return true;
        }
        let corners: Vec<DVec3> = [0, CELLS / 2, CELLS]
            .into_iter()
            .flat_map(|y| [0, CELLS / 2, CELLS].map(|x| self.point(tile.vertex(x, y)).1))
            .collect();
        let middle = corners[4];
        let radius_m = corners
            .iter()
            .map(|corner| corner.distance(middle))
            .fold(0.0, f64::max);
        let distance_m = (middle.length() - radius_m).max(0.0);
        self.width_m(tile) > WIDTH_PER_DISTANCE * distance_m
    }

    fn width_m(&self, tile: &Tile) -> f64 {
        tile.span_deg().to_radians() * self.ellipsoid.a_m
    }

    /// The tile's vertices and heights, if any of it can be seen.
    fn mesh(&self, tile: &Tile, coarser_sides: u32) -> Option<(TileMesh, HeightRange)> {
        let middle_lon_deg = tile.vertex(CELLS / 2, CELLS / 2).lon_deg;
        let count = (CELLS + 1) as usize;
        let mut vertices = Vec::with_capacity(count * count);
        let mut points = Vec::with_capacity(count * count);
        let mut heights = HeightRange {
            min_m: f64::MAX,
            max_m: f64::MIN,
        };
        let mut farthest_m = 0.0_f64;
        for y in 0..=CELLS {
            for x in 0..=CELLS {
                let position = tile.vertex(x, y);
                let (height_m, relative_m) = self.point(position);
                let (u, v) = self.elevation.place(position, middle_lon_deg);
                heights = union(
                    heights,
                    HeightRange {
                        min_m: height_m,
                        max_m: height_m,
                    },
                );
                farthest_m = farthest_m.max(relative_m.length());
                points.push(relative_m);
                vertices.push(TerrainVertex {
                    relative_m: relative_m.as_vec3().to_array(),
                    place: DVec2::new(u, v).as_vec2().to_array(),
                });
            }
        }
        if self.is_outside_picture(&points) || self.is_behind_horizon(&points) {
            return None;
        }
        // A triangle of a stitched side has a circumradius of √5/2 cells; it sags by that squared
        // over twice the earth's radius, at least 6 335 km.
        let cell_m = self.width_m(tile) / f64::from(CELLS);
        let sag_m = 0.7 * cell_m * cell_m / self.ellipsoid.b_m;
        let rounding_m = ROUNDING * farthest_m;
        heights.min_m -= sag_m + rounding_m;
        heights.max_m += rounding_m;
        Some((
            TileMesh {
                vertices,
                coarser_sides,
            },
            heights,
        ))
    }

    /// Whether all points lie beyond one side of the picture.
    fn is_outside_picture(&self, points: &[DVec3]) -> bool {
        let half = self.eye.half_extent;
        let sides = [
            DVec3::new(1.0, 0.0, half.x),
            DVec3::new(-1.0, 0.0, half.x),
            DVec3::new(0.0, 1.0, half.y),
            DVec3::new(0.0, -1.0, half.y),
            DVec3::new(0.0, 0.0, 1.0),
        ];
        let ecef_from_view = self.eye.camera.view_from_ecef.transpose();
        sides.iter().any(|side| {
            let outward = ecef_from_view * *side;
            points.iter().all(|point| point.dot(outward) > 0.0)
        })
    }

    /// Whether all points are hidden by an ellipsoid that lies below all terrain.
    fn is_behind_horizon(&self, points: &[DVec3]) -> bool {
        const BELOW_ALL_M: f64 = 30e3;
        let scale = DVec3::ONE / (self.ellipsoid.radii_m() - BELOW_ALL_M);
        let eye = self.eye.camera.eye_ecef_m * scale;
        let tangent_squared = eye.length_squared() - 1.0;
        points.iter().all(|point| {
            let ray = *point * scale;
            let toward = -ray.dot(eye);
            toward > tangent_squared && toward * toward > tangent_squared * ray.length_squared()
        })
    }
}

/// Triangles of a tile for a mask of coarser sides: there every other vertex is left out, so that
/// both tiles draw the same edges and no crack can open.
pub fn indices(coarser_sides: u32) -> Vec<u16> {
    let is_coarser = |side: Side| coarser_sides & side as u32 != 0;
    let vertex = |mut x: u32, mut y: u32| {
        let on_coarser_row =
            (y == 0 && is_coarser(Side::South)) || (y == CELLS && is_coarser(Side::North));
        let on_coarser_column =
            (x == 0 && is_coarser(Side::West)) || (x == CELLS && is_coarser(Side::East));
        if on_coarser_row {
            x &= !1;
        }
        if on_coarser_column {
            y &= !1;
        }
        (y * (CELLS + 1) + x) as u16
    };
    let mut indices = Vec::with_capacity((CELLS * CELLS * 6) as usize);
    for y in 0..CELLS {
        for x in 0..CELLS {
            let [sw, se, ne, nw] = [
                vertex(x, y),
                vertex(x + 1, y),
                vertex(x + 1, y + 1),
                vertex(x, y + 1),
            ];
            for [a, b, c] in [[sw, se, ne], [sw, ne, nw]] {
                if a != b && b != c && c != a {
                    indices.extend([a, b, c]);
                }
            }
        }
    }
    indices
}
