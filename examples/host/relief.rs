//! Shaded relief: colours by height, lit from the north-west.

use glam::{DVec3, UVec2};

use super::{elevation::Elevation, picture::Picture};

/// Colours by height, metres and sRGB: sea floor, shelf, lowland, hills, rock, snow.
const TINTS: [(f64, [f64; 3]); 12] = [
    (-11_000.0, [8.0, 22.0, 58.0]),
    (-6_000.0, [16.0, 44.0, 94.0]),
    (-3_000.0, [28.0, 70.0, 128.0]),
    (-200.0, [66.0, 122.0, 170.0]),
    (0.0, [116.0, 168.0, 196.0]),
    (1.0, [104.0, 138.0, 88.0]),
    (400.0, [142.0, 158.0, 102.0]),
    (1_200.0, [182.0, 166.0, 118.0]),
    (2_500.0, [158.0, 130.0, 104.0]),
    (4_200.0, [168.0, 150.0, 134.0]),
    (5_400.0, [206.0, 202.0, 202.0]),
    (6_500.0, [246.0, 248.0, 252.0]),
];

/// Slopes look this many times steeper, or mountains would hardly show from afar.
const EXAGGERATION: f64 = 3.0;

/// A picture of the whole grid, one texel a node, thinned where `most_px` does not hold it.
pub fn picture(elevation: &Elevation, most_px: u32) -> Picture {
    let nodes = elevation.size();
    let stride = nodes.max_element().div_ceil(most_px);
    let size_px = (nodes - 1) / stride + 1;
    let mut rgba = Vec::with_capacity((size_px.x * size_px.y * 4) as usize);
    for row in 0..size_px.y {
        for column in 0..size_px.x {
            let color = node_color(elevation, column * stride, row * stride);
            rgba.extend(color.map(|channel| channel.round().clamp(0.0, 255.0) as u8));
            rgba.push(255);
        }
    }
    Picture { size_px, rgba }
}

fn node_color(elevation: &Elevation, column: u32, row: u32) -> [f64; 3] {
    let height_m = elevation.node_m(column, row);
    let light = hillshade(elevation, column, row);
    tint(height_m).map(|channel| channel * light)
}

fn tint(height_m: f64) -> [f64; 3] {
    let above = TINTS
        .partition_point(|(height, _)| *height < height_m)
        .clamp(1, TINTS.len() - 1);
    let ((low, from), (high, to)) = (TINTS[above - 1], TINTS[above]);
    let part = ((height_m - low) / (high - low)).clamp(0.0, 1.0);
    [0, 1, 2].map(|channel| from[channel] + (to[channel] - from[channel]) * part)
}

/// Brightness of a node, 1 on level ground.
fn hillshade(elevation: &Elevation, column: u32, row: u32) -> f64 {
    const METRES_PER_DEG: f64 = 111_320.0;
    let UVec2 {
        x: columns,
        y: rows,
    } = elevation.size();
    let (west, east) = (column.saturating_sub(1), (column + 1).min(columns - 1));
    let (north, south) = (row.saturating_sub(1), (row + 1).min(rows - 1));
    let (lon_step_deg, lat_step_deg) = elevation.step_deg();
    let shrink = elevation.row_lat_deg(row).to_radians().cos().max(0.05);
    let width_m = f64::from(east - west) * lon_step_deg * METRES_PER_DEG * shrink;
    let height_m = f64::from(south - north) * lat_step_deg * METRES_PER_DEG;
    let rise_east = (elevation.node_m(east, row) - elevation.node_m(west, row)) / width_m;
    let rise_north = (elevation.node_m(column, north) - elevation.node_m(column, south)) / height_m;
    // Steepness is compressed: a grid's steepest slopes would else be black or white.
    let steep = |rise: f64| (EXAGGERATION * rise * 4.0).tanh() * 0.9;
    let normal = DVec3::new(-steep(rise_east), -steep(rise_north), 1.0).normalize();
    let sun = DVec3::new(-1.0, 1.0, 1.4).normalize();
    0.35 + 0.65 * (normal.dot(sun) / sun.z).max(0.0)
}
