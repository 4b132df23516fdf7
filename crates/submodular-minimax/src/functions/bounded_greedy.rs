//! Greedy facility location over points without a kernel matrix: bounds of boxes skip most gains.
//!
//! Candidates lie in a kd-tree. Each keeps the least bound on its gain that was ever found; gains fall
//! while the set grows, so it stays one. A round searches the tree best first: a small box gets one
//! [`ClientBlocks::gain_bound`] for all its candidates, is then split, and a candidate that stays on top
//! gets its exact gain. A box or candidate is left alone once an exact gain beats its bound, so the
//! selection is exactly that of greedy, ties to the lowest index included.
//! Cost: n kernel bounds a box, less where clients are certainly served better, and n kernel values an
//! exact gain; memory O(n).

use super::client_blocks::ClientBlocks;
use super::facility_location::{FacilityLocation, Serving};
use super::similarity::{Points, Similarity};
use crate::maximize::{LazyGreedy, MaximizeError, MaximizeStop, Maximizer, Maximum};
use crate::neighbours::RangeTree;
use crate::set_function::Growth;
use crate::subset::Subset;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::ops::Range;

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
    /// k = 0, weights so large that a gain overflows.
    pub fn greedy(&self, k: usize) -> Result<Maximum, MaximizeError> {
        if self.is_truncated() || k == 0 {
            return LazyGreedy::cardinality(k).maximize(self);
        }
        let n = self.similarity().row_count();
        let mut search = Search::new(self);
        let mut found = Maximum::start(n, 0.0);
        found.stop = MaximizeStop::Full;
        while found.picks.len() < k.min(n) {
            let best = search.best(&mut found.evaluations)?;
            let Some((gain, element)) = best.filter(|best| best.0 > 0.0) else {
                found.stop = MaximizeStop::NoGain;
                break;
            };
            found.pick(element, gain);
            search.insert(element);
        }
        Ok(found)
    }
}

struct Search<'a> {
    points: &'a Points,
    serving: Serving<'a, Points>,
    clients: ClientBlocks,
    nodes: Vec<Node>,
    /// Candidates in leaf order.
    order: Vec<u32>,
    /// What each candidate, in leaf order, gains at most; below 0 for those that are out.
    bounds: Vec<f64>,
    heap: BinaryHeap<Entry>,
}

/// A box of candidates.
struct Node {
    low: [f64; 3],
    high: [f64; 3],
    span: Range<usize>,
    /// The right child, the left one is next; 0 for a leaf.
    right: usize,
}

/// A node or candidate in the heap and how much of this round's work on it is done.
#[derive(Clone, Copy, PartialEq)]
struct Entry {
    bound: f64,
    step: Step,
    /// A node, a candidate's position in leaf order, or an element.
    item: usize,
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Step {
    Exact,
    Single,
    Candidate,
    Split,
    Node,
}

impl<'a> Search<'a> {
    fn new(function: &'a FacilityLocation<Points>) -> Self {
        let points = function.similarity();
        let n = points.row_count();
        let places: Vec<[f64; 3]> = (0..n).map(|v| points.point(v)).collect();
        let tree = RangeTree::new(&places, &[]);
        let nodes = tree.boxes().map(|(low, high, span, right)| Node {
            low,
            high,
            span,
            right,
        });
        Self {
            points,
            serving: function.serving(&Subset::empty(n)),
            clients: ClientBlocks::new(points, |v| function.weight(v), tree.order()),
            nodes: nodes.collect(),
            order: tree.order().to_vec(),
            bounds: first_bounds(&places, tree.order()),
            heap: BinaryHeap::new(),
        }
    }

    /// The largest gain and the lowest index that has it; `None` if nothing can gain.
    fn best(&mut self, evaluations: &mut usize) -> Result<Option<(f64, usize)>, MaximizeError> {
        self.heap.clear();
        self.push_node(Step::Node, 0);
        while let Some(top) = self.heap.pop() {
            match top.step {
                Step::Node => {
                    let node = &self.nodes[top.item];
                    if node.span.len() <= LARGEST {
                        self.sharpen(node.low, node.high, node.span.clone());
                        self.push_node(Step::Split, top.item);
                    } else {
                        self.split(top.item);
                    }
                }
                Step::Split => self.split(top.item),
                Step::Candidate => {
                    let place = self.points.point(self.order[top.item] as usize);
                    self.sharpen(place, place, top.item..top.item + 1);
                    self.push(self.bounds[top.item], Step::Single, top.item);
                }
                Step::Single => {
                    *evaluations += 1;
                    let gain = self.exact(top.item)?;
                    self.push(gain, Step::Exact, self.order[top.item] as usize);
                }
                Step::Exact => return Ok(Some((top.bound, top.item))),
            }
        }
        Ok(None)
    }

    /// Lowers the bounds of the candidates in a box.
    fn sharpen(&mut self, low: [f64; 3], high: [f64; 3], span: Range<usize>) {
        let bound = self.clients.gain_bound(low, high);
        for position in span {
            let gain = bound.at(self.points.point(self.order[position] as usize));
            // Weights near the largest number make it NaN, which bounds nothing.
            if gain < self.bounds[position] {
                self.bounds[position] = gain.max(0.0);
            }
        }
    }

    fn exact(&mut self, position: usize) -> Result<f64, MaximizeError> {
        let element = self.order[position] as usize;
        let gain = self.serving.gain(element);
        if !gain.is_finite() {
            return Err(MaximizeError::NonFinite { element, gain });
        }
        self.bounds[position] = gain;
        Ok(gain)
    }

    fn split(&mut self, at: usize) {
        let node = &self.nodes[at];
        if node.right == 0 {
            for position in node.span.clone() {
                self.push(self.bounds[position], Step::Candidate, position);
            }
        } else {
            let right = node.right;
            self.push_node(Step::Node, at + 1);
            self.push_node(Step::Node, right);
        }
    }

    fn push_node(&mut self, step: Step, at: usize) {
        if let Some(node) = self.nodes.get(at) {
            let bounds = &self.bounds[node.span.clone()];
            let bound = bounds.iter().copied().fold(OUT, f64::max);
            self.push(bound, step, at);
        }
    }

    fn push(&mut self, bound: f64, step: Step, item: usize) {
        if bound > 0.0 {
            self.heap.push(Entry { bound, step, item });
        }
    }

    fn insert(&mut self, element: usize) {
        self.serving.insert(element);
        self.clients
            .serve(self.points.point(element), &self.serving.served);
        if let Some(position) = self.order.iter().position(|&e| e as usize == element) {
            self.bounds[position] = OUT;
        }
    }
}

/// Infinite; but of candidates at one place only that of lowest index can ever be selected.
fn first_bounds(places: &[[f64; 3]], order: &[u32]) -> Vec<f64> {
    let mut positions: Vec<usize> = (0..order.len()).collect();
    let key = |position: usize| (places[order[position] as usize], order[position]);
    positions.sort_unstable_by(|&a, &b| {
        let ((a, first), (b, second)) = (key(a), key(b));
        let by_axis = |axis: usize| a[axis].total_cmp(&b[axis]);
        let by_place = by_axis(0).then_with(|| by_axis(1)).then_with(|| by_axis(2));
        by_place.then(first.cmp(&second))
    });
    let mut bounds = vec![f64::INFINITY; order.len()];
    for pair in positions.windows(2) {
        if key(pair[0]).0 == key(pair[1]).0 {
            bounds[pair[1]] = OUT;
        }
    }
    bounds
}

impl Eq for Entry {}

impl Ord for Entry {
    /// By bound; among equals bounds before exact gains, since they may hide a lower index.
    fn cmp(&self, other: &Self) -> Ordering {
        let by_bound = self.bound.total_cmp(&other.bound);
        by_bound
            .then(self.step.cmp(&other.step))
            .then(other.item.cmp(&self.item))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Candidates that a node may hold to get a bound of its own.
const LARGEST: usize = 64;
/// The bound of a candidate that cannot be selected any more.
const OUT: f64 = f64::NEG_INFINITY;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::functions::Kernel;
    use crate::maximize::Greedy;
    use proptest::prelude::*;

    fn same_as_naive(points: &[[f64; 3]], kernel: Kernel, k: usize) -> Maximum {
        let function = FacilityLocation::new(Points::new(points, kernel).unwrap());
        let naive = Greedy::cardinality(k).maximize(&function).unwrap();
        let fast = function.greedy(k).unwrap();
        assert_eq!((&fast.picks, &fast.gains), (&naive.picks, &naive.gains));
        assert_eq!(fast.value, naive.value);
        fast
    }

    #[test]
    fn computes_few_exact_gains() {
        let points: Vec<[f64; 3]> = (0..1200)
            .map(|i| [0.37, 0.59, 0.83].map(|step| (f64::from(i) * step).sin() * 5.0))
            .collect();
        for kernel in [
            Kernel::Linear { reach: 20.0 },
            Kernel::Reciprocal { scale: 1.0 },
            Kernel::Rational { scale: 0.5 },
        ] {
            let found = same_as_naive(&points, kernel, 8);
            assert!(found.evaluations < 40, "{kernel:?}: {}", found.evaluations);
        }
    }

    #[test]
    fn far_outliers_and_lengths_out_of_proportion_do_not_mislead() {
        let mut points: Vec<[f64; 3]> = (0..90)
            .map(|i| [f64::from(i % 9), f64::from(i * i % 11), 0.1 * f64::from(i)])
            .collect();
        points.extend([
            [1e9, 0.0, 0.0],
            [-1e5, 1e7, 3.0],
            [4.0, 4.0, 4.0],
            [4.0, 4.0, 4.0],
        ]);
        for length in [1e-300, 1e-9, 1e-3, 1e3, 1e12, 1e300] {
            same_as_naive(&points, Kernel::Linear { reach: length }, 9);
            same_as_naive(&points, Kernel::Reciprocal { scale: length }, 9);
            same_as_naive(&points, Kernel::Rational { scale: length }, 9);
        }
    }

    #[test]
    fn coordinates_at_the_end_of_what_numbers_can_tell_do_not_mislead() {
        let points: Vec<[f64; 3]> = (0..200)
            .map(|i| [0.37, 0.59, 0.83].map(|step| (f64::from(i) * step).sin() * f64::MAX))
            .collect();
        same_as_naive(&points, Kernel::Linear { reach: f64::MAX }, 9);
        same_as_naive(&points, Kernel::Reciprocal { scale: 1e307 }, 9);
        same_as_naive(&points, Kernel::Rational { scale: 1e308 }, 9);
    }

    #[test]
    fn weights_that_overflow_are_an_error_and_tiny_ones_count() {
        let points: Vec<[f64; 3]> = (0..30).map(|i| [f64::from(i), 0.0, 0.0]).collect();
        let weighted = |weights: Vec<f64>| {
            let points = Points::new(&points, Kernel::Reciprocal { scale: 1.0 }).unwrap();
            FacilityLocation::new(points).weighted(weights).unwrap()
        };
        let huge = weighted(vec![1e308; 30]).greedy(2);
        assert!(matches!(huge, Err(MaximizeError::NonFinite { .. })));
        let mut weights = vec![0.0; 30];
        (weights[0], weights[29]) = (1e200, 1e-100);
        let function = weighted(weights);
        let naive = Greedy::cardinality(3).maximize(&function).unwrap();
        assert_eq!(function.greedy(3).unwrap().picks, naive.picks);
        assert_eq!(
            weighted(vec![0.0; 30]).greedy(3).unwrap().stop,
            MaximizeStop::NoGain
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn selects_what_naive_greedy_selects(
            cells in prop::collection::vec((0..9i8, 0..9i8, 0..4i8), 1..150),
            k in 1..12usize,
            kernel in prop::sample::select(vec![
                Kernel::Linear { reach: 3.0 }, Kernel::Linear { reach: 30.0 },
                Kernel::Reciprocal { scale: 1.0 }, Kernel::Rational { scale: 1.5 },
            ]),
            (weighted, truncated) in any::<(bool, bool)>(),
        ) {
            let points: Vec<[f64; 3]> =
                cells.iter().map(|c| [f64::from(c.0), f64::from(c.1), 0.5 * f64::from(c.2)]).collect();
            let n = points.len();
            let mut function = FacilityLocation::new(Points::new(&points, kernel).unwrap());
            if weighted {
                function = function.weighted((0..n).map(|v| (v % 3) as f64).collect()).unwrap();
            }
            if truncated {
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
