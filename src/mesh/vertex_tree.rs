//! Vertices in a balanced tree, to find those near a chord.

use glam::DVec3;
use rayon::join;

/// Vertices that are not split further.
const LEAF: usize = 8;
/// Fewer are split on one thread.
const WORTH_A_THREAD: usize = 4096;

/// A box and the vertices in it.
pub(crate) struct VertexTree<'a> {
    points: &'a [DVec3],
    order: Vec<u32>,
    root: Node,
}

struct Node {
    centre: DVec3,
    /// Radius of a ball that holds all.
    radius: f64,
    /// Both halves, the first of `middle` vertices.
    halves: Option<Box<[Node; 2]>>,
    count: usize,
}

impl<'a> VertexTree<'a> {
    pub(crate) fn new(points: &'a [DVec3]) -> Self {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let root = Node::new(points, &mut order);
        Self {
            points,
            order,
            root,
        }
    }

    /// Whether `found` says yes to a vertex within `radius` of the segment from `a` to `b`. Others may be
    /// asked about, too.
    pub(crate) fn any_near(
        &self,
        [a, b]: [DVec3; 2],
        radius: f64,
        mut found: impl FnMut(u32, DVec3) -> bool,
    ) -> bool {
        let mut open = vec![(&self.root, 0)];
        while let Some((node, first)) = open.pop() {
            if distance_to_segment(node.centre, a, b) > radius + node.radius {
                continue;
            }
            if let Some(halves) = &node.halves {
                let [left, right] = &**halves;
                open.extend([(left, first), (right, first + left.count)]);
                continue;
            }
            let mut own = self.order[first..first + node.count].iter();
            if own.any(|&vertex| found(vertex, self.points[vertex as usize])) {
                return true;
            }
        }
        false
    }
}

impl Node {
    fn new(points: &[DVec3], order: &mut [u32]) -> Self {
        let position = |vertex: u32| points[vertex as usize];
        let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for &vertex in &*order {
            least = least.min(position(vertex));
            most = most.max(position(vertex));
        }
        let count = order.len();
        let extent = most - least;
        let halves = (count > LEAF && extent.max_element() > 0.0).then(|| {
            let axis = extent.to_array();
            let axis = (0..3).max_by(|&i, &j| axis[i].total_cmp(&axis[j]));
            let axis = axis.unwrap_or(0);
            let (left, right) = {
                order.select_nth_unstable_by(count / 2, |&i, &j| {
                    position(i)[axis].total_cmp(&position(j)[axis])
                });
                order.split_at_mut(count / 2)
            };
            let (left, right) = if count < WORTH_A_THREAD {
                (Self::new(points, left), Self::new(points, right))
            } else {
                join(|| Self::new(points, left), || Self::new(points, right))
            };
            Box::new([left, right])
        });
        Self {
            centre: 0.5 * (least + most),
            radius: 0.5 * extent.length(),
            halves,
            count,
        }
    }
}

fn distance_to_segment(point: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let length_squared = along.length_squared();
    let t = if length_squared > 0.0 {
        ((point - a).dot(along) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    point.distance(a + t * along)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_vertices_near_a_segment_are_found() {
        let spread = |index: u32, factor: f64| (f64::from(index) * factor).fract();
        let points: Vec<DVec3> = (0..5_000)
            .map(|index| {
                DVec3::new(
                    spread(index, 0.618),
                    spread(index, 0.755),
                    spread(index, 0.57),
                )
            })
            .collect();
        let tree = VertexTree::new(&points);
        for index in 0..40 {
            let [a, b] = [points[17 * index], points[90 * index]];
            let radius = 0.01 * f64::from(index as u32 % 7);
            let mut near = Vec::new();
            tree.any_near([a, b], radius, |vertex, point| {
                assert_eq!(point, points[vertex as usize]);
                if distance_to_segment(point, a, b) <= radius {
                    near.push(vertex);
                }
                false
            });
            near.sort_unstable();
            let expected = (0..points.len() as u32)
                .filter(|&vertex| distance_to_segment(points[vertex as usize], a, b) <= radius);
            assert_eq!(near, expected.collect::<Vec<_>>());
        }
    }

    #[test]
    fn nothing_is_near_where_there_is_nothing() {
        let ends = [DVec3::ZERO, DVec3::X];
        assert!(!VertexTree::new(&[]).any_near(ends, 9.0, |_, _| true));
        let same = [DVec3::Y; 100];
        assert!(VertexTree::new(&same).any_near(ends, 2.0, |_, _| true));
        assert!(!VertexTree::new(&same).any_near(ends, 0.5, |_, _| true));
    }
}
