//! The constrained Delaunay triangulation of a piece, and how often its loops wind around each face.

use glam::{DVec2, DVec3};
use rustc_hash::FxHashMap;
use spade::{
    ConstrainedDelaunayTriangulation, Point2, PositionInTriangulation, Triangulation,
    handles::{FixedDirectedEdgeHandle, FixedFaceHandle, FixedVertexHandle, InnerTag},
    mitigate_underflow,
};

use super::{Outline, chart::Chart, sleeve::walk};

pub(super) type Cdt = ConstrainedDelaunayTriangulation<Point2<f64>>;
/// A face with three corners.
pub(super) type Face = FixedFaceHandle<InnerTag>;

/// A triangulation in a chart in which every loop is a closed walk on constraint edges.
pub(super) struct Constrained {
    pub chart: Chart,
    pub cdt: Cdt,
    /// On the unit sphere, per vertex of the triangulation: first the boundary, then the interior.
    pub points: Vec<DVec3>,
    /// Per boundary vertex its index among the outline's points.
    names: Vec<u32>,
    /// Per undirected edge of the triangulation of the boundary, how often loops walk along it,
    /// less how often they walk against it. Constraint edges keep their handles when vertices are
    /// added, and edges made later bound nothing.
    walked: Vec<i32>,
    /// How often the loops wind around the chart's pole. If at all, the pole is a vertex, the last.
    pub winding_of_pole: i32,
    /// Per face, how often the loops wind around it.
    winding: Vec<i32>,
    /// Triangles of the outline's points between loop edges and their walks.
    ears: Vec<[u32; 3]>,
}

impl Constrained {
    /// Triangulates an outline; `None` if in this chart all its points lie on one line.
    pub(super) fn new(chart: Chart, winding_of_pole: i32, outline: &Outline) -> Option<Self> {
        let mut sites = Sites::new(&chart, &outline.points);
        let mut this = Self {
            chart,
            cdt: sites.triangulate(outline)?,
            points: sites
                .names
                .iter()
                .map(|&n| outline.points[n as usize])
                .collect(),
            names: sites.names,
            walked: Vec::new(),
            winding_of_pole,
            winding: Vec::new(),
            ears: Vec::new(),
        };
        this.walk_along(outline, &sites.of_point)?;
        this.winding = this.counted_winding();
        Some(this)
    }

    /// Maps every edge of the outline to a walk, with ears between the two.
    fn walk_along(&mut self, outline: &Outline, site_of_point: &[u32]) -> Option<()> {
        self.walked = vec![0; self.cdt.num_undirected_edges()];
        for [a, b] in outline.edges() {
            let [from, to] = [a, b].map(|point| site_of_point[point]);
            self.bridge(
                [a as u32, b as u32],
                [from, to].map(|s| self.names[s as usize]),
            );
            if from == to {
                continue;
            }
            let [from, to] = [from, to].map(|site| FixedVertexHandle::from_index(site as usize));
            let edges = walk(&self.cdt, &self.points, from, to)?;
            for &edge in &edges {
                self.count(edge);
            }
            if edges.len() > 1 {
                self.close(&edges);
            }
        }
        Some(())
    }

    fn count(&mut self, edge: FixedDirectedEdgeHandle) {
        self.walked[edge.as_undirected().index()] += direction(edge);
        if !self.cdt.is_constraint_edge(edge.as_undirected()) {
            let [from, to] = self.cdt.directed_edge(edge).vertices().map(|v| v.fix());
            // The edge exists, so this only marks it.
            self.cdt.add_constraint(from, to);
        }
    }

    /// The chain between a straight edge and a walk with the same ends: a negative fan.
    fn close(&mut self, edges: &[FixedDirectedEdgeHandle]) {
        let name = |vertex: FixedVertexHandle| self.names[vertex.index()];
        let mut fan = Vec::with_capacity(edges.len() - 1);
        let start = name(self.cdt.directed_edge(edges[0]).from().fix());
        for &edge in &edges[1..] {
            let [from, to] = self
                .cdt
                .directed_edge(edge)
                .vertices()
                .map(|v| name(v.fix()));
            fan.push([start, to, from]);
        }
        self.ears.extend(fan);
    }

    /// The chain between an edge and the same edge of the points that stand for its ends in the
    /// chart. The sides from end to end cancel around a loop.
    fn bridge(&mut self, [a, b]: [u32; 2], [site_a, site_b]: [u32; 2]) {
        if a != site_a || b != site_b {
            self.ears.push([a, b, site_b]);
            self.ears.push([a, site_b, site_a]);
        }
    }

    /// How often the loops wind around each face, counted from the pole inwards.
    fn counted_winding(&self) -> Vec<i32> {
        const UNKNOWN: i32 = i32::MIN;
        let mut winding = vec![UNKNOWN; self.cdt.num_all_faces()];
        winding[self.cdt.outer_face().fix().index()] = self.winding_of_pole;
        let hull = self.cdt.directed_edges().filter(|e| e.is_outer_edge());
        let mut pending: Vec<_> = hull.collect();
        while let Some(edge) = pending.pop() {
            let across = edge.rev().face();
            if winding[across.index()] != UNKNOWN {
                continue;
            }
            winding[across.index()] = winding[edge.face().index()] - self.walked_along(edge.fix());
            if let Some(face) = across.as_inner() {
                pending.extend(face.adjacent_edges());
            }
        }
        winding
    }

    /// How often loops walk along a directed edge, less how often against it.
    fn walked_along(&self, edge: FixedDirectedEdgeHandle) -> i32 {
        let walked = self.walked.get(edge.as_undirected().index());
        walked.map_or(0, |walked| walked * direction(edge))
    }

    /// How often the loops wind around a face.
    pub(super) fn winding(&self, face: Face) -> i32 {
        self.winding[face.index()]
    }

    /// The points of a face's corners.
    pub(super) fn corners(&self, face: Face) -> [DVec3; 3] {
        let vertices = self.cdt.face(face).vertices();
        vertices.map(|v| self.points[v.index()])
    }

    /// Adds a vertex, unless it would split a piece of boundary. It is looked for from `near` on.
    ///
    /// Edges that are flipped then are no boundary, so faces keep their winding numbers, and new faces
    /// have the one of the place where the vertex went.
    pub(super) fn insert(&mut self, plane: DVec2, point: DVec3, near: FixedVertexHandle) {
        let position = position(plane);
        let winding = match self.cdt.locate_with_hint(position, near) {
            PositionInTriangulation::OnFace(face) => Some(self.winding(face)),
            PositionInTriangulation::OnEdge(edge) => {
                let face = self.cdt.directed_edge(edge).face().fix();
                let is_boundary = self.cdt.is_constraint_edge(edge.as_undirected());
                (!is_boundary).then(|| self.winding[face.index()])
            }
            PositionInTriangulation::OutsideOfConvexHull(_) => Some(self.winding_of_pole),
            _ => None,
        };
        // A finite position is the only condition of an insertion.
        if let Some(winding) = winding
            && self.cdt.insert_with_hint(position, near).is_ok()
        {
            self.points.push(point);
            self.winding.resize(self.cdt.num_all_faces(), winding);
        }
    }

    /// Whether the winding numbers are those that counting anew gives.
    pub(super) fn is_wound(&self) -> bool {
        self.winding == self.counted_winding()
    }

    /// Every face as often as the loops wind around it, clockwise where they do so clockwise.
    pub(super) fn triangles(&self, boundary_points: usize) -> Vec<[u32; 3]> {
        let name = |vertex: usize| match self.names.get(vertex) {
            Some(&name) => name,
            None => (boundary_points + vertex - self.names.len()) as u32,
        };
        let mut triangles = self.ears.clone();
        for face in self.cdt.inner_faces() {
            let winding = self.winding[face.index()];
            let [a, b, c] = face.vertices().map(|v| name(v.index()));
            let triangle = if winding > 0 { [a, b, c] } else { [a, c, b] };
            triangles.extend((0..winding.unsigned_abs()).map(|_| triangle));
        }
        for _ in 0..self.winding_of_pole {
            let pole = name(self.points.len());
            let hull = self.cdt.convex_hull();
            // The outer face, and with it the pole, is on the left of these edges.
            triangles.extend(hull.map(|edge| {
                let [from, to] = edge.vertices().map(|v| name(v.index()));
                [from, to, pole]
            }));
        }
        triangles
    }

    /// Number of vertices that were added inside.
    pub(super) fn interior_count(&self) -> usize {
        self.points.len() - self.names.len()
    }

    /// The vertices that were added inside.
    pub(super) fn into_interior(mut self) -> Vec<DVec3> {
        let pole = (self.winding_of_pole != 0).then(|| -self.chart.centre());
        self.points.extend(pole);
        self.points.split_off(self.names.len())
    }
}

/// Whether a directed edge runs as its undirected edge is stored, as a sign.
fn direction(edge: FixedDirectedEdgeHandle) -> i32 {
    if edge.as_undirected().as_directed() == edge {
        1
    } else {
        -1
    }
}

/// A position that the triangulation accepts: it has no use for numbers below 10⁻⁴³.
pub(super) fn position(plane: DVec2) -> Point2<f64> {
    mitigate_underflow(Point2::new(plane.x, plane.y))
}

/// The distinct positions of points in a chart.
struct Sites {
    positions: Vec<Point2<f64>>,
    /// For each site the first point there.
    names: Vec<u32>,
    /// For each point its site.
    of_point: Vec<u32>,
}

impl Sites {
    fn new(chart: &Chart, points: &[DVec3]) -> Self {
        let mut sites = Self {
            positions: Vec::with_capacity(points.len()),
            names: Vec::with_capacity(points.len()),
            of_point: Vec::with_capacity(points.len()),
        };
        let mut known = FxHashMap::with_capacity_and_hasher(points.len(), Default::default());
        for (name, &point) in points.iter().enumerate() {
            let position = position(chart.project(point));
            // `+ 0.0` turns −0 into +0, so that equal positions have equal bits.
            let key = [position.x, position.y].map(|x| (x + 0.0).to_bits());
            let site = *known.entry(key).or_insert_with(|| {
                sites.positions.push(position);
                sites.names.push(name as u32);
                sites.names.len() as u32 - 1
            });
            sites.of_point.push(site);
        }
        sites
    }

    /// Triangulates the sites with all constraints that do not cross one before; the others, too,
    /// become walks later. `None` if the sites span no area.
    fn triangulate(&mut self, outline: &Outline) -> Option<Cdt> {
        let site_edges = outline
            .edges()
            .map(|edge| edge.map(|p| self.of_point[p] as usize));
        let constraints = site_edges.filter(|[from, to]| from != to).collect();
        let positions = std::mem::take(&mut self.positions);
        let cdt = Cdt::try_bulk_load_cdt(positions, constraints, |_| {}).ok()?;
        (cdt.num_inner_faces() > 0).then_some(cdt)
    }
}
