//! What one case took and gave, as a line of a table and as JSON.

use globefill::{FillMesh, Region};
use serde_json::{Value, json};

use crate::case::Case;

/// The names of the columns of [`Report::line`].
pub const HEADING: &str = "case                 vertices    holes   parts   stored triangles  parse s  build s    CPU s  growth  \
     input MB  peak MB  growth  locator s  query us  wrong  area error (bound)  open";

/// What one case took and gave.
#[derive(Clone, Debug, Default)]
pub struct Report {
    pub vertices: usize,
    pub holes: usize,
    pub parts: usize,
    pub pieces: usize,
    pub stored_vertices: usize,
    pub triangles: usize,
    pub repairs: usize,
    pub overlaps: usize,
    pub parse_s: f64,
    pub build_s: f64,
    /// Of all threads.
    pub build_cpu_s: f64,
    pub measures_s: f64,
    pub locator_s: f64,
    /// A question to the locator, microseconds.
    pub query_us: f64,
    /// Most memory until the input was there, until the mesh was, and with all that judges it.
    pub parse_peak_bytes: u64,
    pub build_peak_bytes: u64,
    pub peak_bytes: u64,
    /// Pieces whose triangles do not end at their arcs.
    pub open_pieces: usize,
    /// How far the caps' area is off what the true edges enclose, as a share of it, and how far it may.
    pub area_error: f64,
    pub area_bound: f64,
    pub points: usize,
    pub points_inside: usize,
    pub wrong_points: usize,
}

impl Report {
    /// What there is to mesh.
    pub fn of_input(regions: &[Region]) -> Self {
        let polygons = || regions.iter().flat_map(|region| &region.polygons);
        let holes = || polygons().flat_map(|polygon| &polygon.holes);
        Self {
            vertices: polygons().map(|polygon| polygon.shell.len()).sum::<usize>()
                + holes().map(Vec::len).sum::<usize>(),
            holes: holes().count(),
            parts: polygons().count(),
            ..Self::default()
        }
    }

    pub fn add_mesh(&mut self, mesh: &FillMesh) {
        self.pieces = mesh.pieces.len();
        self.stored_vertices = mesh.vertices.len();
        self.triangles = mesh.cap_triangles.len();
        self.repairs = mesh.repairs.len();
        self.overlaps = mesh.overlaps.len();
    }

    /// Whether all that was judged is right.
    pub fn is_sound(&self) -> bool {
        self.open_pieces == 0 && self.wrong_points == 0 && self.area_error <= self.area_bound
    }

    /// One line; growth is the exponent p of sizeᵖ since the `smaller` case.
    pub fn line(&self, case: &Case, smaller: Option<&Self>) -> String {
        let growth = |amount: fn(&Self) -> f64| {
            let ratio = |smaller: &Self| {
                let size = self.vertices as f64 / smaller.vertices as f64;
                (amount(self) / amount(smaller)).ln() / size.ln()
            };
            smaller.map_or(String::new(), |smaller| format!("{:.2}", ratio(smaller)))
        };
        let mb = |bytes: u64| bytes as f64 / 1e6;
        format!(
            "{:18} {:>10} {:>8} {:>7} {:>8} {:>9} {:>8.2} {:>8.2} {:>8.2} {:>7} {:>9.0} {:>8.0} {:>7} {:>10.2} {:>9.1} {:>6} {:>9.1e} ({:.0e}) {:>5}",
            case.to_string(),
            self.vertices,
            self.holes,
            self.parts,
            self.stored_vertices,
            self.triangles,
            self.parse_s,
            self.build_s,
            self.build_cpu_s,
            growth(|report| report.build_cpu_s),
            mb(self.parse_peak_bytes),
            mb(self.build_peak_bytes),
            growth(|report| report.build_peak_bytes as f64),
            self.locator_s,
            self.query_us,
            self.wrong_points,
            self.area_error,
            self.area_bound,
            self.open_pieces,
        )
    }

    pub fn to_json(&self, case: &Case) -> Value {
        json!({
            "case": case.to_string(),
            "vertices": self.vertices,
            "holes": self.holes,
            "parts": self.parts,
            "pieces": self.pieces,
            "stored_vertices": self.stored_vertices,
            "triangles": self.triangles,
            "repairs": self.repairs,
            "overlaps": self.overlaps,
            "parse_s": self.parse_s,
            "build_s": self.build_s,
            "build_cpu_s": self.build_cpu_s,
            "measures_s": self.measures_s,
            "locator_s": self.locator_s,
            "query_us": self.query_us,
            "parse_peak_bytes": self.parse_peak_bytes,
            "build_peak_bytes": self.build_peak_bytes,
            "peak_bytes": self.peak_bytes,
            "open_pieces": self.open_pieces,
            "area_error": self.area_error,
            "area_bound": self.area_bound,
            "points": self.points,
            "points_inside": self.points_inside,
            "wrong_points": self.wrong_points,
        })
    }

    /// The inverse of [`Self::to_json`].
    pub fn from_json(value: Value) -> Self {
        let count = |name: &str| value[name].as_u64().unwrap_or_default();
        let size = |name: &str| count(name) as usize;
        let number = |name: &str| value[name].as_f64().unwrap_or(f64::NAN);
        Self {
            vertices: size("vertices"),
            holes: size("holes"),
            parts: size("parts"),
            pieces: size("pieces"),
            stored_vertices: size("stored_vertices"),
            triangles: size("triangles"),
            repairs: size("repairs"),
            overlaps: size("overlaps"),
            parse_s: number("parse_s"),
            build_s: number("build_s"),
            build_cpu_s: number("build_cpu_s"),
            measures_s: number("measures_s"),
            locator_s: number("locator_s"),
            query_us: number("query_us"),
            parse_peak_bytes: count("parse_peak_bytes"),
            build_peak_bytes: count("build_peak_bytes"),
            peak_bytes: count("peak_bytes"),
            open_pieces: size("open_pieces"),
            area_error: number("area_error"),
            area_bound: number("area_bound"),
            points: size("points"),
            points_inside: size("points_inside"),
            wrong_points: size("wrong_points"),
        }
    }
}
