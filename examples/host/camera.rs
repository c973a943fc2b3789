//! The camera: where it stands, how it looks, and what its depth values mean.

use std::str::FromStr;

use glam::{DMat3, DMat4, DVec2, DVec3, UVec2};
use globefill::{Camera, DepthConvention, Ellipsoid, LonLat};

use super::elevation::Elevation;

/// Lowest camera height above the ellipsoid, metres: a little below the deepest sea floor.
const LOWEST_HEIGHT_M: f64 = -12_000.0;
/// Highest camera height, metres; beyond it single-precision depth means little.
const GREATEST_HEIGHT_M: f64 = 1e10;

/// Where the camera stands and where it looks, as `--camera` gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    pub foot: LonLat,
    /// Above the ellipsoid, along its normal.
    pub height_m: f64,
    /// Clockwise from north.
    pub heading_deg: f64,
    /// −90 looks straight down, 0 at the horizontal plane, 90 straight up.
    pub pitch_deg: f64,
}

impl FromStr for Viewpoint {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Vec<f64> = text
            .split(',')
            .map(|word| {
                word.trim()
                    .parse::<f64>()
                    .map_err(|e| format!("{word:?}: {e}"))
            })
            .collect::<Result<_, _>>()?;
        let (lon_deg, lat_deg, height_m, heading_deg, pitch_deg) = match numbers[..] {
            [lon, lat, height] => (lon, lat, height, 0.0, -90.0),
            [lon, lat, height, heading, pitch] => (lon, lat, height, heading, pitch),
            _ => {
                return Err(
                    "expected LON,LAT,HEIGHT_M or LON,LAT,HEIGHT_M,HEADING_DEG,PITCH_DEG".into(),
                );
            }
        };
        if numbers.iter().any(|number| !number.is_finite()) {
            return Err("every number must be finite".into());
        }
        if lat_deg.abs() > 90.0 {
            return Err(format!("latitude {lat_deg} is beyond ±90"));
        }
        if !(LOWEST_HEIGHT_M..=GREATEST_HEIGHT_M).contains(&height_m) {
            return Err(format!(
                "height {height_m} m is not within {LOWEST_HEIGHT_M} … {GREATEST_HEIGHT_M:e} m"
            ));
        }
        if pitch_deg.abs() > 90.0 {
            return Err(format!("pitch {pitch_deg} is beyond ±90"));
        }
        Ok(Self {
            foot: LonLat::new(lon_deg, lat_deg),
            height_m,
            heading_deg,
            pitch_deg,
        })
    }
}

impl Viewpoint {
    /// Rotation from ECEF to view axes (x right, y up, looking along −z).
    fn view_from_ecef(&self) -> DMat3 {
        let (sin_lon, cos_lon) = self.foot.lon_deg.to_radians().sin_cos();
        let (sin_lat, cos_lat) = self.foot.lat_deg.to_radians().sin_cos();
        let (sin_heading, cos_heading) = self.heading_deg.to_radians().sin_cos();
        let (sin_pitch, cos_pitch) = self.pitch_deg.to_radians().sin_cos();
        let east = DVec3::new(-sin_lon, cos_lon, 0.0);
        let north = DVec3::new(-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat);
        let up = DVec3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat);
        let level = sin_heading * east + cos_heading * north;
        let right = cos_heading * east - sin_heading * north;
        let forward = cos_pitch * level + sin_pitch * up;
        DMat3::from_cols(right, right.cross(forward), -forward).transpose()
    }
}

/// Picture size, field of view and depth convention.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shot {
    /// Vertical field of view.
    pub fov_deg: f64,
    pub size_px: UVec2,
    pub depth: DepthConvention,
}

/// A shot with its depth range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Vertical field of view.
    pub fov_deg: f64,
    pub size_px: UVec2,
    pub depth: DepthConvention,
    pub near_m: f64,
    /// Used by [`DepthConvention::Standard`] only; the reversed one is infinite.
    pub far_m: f64,
}

/// One camera, ready to draw and to measure with.
#[derive(Clone, Copy, Debug)]
pub struct Eye {
    pub camera: Camera,
    pub lens: Lens,
    /// Half the picture's width and height at distance 1 along the view axis.
    pub half_extent: DVec2,
}

impl Eye {
    /// A camera whose depth range cuts nothing off the ground: the bare ellipsoid, or terrain on it.
    pub fn above(
        ellipsoid: &Ellipsoid,
        elevation: Option<&Elevation>,
        viewpoint: &Viewpoint,
        shot: Shot,
    ) -> Self {
        let ground_m = elevation.map_or(0.0, |elevation| {
            elevation.height_m(viewpoint.foot.canonical())
        });
        let highest_m = elevation.map_or(0.0, Elevation::highest_m);
        let range_m = depth_range_m(ellipsoid, viewpoint, ground_m, highest_m);
        Self::within(ellipsoid, viewpoint, shot, range_m)
    }

    /// The same over ground that is as high everywhere.
    pub fn over_level(
        ellipsoid: &Ellipsoid,
        ground_m: f64,
        viewpoint: &Viewpoint,
        shot: Shot,
    ) -> Self {
        let range_m = depth_range_m(ellipsoid, viewpoint, ground_m, ground_m);
        Self::within(ellipsoid, viewpoint, shot, range_m)
    }

    fn within(
        ellipsoid: &Ellipsoid,
        viewpoint: &Viewpoint,
        shot: Shot,
        (near_m, far_m): (f64, f64),
    ) -> Self {
        let lens = Lens {
            fov_deg: shot.fov_deg,
            size_px: shot.size_px,
            depth: shot.depth,
            near_m,
            far_m,
        };
        Self::new(ellipsoid, viewpoint, lens)
    }

    fn new(ellipsoid: &Ellipsoid, viewpoint: &Viewpoint, lens: Lens) -> Self {
        let half_height = (lens.fov_deg.to_radians() / 2.0).tan();
        let aspect = f64::from(lens.size_px.x) / f64::from(lens.size_px.y);
        let half_extent = DVec2::new(half_height * aspect, half_height);
        let (z_scale, z_offset) = depth_coefficients(&lens);
        // clip = (x/hx, y/hy, −z_scale·z + z_offset, −z): depth = z_scale + z_offset / distance.
        let clip_from_view = DMat4::from_cols_array_2d(&[
            [1.0 / half_extent.x, 0.0, 0.0, 0.0],
            [0.0, 1.0 / half_extent.y, 0.0, 0.0],
            [0.0, 0.0, -z_scale, -1.0],
            [0.0, 0.0, z_offset, 0.0],
        ]);
        Self {
            camera: Camera {
                eye_ecef_m: ellipsoid.ecef(viewpoint.foot, viewpoint.height_m),
                view_from_ecef: viewpoint.view_from_ecef(),
                clip_from_view,
            },
            lens,
            half_extent,
        }
    }

    /// Depth is `scale + offset / distance along the view axis`.
    pub fn depth_coefficients(&self) -> (f64, f64) {
        depth_coefficients(&self.lens)
    }

    /// Size of a pixel at distance 1 m along the view axis, metres.
    pub fn pixel_size(&self) -> f64 {
        2.0 * self.half_extent.y / f64::from(self.lens.size_px.y)
    }

    /// ECEF vector from the eye through a pixel's centre, of length 1 along the view axis.
    pub fn ray(&self, column: u32, row: u32) -> DVec3 {
        let size = self.lens.size_px.as_dvec2();
        let x = 2.0 * (f64::from(column) + 0.5) / size.x - 1.0;
        let y = 1.0 - 2.0 * (f64::from(row) + 0.5) / size.y;
        let view = DVec3::new(x * self.half_extent.x, y * self.half_extent.y, -1.0);
        self.camera.view_from_ecef.transpose() * view
    }

    /// ECEF position, metres, of the surface point that a pixel's depth value stands for; `None`
    /// for the depth of the sky.
    pub fn surface_ecef_m(&self, column: u32, row: u32, depth: f32) -> Option<DVec3> {
        if depth == self.clear_depth() {
            return None;
        }
        let (scale, offset) = self.depth_coefficients();
        let distance_m = offset / (f64::from(depth) - scale);
        Some(self.camera.eye_ecef_m + distance_m * self.ray(column, row))
    }

    /// The depth value of the sky.
    pub fn clear_depth(&self) -> f32 {
        match self.lens.depth {
            DepthConvention::Reversed => 0.0,
            DepthConvention::Standard => 1.0,
        }
    }
}

fn depth_coefficients(lens: &Lens) -> (f64, f64) {
    match lens.depth {
        DepthConvention::Reversed => (0.0, lens.near_m),
        DepthConvention::Standard => {
            let scale = lens.far_m / (lens.far_m - lens.near_m);
            (scale, -scale * lens.near_m)
        }
    }
}

/// Near and far distances along the view axis that cut nothing off.
///
/// `ground_m` is the terrain's height under the camera, `highest_m` the greatest anywhere. A tenth
/// of the way to the ground leaves room for the picture's corners (their distance along the axis is
/// shorter) and for slopes.
fn depth_range_m(
    ellipsoid: &Ellipsoid,
    viewpoint: &Viewpoint,
    ground_m: f64,
    highest_m: f64,
) -> (f64, f64) {
    let height_m = viewpoint.height_m;
    let clearance_m = (height_m - highest_m).max(0.5 * (height_m - ground_m).abs());
    let near_m = (0.1 * clearance_m).max(0.01);
    // The farthest ground is a mountain behind the horizon; never nearer than the depth of the ground.
    let tangent_m = |h: f64| (h.max(0.0) * (2.0 * ellipsoid.a_m + h.max(0.0))).sqrt();
    let far_m = tangent_m(height_m) + tangent_m(highest_m) + 2.0 * height_m.abs() + 1e4;
    (near_m, far_m)
}
