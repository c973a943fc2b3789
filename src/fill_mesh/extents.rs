//! The rectangle of longitudes and latitudes that holds a fill, from its true edges.

use crate::{
    curve::{Curve, CurveKind, CurveOn},
    ellipsoid::Ellipsoid,
    extents::{Extents, longitudes::Longitudes},
    fill_mesh::{Fill, FillMesh},
    geodetic::LonLat,
    locator::Locator,
};

/// Golden sections of a curve: they leave 10⁻¹³ of it.
const SECTIONS: usize = 62;

impl FillMesh {
    /// The smallest rectangle in longitude and geodetic latitude that holds a fill, from its true edges
    /// and not the chords drawn for them. None for a fill that is empty or not there.
    ///
    /// West is in −180 … 180 (exclusive), east above it by 360 at most: across the antimeridian it is
    /// above 180. The longitudes left out are the largest gap. With a pole inside it is all longitudes,
    /// from −180 to 180; with one on the boundary those of the fill away from the pole.
    ///
    /// Longitudes, and latitudes at vertices, are those of the mesh, multiples of 2⁻³⁶°; latitudes of
    /// edges that bulge beyond their ends are within 10⁻⁹°, inside. Takes some microseconds an edge.
    pub fn extents(&self, fill: u32) -> Option<Extents> {
        let record = self.fills.get(fill as usize)?;
        if record.piece_count == 0 {
            return None;
        }
        let edges = match self.edges_of(record) {
            Edges::Some(edges) => edges,
            Edges::NoneOfAPiece => return Some(Extents::GLOBE),
        };
        let locator = Locator::of_fill(self, fill);
        let pole = |lat_deg: f64| Pole {
            is_inside: locator.contains(fill, LonLat::new(0.0, lat_deg)),
            is_on_edge: edges.iter().any(|edge| ends_at(edge, lat_deg)),
        };
        let (south, north) = (pole(-90.0), pole(90.0));
        let (west_deg, east_deg) = if south.is_surrounded() || north.is_surrounded() {
            None
        } else {
            // No edge crosses a gap's meridians, so they are inside from pole to pole or not at all.
            let is_filled = |lon_deg: f64| {
                let has_pole = south.is_on_edge || north.is_on_edge;
                has_pole && locator.contains(fill, LonLat::new(lon_deg, 0.0))
            };
            longitudes(&edges).shortest(is_filled)
        }
        .unwrap_or((-180.0, 180.0));
        let (south_deg, north_deg) = self.latitudes_deg(&edges, &south, &north);
        Some(Extents {
            west_deg,
            south_deg,
            east_deg,
            north_deg,
        })
    }

    /// The edges of a fill, once each, in any direction.
    fn edges_of(&self, record: &Fill) -> Edges<'_> {
        let mut has_edges = vec![false; record.piece_count as usize];
        let mut edges = Vec::new();
        for arc in &self.arcs {
            let mut is_of_fill = false;
            for piece in [arc.left, arc.right].into_iter().flatten() {
                let own = piece.checked_sub(record.first_piece);
                if let Some(has_edges) = own.and_then(|piece| has_edges.get_mut(piece as usize)) {
                    (*has_edges, is_of_fill) = (true, true);
                }
            }
            if is_of_fill {
                edges.extend(self.curves_along(arc));
            }
        }
        if has_edges.contains(&false) {
            Edges::NoneOfAPiece
        } else {
            Edges::Some(edges)
        }
    }

    fn latitudes_deg(&self, edges: &[&Curve], south: &Pole, north: &Pole) -> (f64, f64) {
        let mut south_deg = if south.is_held() { -90.0 } else { 90.0_f64 };
        let mut north_deg = if north.is_held() { 90.0 } else { -90.0_f64 };
        for edge in edges {
            for end in [edge.from, edge.to] {
                south_deg = south_deg.min(end.lat_deg);
                north_deg = north_deg.max(end.lat_deg);
            }
        }
        // Only few edges come near what the vertices reach.
        for edge in edges.iter().filter(|edge| may_bulge(edge)) {
            let reach_deg = reach_deg(&self.ellipsoid, edge);
            let (low_deg, high_deg) = ordered(edge.from.lat_deg, edge.to.lat_deg);
            let (to_south, to_north) = (
                low_deg - reach_deg < south_deg,
                high_deg + reach_deg > north_deg,
            );
            if !(to_south || to_north) {
                continue;
            }
            let curve = edge.on(&self.ellipsoid);
            if to_south {
                south_deg = south_deg.min(-greatest_lat_deg(&curve, -1.0));
            }
            if to_north {
                north_deg = north_deg.max(greatest_lat_deg(&curve, 1.0));
            }
        }
        (south_deg, north_deg)
    }
}

/// The edges of a fill.
enum Edges<'a> {
    Some(Vec<&'a Curve>),
    /// A piece without edges is everything.
    NoneOfAPiece,
}

/// How a fill holds a pole.
struct Pole {
    /// If it is not on an edge.
    is_inside: bool,
    is_on_edge: bool,
}

impl Pole {
    fn is_held(&self) -> bool {
        self.is_inside || self.is_on_edge
    }

    fn is_surrounded(&self) -> bool {
        self.is_inside && !self.is_on_edge
    }
}

fn ends_at(edge: &Curve, lat_deg: f64) -> bool {
    edge.from.lat_deg == lat_deg || edge.to.lat_deg == lat_deg
}

/// What edges sweep.
fn longitudes(edges: &[&Curve]) -> Longitudes {
    let mut longitudes = Longitudes::default();
    for edge in edges {
        // A geodesic from a pole knows its meridian at the other end only.
        let is_from_pole = edge.kind == CurveKind::Geodesic && edge.from.is_pole();
        let from = if is_from_pole { edge.to } else { edge.from };
        longitudes.sweep(from.lon_deg, edge.turn_deg);
    }
    longitudes
}

/// Whether an edge may reach beyond the latitudes of its ends. Rhumb lines and straight edges are
/// monotone.
fn may_bulge(edge: &Curve) -> bool {
    !matches!(edge.kind, CurveKind::Rhumb | CurveKind::Straight)
}

fn ordered(a: f64, b: f64) -> (f64, f64) {
    (a.min(b), a.max(b))
}

/// Bound on how far, degrees, latitudes along an edge go beyond those of its ends: half its length,
/// which is below three times the chord's (a half circle's is π/2), where meridians are bent the most.
fn reach_deg(ellipsoid: &Ellipsoid, edge: &Curve) -> f64 {
    let [from, to] = [edge.from, edge.to].map(|end| ellipsoid.ecef(end, 0.0));
    let (least_m, most_m) = ordered(ellipsoid.a_m, ellipsoid.b_m);
    (1.5 * from.distance(to) / (least_m * least_m / most_m)).to_degrees()
}

/// The greatest of ± the latitudes of a curve, degrees, by golden section.
///
/// Along each kind there is one extreme at most. Geodesics of less than half a turn have one vertex at
/// most. A circle runs along a parallel where the shortest path from the centre arrives on a meridian,
/// which then (by Clairaut's relation) it has followed all the way: due north or south of the centre, and
/// arcs have less than half of the circle. Curves beside a geodesic do so beside its vertex.
fn greatest_lat_deg(curve: &CurveOn, sign: f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let lat_deg = |t: f64| sign * curve.lon_lat(t).lat_deg;
    let (mut low, mut high) = (0.0, 1.0);
    let (mut left, mut right) = (1.0 - GOLDEN, GOLDEN);
    let (mut left_deg, mut right_deg) = (lat_deg(left), lat_deg(right));
    for _ in 0..SECTIONS {
        if left_deg > right_deg {
            (high, right, right_deg) = (right, left, left_deg);
            left = high - GOLDEN * (high - low);
            left_deg = lat_deg(left);
        } else {
            (low, left, left_deg) = (left, right, right_deg);
            right = low + GOLDEN * (high - low);
            right_deg = lat_deg(right);
        }
    }
    left_deg.max(right_deg)
}
