//! Zones: circles, rings, sectors and corridors measured along the surface.

mod arcs;
mod corridor;
pub(crate) mod outline;

use crate::{
    curve::{beside::geodesics, in_turn},
    ellipsoid::Ellipsoid,
    error::ZoneError,
    geodetic::LonLat,
    region::{EdgeKind, Inside, Polygon, Region, Ring},
    zone::outline::{Outline, Pen},
};

/// Lengths in a zone, and what a sector's or ring's sides are apart, are not below this, metres.
pub const SHORTEST_M: f64 = 0.01;
/// Greatest half width of a corridor, in the ellipsoid's smaller radii: 1 900 km on Earth.
pub const WIDEST_HALF: f64 = 0.3;

/// A part of the surface measured along it, in metres and azimuths.
///
/// Distances are geodesic ones on the ellipsoid of [`MeshOptions`](crate::MeshOptions), lengths of
/// shortest paths along its surface; azimuths are degrees clockwise from north (at a pole: from the
/// meridian of the longitude that is written for it; at the north pole the azimuth 180° leads along
/// that meridian, at the south pole 0°).
///
/// **Accuracy.** The boundaries are no polygons: they are evaluated in double precision wherever the
/// mesh or a frame needs a point (Karney's geodesics, 15 nm), between corners that are rounded to
/// 1.1 µm; drawn, they are refined like every other edge.
///
/// A zone is a [`Region`] by `Region::from(zone)`, or one of the [`zones`](Region::zones) of one.
/// Poles and the antimeridian are ordinary, and so are zones larger than a hemisphere.
///
/// ```
/// use globefill::{FillMesh, LonLat, MeshOptions, Region, Zone};
///
/// let battery = LonLat::new(24.9, 60.2);
/// let regions = [
///     Zone::circle(battery, 40_000.0),
///     Zone::annulus(battery, 60_000.0, 150_000.0),
///     Zone::sector(battery, 0.0, 250_000.0, 80.0, 130.0),
///     Zone::corridor(vec![battery, LonLat::new(18.1, 59.3)], 20_000.0),
/// ]
/// .map(Region::from);
/// let mesh = FillMesh::build(&regions, &MeshOptions::default())?;
/// # Ok::<(), globefill::RegionError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case", deny_unknown_fields)
)]
pub enum Zone {
    /// The points up to `radius_m` from `centre`.
    Circle {
        /// The centre.
        centre: LonLat,
        /// The radius, metres; see [`greatest_range_m`].
        radius_m: f64,
    },
    /// The points from `min_m` to `max_m` away from `centre`.
    Annulus {
        /// The centre.
        centre: LonLat,
        /// The least distance, metres; 0 makes it a circle.
        min_m: f64,
        /// The greatest distance, metres; see [`greatest_range_m`].
        max_m: f64,
    },
    /// The points from `min_m` to `max_m` away from `centre` whose direction, seen from there, lies
    /// clockwise between two azimuths.
    Sector {
        /// The centre.
        centre: LonLat,
        /// The least distance, metres; with 0 the centre is a corner.
        min_m: f64,
        /// The greatest distance, metres; see [`greatest_range_m`].
        max_m: f64,
        /// Where the sector begins, degrees.
        from_deg: f64,
        /// Where it ends, clockwise, degrees; equal azimuths, or 360° more, are the whole turn.
        to_deg: f64,
    },
    /// The points up to half of `width_m` away from the line through `points`, whose legs are
    /// shortest paths: round at both ends and on the outer side of bends.
    ///
    /// A corridor that crosses or touches itself is the union, covered once; it must leave some of
    /// the globe uncovered. Legs that run back along others, or nearly so (below some 10⁻⁶ rad), and
    /// tangles of many crossings within metres may be refused as
    /// [`Tangled`](crate::RegionError::Tangled). One point alone is a circle.
    ///
    /// Where a line has many points within one width, its sides cross each other often: a thousand
    /// points within ten widths take seconds.
    Corridor {
        /// The line. Points nearer than 0.1 mm to their predecessor are left out.
        points: Vec<LonLat>,
        /// The width, metres, up to 0.6 of the ellipsoid's smaller radius.
        width_m: f64,
    },
}

/// The greatest distance, metres, from a centre up to which circles are regular curves on an
/// ellipsoid, with some room: 19 430 km on Earth. Shortest paths cease to be unique a little further.
pub fn greatest_range_m(ellipsoid: &Ellipsoid) -> f64 {
    let half_turn_m = std::f64::consts::PI * ellipsoid.a_m.min(ellipsoid.b_m);
    half_turn_m * (0.98 - 2.0 * ellipsoid.flattening().abs())
}

impl Zone {
    /// The points up to `radius_m` from `centre`.
    pub fn circle(centre: LonLat, radius_m: f64) -> Self {
        Self::Circle { centre, radius_m }
    }

    /// The points from `min_m` to `max_m` away from `centre`.
    pub fn annulus(centre: LonLat, min_m: f64, max_m: f64) -> Self {
        Self::Annulus {
            centre,
            min_m,
            max_m,
        }
    }

    /// The part of an annulus (with `min_m` = 0: of a circle) between two azimuths, clockwise from
    /// `from_deg` to `to_deg`.
    pub fn sector(centre: LonLat, min_m: f64, max_m: f64, from_deg: f64, to_deg: f64) -> Self {
        Self::Sector {
            centre,
            min_m,
            max_m,
            from_deg,
            to_deg,
        }
    }

    /// The points up to half of `width_m` away from the line through `points`.
    pub fn corridor(points: Vec<LonLat>, width_m: f64) -> Self {
        Self::Corridor { points, width_m }
    }

    /// Whether the zone can be on an ellipsoid; [`FillMesh::build`](crate::FillMesh::build) answers
    /// the same.
    ///
    /// # Errors
    /// What contradicts itself: see [`ZoneError`].
    pub fn check(&self, ellipsoid: &Ellipsoid) -> Result<(), ZoneError> {
        match self {
            Self::Circle { centre, radius_m } => {
                check_position(0, *centre)?;
                check_range(ellipsoid, SHORTEST_M, *radius_m)
            }
            Self::Annulus {
                centre,
                min_m,
                max_m,
            } => {
                check_position(0, *centre)?;
                check_ranges(ellipsoid, *min_m, *max_m)
            }
            Self::Sector {
                centre,
                min_m,
                max_m,
                from_deg,
                to_deg,
            } => {
                check_position(0, *centre)?;
                check_ranges(ellipsoid, *min_m, *max_m)?;
                check_azimuths(*max_m, *from_deg, *to_deg)
            }
            Self::Corridor { points, width_m } => corridor::check(ellipsoid, points, *width_m),
        }
    }

    /// The zone's boundary on an ellipsoid.
    pub(crate) fn outline(&self, ellipsoid: &Ellipsoid) -> Result<Outline, ZoneError> {
        self.check(ellipsoid)?;
        let geodesic = geodesics(ellipsoid);
        let pen = Pen::new(&geodesic);
        Ok(match *self {
            Self::Circle { centre, radius_m } => arcs::annulus(pen, in_turn(centre), 0.0, radius_m),
            Self::Annulus {
                centre,
                min_m,
                max_m,
            } => arcs::annulus(pen, in_turn(centre), min_m, max_m),
            Self::Sector {
                centre,
                min_m,
                max_m,
                from_deg,
                to_deg,
            } => match sweep_deg(from_deg, to_deg) {
                360.0 => arcs::annulus(pen, in_turn(centre), min_m, max_m),
                sweep_deg => {
                    arcs::sector(pen, in_turn(centre), [min_m, max_m], from_deg, sweep_deg)
                }
            },
            Self::Corridor {
                ref points,
                width_m,
            } => corridor::outline(pen, points, 0.5 * width_m),
        })
    }
}

impl From<Zone> for Region {
    fn from(zone: Zone) -> Self {
        Self {
            zones: vec![zone],
            ..Self::default()
        }
    }
}

impl Region {
    /// One ring whose vertices are joined by edges of one kind, its smaller side inside:
    /// `Region::ring(vertices, EdgeKind::Rhumb)` is the polygon whose sides keep their azimuths.
    pub fn ring(vertices: Ring, edges: EdgeKind) -> Self {
        Self {
            polygons: vec![Polygon {
                shell: vertices,
                holes: Vec::new(),
            }],
            edges,
            inside: Inside::Smaller,
            zones: Vec::new(),
        }
    }
}

/// How far a sector reaches clockwise, degrees, above 0 and up to 360.
fn sweep_deg(from_deg: f64, to_deg: f64) -> f64 {
    let sweep_deg = (to_deg - from_deg).rem_euclid(360.0);
    if sweep_deg == 0.0 { 360.0 } else { sweep_deg }
}

fn check_position(point: usize, position: LonLat) -> Result<(), ZoneError> {
    let LonLat { lon_deg, lat_deg } = position;
    if position.is_valid() {
        return Ok(());
    }
    Err(ZoneError::Position {
        point,
        lon_deg,
        lat_deg,
    })
}

/// Whether a length is one between `least_m` and the greatest range.
fn check_range(ellipsoid: &Ellipsoid, least_m: f64, range_m: f64) -> Result<(), ZoneError> {
    let most_m = greatest_range_m(ellipsoid);
    if (least_m..=most_m).contains(&range_m) {
        return Ok(());
    }
    Err(ZoneError::Range {
        range_m,
        least_m,
        most_m,
    })
}

fn check_ranges(ellipsoid: &Ellipsoid, min_m: f64, max_m: f64) -> Result<(), ZoneError> {
    check_range(ellipsoid, SHORTEST_M, max_m)?;
    if min_m != 0.0 {
        check_range(ellipsoid, SHORTEST_M, min_m)?;
    }
    if min_m + SHORTEST_M > max_m {
        return Err(ZoneError::EmptyRange { min_m, max_m });
    }
    Ok(())
}

fn check_azimuths(max_m: f64, from_deg: f64, to_deg: f64) -> Result<(), ZoneError> {
    let invalid = ZoneError::Azimuths { from_deg, to_deg };
    // So many turns leave an azimuth nine digits after the point.
    if !(from_deg.abs() <= 1e6 && to_deg.abs() <= 1e6) {
        return Err(invalid);
    }
    let sweep_deg = sweep_deg(from_deg, to_deg);
    let apart_m = sweep_deg.min(360.0 - sweep_deg).to_radians() * max_m.min(1e6);
    if sweep_deg == 360.0 || apart_m >= SHORTEST_M {
        Ok(())
    } else {
        Err(invalid)
    }
}
