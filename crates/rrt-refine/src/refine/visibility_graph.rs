//! Shortest path over some vertices of a path, with as few validity checks as the answer needs.
//!
//! Nodes are the vertices p₀ … pₙ₋₁, edges i → j for i < j whose straight motion is free. A* with the straight distance to the
//! end as its bound. An edge enters the queue under its length, is weighed by its cost when it comes first, and is checked for
//! freedom when it still comes first; so only edges that could be on the best path are ever checked (lazy weighted A*,
//! Cohen, Phillips, Likhachev 2014). Equal bounds: the farther vertex, then the earlier origin first.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BinaryHeap};

use crate::euclid::distance;
use crate::motion::MotionValidator;

pub(super) struct VisibilityGraph<'a, const D: usize, M> {
    points: &'a [[f64; D]],
    motion: &'a M,
    /// Whether the motion from i to j is free, for every pair that was asked.
    known: BTreeMap<(usize, usize), bool>,
    pub(super) checks: usize,
    max_checks: usize,
}

/// Whether the segments between neighbours are known to be free.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Segments {
    Trusted,
    Checked,
}

impl<'a, const D: usize, M: MotionValidator<D>> VisibilityGraph<'a, D, M> {
    pub(super) fn new(
        points: &'a [[f64; D]],
        motion: &'a M,
        segments: Segments,
        max_checks: usize,
    ) -> Self {
        let known = match segments {
            Segments::Trusted => (1..points.len()).map(|j| ((j - 1, j), true)).collect(),
            Segments::Checked => BTreeMap::new(),
        };
        Self {
            points,
            motion,
            known,
            checks: 0,
            max_checks,
        }
    }

    /// Whether a check was refused because the budget was used up.
    pub(super) fn is_spent(&self) -> bool {
        self.checks >= self.max_checks
    }

    /// An edge that the budget leaves unchecked counts as blocked.
    fn is_free(&mut self, i: usize, j: usize) -> bool {
        if let Some(&free) = self.known.get(&(i, j)) {
            return free;
        }
        if self.is_spent() {
            return false;
        }
        self.checks += 1;
        let free = self.motion.is_free(&self.points[i], &self.points[j]);
        self.known.insert((i, j), free);
        free
    }

    /// The cheapest way over the vertices in `among` (ascending, at least one) from the first to the last, and its cost.
    ///
    /// `cost` of a motion counts as its length where it is less, or NaN.
    pub(super) fn cheapest(
        &mut self,
        among: &[usize],
        cost: &impl Fn(&[f64; D], &[f64; D]) -> f64,
    ) -> Option<(Vec<usize>, f64)> {
        let points = self.points;
        let last = among.len() - 1;
        let gap = |i: usize, j: usize| distance(&points[among[i]], &points[among[j]]);
        let mut parent: Vec<Option<usize>> = vec![None; among.len()];
        let mut open = BinaryHeap::from([Edge::to_start(gap(0, last))]);
        while let Some(mut edge) = open.pop() {
            let (from, to) = (edge.from, edge.to);
            if parent[to].is_some() {
                continue;
            }
            if !edge.weighed {
                let bound = edge.bound;
                let weight = cost(&points[among[from]], &points[among[to]]);
                edge.weigh(weight.max(edge.weight), gap(to, last));
                if edge.bound > bound {
                    open.push(edge);
                    continue;
                }
            }
            if from != to && !self.is_free(among[from], among[to]) {
                continue;
            }
            parent[to] = Some(from);
            let reached = edge.base + edge.weight;
            if to == last {
                return Some((chain(&parent, among), reached));
            }
            for next in (to + 1..among.len()).filter(|&next| parent[next].is_none()) {
                open.push(Edge::unweighed(
                    reached,
                    to,
                    next,
                    gap(to, next),
                    gap(next, last),
                ));
            }
        }
        None
    }
}

/// The vertices from the first to the last along the parents.
fn chain(parent: &[Option<usize>], among: &[usize]) -> Vec<usize> {
    let mut at = among.len() - 1;
    let mut chain = vec![among[at]];
    while let Some(before) = parent[at].filter(|&before| before != at) {
        chain.push(among[before]);
        at = before;
    }
    chain.reverse();
    chain
}

/// An edge that may lie on the best path; the heap gives the least bound first.
struct Edge {
    /// Cost of the best path through this edge, from below.
    bound: f64,
    /// Cost from the start to the origin of this edge.
    base: f64,
    /// Cost of this edge; its length while not weighed.
    weight: f64,
    from: usize,
    to: usize,
    weighed: bool,
}

impl Edge {
    fn to_start(bound: f64) -> Self {
        Self {
            bound,
            base: 0.0,
            weight: 0.0,
            from: 0,
            to: 0,
            weighed: true,
        }
    }

    fn unweighed(base: f64, from: usize, to: usize, length: f64, to_end: f64) -> Self {
        Self {
            bound: base + length + to_end,
            base,
            weight: length,
            from,
            to,
            weighed: false,
        }
    }

    fn weigh(&mut self, weight: f64, to_end: f64) {
        self.weight = weight;
        self.bound = self.base + weight + to_end;
        self.weighed = true;
    }
}

impl Ord for Edge {
    fn cmp(&self, other: &Self) -> Ordering {
        // Greater is popped first.
        other
            .bound
            .total_cmp(&self.bound)
            .then(self.to.cmp(&other.to))
            .then(other.from.cmp(&self.from))
            .then(self.weighed.cmp(&other.weighed))
    }
}

impl PartialOrd for Edge {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Edge {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Edge {}
