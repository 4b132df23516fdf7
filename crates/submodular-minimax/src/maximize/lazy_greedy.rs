//! Lazy greedy: greedy's answer with few evaluations, by gains that can only fall.
//!
//! Reference: Minoux, "Accelerated greedy algorithms for maximizing submodular set functions",
//! Optimization Techniques 1978. Worst case O(n k) gains, in practice a few times n.

use super::constraint::{Constraint, MaximizeError};
use super::greedy::{better_single, greedy_factor};
use super::{MaximizeStop, Maximizer, Maximum, finite};
use crate::set_function::{Growth, SetFunction};
use crate::subset::Subset;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The same selection as [`Greedy`](super::Greedy), ties included, for submodular functions.
#[derive(Debug, Clone, PartialEq)]
pub struct LazyGreedy {
    /// Which sets are allowed.
    pub constraint: Constraint,
}

impl LazyGreedy {
    /// At most `k` elements.
    #[must_use]
    pub fn cardinality(k: usize) -> Self {
        Self {
            constraint: Constraint::Cardinality(k),
        }
    }

    fn candidates(
        &self,
        growth: &dyn Growth,
        n: usize,
    ) -> Result<BinaryHeap<Candidate>, MaximizeError> {
        let mut all = Vec::with_capacity(n);
        for element in 0..n {
            let gain = finite(element, growth.gain(element))?;
            let cost = self.constraint.cost(element);
            all.push(Candidate {
                key: gain / cost,
                gain,
                element,
                age: 0,
            });
        }
        Ok(BinaryHeap::from(all))
    }
}

impl Maximizer for LazyGreedy {
    fn maximize(&mut self, function: &dyn SetFunction) -> Result<Maximum, MaximizeError> {
        let n = function.ground_size();
        self.constraint.validate(n)?;
        let mut growth = function.grow(&Subset::empty(n));
        let mut found = Maximum::start(n, growth.value());
        let mut heap = self.candidates(growth.as_ref(), n)?;
        found.evaluations = n;
        let mut left = self.constraint.budget();
        let fits = |c: &&Candidate| self.constraint.cost(c.element) <= left;
        let by_gain = |a: &&Candidate, b: &&Candidate| {
            a.gain.total_cmp(&b.gain).then(b.element.cmp(&a.element))
        };
        let single = heap
            .iter()
            .filter(fits)
            .max_by(by_gain)
            .map(|c| (c.gain, c.element));
        while let Some(mut top) = heap.pop() {
            let cost = self.constraint.cost(top.element);
            if cost > left {
                continue;
            }
            if top.age == found.picks.len() {
                if top.gain <= 0.0 {
                    found.stop = MaximizeStop::NoGain;
                    break;
                }
                found.pick(top.element, top.gain);
                growth.insert(top.element);
                left -= cost;
                continue;
            }
            top.gain = finite(top.element, growth.gain(top.element))?;
            top.key = top.gain / cost;
            top.age = found.picks.len();
            found.evaluations += 1;
            heap.push(top);
        }
        Ok(better_single(found, single, function, n))
    }

    fn constraint(&self) -> &Constraint {
        &self.constraint
    }

    fn factor(&self, monotone: bool) -> Option<f64> {
        greedy_factor(&self.constraint, monotone)
    }
}

/// An element with the gain it had when the set had `age` elements.
struct Candidate {
    key: f64,
    gain: f64,
    element: usize,
    age: usize,
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        self.key
            .total_cmp(&other.key)
            .then(other.element.cmp(&self.element))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}
