//! The CPU pipeline: regions → rings → nodes → loops → arcs → vertices → triangles.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

use crate::{
    boundary::arcs::{Chain, EdgeSides, chains},
    boundary::authalic::Authalic,
    boundary::bound_polygons::bound_polygons,
    boundary::boundary_graph::BoundaryGraph,
    boundary::inside::Boundary,
    boundary::noding::{PolygonPairs, PolygonWalk, node_boundaries},
    boundary::overlaps::overlaps,
    boundary::rings::walk_ring,
    boundary::zones::walk_zone,
    ellipsoid::Ellipsoid,
    error::RegionError,
    fill_mesh::{Arc, BoundaryVertex, Bounds, Fill, FillMesh, MeshOptions, Piece},
    geodetic::LonLat,
    limits::{Excess, Quantity},
    mesh::densify::{DenseChain, densify},
    mesh::levels::coarser,
    mesh::vertex_room::VertexRoom,
    mesh::vertex_runs::VertexRuns,
    region::{Polygon, Region},
    repair::{Place, Repair},
    zone::Zone,
};

/// Runs the whole pipeline.
pub(crate) fn build(regions: &[Region], options: &MeshOptions) -> Result<FillMesh, RegionError> {
    let ellipsoid = options.ellipsoid;
    let mut mesh = FillMesh {
        ellipsoid,
        ..FillMesh::default()
    };
    if !ellipsoid.is_supported() {
        return Err(RegionError::InvalidEllipsoid {
            a_m: ellipsoid.a_m,
            b_m: ellipsoid.b_m,
        });
    }
    let limits = &options.limits;
    limits.check(Quantity::Rings, count_rings(regions))?;
    let vertex_count = count_vertices(regions);
    limits.check(Quantity::Vertices, vertex_count)?;
    let mut graph = BoundaryGraph::with_capacity(vertex_count);
    let mut polygons = walk_polygons(regions, &ellipsoid, &mut graph, &mut mesh.repairs)?;
    let repairs = &mut mesh.repairs;
    let crossing = node_boundaries(&ellipsoid, &mut graph, &mut polygons, repairs, limits)?;
    let graph = graph.finished();
    let boundaries = bound_polygons(regions, &ellipsoid, &graph, &polygons, &mut mesh.repairs)?;
    mesh.repairs.sort_by_key(|repair| {
        let Place {
            region,
            polygon,
            ring,
            vertex,
        } = repair.place;
        (region, polygon, ring, vertex)
    });

    let piece_of_polygon = mesh.add_pieces(regions.len(), &polygons, &boundaries);
    drop(polygons);
    let pieces: Vec<Boundary> = boundaries.into_iter().flatten().collect();
    let sides = EdgeSides::new(&graph, &pieces);
    let crossing = crossing_pieces(crossing, &piece_of_polygon);
    let (overlaps, added): (_, Result<(), Excess>) = rayon::join(
        || overlaps(&ellipsoid, &graph, &sides, &pieces, crossing, limits),
        || {
            let chains = chains(&graph, &sides, &pieces);
            let vertex_runs = mesh.add_arcs(&graph, &chains, options)?;
            let loops_of = |piece: usize| -> Vec<Vec<u32>> {
                let loops = pieces[piece].loops.iter();
                loops
                    .map(|edges| vertex_runs.loop_vertices(edges))
                    .collect()
            };
            let inside_sr = inside_sr(&ellipsoid, &pieces);
            mesh.add_caps(loops_of, &inside_sr, limits)?;
            mesh.coarser = coarser(&mesh, &inside_sr, options.tolerance_m, limits)?;
            Ok(())
        },
    );
    mesh.overlaps = overlaps?;
    added?;
    Ok(mesh)
}

/// The area inside each piece's loops, on the unit sphere.
fn inside_sr(ellipsoid: &Ellipsoid, pieces: &[Boundary]) -> Vec<f64> {
    let authalic = Authalic::new(*ellipsoid);
    let of_piece = |piece: &Boundary| 4.0 * PI * authalic.left_share(piece.enclosed);
    pieces.iter().map(of_piece).collect()
}

fn count_vertices(regions: &[Region]) -> usize {
    let polygons = regions.iter().flat_map(|region| &region.polygons);
    let of_rings = polygons.flat_map(rings_of).map(|(_, ring)| ring.len());
    let of_zones = regions.iter().flat_map(|region| &region.zones);
    let of_zones = of_zones.map(|zone| match zone {
        Zone::Corridor { points, .. } => points.len(),
        _ => 1,
    });
    of_rings.chain(of_zones).sum()
}

fn count_rings(regions: &[Region]) -> usize {
    let of_region = |region: &Region| {
        let of_polygons = region
            .polygons
            .iter()
            .map(|polygon| 1 + polygon.holes.len());
        region.zones.len() + of_polygons.sum::<usize>()
    };
    regions.iter().map(of_region).sum()
}

/// Shell and holes, numbered.
fn rings_of(polygon: &Polygon) -> impl Iterator<Item = (usize, &[LonLat])> {
    let holes = polygon.holes.iter().map(Vec::as_slice);
    std::iter::once(polygon.shell.as_slice())
        .chain(holes)
        .enumerate()
}

fn walk_polygons(
    regions: &[Region],
    ellipsoid: &Ellipsoid,
    graph: &mut BoundaryGraph,
    repairs: &mut Vec<Repair>,
) -> Result<Vec<PolygonWalk>, RegionError> {
    let mut walks = Vec::new();
    for (region_index, region) in regions.iter().enumerate() {
        for (polygon_index, polygon) in region.polygons.iter().enumerate() {
            let place = Place {
                region: region_index,
                polygon: polygon_index,
                ..Place::default()
            };
            let mut walk = PolygonWalk {
                place,
                rings: Vec::with_capacity(1 + polygon.holes.len()),
                is_zone: false,
            };
            for (ring_index, ring) in rings_of(polygon) {
                let place = Place {
                    ring: ring_index,
                    ..place
                };
                walk.rings.push(walk_ring(
                    ring,
                    region.edges,
                    ellipsoid,
                    place,
                    graph,
                    repairs,
                )?);
            }
            walks.push(walk);
        }
        for (zone_index, zone) in region.zones.iter().enumerate() {
            let place = Place {
                region: region_index,
                polygon: region.polygons.len() + zone_index,
                ..Place::default()
            };
            walks.push(walk_zone(zone, ellipsoid, place, graph)?);
        }
    }
    Ok(walks)
}

fn crossing_pieces(crossing: PolygonPairs, piece_of_polygon: &[Option<u32>]) -> Vec<(u32, u32)> {
    crossing
        .into_iter()
        .filter_map(|(a, b)| {
            let [a, b] = [a, b].map(|polygon| piece_of_polygon[polygon as usize]);
            a.zip(b)
        })
        .collect()
}

/// Chains are densified so many edges at a time: what is not yet in the mesh stays small.
const BATCH_EDGES: usize = 1 << 18;

fn batches<'a>(chains: &'a [&'a Chain]) -> impl Iterator<Item = &'a [&'a Chain]> {
    let mut rest = chains;
    std::iter::from_fn(move || {
        let mut edges = 0;
        let is_within = |chain: &&&Chain| {
            edges += chain.edges.len();
            edges <= BATCH_EDGES
        };
        // One at least, however long it is.
        let count = rest.iter().take_while(is_within).count().max(1);
        let (batch, others) = rest.split_at_checked(count)?;
        rest = others;
        Some(batch)
    })
}

impl FillMesh {
    /// Adds fills and pieces; answers the piece of each polygon.
    fn add_pieces(
        &mut self,
        fill_count: usize,
        polygons: &[PolygonWalk],
        boundaries: &[Option<Boundary>],
    ) -> Vec<Option<u32>> {
        self.fills = vec![Fill::default(); fill_count];
        let mut piece_of_polygon = Vec::with_capacity(polygons.len());
        for (walk, boundary) in polygons.iter().zip(boundaries) {
            piece_of_polygon.push(boundary.as_ref().map(|_| self.pieces.len() as u32));
            if boundary.is_some() {
                let fill = walk.place.region as u32;
                self.pieces.push(Piece {
                    fill,
                    ..Piece::default()
                });
                self.fills[walk.place.region].piece_count += 1;
            }
        }
        let mut first_piece = 0;
        for fill in &mut self.fills {
            fill.first_piece = first_piece;
            first_piece += fill.piece_count;
        }
        piece_of_polygon
    }

    /// Adds arcs with their vertices and curves.
    fn add_arcs(
        &mut self,
        graph: &BoundaryGraph,
        chains: &[Chain],
        options: &MeshOptions,
    ) -> Result<VertexRuns, Excess> {
        let ellipsoid = self.ellipsoid;
        let node_ecef_m: Vec<DVec3> = graph
            .nodes
            .par_iter()
            .with_min_len(256)
            .map(|point| ellipsoid.ecef(point.lon_lat(), 0.0))
            .collect();
        let room = VertexRoom::new(options.limits);
        let tolerance_m = options.tolerance_m;
        let edge_count = chains.iter().map(|chain| chain.edges.len()).sum();
        self.curves.reserve(edge_count);
        self.vertices.reserve(edge_count + chains.len());
        self.boundary.reserve(edge_count + chains.len());
        let mut runs = VertexRuns::new(graph);
        let originals: Vec<&Chain> = chains.iter().filter(|chain| !chain.is_copy).collect();
        for batch in batches(&originals) {
            let dense: Vec<DenseChain> = batch
                .par_iter()
                .map(|chain| densify(&ellipsoid, graph, &node_ecef_m, chain, tolerance_m, &room))
                .collect();
            room.check()?;
            for (chain, dense) in batch.iter().zip(dense) {
                runs.add(chain, &dense, self.vertices.len() as u32);
                self.add_arc(chain, &dense);
            }
        }
        for chain in chains.iter().filter(|chain| chain.is_copy) {
            let copy = self.copy_of(graph, chain, &runs);
            room.take(copy.vertices.len());
            room.check()?;
            self.add_arc(chain, &copy);
        }
        self.bound_arcs();
        Ok(runs)
    }

    fn add_arc(&mut self, chain: &Chain, dense: &DenseChain) {
        let first_curve = self.curves.len() as u32;
        self.sag_m = self
            .sag_m
            .max(self.ellipsoid.chord_sag_m(dense.longest_chord_m));
        self.arcs.push(Arc {
            first_vertex: self.vertices.len() as u32,
            vertex_count: dense.vertices.len() as u32,
            left: Some(chain.left),
            right: chain.right,
            bounds: Bounds::default(),
        });
        self.vertices.extend_from_slice(&dense.vertices);
        self.curves.extend_from_slice(&dense.curves);
        self.boundary
            .extend(dense.boundary.iter().map(|vertex| BoundaryVertex {
                curve: first_curve + vertex.curve,
                ..*vertex
            }));
    }

    /// A chain's vertices from the arcs that run along the same edges already: bit for bit the same
    /// positions, in this chain's order.
    fn copy_of(&self, graph: &BoundaryGraph, chain: &Chain, runs: &VertexRuns) -> DenseChain {
        let mut copy = DenseChain::default();
        for &edge in &chain.edges {
            copy.edge_starts.push(copy.vertices.len() as u32);
            let curve_index = copy.curves.len() as u32;
            let curve = graph.walk(edge).curve();
            copy.curves.push(curve);
            let run: Vec<u32> = runs.along(edge).collect();
            for pair in run.windows(2) {
                let [index, next] = [pair[0] as usize, pair[1] as usize];
                let (t, deviation_m) = if index < next {
                    (self.boundary[index].t, self.boundary[index].deviation_m)
                } else {
                    // The vertex after an edge's last one is the next edge's first, at its t = 0.
                    let own = self.boundary[next].curve == self.boundary[index].curve;
                    let t = if own {
                        1.0 - self.boundary[index].t
                    } else {
                        0.0
                    };
                    (t, self.boundary[next].deviation_m)
                };
                let [start, end] = [index, next].map(|vertex| self.vertices[vertex]);
                copy.vertices.push(start);
                copy.boundary.push(BoundaryVertex {
                    curve: curve_index,
                    deviation_m,
                    t,
                });
                copy.longest_chord_m = copy.longest_chord_m.max(start.distance(end));
            }
            if Some(&edge) == chain.edges.last()
                && let Some(&last) = run.last()
            {
                copy.vertices.push(self.vertices[last as usize]);
                copy.boundary.push(BoundaryVertex {
                    curve: curve_index,
                    deviation_m: 0.0,
                    t: 1.0,
                });
            }
        }
        copy
    }
}
