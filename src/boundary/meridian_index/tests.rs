//! Against a walk past all edges.

use super::*;
use crate::{curve::Curve, geodetic::LonLat, region::EdgeKind};

#[test]
fn boxes_and_polar_rings_separate() {
    for kind in [EdgeKind::Straight, EdgeKind::Rhumb, EdgeKind::Geodesic] {
        let mut graph = BoundaryGraph::default();
        let rings: [&[(f64, f64)]; 3] = [
            &[(170.0, 0.0), (-170.0, 0.0), (-170.0, 20.0), (170.0, 20.0)],
            &[(0.0, 70.0), (120.0, 70.0), (-120.0, 70.0)],
            &[(10.0, 60.0), (50.0, 60.0), (50.0, 90.0), (10.0, 90.0)],
        ];
        let mut edges = Vec::new();
        for (label, ring) in rings.iter().enumerate() {
            for k in 0..ring.len() {
                let [a, b] =
                    [ring[k], ring[(k + 1) % ring.len()]].map(|(lon, lat)| LonLat::new(lon, lat));
                edges.extend(
                    graph
                        .insert_curve(&Curve::between(kind, a, b))
                        .map(|edge| (edge, label as u32)),
                );
            }
        }
        let index = MeridianIndex::new(&Ellipsoid::WGS84, &graph, edges.iter().copied());
        let separating = |lon, lat| {
            let point = LatticePoint::nearest(LonLat::new(lon, lat)).canonical();
            index.separating(&Ellipsoid::WGS84, &graph, point, |_| {
                panic!("not on a node")
            })
        };
        assert_eq!(separating(180.0, 10.0), [0, 1]);
        assert_eq!(separating(-171.0, 1.0), [0, 1]);
        assert_eq!(separating(-171.0, -1.0), [1]);
        assert_eq!(separating(0.5, 85.0), [0; 0]);
        assert_eq!(separating(30.0, 69.0), [1, 2]);
        assert_eq!(separating(30.0, 88.0), [2]);
    }
}

/// All edges asked, all the way to the pole.
fn past_all_edges(
    graph: &BoundaryGraph,
    labelled: &[(DirectedEdge, u32)],
    point: LatticePoint,
) -> Vec<u32> {
    let mut crossed = Vec::new();
    for &(directed, label) in labelled {
        let edge = &graph.edges[directed.edge() as usize];
        let ends = [edge.from, edge.to].map(|node| graph.nodes[node as usize]);
        if !ends.contains(&point) && passes_north_of(&Ellipsoid::WGS84, edge, point) {
            crossed.push(label);
        }
        for tip in [edge.start, edge.end] {
            if tip.lat == POLE && point.lon < wrap(tip.lon) {
                crossed.push(label);
            }
        }
    }
    crossed.sort_unstable();
    odd_ones(&crossed)
}

#[test]
fn cells_answer_as_all_edges_do() {
    let mut state = 3_u64;
    let mut random = |range: i64| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        ((state >> 20) as i64).rem_euclid(range)
    };
    for round in 0..60 {
        let kind = [EdgeKind::Straight, EdgeKind::Rhumb, EdgeKind::Geodesic][round % 3];
        // Rings of all sizes that cross each other, on a grid that makes ties and reaches the poles.
        let mut graph = BoundaryGraph::default();
        let mut labelled = Vec::new();
        for label in 0..12 + 4 * (round as u32 % 7) {
            let reach = 1 + random(1 + 8 * (round as i64 % 9));
            let (lon, lat) = (random(360), random(181) - 90);
            let ring: Vec<LonLat> = (0..3 + random(12))
                .map(|_| {
                    let lon = lon + random(2 * reach) - reach;
                    let lat = (lat + random(2 * reach) - reach).clamp(-90, 90);
                    LonLat::new(lon as f64, lat as f64)
                })
                .collect();
            for (from, to) in ring.iter().zip(ring.iter().cycle().skip(1)) {
                let curve = Curve::between(kind, *from, *to);
                let edge = graph.insert_curve(&curve);
                labelled.extend(edge.map(|edge| (edge, label)));
            }
        }
        let index = MeridianIndex::new(&Ellipsoid::WGS84, &graph, labelled.iter().copied());
        let mut points: Vec<LatticePoint> = graph.nodes.clone();
        points.extend((0..300).map(|_| {
            let lon = LatticePoint::nearest(LonLat::new(random(360) as f64, 0.0)).lon;
            LatticePoint::new(lon + random(3), random(2 * POLE) - POLE).canonical()
        }));
        for &point in points.iter().filter(|point| point.lat < POLE) {
            let found = index.separating(&Ellipsoid::WGS84, &graph, point, |_| {});
            let expected = past_all_edges(&graph, &labelled, point);
            assert_eq!(found, expected, "round {round}, {point:?}");
        }
    }
}
