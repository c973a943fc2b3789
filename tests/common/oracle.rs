//! Which regions contain a point: crossing parity along the point's meridian, in f64, against the
//! true edges. No triangles, no chords, nothing of the crate but its input types.

use std::collections::HashMap;

use globefill::{Ellipsoid, Inside, LonLat, Polygon, Region, Ring};

use super::{
    edge::{TrueEdge, canonical},
    figure::Figure,
};

/// Bins of longitude by which edges are found.
const BINS: usize = 7200;

/// Decides for points of the ellipsoid which regions contain them.
pub struct Oracle {
    pub figure: Figure,
    rings: Vec<TrueRing>,
    regions: Vec<TrueRegion>,
    /// For each bin of longitude the edges (ring, edge) that reach into it.
    bins: Vec<Vec<(u32, u32)>>,
    /// Regions that hold some point whose meridian meets none of their edges to the north.
    reach_north_pole: Vec<u32>,
}

struct TrueRing {
    region: u32,
    edges: Vec<TrueEdge>,
    /// The crossing parity of the points that this ring keeps in its polygon.
    kept_parity: bool,
}

struct TrueRegion {
    /// Indices into `Oracle::rings`, a list for each polygon.
    polygons: Vec<Vec<u32>>,
    /// Edges (ring, edge) with the region on one side only.
    boundary: Vec<(u32, u32)>,
}

/// Working memory of a query.
#[derive(Default)]
pub struct Scratch {
    odd: Vec<bool>,
    touched: Vec<u32>,
}

impl Oracle {
    pub fn new(regions: &[Region], ellipsoid: Ellipsoid) -> Self {
        let mut oracle = Self {
            figure: Figure::new(ellipsoid),
            rings: Vec::new(),
            regions: Vec::new(),
            bins: vec![Vec::new(); BINS],
            reach_north_pole: Vec::new(),
        };
        for (index, region) in regions.iter().enumerate() {
            oracle.add_region(index as u32, region);
        }
        oracle.fill_bins();
        let no_crossing = vec![false; oracle.rings.len()];
        oracle.reach_north_pole = (0..oracle.regions.len() as u32)
            .filter(|&region| oracle.holds(region, &no_crossing))
            .collect();
        oracle
    }

    fn add_region(&mut self, index: u32, region: &Region) {
        let mut polygons = Vec::new();
        for polygon in &region.polygons {
            let first = self.rings.len() as u32;
            self.add_polygon(index, region, polygon);
            polygons.push((first..self.rings.len() as u32).collect());
        }
        let boundary = self.boundary_of(&polygons);
        self.regions.push(TrueRegion { polygons, boundary });
    }

    fn add_polygon(&mut self, index: u32, region: &Region, polygon: &Polygon) {
        let shell = true_ring(&self.figure, region, &polygon.shell);
        let kept_parity = match region.inside {
            Inside::Smaller => area_share(&self.figure, &shell) <= 0.5,
            Inside::LeftOfRing => left_parity(&self.figure, &shell),
        };
        let holes: Vec<TrueRing> = polygon
            .holes
            .iter()
            .map(|hole| {
                let edges = true_ring(&self.figure, region, hole);
                TrueRing {
                    region: index,
                    kept_parity: parity_of_most(&self.figure, &edges, &polygon.shell),
                    edges,
                }
            })
            .collect();
        self.rings.push(TrueRing {
            region: index,
            edges: shell,
            kept_parity,
        });
        self.rings.extend(holes);
    }

    /// Leaves out the turns at a pole and the seams: edges that the region walks in both directions.
    fn boundary_of(&self, polygons: &[Vec<u32>]) -> Vec<(u32, u32)> {
        let key = |from: LonLat, to: LonLat, span_deg: f64| {
            let (from, to) = (canonical(from), canonical(to));
            [
                from.lon_deg,
                from.lat_deg,
                to.lon_deg,
                to.lat_deg,
                span_deg + 0.0,
            ]
            .map(f64::to_bits)
        };
        let all = || {
            polygons.iter().flatten().flat_map(|&ring| {
                let edges = &self.rings[ring as usize].edges;
                (0..edges.len() as u32).map(move |edge| (ring, edge))
            })
        };
        let mut walks: HashMap<_, i32> = HashMap::new();
        for (ring, edge) in all() {
            let edge = self.edge(ring, edge);
            let span_deg = edge.span_deg();
            *walks.entry(key(edge.from, edge.to, span_deg)).or_default() += 1;
            *walks.entry(key(edge.to, edge.from, -span_deg)).or_default() -= 1;
        }
        all()
            .filter(|&(ring, edge)| {
                let edge = self.edge(ring, edge);
                !edge.is_pole_turn() && walks[&key(edge.from, edge.to, edge.span_deg())] != 0
            })
            .collect()
    }

    fn fill_bins(&mut self) {
        for (ring_index, ring) in self.rings.iter().enumerate() {
            for (edge_index, edge) in ring.edges.iter().enumerate() {
                let Some((west, east)) = edge.extent_deg() else {
                    continue;
                };
                let first = bin(west);
                let last = if west < east {
                    bin(east)
                } else {
                    bin(east) + BINS
                };
                let last = last.min(first + BINS - 1);
                for k in first..=last {
                    self.bins[k % BINS].push((ring_index as u32, edge_index as u32));
                }
            }
        }
    }

    fn edge(&self, ring: u32, edge: u32) -> &TrueEdge {
        &self.rings[ring as usize].edges[edge as usize]
    }

    /// Edges that bound a region.
    pub fn boundary(&self, region: u32) -> impl Iterator<Item = &TrueEdge> {
        let list = &self.regions[region as usize].boundary;
        list.iter().map(|&(ring, edge)| self.edge(ring, edge))
    }

    pub fn region_count(&self) -> u32 {
        self.regions.len() as u32
    }

    /// All regions that contain a point, in input order.
    pub fn containing(&self, p: LonLat, scratch: &mut Scratch) -> Vec<u32> {
        let p = canonical(p);
        scratch.odd.resize(self.rings.len(), false);
        for &(ring, edge) in &self.bins[bin(p.lon_deg)] {
            if self.edge(ring, edge).crosses_north_of(&self.figure, p) {
                scratch.odd[ring as usize] ^= true;
                scratch.touched.push(ring);
            }
        }
        let mut candidates = self.reach_north_pole.clone();
        candidates.extend(
            scratch
                .touched
                .iter()
                .map(|&r| self.rings[r as usize].region),
        );
        candidates.sort_unstable();
        candidates.dedup();
        candidates.retain(|&region| self.holds(region, &scratch.odd));
        for ring in scratch.touched.drain(..) {
            scratch.odd[ring as usize] = false;
        }
        candidates
    }

    fn holds(&self, region: u32, odd: &[bool]) -> bool {
        self.regions[region as usize].polygons.iter().any(|rings| {
            rings.iter().all(|&ring| {
                let ring_data = &self.rings[ring as usize];
                odd[ring as usize] == ring_data.kept_parity
            })
        })
    }
}

fn bin(lon_deg: f64) -> usize {
    (((lon_deg + 180.0) / 360.0 * BINS as f64) as usize).min(BINS - 1)
}

/// The edges of a ring, with a turn wherever it passes the north pole.
fn true_ring(figure: &Figure, region: &Region, ring: &Ring) -> Vec<TrueEdge> {
    let mut vertices = ring.clone();
    if vertices.len() > 1 && canonical(vertices[0]) == canonical(vertices[vertices.len() - 1]) {
        vertices.pop();
        // The closing vertex may be written 360° away; the edge before it was written towards it.
        vertices.push(ring[ring.len() - 1]);
    } else if let Some(&first) = vertices.first() {
        vertices.push(first);
    }
    let edges: Vec<TrueEdge> = vertices
        .windows(2)
        .flat_map(|pair| TrueEdge::between(figure, region.edges, pair[0], pair[1]))
        .collect();
    let mut turns = Vec::new();
    for (k, edge) in edges.iter().enumerate() {
        let next = &edges[(k + 1) % edges.len()];
        if edge.to.lat_deg == 90.0 {
            turns.extend(TrueEdge::north_pole(
                figure,
                edge.to.lon_deg,
                next.from.lon_deg,
            ));
        }
    }
    edges.into_iter().chain(turns).collect()
}

fn parity(figure: &Figure, ring: &[TrueEdge], p: LonLat) -> bool {
    let p = canonical(p);
    ring.iter()
        .filter(|edge| edge.crosses_north_of(figure, p))
        .count()
        % 2
        == 1
}

/// Share of the ellipsoid's area that has odd parity, 0 for rings within half a turn of longitude: exact
/// along each of many meridians.
fn area_share(figure: &Figure, ring: &[TrueEdge]) -> f64 {
    let wraps = ring
        .iter()
        .filter_map(TrueEdge::extent_deg)
        .any(|(w, e)| w >= e);
    let (west, east) = if wraps {
        (-180.0, 180.0)
    } else {
        ring.iter()
            .filter_map(TrueEdge::extent_deg)
            .fold((180.0, -180.0), |(w, e): (f64, f64), x| {
                (w.min(x.0), e.max(x.1))
            })
    };
    // Within half a turn lies less than half of the globe: that is all that is asked.
    if east - west < 180.0 {
        return 0.0;
    }
    const MERIDIANS: usize = 2048;
    let step_deg = (east - west) / MERIDIANS as f64;
    let mut crossings = vec![Vec::new(); MERIDIANS];
    for edge in ring {
        let Some((w, e)) = edge.extent_deg() else {
            continue;
        };
        let parts = if w < e {
            [(w, e), (0.0, 0.0)]
        } else {
            [(w, 180.0), (-180.0, e)]
        };
        for (w, e) in parts {
            let first = ((w - west) / step_deg - 0.5).ceil().max(0.0) as usize;
            for (k, crossed) in crossings.iter_mut().enumerate().skip(first) {
                let lon_deg = west + (k as f64 + 0.5) * step_deg;
                if lon_deg >= e {
                    break;
                }
                crossed.push(figure.area_share(edge.latitude_at(figure, lon_deg)));
            }
        }
    }
    let odd: f64 = crossings
        .iter_mut()
        .map(|latitudes| {
            latitudes.sort_by(|a, b| b.total_cmp(a));
            latitudes.push(-1.0);
            latitudes
                .chunks_exact(2)
                .map(|pair| pair[0] - pair[1])
                .sum::<f64>()
        })
        .sum();
    odd / 2.0 * step_deg / 360.0
}

/// The parity of the points to the left of a ring's edges.
fn left_parity(figure: &Figure, ring: &[TrueEdge]) -> bool {
    let mut longest: Vec<&TrueEdge> = ring.iter().filter(|e| !e.is_pole_turn()).collect();
    longest.sort_by(|a, b| b.radius_m.total_cmp(&a.radius_m));
    for offset in [1e-3, 1e-4, 1e-5, 1e-6] {
        for edge in longest.iter().take(5) {
            let at = |t: f64| figure.ecef(edge.point(figure, t), 0.0);
            let (here_m, ahead_m) = (at(0.5), at(0.5 + 1e-4));
            let up = figure.normal(edge.point(figure, 0.5));
            let left_m = up.cross(ahead_m - here_m).normalize() * edge.radius_m * offset;
            let side = |m| parity(figure, ring, figure.geodetic(m).0);
            let (left, right) = (side(here_m + left_m), side(here_m - left_m));
            if left != right {
                return left;
            }
        }
    }
    panic!("the ring has no two sides");
}

/// The parity, with regard to `ring`, of most of `vertices` that are not vertices of the ring. Poles have no
/// say: a box that ends there on a map has no vertex there on the globe.
fn parity_of_most(figure: &Figure, ring: &[TrueEdge], vertices: &[LonLat]) -> bool {
    let stride = vertices.len() / 64 + 1;
    let votes: i32 = vertices
        .iter()
        .step_by(stride)
        .filter(|v| v.lat_deg.abs() < 90.0)
        .filter(|&&v| !ring.iter().any(|e| canonical(e.from) == canonical(v)))
        .map(|&v| if parity(figure, ring, v) { 1 } else { -1 })
        .sum();
    votes > 0
}
