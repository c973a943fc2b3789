//! Single stages of the error budget (docs/accuracy.md) that no other test measures, without a GPU:
//! `cargo test --test error_budget -- --nocapture`

mod common;

use common::{edge::TrueEdge, figure::Figure};
use glam::DVec3;
use globefill::{
    EdgeKind, Ellipsoid, FillMesh, LonLat, Polygon, Region, countries::Dataset,
    fill_mesh::MeshOptions,
};

const KINDS: [EdgeKind; 3] = [EdgeKind::Straight, EdgeKind::Rhumb, EdgeKind::Geodesic];

fn figure() -> Figure {
    Figure::new(Ellipsoid::WGS84)
}

fn region(kind: EdgeKind, shell: Vec<LonLat>) -> Region {
    Region {
        polygons: vec![Polygon {
            shell,
            holes: vec![],
        }],
        edges: kind,
        ..Default::default()
    }
}

fn meshed(regions: &[Region], tolerance_m: f64) -> FillMesh {
    let options = MeshOptions {
        tolerance_m,
        ..MeshOptions::default()
    };
    FillMesh::build(regions, &options).expect("sound regions")
}

/// Numbers 0 … 1, the same every time: multiples of the golden section.
fn numbers() -> impl FnMut() -> f64 {
    let mut k = 0.0;
    move || {
        k += 1.0;
        (k * 0.618_033_988_749_894_9_f64 + 0.137 * (k * 0.754_877_666_246_692_7).fract()).fract()
    }
}

/// Half a lattice step of 2⁻³⁶° along each axis.
#[test]
fn vertices_are_rounded_by_half_a_lattice_step() {
    let figure = figure();
    let mut next = numbers();
    let mut worst_m = 0.0_f64;
    let mut count = 0;
    for _ in 0..2_000 {
        let (lon_deg, lat_deg) = (360.0 * next() - 180.0, 176.0 * next() - 88.0);
        let written: Vec<LonLat> = [(0.0, 0.0), (0.3, 0.1), (0.1, 0.4)]
            .map(|(east, north)| LonLat::new(lon_deg + east + 1e-3 * next(), lat_deg + north))
            .to_vec();
        let mesh = meshed(&[region(EdgeKind::Geodesic, written.clone())], 5.0);
        assert_eq!(mesh.curves.len(), 3);
        for vertex in written {
            let vertex_m = figure.ecef(vertex, 0.0);
            let away_m = |rounded: &LonLat| figure.ecef(*rounded, 0.0).distance(vertex_m);
            let ends = mesh.curves.iter().map(|curve| curve.from);
            let nearest_m = ends.map(|end| away_m(&end)).fold(f64::INFINITY, f64::min);
            worst_m = worst_m.max(nearest_m);
            count += 1;
        }
    }
    println!("{count} vertices: moved by up to {:.2} µm", 1e6 * worst_m);
    // Both axes at once, at the equator; rounding of positions in f64.
    assert!(worst_m < 1.15e-6 + 4e-9, "{worst_m}");
}

/// Stored chords against the true edge, at two points of each.
#[test]
fn chords_lie_as_close_as_was_asked() {
    let figure = figure();
    let shells = [
        [(-100.0, 49.0), (-70.0, 49.0), (-80.0, 60.0)],
        [(170.0, -17.0), (195.0, -12.0), (180.0, 3.0)],
        [(20.0, 86.0), (50.0, 88.0), (35.0, 80.0)],
    ];
    for tolerance_m in [100.0, 5.0, 1.0] {
        let (mut worst_m, mut bound_m, mut chords) = (0.0_f64, 0.0_f64, 0);
        for (kind, shell) in KINDS
            .iter()
            .flat_map(|kind| shells.map(|shell| (*kind, shell)))
        {
            let shell = shell.map(|(lon_deg, lat_deg)| LonLat::new(lon_deg, lat_deg));
            let edges: Vec<TrueEdge> = (0..3)
                .flat_map(|k| TrueEdge::between(&figure, kind, shell[k], shell[(k + 1) % 3]))
                .collect();
            let mesh = meshed(&[region(kind, shell.to_vec())], tolerance_m);
            for arc in &mesh.arcs {
                let first = arc.first_vertex as usize;
                for vertex in first..first + arc.vertex_count as usize - 1 {
                    let said_m = f64::from(mesh.boundary[vertex].deviation_m);
                    let [a, b] = [vertex, vertex + 1].map(|end| mesh.vertices[end]);
                    for share in [0.5, 0.75] {
                        let (foot, _) = figure.geodetic(a.lerp(b, share));
                        let foot_m = figure.ecef(foot, 0.0);
                        let off_m = edges
                            .iter()
                            .filter(|edge| edge.middle_m.distance(foot_m) < edge.radius_m + 1e3)
                            .map(|edge| edge.nearest(&figure, foot_m).0)
                            .fold(f64::INFINITY, f64::min);
                        // Vertices are rounded, and so is the search for the nearest point.
                        assert!(off_m <= said_m + 3e-6, "{kind:?} {off_m} > {said_m}");
                        worst_m = worst_m.max(off_m);
                    }
                    bound_m = bound_m.max(said_m);
                    chords += 1;
                }
            }
        }
        println!(
            "tolerance {tolerance_m} m: {chords} chords say up to {bound_m:.3} m and are off by up to {worst_m:.3} m"
        );
        assert!(bound_m <= tolerance_m && chords > 100);
    }
}

/// The deepest of a triangle's points below the ellipsoid, metres.
fn depth_m(figure: &Figure, corners: [DVec3; 3]) -> f64 {
    const STEPS: u32 = 6;
    let mut deepest_m = 0.0_f64;
    for i in 0..=STEPS {
        for j in 0..=STEPS - i {
            let [u, v] = [i, j].map(|k| f64::from(k) / f64::from(STEPS));
            let point_m = corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v;
            deepest_m = deepest_m.max(-figure.geodetic(point_m).1);
        }
    }
    deepest_m
}

#[test]
fn caps_sag_no_deeper_than_the_mesh_says() {
    let figure = figure();
    let at = |(lon_deg, lat_deg)| LonLat::new(lon_deg, lat_deg);
    let everything = [
        (-180.0, -90.0),
        (180.0, -90.0),
        (180.0, 90.0),
        (-180.0, 90.0),
    ]
    .map(at);
    let globe = vec![region(EdgeKind::Straight, everything.to_vec())];
    let countries = Dataset::Countries110m.countries().into_iter();
    let countries: Vec<Region> = countries.map(|country| country.region).collect();
    for (name, regions) in [("the whole globe", globe), ("countries at 110m", countries)] {
        let mesh = meshed(&regions, 5.0);
        let corners = mesh.cap_triangles.iter();
        let deepest_m = corners
            .map(|corners| corners.map(|corner| mesh.vertices[corner as usize]))
            .map(|corners| depth_m(&figure, corners))
            .fold(0.0, f64::max);
        println!(
            "{name}: {} triangles, {deepest_m:.0} m below the ellipsoid; the mesh says {:.0} m",
            mesh.cap_triangles.len(),
            mesh.sag_m
        );
        assert!(deepest_m <= mesh.sag_m && mesh.sag_m < 1_300.0);
        assert!(deepest_m > 0.5 * mesh.sag_m, "the bound is loose");
    }
}

/// Foot points of the shaders' formulas in f64: what is left is not rounding. τ as seen.wgsl takes it,
/// and with the step of Newton's method that surface.wgsl adds.
fn foots_m(ellipsoid: Ellipsoid, point_m: DVec3) -> [DVec3; 2] {
    let a = ellipsoid.a_m;
    let squash = (a / ellipsoid.b_m).powi(2);
    let m = DVec3::new(1.0, 1.0, squash);
    let outside = point_m.dot(m * point_m) / a - a;
    let relative = outside / a;
    let root = (1.0 + relative).sqrt();
    let gradient = (m * point_m).length_squared();
    let tau = relative * (a * a) * (1.0 + relative) / ((1.0 + root) * gradient);
    let foot = |tau: f64| point_m / (DVec3::ONE + tau * m);
    let normal = m * foot(tau);
    let off = foot(tau).dot(normal) - a * a;
    let shrink = DVec3::ONE / (DVec3::ONE + tau * m);
    [
        foot(tau),
        foot(tau + 0.5 * off / normal.dot(shrink * normal)),
    ]
}

/// The bounds of the comments in seen.wgsl and surface.wgsl.
#[test]
fn foot_points_of_the_shaders_are_those_of_vermeille() {
    let figure = figure();
    // Rounding of both in f64.
    const ROUNDING_M: f64 = 6e-9;
    for (height_m, quick_m) in [(9e3, 2e-9), (9e4, 1e-6), (1e6, 1e-3)] {
        let mut worst_m = [0.0_f64; 2];
        for step in 0..=1_800 {
            let lat_deg = f64::from(step) / 20.0;
            let point_m = figure.ecef(LonLat::new(31.0, lat_deg), height_m);
            let (foot, _) = figure.geodetic(point_m);
            let (foot_m, normal) = (figure.ecef(foot, 0.0), figure.normal(foot));
            for (worst_m, found_m) in worst_m.iter_mut().zip(foots_m(Ellipsoid::WGS84, point_m)) {
                // Beside the true foot point: along the normal it does not matter.
                let off_m = (found_m - foot_m).reject_from_normalized(normal).length();
                *worst_m = worst_m.max(off_m);
            }
        }
        let [quick, exact] = worst_m;
        println!(
            "{height_m} m high: {quick:.1e} m beside by seen.wgsl, {exact:.1e} m by surface.wgsl"
        );
        assert!(
            quick <= quick_m + ROUNDING_M && exact <= 1e-6 + ROUNDING_M,
            "{worst_m:?}"
        );
    }
}
