//! What every mesh keeps, whatever it was made from.

use globefill::{FillMesh, Locator, LonLat, MeshOptions, Ring, fill_mesh::Bounds, glam::DVec3};

/// Meshes with more triangles are not asked point by point.
const MOST_TRIANGLES: usize = 3000;

/// The structure, the closed boundaries, the bounds.
pub fn check(mesh: &FillMesh, options: &MeshOptions) {
    check_vertices(mesh, options);
    check_order(mesh);
    check_closed(mesh);
    check_bounds(mesh);
}

fn check_vertices(mesh: &FillMesh, options: &MeshOptions) {
    let radii_m = mesh.ellipsoid.radii_m();
    for &position in &mesh.vertices {
        let length = (position / radii_m).length();
        assert!(
            (length - 1.0).abs() < 1e-14,
            "{position} is not on the ellipsoid: {length}"
        );
    }
    assert!(mesh.sag_m.is_finite() && mesh.sag_m >= 0.0);
    let most_m = options.tolerance_m.max(1e-3) * 1.000_1;
    for vertex in &mesh.boundary {
        assert!((0.0..=1.0).contains(&vertex.t));
        assert!(
            vertex.deviation_m >= 0.0 && f64::from(vertex.deviation_m) <= most_m,
            "{vertex:?}, {:?}",
            mesh.curves[vertex.curve as usize]
        );
    }
}

fn check_order(mesh: &FillMesh) {
    let mut next_vertex = 0;
    for arc in &mesh.arcs {
        assert_eq!(arc.first_vertex, next_vertex);
        assert!(arc.vertex_count >= 2);
        assert_ne!(arc.left, arc.right);
        next_vertex += arc.vertex_count;
        let run = &mesh.boundary[arc.first_vertex as usize..next_vertex as usize];
        for pair in run.windows(2) {
            let same_curve = pair[0].curve == pair[1].curve && pair[0].t < pair[1].t;
            let next_curve = pair[1].curve == pair[0].curve + 1 && pair[1].t == 0.0;
            assert!(same_curve || next_curve, "{pair:?}");
        }
    }
    assert_eq!(next_vertex as usize, mesh.boundary.len());
    let (mut next_piece, mut next_triangle) = (0, 0);
    for (index, fill) in mesh.fills.iter().enumerate() {
        assert_eq!(fill.first_piece, next_piece);
        next_piece += fill.piece_count;
        for piece in &mesh.pieces[fill.first_piece as usize..next_piece as usize] {
            assert_eq!(piece.fill as usize, index);
            assert_eq!(piece.first_triangle, next_triangle);
            next_triangle += piece.triangle_count;
        }
    }
    assert_eq!(next_piece as usize, mesh.pieces.len());
    assert_eq!(next_triangle as usize, mesh.cap_triangles.len());
    assert!(mesh.overlaps.is_sorted());
    for &(a, b) in &mesh.overlaps {
        assert!(a < b && (b as usize) < mesh.pieces.len());
    }
}

/// The signed boundary of a piece's triangles is its arcs, bit for bit.
fn check_closed(mesh: &FillMesh) {
    type Walk = (u32, [u64; 3], [u64; 3], i32);
    let key = |vertex: u32| {
        mesh.vertices[vertex as usize]
            .to_array()
            .map(|x| (x + 0.0).to_bits())
    };
    let mut walks: Vec<Walk> = Vec::new();
    let mut walk = |piece: u32, from: u32, to: u32, times: i32| {
        let (from, to) = (key(from), key(to));
        walks.push(if from < to {
            (piece, from, to, times)
        } else {
            (piece, to, from, -times)
        });
    };
    for arc in &mesh.arcs {
        for (side, times) in [(arc.left, -1), (arc.right, 1)] {
            let Some(piece) = side else { continue };
            for vertex in arc.first_vertex..arc.first_vertex + arc.vertex_count - 1 {
                walk(piece, vertex, vertex + 1, times);
            }
        }
    }
    for (index, piece) in (0..).zip(&mesh.pieces) {
        let first = piece.first_triangle as usize;
        for &[a, b, c] in &mesh.cap_triangles[first..first + piece.triangle_count as usize] {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                walk(index, from, to, 1);
            }
        }
    }
    walks.sort_unstable();
    for same in walks.chunk_by(|a, b| (a.0, a.1, a.2) == (b.0, b.1, b.2)) {
        let times: i32 = same.iter().map(|walk| walk.3).sum();
        assert!(
            times == 0 || same[0].1 == same[0].2,
            "piece {} is open",
            same[0].0
        );
    }
}

fn check_bounds(mesh: &FillMesh) {
    let inside = |bounds: &Bounds, position: DVec3| {
        let unit = (position / mesh.ellipsoid.radii_m()).normalize();
        2.0 * (0.5 * unit.distance(bounds.axis)).min(1.0).asin() <= bounds.radius_rad
    };
    for arc in &mesh.arcs {
        for vertex in arc.first_vertex..arc.first_vertex + arc.vertex_count {
            let position = mesh.vertices[vertex as usize];
            assert!(inside(&arc.bounds, position));
            let pieces = [arc.left, arc.right].into_iter().flatten();
            pieces.for_each(|piece| assert!(inside(&mesh.pieces[piece as usize].bounds, position)));
        }
    }
}

/// The caps cover what the locator says, once, and what two pieces cover is listed.
pub fn check_covering(mesh: &FillMesh, probes: impl Iterator<Item = LonLat>) {
    if mesh.cap_triangles.len() > MOST_TRIANGLES {
        return;
    }
    let locator = Locator::new(mesh);
    for probe in probes {
        let point = mesh.ellipsoid.ecef(probe.canonical(), 0.0);
        if is_near_boundary(mesh, point) {
            continue;
        }
        let fills = locator.fills_at(probe);
        // A pole may be a vertex of a cap, which no triangle has to itself.
        let point = point + 1e-13 * mesh.ellipsoid.a_m * DVec3::new(0.37, 0.61, 0.23);
        let mut covering: Vec<u32> = Vec::new();
        for (index, piece) in (0..).zip(&mesh.pieces) {
            let first = piece.first_triangle as usize;
            let triangles = &mesh.cap_triangles[first..first + piece.triangle_count as usize];
            let times: i32 = triangles
                .iter()
                .map(|&corners| covers(mesh, corners, point))
                .sum();
            assert!(
                (0..=1).contains(&times),
                "piece {index} covers {probe:?} {times} times"
            );
            if times == 1 {
                covering.push(index);
            }
        }
        let mut drawn: Vec<u32> = covering
            .iter()
            .map(|&piece| mesh.pieces[piece as usize].fill)
            .collect();
        drawn.dedup();
        assert_eq!(drawn, fills, "at {probe:?}");
        for (index, &a) in covering.iter().enumerate() {
            for &b in &covering[index + 1..] {
                assert!(
                    mesh.overlaps.binary_search(&(a, b)).is_ok(),
                    "{a} and {b} at {probe:?}"
                );
            }
        }
    }
}

/// Whether a triangle covers a surface point, seen from the centre: 1, or −1 from behind.
fn covers(mesh: &FillMesh, corners: [u32; 3], point: DVec3) -> i32 {
    let corners = corners.map(|corner| mesh.vertices[corner as usize]);
    let [a, b, c] = corners.map(|corner| corner - point);
    if corners.iter().any(|corner| corner.dot(point) <= 0.0) {
        return 0;
    }
    match [(a, b), (b, c), (c, a)].map(|(p, q)| p.cross(q).dot(point) > 0.0) {
        [true, true, true] => 1,
        [false, false, false] => -1,
        _ => 0,
    }
}

/// Whether a point is so near the boundary that chords, rulings and rounding may decide.
pub fn is_near_boundary(mesh: &FillMesh, point: DVec3) -> bool {
    let ellipsoid = &mesh.ellipsoid;
    mesh.arcs.iter().any(|arc| {
        let first = arc.first_vertex as usize;
        (first..first + arc.vertex_count as usize - 1).any(|index| {
            let (start, end) = (mesh.vertices[index], mesh.vertices[index + 1]);
            let chord = end - start;
            let across = chord
                .cross(ellipsoid.normal_at_surface(start + end))
                .normalize();
            let sag_m = chord.length_squared() / (8.0 * ellipsoid.b_m);
            let margin_m = 2.0 * f64::from(mesh.boundary[index].deviation_m)
                + 4.0 * ellipsoid.flattening().abs() * sag_m
                + 1e-12 * ellipsoid.a_m;
            let along_m = (point - start).dot(chord.normalize());
            (point - start).dot(across).abs() < margin_m
                && (-margin_m - sag_m..=chord.length() + margin_m + sag_m).contains(&along_m)
        })
    })
}

/// The locator answers as the even-odd rule on the lon/lat plane does, for a ring of straight edges
/// that lies away from the poles and spans less than half a turn.
pub fn check_plane(mesh: &FillMesh, ring: &Ring, probes: impl Iterator<Item = LonLat>) {
    /// Crossings are rounded to 2⁻³⁶°.
    const MARGIN_DEG: f64 = 1e-9;
    let locator = Locator::new(mesh);
    for probe in probes {
        let (mut inside, mut near) = (false, false);
        for (index, &a) in ring.iter().enumerate() {
            let b = ring[(index + 1) % ring.len()];
            let [(ax, ay), (bx, by)] =
                [a, b].map(|v| (v.lon_deg - probe.lon_deg, v.lat_deg - probe.lat_deg));
            let (ux, uy) = (bx - ax, by - ay);
            let length = ux.hypot(uy);
            let share = if length > 0.0 {
                (-(ax * ux + ay * uy) / (length * length)).clamp(0.0, 1.0)
            } else {
                0.0
            };
            near |= (ax + share * ux).hypot(ay + share * uy) < MARGIN_DEG;
            if (ay > 0.0) != (by > 0.0) && ax - ay * ux / uy > 0.0 {
                inside = !inside;
            }
        }
        if !near {
            assert_eq!(locator.contains(0, probe), inside, "{probe:?}");
        }
    }
}

/// Measures, extents and caps are numbers.
pub fn check_answers(mesh: &FillMesh) {
    let whole_m2 = 4.0 * std::f64::consts::PI * mesh.ellipsoid.radii_m().max_element().powi(2);
    for fill in 0..mesh.fills.len() as u32 {
        let measures = mesh.measures(fill);
        let pieces = f64::from(mesh.fills[fill as usize].piece_count);
        let least_m2 = -1e-9 * whole_m2;
        assert!(
            (least_m2..=whole_m2 * (pieces + 1e-9)).contains(&measures.area_m2),
            "{measures:?}"
        );
        assert!(measures.centroid().is_none_or(LonLat::is_valid));
        if let Some(cap) = mesh.bounding_cap(fill) {
            assert!((0.0..=4.0).contains(&cap.radius_rad), "{}", cap.radius_rad);
        }
        if let Some(extents) = mesh.extents(fill) {
            assert!(extents.west_deg < extents.east_deg, "{extents:?}");
            assert!(extents.south_deg <= extents.north_deg, "{extents:?}");
            assert!(
                extents.south_deg >= -90.0 && extents.north_deg <= 90.0,
                "{extents:?}"
            );
        }
    }
}
