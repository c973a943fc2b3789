//! Two neighbouring polygons with one common edge, and a mesh of them made without the mesher: fans
//! about a middle vertex, so that the renderer is tested apart from it.

use glam::DVec3;
use globefill::{
    Curve, EdgeKind, Ellipsoid, FillMesh, LonLat, Polygon, Region,
    fill_mesh::{Arc, BoundaryVertex, Bounds, Fill, Piece},
};

/// What stored boundaries may lie beside the true ones.
const TOLERANCE_M: f64 = 5.0;

/// Fill 0 lies to the left of the edge `a` → `b`, fill 1 to the right.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    pub kind: EdgeKind,
    pub a: LonLat,
    pub b: LonLat,
    pub left: LonLat,
    pub right: LonLat,
}

impl Pair {
    /// An edge of `length_deg` of arc about a middle point, and its neighbours of the same size.
    pub fn about(
        kind: EdgeKind,
        lon_deg: f64,
        lat_deg: f64,
        heading_deg: f64,
        length_deg: f64,
    ) -> Self {
        let (sin, cos) = heading_deg.to_radians().sin_cos();
        let at = |along: f64, left: f64| {
            let (east, north) = (along * sin - left * cos, along * cos + left * sin);
            LonLat::new(
                lon_deg + length_deg * east / lat_deg.to_radians().cos(),
                lat_deg + length_deg * north,
            )
        };
        Self {
            kind,
            a: at(-0.5, 0.0),
            b: at(0.5, 0.0),
            left: at(0.1, 0.9),
            right: at(-0.1, -0.9),
        }
    }

    pub fn regions(&self) -> Vec<Region> {
        [[self.a, self.b, self.left], [self.b, self.a, self.right]]
            .map(|shell| Region {
                polygons: vec![Polygon {
                    shell: shell.to_vec(),
                    holes: vec![],
                }],
                edges: self.kind,
                ..Default::default()
            })
            .to_vec()
    }

    pub fn mesh(&self) -> FillMesh {
        let mut mesh = FillMesh::default();
        let common = mesh_arc(&mut mesh, self.kind, &[self.a, self.b], Some(0), Some(1));
        let left = mesh_arc(
            &mut mesh,
            self.kind,
            &[self.b, self.left, self.a],
            Some(0),
            None,
        );
        let right = mesh_arc(
            &mut mesh,
            self.kind,
            &[self.b, self.right, self.a],
            None,
            Some(1),
        );
        let mut outline: Vec<u32> = common.clone().chain(left).collect();
        mesh_fan(&mut mesh, &outline, 0);
        outline = common.chain(right).collect();
        outline.reverse();
        mesh_fan(&mut mesh, &outline, 1);
        mesh.sag_m = sag_m(&mesh);
        mesh
    }
}

/// Adds an arc through the vertices; returns its vertices.
fn mesh_arc(
    mesh: &mut FillMesh,
    kind: EdgeKind,
    through: &[LonLat],
    left: Option<u32>,
    right: Option<u32>,
) -> std::ops::Range<u32> {
    let first_vertex = mesh.vertices.len() as u32;
    for ends in through.windows(2) {
        let curve = Curve::between(kind, ends[0], ends[1]);
        let on = curve.on(&Ellipsoid::WGS84);
        let index = mesh.curves.len() as u32;
        mesh.curves.push(curve);
        let fits = |steps: &u32| {
            let n = f64::from(*steps);
            (0..*steps).all(|k| {
                let (t0, t1) = (f64::from(k) / n, f64::from(k + 1) / n);
                on.deviation_bound_m(t0, t1) <= TOLERANCE_M
            })
        };
        let steps = (1..).find(fits).expect("some number of steps fits");
        let n = f64::from(steps);
        for k in 0..steps {
            let (t, next) = (f64::from(k) / n, f64::from(k + 1) / n);
            mesh.vertices.push(on.ecef(t));
            mesh.boundary.push(BoundaryVertex {
                curve: index,
                deviation_m: (on.deviation_bound_m(t, next) as f32).next_up(),
                t,
            });
        }
        if std::ptr::eq(&ends[1], &through[through.len() - 1]) {
            mesh.vertices.push(on.ecef(1.0));
            mesh.boundary.push(BoundaryVertex {
                curve: index,
                deviation_m: 0.0,
                t: 1.0,
            });
        }
    }
    let range = first_vertex..mesh.vertices.len() as u32;
    mesh.arcs.push(Arc {
        first_vertex,
        vertex_count: range.len() as u32,
        left,
        right,
        bounds: bounds(mesh, range.clone()),
    });
    range
}

/// Adds a fill of one piece: a fan about a new vertex in the middle of the closed outline.
fn mesh_fan(mesh: &mut FillMesh, outline: &[u32], piece: u32) {
    let hub = mesh.vertices.len() as u32;
    let sum: DVec3 = outline.iter().map(|&v| mesh.vertices[v as usize]).sum();
    let (foot, _) = Ellipsoid::WGS84.geodetic(sum / outline.len() as f64);
    mesh.vertices.push(Ellipsoid::WGS84.ecef(foot, 0.0));
    let first_triangle = mesh.cap_triangles.len() as u32;
    let triangles = outline
        .iter()
        .zip(outline.iter().cycle().skip(1))
        .filter(|&(&v, &w)| mesh.vertices[v as usize] != mesh.vertices[w as usize])
        .map(|(&v, &w)| [hub, v, w]);
    mesh.cap_triangles.extend(triangles);
    mesh.pieces.push(Piece {
        fill: piece,
        first_triangle,
        triangle_count: mesh.cap_triangles.len() as u32 - first_triangle,
        bounds: bounds(mesh, outline.iter().copied()),
    });
    mesh.fills.push(Fill {
        first_piece: piece,
        piece_count: 1,
    });
}

fn bounds(mesh: &FillMesh, vertices: impl Iterator<Item = u32> + Clone) -> Bounds {
    let radii_m = Ellipsoid::WGS84.radii_m();
    let scaled = vertices.map(|v| (mesh.vertices[v as usize] / radii_m).normalize());
    let axis = scaled.clone().sum::<DVec3>().normalize();
    // A margin for edges that bulge between the vertices.
    let radius_rad = 1.01 * scaled.map(|v| v.angle_between(axis)).fold(0.0, f64::max) + 1e-5;
    Bounds { axis, radius_rad }
}

/// L²/6R of the longest side of a triangle bounds what lies below the surface there; doubled.
fn sag_m(mesh: &FillMesh) -> f64 {
    let longest_m = mesh
        .cap_triangles
        .iter()
        .flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])])
        .map(|(v, w)| mesh.vertices[v as usize].distance(mesh.vertices[w as usize]))
        .fold(0.0, f64::max);
    longest_m * longest_m / (3.0 * Ellipsoid::WGS84.b_m)
}
