//! A kd-tree whose boxes know the largest viewing range inside, for exact range-normalised queries.
//!
//! The squared distance between u and v is ‖u − v‖² / (r_u r_v). With r = 1 everywhere it is the
//! Euclidean one. A box at Euclidean distance b whose points have ranges at most R cannot hold
//! anything nearer to u than b² / (r_u R), so pruning by that bound loses nothing.
//! Cost: O(n log n) to build, O(log n + k) expected a query, 16 points a leaf.

use crate::points::squared_distance;

/// Points in leaf order with the boxes above them.
pub(crate) struct RangeTree {
    points: Vec<[f64; 3]>,
    ranges: Vec<f64>,
    index: Vec<u32>,
    nodes: Vec<Node>,
}

#[derive(Clone, Copy)]
struct Node {
    low: [f64; 3],
    high: [f64; 3],
    largest_range: f64,
    /// The least index of the points inside.
    first: u32,
    start: u32,
    end: u32,
    /// The right child; the left one follows its parent. 0 marks a leaf.
    right: u32,
}

/// One neighbour: squared normalised distance and the point's index.
pub(crate) type Neighbour = (f64, u32);

impl RangeTree {
    /// Builds over finite points; `ranges` is empty for the Euclidean distance, else positive.
    pub(crate) fn new(points: &[[f64; 3]], ranges: &[f64]) -> Self {
        let mut index: Vec<u32> = (0..points.len() as u32).collect();
        let mut nodes = Vec::with_capacity(points.len() / LEAF * 4 + 1);
        if !points.is_empty() {
            build(points, ranges, &mut index, 0, &mut nodes);
        }
        Self {
            points: index.iter().map(|&i| points[i as usize]).collect(),
            ranges: index.iter().map(|&i| range_of(ranges, i)).collect(),
            index,
            nodes,
        }
    }

    /// Point indices in leaf order: queries in this order touch memory that is still warm.
    pub(crate) fn order(&self) -> &[u32] {
        &self.index
    }

    /// The `capacity` nearest points within squared distance `limit` of the point at leaf `position`.
    ///
    /// The point itself is left out, its duplicates are not. Ascending by distance, then by index.
    pub(crate) fn nearest(
        &self,
        position: usize,
        capacity: usize,
        limit: f64,
        found: &mut Vec<Neighbour>,
    ) {
        found.clear();
        if capacity > 0 {
            let inverse_range = 1.0 / self.ranges[position];
            let search = Search {
                position,
                inverse_range,
                capacity,
            };
            self.descend(0, 0.0, &search, limit, found);
        }
    }

    /// Every box, parents before children and the left child next: its corners, its span in leaf
    /// order and the position of its right child, 0 for a leaf.
    pub(crate) fn boxes(
        &self,
    ) -> impl Iterator<Item = ([f64; 3], [f64; 3], std::ops::Range<usize>, usize)> + '_ {
        self.nodes.iter().map(|node| {
            (
                node.low,
                node.high,
                node.start as usize..node.end as usize,
                node.right as usize,
            )
        })
    }

    /// The index of the point nearest to `center` (ranges do not count); `None` without points.
    pub(crate) fn nearest_to(&self, center: [f64; 3]) -> Option<u32> {
        let mut best: Option<Neighbour> = None;
        let mut stack = vec![0usize];
        while let Some(at) = stack.pop() {
            let Some(node) = self.nodes.get(at) else {
                break;
            };
            if best.is_some_and(|b| box_distance(node, center) > b.0) {
                continue;
            }
            if node.right != 0 {
                stack.push(node.right as usize);
                stack.push(at + 1);
                continue;
            }
            for i in node.start as usize..node.end as usize {
                let new = (squared_distance(center, self.points[i]), self.index[i]);
                if best.is_none_or(|b| precedes(new, b)) {
                    best = Some(new);
                }
            }
        }
        best.map(|b| b.1)
    }

    fn descend(
        &self,
        at: usize,
        nearest_possible: f64,
        search: &Search,
        mut limit: f64,
        found: &mut Vec<Neighbour>,
    ) -> f64 {
        if nearest_possible > limit {
            return limit;
        }
        let node = &self.nodes[at];
        // At equal distance lower indices come first, so a stack of equal points need not be searched whole.
        let tied = |last: &Neighbour| nearest_possible == last.0 && node.first > last.1;
        if found.len() == search.capacity && found.last().is_some_and(tied) {
            return limit;
        }
        if node.right == 0 {
            return self.scan(node, search, limit, found);
        }
        let center = self.points[search.position];
        let bound = |child: usize| {
            let node = &self.nodes[child];
            box_distance(node, center) * (search.inverse_range / node.largest_range)
        };
        let (left, right) = (at + 1, node.right as usize);
        let (to_left, to_right) = (bound(left), bound(right));
        let [near, far] = if to_left <= to_right {
            [(left, to_left), (right, to_right)]
        } else {
            [(right, to_right), (left, to_left)]
        };
        limit = self.descend(near.0, near.1, search, limit, found);
        self.descend(far.0, far.1, search, limit, found)
    }

    fn scan(
        &self,
        node: &Node,
        search: &Search,
        mut limit: f64,
        found: &mut Vec<Neighbour>,
    ) -> f64 {
        let center = self.points[search.position];
        let span = node.start as usize..node.end as usize;
        let members = self.points[span.clone()]
            .iter()
            .zip(&self.ranges[span.clone()]);
        // Whether a point is near enough is a coin toss: collecting those first needs no branch.
        let mut near = [(0.0, 0); LEAF];
        let mut count = 0;
        for (i, (&point, &range)) in span.zip(members) {
            let d = squared_distance(center, point) * (search.inverse_range / range);
            near[count.min(LEAF - 1)] = (d, self.index[i]);
            count += usize::from((d <= limit) & (i != search.position));
        }
        for &new in &near[..count] {
            if new.0 <= limit {
                limit = insert(found, new, search.capacity, limit);
            }
        }
        limit
    }
}

struct Search {
    position: usize,
    inverse_range: f64,
    capacity: usize,
}

/// Keeps `found` sorted and at most `capacity` long; returns the distance that still matters.
fn insert(found: &mut Vec<Neighbour>, new: Neighbour, capacity: usize, limit: f64) -> f64 {
    if found.len() == capacity {
        match found.last() {
            Some(&last) if precedes(new, last) => {
                found.pop();
            }
            _ => return limit,
        }
    }
    found.push(new);
    place_last(found, new);
    if found.len() == capacity {
        found[capacity - 1].0
    } else {
        limit
    }
}

/// Moves the last entry, `new`, to its place among the others, which are in order.
fn place_last(found: &mut [Neighbour], new: Neighbour) {
    for at in (1..found.len()).rev() {
        if !precedes(new, found[at - 1]) {
            found[at] = new;
            return;
        }
        found[at] = found[at - 1];
    }
    found[0] = new;
}

fn precedes(a: Neighbour, b: Neighbour) -> bool {
    a.0 < b.0 || (a.0 == b.0 && a.1 < b.1)
}

/// Splits `index` (which starts at `start` in leaf order) at the median of the widest side.
fn build(
    points: &[[f64; 3]],
    ranges: &[f64],
    index: &mut [u32],
    start: usize,
    nodes: &mut Vec<Node>,
) {
    let at = nodes.len();
    let node = bounds(points, ranges, index, start);
    nodes.push(node);
    if index.len() <= LEAF {
        return;
    }
    let side = |axis: usize| node.high[axis] - node.low[axis];
    let axis = (1..3).fold(
        0,
        |best, axis| if side(axis) > side(best) { axis } else { best },
    );
    let middle = index.len() / 2;
    index.select_nth_unstable_by(middle, |&a, &b| {
        let order = points[a as usize][axis].total_cmp(&points[b as usize][axis]);
        order.then(a.cmp(&b))
    });
    let (left, right) = index.split_at_mut(middle);
    build(points, ranges, left, start, nodes);
    nodes[at].right = nodes.len() as u32;
    build(points, ranges, right, start + middle, nodes);
}

fn bounds(points: &[[f64; 3]], ranges: &[f64], index: &[u32], start: usize) -> Node {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    let mut largest_range = 0.0_f64;
    for &i in index {
        for axis in 0..3 {
            low[axis] = low[axis].min(points[i as usize][axis]);
            high[axis] = high[axis].max(points[i as usize][axis]);
        }
        largest_range = largest_range.max(range_of(ranges, i));
    }
    let first = index.iter().copied().min().unwrap_or_default();
    let (start, end) = (start as u32, (start + index.len()) as u32);
    Node {
        low,
        high,
        largest_range,
        first,
        start,
        end,
        right: 0,
    }
}

fn range_of(ranges: &[f64], i: u32) -> f64 {
    ranges.get(i as usize).copied().unwrap_or(1.0)
}

fn box_distance(node: &Node, center: [f64; 3]) -> f64 {
    let mut sum = 0.0;
    for (axis, &x) in center.iter().enumerate() {
        let outside = (node.low[axis] - x).max(x - node.high[axis]).max(0.0);
        sum += outside * outside;
    }
    sum
}

/// Points a leaf holds at most.
const LEAF: usize = 12;
