//! Whether a mesh is right, in one pass over it, without tables.

use globefill::{FillMesh, glam::DVec3};

/// The number of pieces whose triangles have another signed boundary than their arcs.
///
/// Each edge adds a number that is as good as random, with its sign: the sums vanish if all edges
/// cancel, and by chance once in 2⁶⁴ otherwise.
pub fn open_pieces(mesh: &FillMesh) -> usize {
    // Equal positions are one point.
    let names: Vec<u64> = mesh
        .vertices
        .iter()
        .map(|&position| name(position))
        .collect();
    let mut sums = vec![0_u64; mesh.pieces.len()];
    for arc in &mesh.arcs {
        let first = arc.first_vertex as usize;
        for pair in names[first..first + arc.vertex_count as usize].windows(2) {
            let edge = signed(pair[0], pair[1]);
            if let Some(piece) = arc.left {
                sums[piece as usize] = sums[piece as usize].wrapping_sub(edge);
            }
            if let Some(piece) = arc.right {
                sums[piece as usize] = sums[piece as usize].wrapping_add(edge);
            }
        }
    }
    for (piece, sum) in mesh.pieces.iter().zip(&mut sums) {
        let first = piece.first_triangle as usize;
        for corners in &mesh.cap_triangles[first..first + piece.triangle_count as usize] {
            let [a, b, c] = corners.map(|corner| names[corner as usize]);
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *sum = sum.wrapping_add(signed(from, to));
            }
        }
    }
    sums.iter().filter(|&&sum| sum != 0).count()
}

fn name(position: DVec3) -> u64 {
    // `+ 0.0` turns −0 into +0.
    let bits = position.to_array().map(|x| (x + 0.0).to_bits());
    bits.into_iter().fold(1, |name, bits| mix(name ^ bits))
}

fn signed(from: u64, to: u64) -> u64 {
    let edge = mix(mix(from.min(to)).wrapping_add(from.max(to)));
    match from.cmp(&to) {
        std::cmp::Ordering::Less => edge,
        std::cmp::Ordering::Equal => 0,
        std::cmp::Ordering::Greater => edge.wrapping_neg(),
    }
}

/// The finaliser of splitmix64.
pub fn mix(mut x: u64) -> u64 {
    x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// The greatest difference between a fill's caps and what its true edges enclose, and the greatest that
/// drawn chords allow, both as shares of all fills' area.
///
/// A chord may enclose its length times its deviation more or less, and 1 µm of rounding to either side.
pub fn area_error(mesh: &FillMesh, measured_m2: &[f64]) -> (f64, f64) {
    let sphere = AuthalicSphere::new(mesh);
    let points: Vec<DVec3> = mesh
        .vertices
        .iter()
        .map(|&vertex| sphere.place(vertex))
        .collect();
    let mut caps_m2 = vec![0.0; mesh.fills.len()];
    for piece in &mesh.pieces {
        let first = piece.first_triangle as usize;
        let triangles = &mesh.cap_triangles[first..first + piece.triangle_count as usize];
        let area_sr: f64 = triangles
            .iter()
            .map(|corners| excess(corners.map(|corner| points[corner as usize])))
            .sum();
        caps_m2[piece.fill as usize] += area_sr * sphere.radius_m.powi(2);
    }
    let mut allowed_m2 = vec![0.0; mesh.fills.len()];
    for arc in &mesh.arcs {
        let first = arc.first_vertex as usize;
        let run = first..first + arc.vertex_count as usize;
        let chords = mesh.vertices[run.clone()].windows(2);
        let beside_m2: f64 = chords
            .zip(&mesh.boundary[run])
            .map(|(pair, vertex)| {
                pair[0].distance(pair[1]) * (2.0 * f64::from(vertex.deviation_m) + 1e-6)
            })
            .sum();
        for piece in [arc.left, arc.right].into_iter().flatten() {
            allowed_m2[mesh.pieces[piece as usize].fill as usize] += beside_m2;
        }
    }
    let all_m2: f64 = measured_m2.iter().sum();
    let worst = caps_m2
        .iter()
        .zip(measured_m2)
        .map(|(caps_m2, measured_m2)| (caps_m2 - measured_m2).abs())
        .fold(0.0, f64::max);
    let allowed_m2 = allowed_m2.into_iter().fold(0.0, f64::max);
    (worst / all_m2, allowed_m2 / all_m2 + 1e-10)
}

/// The sphere of the ellipsoid's area, on which places have the longitude of theirs and areas are equal.
struct AuthalicSphere {
    eccentricity: f64,
    q_at_pole: f64,
    axis_ratio_squared: f64,
    radius_m: f64,
}

impl AuthalicSphere {
    fn new(mesh: &FillMesh) -> Self {
        let (a_m, b_m) = (mesh.ellipsoid.a_m, mesh.ellipsoid.b_m);
        let eccentricity = (1.0 - (b_m / a_m).powi(2)).sqrt();
        let q_at_pole = q(eccentricity, 1.0);
        Self {
            eccentricity,
            q_at_pole,
            axis_ratio_squared: (a_m / b_m).powi(2),
            radius_m: a_m * (0.5 * q_at_pole).sqrt(),
        }
    }

    /// Snyder 1987, equations 3-11 and 3-12.
    fn place(&self, ecef_m: DVec3) -> DVec3 {
        let across = ecef_m.x.hypot(ecef_m.y);
        let up = ecef_m.z * self.axis_ratio_squared;
        let sin_lat = up / up.hypot(across);
        let sin = (q(self.eccentricity, sin_lat) / self.q_at_pole).clamp(-1.0, 1.0);
        let cos = (1.0 - sin * sin).sqrt();
        if across == 0.0 {
            return DVec3::new(0.0, 0.0, sin);
        }
        DVec3::new(cos * ecef_m.x / across, cos * ecef_m.y / across, sin).normalize()
    }
}

fn q(e: f64, sin: f64) -> f64 {
    (1.0 - e * e) * (sin / (1.0 - (e * sin).powi(2)) + (e * sin).atanh() / e)
}

/// Signed area of a spherical triangle, steradians.
fn excess([a, b, c]: [DVec3; 3]) -> f64 {
    // Relative to one corner the determinant keeps its digits.
    let volume = a.dot((b - a).cross(c - a));
    2.0 * volume.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}
