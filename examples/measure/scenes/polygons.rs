//! Regions that are made up.

use std::f64::consts::TAU;

use globefill::{EdgeKind, Inside, LonLat, Polygon, Region, Ring};

const VERTICES_OF_CIRCLE: usize = 64;
/// Columns of rough rings, the south-western corner of all, and the distance from ring to ring, degrees.
const COLUMNS: usize = 5;
const CORNER: LonLat = LonLat::new(1.0, 41.0);
const CELL_DEG: f64 = 3.0;

/// Circles as people who have only polygons draw them.
pub fn circles(middles: &[LonLat], radius_deg: f64) -> Vec<Region> {
    middles
        .iter()
        .map(|&middle| region(circle(middle, radius_deg), EdgeKind::Geodesic))
        .collect()
}

/// Counter-clockwise, on the sphere.
fn circle(middle: LonLat, radius_deg: f64) -> Ring {
    let (sin_lat, cos_lat) = middle.lat_deg.to_radians().sin_cos();
    let (sin_radius, cos_radius) = radius_deg.to_radians().sin_cos();
    let vertex = |index: usize| {
        let (sin, cos) = (TAU * index as f64 / VERTICES_OF_CIRCLE as f64).sin_cos();
        let sine = sin_lat * cos_radius + cos_lat * sin_radius * sin;
        let east = (sin_radius * cos * cos_lat).atan2(cos_radius - sin_lat * sine);
        LonLat::new(middle.lon_deg + east.to_degrees(), sine.asin().to_degrees())
    };
    (0..VERTICES_OF_CIRCLE).map(vertex).collect()
}

/// Stars that are rough at all scales like coasts, in rows; `vertices` altogether.
pub fn rough_rings(rings: usize, vertices: usize) -> Vec<Region> {
    (0..rings)
        .map(|ring| {
            let (column, row) = ((ring % COLUMNS) as f64, (ring / COLUMNS) as f64);
            let middle = LonLat::new(
                CORNER.lon_deg + (column + 0.5) * CELL_DEG,
                CORNER.lat_deg + (row + 0.5) * CELL_DEG,
            );
            let own = vertices * (ring + 1) / rings - vertices * ring / rings;
            region(rough_ring(middle, ring, own), EdgeKind::Straight)
        })
        .collect()
}

/// A sum of waves, each twice as many as the last and 0.6 times as high: it stays within its cell.
fn rough_ring(middle: LonLat, seed: usize, vertices: usize) -> Ring {
    let octaves = (vertices / 4).max(2).ilog2();
    let vertex = |index: usize| {
        let angle = TAU * index as f64 / vertices as f64;
        let wave = |octave: u32| {
            let phase = (seed as f64 + 1.0) * f64::from(octave + 1) * 2.399_963;
            0.2 * 0.6_f64.powi(octave as i32) * (f64::from(1 << octave) * angle + phase).sin()
        };
        let radius_deg = 0.3 * CELL_DEG * (1.0 + (0..=octaves).map(wave).sum::<f64>());
        let (sin, cos) = angle.sin_cos();
        LonLat::new(
            middle.lon_deg + radius_deg * cos,
            middle.lat_deg + radius_deg * sin,
        )
    };
    (0..vertices).map(vertex).collect()
}

fn region(shell: Ring, edges: EdgeKind) -> Region {
    let holes = Vec::new();
    Region {
        polygons: vec![Polygon { shell, holes }],
        edges,
        inside: Inside::Smaller,
        zones: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the spherical law of cosines, from the middle.
    #[test]
    fn vertices_of_circles_are_equally_far() {
        for middle in [
            LonLat::new(10.0, 20.0),
            LonLat::new(179.0, -85.0),
            LonLat::new(0.0, 0.0),
        ] {
            for vertex in circle(middle, 12.0) {
                let [a, b] = [middle.lat_deg, vertex.lat_deg].map(f64::to_radians);
                let apart = (vertex.lon_deg - middle.lon_deg).to_radians();
                let cosine = a.sin() * b.sin() + a.cos() * b.cos() * apart.cos();
                assert!((cosine.acos().to_degrees() - 12.0).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn rough_rings_stay_in_their_cells() {
        for (index, region) in rough_rings(20, 20_000).iter().enumerate() {
            let west = CORNER.lon_deg + (index % COLUMNS) as f64 * CELL_DEG;
            let south = CORNER.lat_deg + (index / COLUMNS) as f64 * CELL_DEG;
            for vertex in &region.polygons[0].shell {
                assert!((west..west + CELL_DEG).contains(&vertex.lon_deg));
                assert!((south..south + CELL_DEG).contains(&vertex.lat_deg));
            }
        }
    }
}
