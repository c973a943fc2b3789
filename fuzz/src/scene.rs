//! Bytes → regions full of degeneracies.

use globefill::{
    EdgeKind, Ellipsoid, Inside, Limits, LonLat, MeshOptions, Polygon, Region, Ring, Zone,
};

use crate::source::Source;

pub const KINDS: [EdgeKind; 3] = [EdgeKind::Geodesic, EdgeKind::Rhumb, EdgeKind::Straight];

/// A step of the lattice that vertices are rounded to.
const STEP_DEG: f64 = 1.0 / (1_u64 << 36) as f64;

const LONGITUDES_DEG: [f64; 16] = [
    0.0,
    -0.0,
    180.0,
    -180.0,
    179.999_999_999,
    -180.000_000_000_000_03,
    90.0,
    -90.0,
    360.0,
    540.0,
    -720.0,
    1e9,
    45.0,
    120.0,
    -60.0,
    1e-300,
];
const LATITUDES_DEG: [f64; 16] = [
    0.0,
    -0.0,
    90.0,
    -90.0,
    89.999_999_999,
    -89.999_999_999,
    45.0,
    -45.0,
    1e-12,
    -1e-12,
    60.0,
    85.0,
    -60.0,
    30.0,
    -30.0,
    89.0,
];
const SCALES_DEG: [f64; 16] = [
    1e-3,
    STEP_DEG,
    3.0 * STEP_DEG,
    1e-9,
    1e-7,
    1e-6,
    1e-5,
    1e-4,
    1e-3,
    1e-2,
    0.02,
    0.05,
    0.1,
    0.3,
    5.0,
    11.25,
];

/// Where a scene lies, and how large a step of its grid is.
#[derive(Clone, Copy, Debug)]
pub struct Stage {
    pub centre: LonLat,
    pub scale_deg: f64,
    /// Whether vertices may lie anywhere on the globe.
    pub goes_afar: bool,
}

impl Stage {
    pub fn read(source: &mut Source) -> Self {
        let place = source.byte();
        let size = source.byte();
        Self {
            centre: LonLat::new(
                LONGITUDES_DEG[usize::from(place & 15)],
                LATITUDES_DEG[usize::from(place >> 4)],
            ),
            scale_deg: SCALES_DEG[usize::from(size & 15)],
            goes_afar: size >> 4 == 15,
        }
    }

    /// A point of the plane, in steps from the centre; latitudes end at the poles.
    pub fn at(&self, x: f64, y: f64) -> LonLat {
        let lat_deg = self.centre.lat_deg + y * self.scale_deg;
        LonLat::new(
            self.centre.lon_deg + x * self.scale_deg,
            lat_deg.clamp(-90.0, 90.0),
        )
    }

    /// Points between those of the grid.
    pub fn probes(&self) -> impl Iterator<Item = LonLat> + '_ {
        (0..6).map(|k| {
            let (x, y) = [(0, 0), (-3, 2), (2, -4), (-6, -5), (5, 4), (1, 2)][k];
            self.at(f64::from(x) + 0.372, f64::from(y) + 0.618)
        })
    }

    /// A ring of up to `most` vertices; it ends where the bytes say so.
    pub fn ring(&self, source: &mut Source, most: usize) -> Ring {
        let count = 3 + source.below(most - 2);
        let mut ring = Ring::with_capacity(count);
        for _ in 0..count {
            let vertex = self.vertex(source, &ring);
            ring.push(vertex);
        }
        ring
    }

    fn vertex(&self, source: &mut Source, ring: &[LonLat]) -> LonLat {
        let (op, bits) = (source.byte(), source.byte());
        let low = f64::from(bits & 15) - 8.0;
        let high = f64::from(bits >> 4) - 8.0;
        let earlier = |index: u8| ring.get(usize::from(index) % ring.len().max(1)).copied();
        let on_grid = self.at(low, high);
        match op {
            // An earlier vertex once more, or some steps of the lattice beside it.
            0xc0..0xd0 => earlier(bits).unwrap_or(on_grid),
            0xd0..0xe0 => match earlier(op & 15) {
                Some(near) => LonLat::new(
                    near.lon_deg + low * STEP_DEG,
                    (near.lat_deg + high * STEP_DEG).clamp(-90.0, 90.0),
                ),
                None => on_grid,
            },
            // On, or as good as on, the line through two others.
            0xe0..0xf0 => match (earlier(op & 15), earlier(bits >> 4)) {
                (Some(a), Some(b)) => {
                    let share = f64::from(bits & 15) / 8.0;
                    LonLat::new(
                        a.lon_deg + share * (b.lon_deg - a.lon_deg),
                        (a.lat_deg + share * (b.lat_deg - a.lat_deg)).clamp(-90.0, 90.0),
                    )
                }
                _ => on_grid,
            },
            0xf0..0xf8 if self.goes_afar => LonLat::new(
                LONGITUDES_DEG[usize::from(bits & 15)],
                LATITUDES_DEG[usize::from(bits >> 4)],
            ),
            // Near the antipode of the one before.
            0xf8.. if self.goes_afar => match ring.last() {
                Some(before) => LonLat::new(
                    before.lon_deg + 180.0 + low * f64::from(op & 7) * 0.1,
                    (high * f64::from(op & 7) * 0.1 - before.lat_deg).clamp(-90.0, 90.0),
                ),
                None => on_grid,
            },
            _ => on_grid,
        }
    }

    pub fn polygon(&self, source: &mut Source, most_vertices: usize, most_holes: usize) -> Polygon {
        let holes = source.below(most_holes + 1);
        Polygon {
            shell: self.ring(source, most_vertices),
            holes: (0..holes)
                .map(|_| self.ring(source, most_vertices.min(6)))
                .collect(),
        }
    }

    pub fn zone(&self, source: &mut Source, ellipsoid: &Ellipsoid) -> Zone {
        let step_m = self.scale_deg.to_radians() * ellipsoid.a_m;
        let kind = source.below(4);
        let ring = self.ring(source, 7);
        let centre = ring[0];
        let length_m = |source: &mut Source| f64::from(source.byte()) * 0.125 * step_m;
        let (least_m, more_m) = (length_m(source), length_m(source));
        match kind {
            0 => Zone::circle(centre, more_m),
            1 => Zone::annulus(centre, least_m, least_m + more_m),
            2 => {
                let from_deg = source.signed() * 2.8125;
                let to_deg = from_deg + f64::from(source.byte()) * 1.40625;
                Zone::sector(centre, least_m, least_m + more_m, from_deg, to_deg)
            }
            _ => Zone::corridor(ring, more_m),
        }
    }
}

pub fn options(source: &mut Source) -> MeshOptions {
    let ellipsoid = match source.byte() {
        0..200 => Ellipsoid::WGS84,
        200..215 => Ellipsoid::MOON,
        215..230 => Ellipsoid::MARS,
        230..235 => Ellipsoid {
            a_m: 6e6,
            b_m: 6.119e6,
        },
        235..240 => Ellipsoid {
            a_m: 6e6,
            b_m: 5.881e6,
        },
        240..245 => Ellipsoid::sphere(1.0),
        245..248 => Ellipsoid::sphere(1e-6),
        248..250 => Ellipsoid::sphere(1e-200),
        250..252 => Ellipsoid::sphere(f64::MIN_POSITIVE),
        252..254 => Ellipsoid {
            a_m: 7e6,
            b_m: f64::NAN,
        },
        _ => Ellipsoid {
            a_m: 0.0,
            b_m: -1.0,
        },
    };
    let tolerance_m = source.of(&[5.0, 50.0, 1e4, 500.0, f64::INFINITY]);
    // Two pieces that cover the globe are refused: meshing them takes as long as a thousand small ones.
    let limits = Limits {
        mesh_vertices: 20_000,
        ..Limits::default()
    };
    MeshOptions {
        ellipsoid,
        tolerance_m,
        limits,
    }
}

pub fn region(source: &mut Source, stage: &Stage, ellipsoid: &Ellipsoid) -> Region {
    let kinds = source.byte();
    let mut region = Region {
        edges: KINDS[usize::from(kinds & 3) % 3],
        inside: if kinds & 0x44 == 0x44 {
            Inside::LeftOfRing
        } else {
            Inside::Smaller
        },
        ..Region::default()
    };
    for _ in 0..1 + (kinds >> 3) % 3 {
        if kinds >= 0xd0 {
            region.zones.push(stage.zone(source, ellipsoid));
        } else {
            region.polygons.push(stage.polygon(source, 9, 2));
        }
    }
    region
}

/// Whether points may be held against each other's answers. Within some hundred micrometres of a pole
/// curved edges that lie nanometres apart are not told apart, and where one of them decides on which
/// side the pole lies, the locator may answer for the other side everywhere.
pub fn is_clear_of_poles(regions: &[Region]) -> bool {
    let is_clear = |vertex: &LonLat| vertex.lat_deg.abs() < 89.999 || vertex.is_pole();
    regions
        .iter()
        .filter(|region| region.edges != EdgeKind::Straight)
        .all(|region| {
            let polygons = region.polygons.iter();
            polygons
                .flat_map(|polygon| polygon.holes.iter().chain([&polygon.shell]))
                .flatten()
                .all(is_clear)
        })
}
