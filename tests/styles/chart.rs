//! Where patterns lie, by their definitions, in f64: nothing here is shared with the crate.

use glam::{DVec2, DVec3};
use globefill::{Extents, LonLat};

use crate::common::figure::Figure;

/// The map about an anchor: the ellipsoid seen from the anchor's antipode, on the anchor's tangent plane.
#[derive(Clone, Copy, Debug)]
pub struct Sheet {
    figure: Figure,
    anchor_m: DVec3,
    normal: DVec3,
    right: DVec3,
    up: DVec3,
}

impl Sheet {
    /// `turned_rad` clockwise from north is up.
    pub fn new(figure: &Figure, anchor: LonLat, turned_rad: f64) -> Self {
        let normal = figure.normal(anchor);
        let (sin_lon, cos_lon) = anchor.lon_deg.to_radians().sin_cos();
        let east = DVec3::new(-sin_lon, cos_lon, 0.0);
        let north = normal.cross(east);
        let (sin, cos) = turned_rad.sin_cos();
        Self {
            figure: *figure,
            anchor_m: figure.ecef(anchor, 0.0),
            normal,
            right: east * cos - north * sin,
            up: north * cos + east * sin,
        }
    }

    /// Metres to the right and up, from the anchor, of what stands on the foot point of a point.
    pub fn at_m(&self, point_m: DVec3) -> DVec2 {
        let (foot, _) = self.figure.geodetic(point_m);
        let from_antipode = self.figure.ecef(foot, 0.0) + self.anchor_m;
        // The line from the antipode meets the plane where its part along the normal is that of 2 A.
        let reach = 2.0 * self.anchor_m.dot(self.normal) / from_antipode.dot(self.normal);
        let on_plane = from_antipode * reach - 2.0 * self.anchor_m;
        DVec2::new(on_plane.dot(self.right), on_plane.dot(self.up))
    }
}

/// The place of a picture: u to its right and v down, 0 … 1 within it.
#[derive(Clone, Copy, Debug)]
pub enum Spot {
    /// Over longitudes and latitudes.
    Angles {
        extents: Extents,
        geocentric: bool,
    },
    Local {
        center: LonLat,
        size_m: DVec2,
    },
}

/// A picture in its place.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    pub spot: Spot,
    pub rotation_rad: f64,
    pub repeats: DVec2,
}

impl Layout {
    pub fn new(spot: Spot) -> Self {
        Self {
            spot,
            rotation_rad: 0.0,
            repeats: DVec2::ONE,
        }
    }

    pub fn uv(&self, figure: &Figure, point_m: DVec3) -> DVec2 {
        let turned = match self.spot {
            Spot::Local { center, size_m } => {
                Sheet::new(figure, center, self.rotation_rad).at_m(point_m) / size_m
            }
            Spot::Angles {
                extents,
                geocentric,
            } => {
                let share = share_of(figure, extents, geocentric, point_m);
                let (sin, cos) = self.rotation_rad.sin_cos();
                DVec2::new(share.x * cos - share.y * sin, share.y * cos + share.x * sin)
            }
        };
        0.5 + turned * DVec2::new(1.0, -1.0) * self.repeats
    }
}

/// Where in a rectangle a point stands, from the middle: east and north, in widths and heights.
fn share_of(figure: &Figure, extents: Extents, geocentric: bool, point_m: DVec3) -> DVec2 {
    let (foot, _) = figure.geodetic(point_m);
    let latitude_deg = |lat_deg: f64| {
        if !geocentric {
            return lat_deg;
        }
        let on_meridian = figure.ecef(LonLat::new(0.0, lat_deg), 0.0);
        on_meridian.z.atan2(on_meridian.x).to_degrees()
    };
    let width_deg = match (extents.east_deg - extents.west_deg).rem_euclid(360.0) {
        0.0 => 360.0,
        width_deg => width_deg,
    };
    let from_middle_deg = foot.lon_deg - (extents.west_deg + 0.5 * width_deg);
    let east_deg = from_middle_deg - 360.0 * (from_middle_deg / 360.0).round();
    let [south_deg, north_deg] = [extents.south_deg, extents.north_deg].map(latitude_deg);
    let north_of_middle_deg = latitude_deg(foot.lat_deg) - 0.5 * (south_deg + north_deg);
    DVec2::new(
        east_deg / width_deg,
        north_of_middle_deg / (north_deg - south_deg),
    )
}
