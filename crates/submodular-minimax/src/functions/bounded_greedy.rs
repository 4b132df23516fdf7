//! Greedy facility location over points without a kernel matrix: bounds from boxes skip most gains.
//!
//! Both kernels are convex and falling in the squared distance q, so over a kd-tree node with squared
//! distances in [a, b] and mean m (from centroid and variance)
//!
//! ```text
//! weight · s(m) ≤ Σ weight(v) s(q(v)) ≤ weight · (s(a) + (m − a) (s(b) − s(a)) / (b − a))
//! ```
//!
//! and where every client is served worse than s(b) the service is just subtracted. Nodes are opened
//! until the gap is a twentieth of the gain sought. A heap holds candidates with such bounds and exact
//! gains; the top is sharpened until it is exact and current. Bounds stay bounds while the set grows,
//! so the selection is exactly that of greedy, ties to the lowest index included.
//! Cost: a few hundred nodes a bound, n kernel values an exact gain, few of those; memory O(n).

use super::facility_location::{FacilityLocation, Serving};
use super::similarity::{Points, Similarity};
use crate::maximize::{LazyGreedy, MaximizeError, MaximizeStop, Maximizer, Maximum};
use crate::neighbours::RangeTree;
use crate::points::squared_distance;
use crate::set_function::Growth;
use crate::subset::Subset;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

impl FacilityLocation<Points> {
    /// What [`Greedy`](crate::maximize::Greedy) selects under a cardinality constraint, much faster.
    ///
    /// [`Maximum::evaluations`] counts the exact gains. With caps it is lazy greedy.
    ///
    /// ```
    /// use submodular_minimax::functions::{FacilityLocation, Kernel, Points};
    /// let line: Vec<[f64; 3]> = (0..9).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    /// let function = FacilityLocation::new(Points::new(&line, Kernel::Linear { reach: 5.0 })?);
    /// assert_eq!(function.greedy(1)?.picks, [4]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// k = 0.
    pub fn greedy(&self, k: usize) -> Result<Maximum, MaximizeError> {
        if self.is_truncated() || k == 0 {
            return LazyGreedy::cardinality(k).maximize(self);
        }
        let n = self.similarity().row_count();
        let mut search = Search::new(self);
        let mut found = Maximum::start(n, 0.0);
        found.stop = MaximizeStop::Full;
        while found.picks.len() < k.min(n) {
            let (gain, element) = search.best(&mut found.evaluations);
            if gain <= 0.0 {
                found.stop = MaximizeStop::NoGain;
                break;
            }
            found.pick(element, gain);
            search.insert(element);
        }
        Ok(found)
    }
}

struct Search<'a> {
    points: &'a Points,
    serving: Serving<'a, Points>,
    /// Points, weights, services in leaf order.
    order: Vec<u32>,
    places: Vec<[f64; 3]>,
    weights: Vec<f64>,
    served: Vec<f64>,
    nodes: Vec<Node>,
    heap: BinaryHeap<Entry>,
    round: usize,
    /// What a bound may exceed the gain by, per unit of weight.
    slack: f64,
}

/// A box of clients, what they weigh, where they are, how well they are served.
struct Node {
    low: [f64; 3],
    high: [f64; 3],
    start: usize,
    end: usize,
    right: usize,
    weight: f64,
    centroid: [f64; 3],
    variance: f64,
    least_served: f64,
    most_served: f64,
    total_served: f64,
}

#[derive(Clone, Copy, PartialEq)]
struct Entry {
    bound: f64,
    exact: bool,
    element: usize,
    round: usize,
}

impl<'a> Search<'a> {
    fn new(function: &'a FacilityLocation<Points>) -> Self {
        let points = function.similarity();
        let n = points.row_count();
        let all: Vec<[f64; 3]> = (0..n).map(|v| points.point(v)).collect();
        let tree = RangeTree::new(&all, &[]);
        let order = tree.order().to_vec();
        let places: Vec<[f64; 3]> = order.iter().map(|&v| all[v as usize]).collect();
        let weights: Vec<f64> = order.iter().map(|&v| function.weight(v as usize)).collect();
        let nodes = tree
            .boxes()
            .map(|(low, high, span, right)| Node::new(low, high, span, right, &places, &weights));
        let nodes = nodes.collect();
        let serving = function.serving(&Subset::empty(n));
        let (heap, served) = (BinaryHeap::new(), vec![0.0; n]);
        let mut search = Self {
            points,
            serving,
            order,
            places,
            weights,
            served,
            nodes,
            heap,
            round: 0,
            slack: 1.0,
        };
        for round in 0..2 {
            // The first pass is coarse; from its best bound follows how fine the second must be.
            search.heap.clear();
            (0..n)
                .step_by(if round == 0 { 97 } else { 1 })
                .for_each(|u| search.push_bound(u, f64::INFINITY));
            search.tune();
        }
        search
    }

    /// The largest gain and the lowest index that has it.
    fn best(&mut self, evaluations: &mut usize) -> (f64, usize) {
        while let Some(top) = self.heap.pop() {
            match (top.exact, top.round == self.round) {
                (true, true) => return (top.bound, top.element),
                (false, true) => {
                    *evaluations += 1;
                    let bound = self.serving.gain(top.element);
                    self.heap.push(Entry {
                        bound,
                        exact: true,
                        ..top
                    });
                }
                (_, false) => self.push_bound(top.element, top.bound),
            }
        }
        (0.0, 0)
    }

    fn push_bound(&mut self, element: usize, known: f64) {
        let center = self.points.point(element);
        let bound = self.bound(0, center) * (1.0 + ROUNDING);
        let bound = bound.min(known);
        self.heap.push(Entry {
            bound,
            exact: false,
            element,
            round: self.round,
        });
    }

    /// No candidate at `center` can gain more from the clients of node `at`.
    fn bound(&self, at: usize, center: [f64; 3]) -> f64 {
        let Some(node) = self.nodes.get(at) else {
            return 0.0;
        };
        let (near, far) = node.squared_distances(center);
        let most = self.points.evaluate(near);
        if most <= node.least_served {
            return 0.0;
        }
        let least = self.points.evaluate(far);
        let allowed = self.slack * node.weight;
        if least >= node.most_served {
            let mean = (squared_distance(center, node.centroid) + node.variance).clamp(near, far);
            let share = if far > near {
                (mean - near) / (far - near)
            } else {
                0.0
            };
            let upper = node.weight * (most + share * (least - most));
            if upper - node.weight * self.points.evaluate(mean) <= allowed {
                return upper - node.total_served + ROUNDING * node.weight;
            }
        } else {
            let upper = node.weight * (most - node.least_served);
            if upper <= allowed {
                return upper;
            }
        }
        if node.right == 0 {
            return self.exactly(node, center);
        }
        self.bound(at + 1, center) + self.bound(node.right, center)
    }

    fn exactly(&self, node: &Node, center: [f64; 3]) -> f64 {
        let more = |i: usize| {
            let s = self
                .points
                .evaluate(squared_distance(center, self.places[i]));
            self.weights[i] * (s - self.served[i]).max(0.0)
        };
        (node.start..node.end).map(more).sum()
    }

    fn insert(&mut self, element: usize) {
        self.serving.insert(element);
        self.round += 1;
        for (served, &v) in self.served.iter_mut().zip(&self.order) {
            *served = self.serving.served[v as usize];
        }
        for at in (0..self.nodes.len()).rev() {
            self.serve(at);
        }
        self.tune();
    }

    /// Renews what a node knows of its clients' service, children first.
    fn serve(&mut self, at: usize) {
        let (start, end, right) = (
            self.nodes[at].start,
            self.nodes[at].end,
            self.nodes[at].right,
        );
        let (mut least, mut most, mut total) = (f64::INFINITY, 0.0_f64, 0.0);
        if right == 0 {
            for i in start..end {
                least = least.min(self.served[i]);
                most = most.max(self.served[i]);
                total += self.weights[i] * self.served[i];
            }
        } else {
            for child in [at + 1, right] {
                least = least.min(self.nodes[child].least_served);
                most = most.max(self.nodes[child].most_served);
                total += self.nodes[child].total_served;
            }
        }
        let node = &mut self.nodes[at];
        (node.least_served, node.most_served, node.total_served) = (least, most, total);
    }

    /// Sets the slack to a fixed share of the best bound, spread over all weight.
    fn tune(&mut self) {
        let best = self.heap.peek().map_or(0.0, |top| top.bound);
        let weight = self.nodes.first().map_or(1.0, |root| root.weight);
        self.slack = SLACK * best / weight.max(f64::MIN_POSITIVE);
    }
}

impl Node {
    fn new(
        low: [f64; 3],
        high: [f64; 3],
        span: std::ops::Range<usize>,
        right: usize,
        places: &[[f64; 3]],
        weights: &[f64],
    ) -> Self {
        let weight: f64 = weights[span.clone()].iter().sum();
        let share = |i: usize| {
            if weight > 0.0 {
                weights[i] / weight
            } else {
                0.0
            }
        };
        let mut centroid = [0.0; 3];
        for i in span.clone() {
            (0..3).for_each(|axis| centroid[axis] += share(i) * places[i][axis]);
        }
        let variance = span
            .clone()
            .map(|i| share(i) * squared_distance(places[i], centroid))
            .sum();
        let (start, end) = (span.start, span.end);
        let (least_served, most_served, total_served) = (0.0, 0.0, 0.0);
        Self {
            low,
            high,
            start,
            end,
            right,
            weight,
            centroid,
            variance,
            least_served,
            most_served,
            total_served,
        }
    }

    /// The least and the largest squared distance to the box.
    fn squared_distances(&self, center: [f64; 3]) -> (f64, f64) {
        let (mut near, mut far) = (0.0, 0.0);
        for (axis, &x) in center.iter().enumerate() {
            let (below, above) = (self.low[axis] - x, x - self.high[axis]);
            let outside = below.max(above).max(0.0);
            let across = below.abs().max(above.abs());
            near += outside * outside;
            far += across * across;
        }
        (near, far)
    }
}

impl Eq for Entry {}

impl Ord for Entry {
    /// By bound; among equals bounds before exact gains, since they may hide a lower index.
    fn cmp(&self, other: &Self) -> Ordering {
        let by_bound = self.bound.total_cmp(&other.bound);
        by_bound
            .then(other.exact.cmp(&self.exact))
            .then(other.element.cmp(&self.element))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Relative slack of a bound for rounding; sums of a million terms err by less than 1e-9.
const ROUNDING: f64 = 1e-9;
/// How much of the gain sought a bound may be too high.
const SLACK: f64 = 0.05;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::functions::Kernel;
    use crate::maximize::{Greedy, Maximizer};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn selects_what_naive_greedy_selects(
            cells in prop::collection::vec((0..9i8, 0..9i8, 0..4i8), 1..150),
            k in 1..12usize,
            linear in any::<bool>(),
            weighted in any::<bool>(),
        ) {
            let points: Vec<[f64; 3]> =
                cells.iter().map(|c| [f64::from(c.0), f64::from(c.1), 0.5 * f64::from(c.2)]).collect();
            let kernel =
                if linear { Kernel::Linear { reach: 3.0 } } else { Kernel::Rational { scale: 1.5 } };
            let mut function = FacilityLocation::new(Points::new(&points, kernel).unwrap());
            if weighted {
                let n = points.len();
                function = function.weighted((0..n).map(|v| (v % 3) as f64).collect()).unwrap();
                function = function.truncated((0..n).map(|v| 0.3 + (v % 4) as f64).collect()).unwrap();
            }
            let naive = Greedy::cardinality(k).maximize(&function).unwrap();
            let fast = function.greedy(k).unwrap();
            prop_assert_eq!(&fast.picks, &naive.picks);
            prop_assert_eq!(&fast.gains, &naive.gains);
            prop_assert_eq!(fast.stop == MaximizeStop::NoGain, naive.stop == MaximizeStop::NoGain);
        }
    }
}
