//! A k-d tree that grows point by point and stays balanced by rebuilding the part that leans.
//!
//! Leaves hold up to [`LEAF`] points; a full leaf is cut at the median of its widest axis. Every node knows the tight box around
//! its points, which bounds the distance from below. Where one child holds more than three quarters of the points of
//! its parent, that subtree is rebuilt, so insertion costs O(log² n) on average over any sequence, sorted ones included.

use super::closer;
use crate::euclid::squared_distance;

/// Most points of a leaf whose points differ.
const LEAF: usize = 16;
/// A child may hold this share of its parent's points before the parent is rebuilt.
const LEAN: f64 = 0.75;

/// Points in the order of insertion, searched through a tree.
///
/// Memory: about 3 times the points. Points must be finite; one with a NaN is never found.
///
/// ```
/// let mut tree = rrt_refine::nearest::KdTree::new();
/// for x in 0..100 {
///     tree.insert([f64::from(x), 0.0]);
/// }
/// assert_eq!(tree.nearest(&[41.7, 3.0]).map(|(index, _)| index), Some(42));
/// assert_eq!(tree.within(&[10.0, 0.0], 1.5), [9, 10, 11]);
/// ```
#[derive(Clone, Debug)]
pub struct KdTree<const D: usize> {
    nodes: Vec<Node<D>>,
    /// Nodes that a rebuilding freed.
    spare: Vec<usize>,
    len: usize,
}

#[derive(Clone, Debug)]
struct Node<const D: usize> {
    min: [f64; D],
    max: [f64; D],
    count: usize,
    /// Below this count the node is not rebuilt again: equal points may make balance impossible.
    rebuild_from: usize,
    kind: Kind<D>,
}

#[derive(Clone, Debug)]
enum Kind<const D: usize> {
    Leaf(Vec<Item<D>>),
    /// Points with `point[axis] < at` are left.
    Split {
        axis: usize,
        at: f64,
        left: usize,
        right: usize,
    },
}

#[derive(Clone, Copy, Debug)]
struct Item<const D: usize> {
    index: usize,
    point: [f64; D],
}

const ROOT: usize = 0;

impl<const D: usize> Default for KdTree<D> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const D: usize> KdTree<D> {
    /// No points yet.
    pub fn new() -> Self {
        Self {
            nodes: vec![Node::leaf(Vec::new())],
            spare: Vec::new(),
            len: 0,
        }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Adds a point; its index is the number of points before it.
    pub fn insert(&mut self, point: [f64; D]) {
        let item = Item {
            index: self.len,
            point,
        };
        self.len += 1;
        let mut leaning = None;
        let mut at = ROOT;
        loop {
            self.nodes[at].admit(&point);
            match self.nodes[at].kind {
                Kind::Leaf(ref mut items) => {
                    items.push(item);
                    break;
                }
                Kind::Split {
                    axis,
                    at: value,
                    left,
                    right,
                } => {
                    let child = if point[axis] < value { left } else { right };
                    if leaning.is_none() && self.leans(at, child) {
                        leaning = Some(at);
                    }
                    at = child;
                }
            }
        }
        if let Some(top) = leaning {
            self.rebuild(top);
        } else if self.nodes[at].count > LEAF && self.nodes[at].widest_axis().1 > 0.0 {
            let items = self.take_items(at);
            self.build(at, items);
        }
    }

    /// Index of the nearest point and the squared distance to it; the lowest index of equals. `None` without points.
    pub fn nearest(&self, query: &[f64; D]) -> Option<(usize, f64)> {
        let mut best = (usize::MAX, f64::INFINITY);
        self.search_nearest(ROOT, query, &mut best);
        (best.0 != usize::MAX).then_some(best)
    }

    /// The `k` nearest points (all of them where there are fewer), each with its squared distance, nearest first; of equals
    /// the lower index first.
    pub fn nearest_k(&self, query: &[f64; D], k: usize) -> Vec<(usize, f64)> {
        let mut best = Vec::with_capacity(k.min(self.len) + 1);
        if k > 0 {
            self.search_nearest_k(ROOT, query, k, &mut best);
        }
        best
    }

    /// Indices of all points at most `radius` away, ascending.
    pub fn within(&self, query: &[f64; D], radius: f64) -> Vec<usize> {
        let mut found = Vec::new();
        if radius >= 0.0 {
            self.search_within(ROOT, query, radius * radius, &mut found);
        }
        found.sort_unstable();
        found
    }

    fn search_nearest(&self, at: usize, query: &[f64; D], best: &mut (usize, f64)) {
        match &self.nodes[at].kind {
            Kind::Leaf(items) => {
                for item in items {
                    let squared = squared_distance(query, &item.point);
                    if closer(&(item.index, squared), best) {
                        *best = (item.index, squared);
                    }
                }
            }
            Kind::Split { left, right, .. } => {
                for (child, bound) in self.nearer_first(*left, *right, query) {
                    // Equality too: an equal distance under a lower index wins.
                    if bound <= best.1 {
                        self.search_nearest(child, query, best);
                    }
                }
            }
        }
    }

    fn search_nearest_k(
        &self,
        at: usize,
        query: &[f64; D],
        k: usize,
        best: &mut Vec<(usize, f64)>,
    ) {
        match &self.nodes[at].kind {
            Kind::Leaf(items) => {
                for item in items {
                    let found = (item.index, squared_distance(query, &item.point));
                    let place = best.partition_point(|other| closer(other, &found));
                    // A NaN distance is closer to nothing and must not be kept.
                    if place < k && found.1 < f64::INFINITY {
                        best.insert(place, found);
                        best.truncate(k);
                    }
                }
            }
            Kind::Split { left, right, .. } => {
                for (child, bound) in self.nearer_first(*left, *right, query) {
                    if best.len() < k || best.last().is_some_and(|worst| bound <= worst.1) {
                        self.search_nearest_k(child, query, k, best);
                    }
                }
            }
        }
    }

    /// Both children with the squared distances to their boxes, the nearer one first.
    fn nearer_first(&self, left: usize, right: usize, query: &[f64; D]) -> [(usize, f64); 2] {
        let to_left = self.nodes[left].squared_distance_to(query);
        let to_right = self.nodes[right].squared_distance_to(query);
        if to_left <= to_right {
            [(left, to_left), (right, to_right)]
        } else {
            [(right, to_right), (left, to_left)]
        }
    }

    fn search_within(&self, at: usize, query: &[f64; D], limit: f64, found: &mut Vec<usize>) {
        if self.nodes[at].squared_distance_to(query) > limit {
            return;
        }
        match &self.nodes[at].kind {
            Kind::Leaf(items) => found.extend(
                items
                    .iter()
                    .filter(|item| squared_distance(query, &item.point) <= limit)
                    .map(|item| item.index),
            ),
            Kind::Split { left, right, .. } => {
                self.search_within(*left, query, limit, found);
                self.search_within(*right, query, limit, found);
            }
        }
    }

    /// Whether `child`, about to get one more point, is too large a part of the node `at`.
    fn leans(&self, at: usize, child: usize) -> bool {
        let node = &self.nodes[at];
        node.count >= node.rebuild_from
            && (self.nodes[child].count + 1) as f64 > LEAN * node.count as f64
    }

    fn rebuild(&mut self, top: usize) {
        let items = self.take_items(top);
        self.build(top, items);
        let node = &mut self.nodes[top];
        node.rebuild_from = node.count + node.count / 2;
    }

    /// Empties a subtree and frees its nodes but the top one.
    fn take_items(&mut self, top: usize) -> Vec<Item<D>> {
        let mut items = Vec::with_capacity(self.nodes[top].count);
        let mut open = vec![top];
        while let Some(at) = open.pop() {
            match std::mem::replace(&mut self.nodes[at].kind, Kind::Leaf(Vec::new())) {
                Kind::Leaf(part) => items.extend(part),
                Kind::Split { left, right, .. } => open.extend([left, right]),
            }
            if at != top {
                self.spare.push(at);
            }
        }
        items
    }

    /// Makes the node `at` the root of a balanced subtree over `items`.
    fn build(&mut self, at: usize, mut items: Vec<Item<D>>) {
        self.nodes[at] = Node::leaf(Vec::new());
        for item in &items {
            self.nodes[at].admit(&item.point);
        }
        let (axis, width) = self.nodes[at].widest_axis();
        if items.len() <= LEAF || width <= 0.0 {
            self.nodes[at].kind = Kind::Leaf(items);
            return;
        }
        let (middle, value) = cut(&mut items, axis);
        let upper = items.split_off(middle);
        let (left, right) = (self.new_node(), self.new_node());
        self.build(left, items);
        self.build(right, upper);
        self.nodes[at].kind = Kind::Split {
            axis,
            at: value,
            left,
            right,
        };
    }

    fn new_node(&mut self) -> usize {
        self.spare.pop().unwrap_or_else(|| {
            self.nodes.push(Node::leaf(Vec::new()));
            self.nodes.len() - 1
        })
    }
}

impl<const D: usize> Node<D> {
    fn leaf(items: Vec<Item<D>>) -> Self {
        Self {
            min: [f64::INFINITY; D],
            max: [f64::NEG_INFINITY; D],
            count: 0,
            rebuild_from: 4 * LEAF,
            kind: Kind::Leaf(items),
        }
    }

    /// Counts a point and widens the box to it.
    fn admit(&mut self, point: &[f64; D]) {
        self.count += 1;
        for (axis, &value) in point.iter().enumerate() {
            self.min[axis] = self.min[axis].min(value);
            self.max[axis] = self.max[axis].max(value);
        }
    }

    /// Never above the distance to a point inside, rounding included: each step is monotone and in the same order.
    fn squared_distance_to(&self, query: &[f64; D]) -> f64 {
        let mut sum = 0.0;
        for (axis, &value) in query.iter().enumerate() {
            let below = self.min[axis] - value;
            let above = value - self.max[axis];
            let gap = below.max(above).max(0.0);
            sum += gap * gap;
        }
        sum
    }

    fn widest_axis(&self) -> (usize, f64) {
        let mut widest = (0, 0.0);
        for axis in 0..D {
            let width = self.max[axis] - self.min[axis];
            if width > widest.1 {
                widest = (axis, width);
            }
        }
        widest
    }
}

/// Sorts `items` along `axis` and gives where to cut them: a place near the middle where the coordinate changes.
fn cut<const D: usize>(items: &mut [Item<D>], axis: usize) -> (usize, f64) {
    items.sort_unstable_by(|a, b| {
        a.point[axis]
            .total_cmp(&b.point[axis])
            .then(a.index.cmp(&b.index))
    });
    let coordinate = |place: usize| items[place].point[axis];
    let half = items.len() / 2;
    let below = (1..=half)
        .rev()
        .find(|&p| coordinate(p - 1) < coordinate(p));
    let above = (half + 1..items.len()).find(|&p| coordinate(p - 1) < coordinate(p));
    let middle = match (below, above) {
        (Some(below), Some(above)) if above - half < half - below => above,
        (Some(below), _) => below,
        (None, Some(above)) => above,
        (None, None) => half,
    };
    (middle, coordinate(middle))
}

#[cfg(test)]
mod tests {
    use rand::RngExt;
    use rand_pcg::Pcg64;

    use super::*;
    use crate::nearest::LinearScan;

    /// Inserts the points into both and compares every answer along the way.
    fn agree<const D: usize>(points: &[[f64; D]], queries: &[[f64; D]]) {
        let mut tree = KdTree::new();
        let mut scan = LinearScan::new();
        for (count, point) in points.iter().enumerate() {
            tree.insert(*point);
            scan.insert(*point);
            let query = &queries[count % queries.len()];
            assert_eq!(tree.nearest(query), scan.nearest(query), "{count} points");
            if count % 7 == 0 {
                assert_eq!(tree.within(query, 0.3), scan.within(query, 0.3));
                assert_eq!(tree.nearest_k(query, 9), scan.nearest_k(query, 9));
            }
        }
        assert_eq!(tree.len(), points.len());
    }

    fn random_points<const D: usize>(count: usize, seed: u128) -> Vec<[f64; D]> {
        let mut rng = Pcg64::new(seed, 7);
        (0..count)
            .map(|_| std::array::from_fn(|_| rng.random()))
            .collect()
    }

    #[test]
    fn equals_the_scan_on_scattered_points() {
        agree::<1>(&random_points(600, 1), &random_points(97, 2));
        agree::<2>(&random_points(1500, 3), &random_points(97, 4));
        agree::<3>(&random_points(1500, 5), &random_points(97, 6));
        agree::<6>(&random_points(600, 7), &random_points(97, 8));
    }

    #[test]
    fn equals_the_scan_on_hostile_orders() {
        let sorted: Vec<[f64; 2]> = (0..2000).map(|i| [f64::from(i) / 2000.0, 0.5]).collect();
        agree(&sorted, &random_points(53, 9));
        let grid: Vec<[f64; 2]> = (0..1600)
            .map(|i| [f64::from(i % 40) / 40.0, f64::from(i / 40) / 40.0])
            .collect();
        agree(&grid, &grid[3..100]);
        let equal = vec![[0.25, 0.25]; 500];
        agree(&equal, &random_points(53, 10));
        let mut mostly_equal = equal;
        mostly_equal.extend(random_points::<2>(500, 11));
        agree(&mostly_equal, &random_points(53, 12));
    }

    #[test]
    fn empty_trees_and_queries_that_are_no_points_find_nothing() {
        let mut tree = KdTree::new();
        assert!(tree.is_empty() && tree.nearest(&[0.0, 0.0]).is_none());
        assert!(tree.nearest_k(&[0.0, 0.0], 3).is_empty());
        tree.insert([1.0, 2.0]);
        tree.insert([f64::NAN, 2.0]);
        assert_eq!(tree.nearest(&[1.0, 2.0]), Some((0, 0.0)));
        assert_eq!(tree.nearest_k(&[1.0, 2.0], 3), [(0, 0.0)]);
        assert!(tree.nearest_k(&[1.0, 2.0], 0).is_empty());
        assert!(tree.nearest(&[f64::NAN, 0.0]).is_none());
        assert!(tree.within(&[1.0, 2.0], -1.0).is_empty());
    }

    #[test]
    fn sorted_insertion_stays_shallow() {
        let mut tree = KdTree::new();
        for i in 0..50_000 {
            tree.insert([f64::from(i)]);
        }
        assert!(depth(&tree, ROOT) < 40, "depth {}", depth(&tree, ROOT));
    }

    fn depth<const D: usize>(tree: &KdTree<D>, at: usize) -> usize {
        match tree.nodes[at].kind {
            Kind::Leaf(_) => 1,
            Kind::Split { left, right, .. } => 1 + depth(tree, left).max(depth(tree, right)),
        }
    }
}
