//! A k-d tree of centroids that finds the two nearest ones, with ties to the lowest index.

use crate::vector::{Vec3, distance_squared};

/// The nearest centroid and the squared distances to it and to the runner-up.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearestTwo {
    pub(super) index: usize,
    pub(super) squared: f64,
    pub(super) second_squared: f64,
}

impl NearestTwo {
    pub(super) const NONE: NearestTwo = NearestTwo {
        index: usize::MAX,
        squared: f64::INFINITY,
        second_squared: f64::INFINITY,
    };

    /// Takes a centroid into account. The order of calls does not matter.
    #[inline]
    pub(super) fn offer(&mut self, index: usize, squared: f64) {
        if squared < self.squared || (squared == self.squared && index < self.index) {
            self.second_squared = self.squared;
            self.index = index;
            self.squared = squared;
        } else if squared < self.second_squared {
            self.second_squared = squared;
        }
    }
}

#[derive(Clone, Copy, Debug)]
enum Node {
    Split { axis: usize, at: f64, right: u32 },
    Leaf { start: u32, end: u32 },
}

/// Built in O(K log K); a query visits about log K nodes.
#[derive(Debug)]
pub(super) struct CentroidTree {
    nodes: Vec<Node>,
    entries: Vec<(Vec3, u32)>,
}

const LEAF: usize = 12;

impl CentroidTree {
    pub(super) fn new(centroids: &[Vec3]) -> Self {
        let entries = centroids
            .iter()
            .zip(0..)
            .map(|(&centroid, index)| (centroid, index))
            .collect();
        let mut tree = CentroidTree {
            nodes: Vec::new(),
            entries,
        };
        tree.build(0, centroids.len());
        tree
    }

    fn build(&mut self, start: usize, end: usize) {
        if end - start <= LEAF {
            self.nodes.push(Node::Leaf {
                start: start as u32,
                end: end as u32,
            });
            return;
        }
        let entries = &mut self.entries[start..end];
        let axis = widest_axis(entries);
        let middle = entries.len() / 2;
        entries.select_nth_unstable_by(middle, |a, b| {
            a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1))
        });
        let at = entries[middle].0[axis];
        let node = self.nodes.len();
        self.nodes.push(Node::Split { axis, at, right: 0 });
        self.build(start, start + middle);
        let right = self.nodes.len() as u32;
        self.nodes[node] = Node::Split { axis, at, right };
        self.build(start + middle, end);
    }

    #[inline]
    pub(super) fn nearest_two(&self, point: Vec3) -> NearestTwo {
        let mut best = NearestTwo::NONE;
        self.visit(0, point, &mut best);
        best
    }

    /// The `count` centroids nearest to a point with their squared distances, ascending, without the one with index `own`.
    pub(super) fn nearest_others(&self, point: Vec3, own: usize, count: usize) -> Vec<(f64, u32)> {
        let mut nearest = Vec::with_capacity(count + 1);
        self.gather(0, point, own as u32, count, &mut nearest);
        nearest
    }

    fn gather(
        &self,
        node: usize,
        point: Vec3,
        own: u32,
        count: usize,
        nearest: &mut Vec<(f64, u32)>,
    ) {
        let limit = |nearest: &[(f64, u32)]| match nearest.get(count - 1) {
            Some(last) => last.0,
            None => f64::INFINITY,
        };
        match self.nodes[node] {
            Node::Leaf { start, end } => {
                for &(centroid, index) in &self.entries[start as usize..end as usize] {
                    let squared = distance_squared(point, centroid);
                    if index == own || squared >= limit(nearest) {
                        continue;
                    }
                    let at = nearest
                        .iter()
                        .rposition(|entry| entry.0 <= squared)
                        .map_or(0, |at| at + 1);
                    nearest.insert(at, (squared, index));
                    nearest.truncate(count);
                }
            }
            Node::Split { axis, at, right } => {
                let offset = point[axis] - at;
                let (near, far) = if offset < 0.0 {
                    (node + 1, right as usize)
                } else {
                    (right as usize, node + 1)
                };
                self.gather(near, point, own, count, nearest);
                if offset * offset < limit(nearest) {
                    self.gather(far, point, own, count, nearest);
                }
            }
        }
    }

    fn visit(&self, node: usize, point: Vec3, best: &mut NearestTwo) {
        match self.nodes[node] {
            Node::Leaf { start, end } => {
                for (centroid, index) in &self.entries[start as usize..end as usize] {
                    best.offer(*index as usize, distance_squared(point, *centroid));
                }
            }
            Node::Split { axis, at, right } => {
                let offset = point[axis] - at;
                let (near, far) = if offset < 0.0 {
                    (node + 1, right as usize)
                } else {
                    (right as usize, node + 1)
                };
                self.visit(near, point, best);
                // The rounded square is never above the rounded distance to anything on the far side.
                if offset * offset <= best.second_squared {
                    self.visit(far, point, best);
                }
            }
        }
    }
}

fn widest_axis(entries: &[(Vec3, u32)]) -> usize {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for (centroid, _) in entries {
        low = crate::vector::min(low, *centroid);
        high = crate::vector::max(high, *centroid);
    }
    let extent = crate::vector::sub(high, low);
    if extent[0] >= extent[1] && extent[0] >= extent[2] {
        0
    } else if extent[1] >= extent[2] {
        1
    } else {
        2
    }
}
