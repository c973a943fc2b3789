//! The camera as surface.wgsl reads it.

use glam::{DMat3, DVec3, UVec2, Vec4Swizzles as _};

use crate::{
    frame::lens::log_range, frame::reference::Reference, frame::sight::Sight,
    options::DepthConvention,
};

/// Pixels across a tile; as in tile.wgsl.
pub(crate) const TILE: u32 = 8;
/// Tiles across a block; as in tile.wgsl.
pub(crate) const BLOCK: u32 = 8;

/// What lies farther than this above or below the host's surface is none of it, metres.
const SLACK_M: f64 = 1000.0;

/// Sines of the angle between line of sight and surface below which pixels are taken to span no more:
/// at the limb, where their span is infinite, and on terrain, whose slopes face the eye.
const LIMB_SINE: f64 = 1e-4;
const SLOPE_SINE: f64 = 0.2;

/// `Sight` of surface.wgsl; see there.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct SightUniform {
    pub ray: [f32; 4],
    pub right: [f32; 4],
    pub down: [f32; 4],
    pub depth: [f32; 4],
    pub ellipsoid: [f32; 4],
    pub eye_gradient: [f32; 4],
    pub foot_gradient: [f32; 4],
    pub size: [u32; 4],
    pub tiles: [u32; 4],
    pub blocks: [u32; 4],
    pub counts: [u32; 4],
    pub bounds: [f32; 4],
    pub window: [f32; 4],
}

impl SightUniform {
    pub(crate) fn new(
        sight: &Sight,
        reference: &Reference,
        convention: DepthConvention,
        size_px: UVec2,
    ) -> Self {
        let rows = sight.clip_from_relative.transpose();
        let relative_from_clip =
            DMat3::from_cols(rows.x_axis.xyz(), rows.y_axis.xyz(), rows.z_axis.xyz())
                .transpose()
                .inverse();
        let size = size_px.as_dvec2();
        let [constant, slope] = sight.depth;
        // Parallel lines of sight have one that single precision holds.
        let whole = if sight.parallel {
            constant
        } else {
            constant.round()
        };
        let sky = match convention {
            DepthConvention::Reversed if sight.log_depth.is_none() => 0.0,
            _ => 1.0,
        };
        let depth = match &sight.log_depth {
            Some(log) => [log_range(log), 1.0 / log.per_m, log.from_m, sky],
            None => [constant - whole, slope, whole, sky],
        };
        let [behind_x, behind_y, behind_z] = (-sight.from_host_eye_m).to_array();
        let ellipsoid = &reference.ellipsoid;
        let ratio = ellipsoid.a_m / ellipsoid.b_m;
        let eye_gradient = reference.scaled(reference.eye_ecef_m) * (2.0 / ellipsoid.a_m);
        let foot_gradient = reference.scaled(reference.foot_ecef_m);
        let (lowest_m, highest_m) = (sight.surface_m.0 - SLACK_M, sight.surface_m.1 + SLACK_M);
        let bare = sight.surface_m.0 == sight.surface_m.1;
        let least_sine = if bare { LIMB_SINE } else { SLOPE_SINE };
        let tiles = divided(size_px, TILE);
        let counted = |grid: UVec2| [grid.x, grid.y, grid.element_product(), 0];
        Self {
            ray: padded(relative_from_clip.z_axis, behind_x),
            right: padded(relative_from_clip.x_axis * (2.0 / size.x), behind_y),
            down: padded(relative_from_clip.y_axis * (-2.0 / size.y), behind_z),
            depth: depth.map(|part| part as f32),
            ellipsoid: [ellipsoid.a_m, ratio * ratio, reference.tau, ellipsoid.b_m]
                .map(|part| part as f32),
            eye_gradient: padded(eye_gradient, reference.outside_m),
            foot_gradient: padded(foot_gradient, 0.0),
            size: [size_px.x, size_px.y, 0, 0],
            tiles: counted(tiles),
            blocks: counted(divided(tiles, BLOCK)),
            counts: [0; 4],
            window: [-1.0, -1.0, 1.0, 1.0],
            bounds: [lowest_m as f32, highest_m as f32, 0.0, least_sine as f32],
        }
    }
}

/// How many squares of `side` cover a grid, across and down.
pub(crate) fn divided(grid: UVec2, side: u32) -> UVec2 {
    UVec2::new(grid.x.div_ceil(side), grid.y.div_ceil(side))
}

/// A vector, and one number more.
pub(crate) fn padded(vector: DVec3, last: f64) -> [f32; 4] {
    vector.extend(last).as_vec4().to_array()
}
