//! Winding numbers of a footprint's loops.

use std::f64::consts::TAU;

use globefill::{
    Footprint, FootprintEdge,
    glam::{DVec2, DVec3},
};

/// The loops as fine polylines on a plane: stereographic about the apex, so that the whole visible cap
/// lies on it, and what is behind is far outside.
pub struct Outline {
    axes: [DVec3; 3],
    radii_m: DVec3,
    pub loops: Vec<Vec<DVec2>>,
    /// How far, metres on the ground, the polylines may be off.
    pub tolerance_m: f64,
}

impl Outline {
    pub fn of(footprint: &Footprint) -> Self {
        let radii_m = footprint.ellipsoid().radii_m();
        let middle = (footprint.sensor().pose.apex_ecef_m / radii_m).normalize();
        let across = middle.any_orthonormal_vector();
        let mut outline = Self {
            axes: [across, middle.cross(across), middle],
            radii_m,
            loops: Vec::new(),
            tolerance_m: 0.0,
        };
        let edges = || footprint.loops.iter().flat_map(|closed| &closed.edges);
        let ends: Vec<_> = edges()
            .flat_map(|edge| [0.0, 0.5].map(|t| edge.ecef_m(t)))
            .collect();
        let extent_m = ends
            .iter()
            .map(|end| (*end - ends[0]).length())
            .fold(0.0, f64::max);
        outline.tolerance_m = (1e-4 * extent_m).max(1e-6);
        outline.loops = footprint
            .loops
            .iter()
            .map(|closed| {
                let points = closed.edges.iter().flat_map(|edge| outline.trace(edge));
                points.map(|point_m| outline.flat(point_m)).collect()
            })
            .collect();
        outline
    }

    fn trace(&self, edge: &FootprintEdge) -> Vec<DVec3> {
        let mut points = Vec::new();
        let parts = 16;
        for part in 0..parts {
            let (from, to) = (part as f64 / 16.0, (part + 1) as f64 / 16.0);
            points.push(edge.ecef_m(from));
            self.refine(edge, from, to, 24, &mut points);
        }
        points
    }

    fn refine(
        &self,
        edge: &FootprintEdge,
        from: f64,
        to: f64,
        depth: u32,
        points: &mut Vec<DVec3>,
    ) {
        let middle = 0.5 * (from + to);
        let [a, m, b] = [from, middle, to].map(|t| edge.ecef_m(t));
        if depth > 0 && (m - 0.5 * (a + b)).length() > self.tolerance_m {
            self.refine(edge, from, middle, depth - 1, points);
            points.push(m);
            self.refine(edge, middle, to, depth - 1, points);
        }
    }

    pub fn flat(&self, point_m: DVec3) -> DVec2 {
        let unit = point_m / self.radii_m;
        let [x, y, z] = self.axes.map(|axis| axis.dot(unit));
        DVec2::new(x, y) / (1.0 + z)
    }

    /// Winding number about a point, none if it lies too near the outline to tell.
    pub fn winding(&self, point_m: DVec3) -> Option<i32> {
        let point = self.flat(point_m);
        let too_near = 3.0 * self.tolerance_m / self.radii_m.min_element();
        let mut turn = 0.0;
        for closed in &self.loops {
            for (k, &from) in closed.iter().enumerate() {
                let to = closed[(k + 1) % closed.len()];
                let (out, back) = (from - point, to - point);
                let along = to - from;
                let foot = (-out.dot(along) / along.length_squared()).clamp(0.0, 1.0);
                let foot = if foot.is_finite() { foot } else { 0.0 };
                if (out + along * foot).length() < too_near {
                    return None;
                }
                turn += out.perp_dot(back).atan2(out.dot(back));
            }
        }
        Some((turn / TAU).round() as i32)
    }
}
