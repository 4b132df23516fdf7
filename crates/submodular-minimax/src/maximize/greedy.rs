//! Greedy: always the element that adds most, until none adds anything.
//!
//! Reference: Nemhauser, Wolsey, Fisher, "An analysis of approximations for maximizing submodular set
//! functions I", Mathematical Programming 1978. Cost: O(n k) gains.

use super::constraint::{Constraint, MaximizeError};
use super::{MaximizeStop, Maximizer, Maximum, finite};
use crate::set_function::SetFunction;
use crate::subset::Subset;

/// Greedy; ties go to the lowest index. With a knapsack, the better of gain per cost and the best
/// single element.
#[derive(Debug, Clone, PartialEq)]
pub struct Greedy {
    /// Which sets are allowed.
    pub constraint: Constraint,
}

impl Greedy {
    /// At most `k` elements.
    #[must_use]
    pub fn cardinality(k: usize) -> Self {
        Self {
            constraint: Constraint::Cardinality(k),
        }
    }
}

impl Maximizer for Greedy {
    fn maximize(&mut self, function: &dyn SetFunction) -> Result<Maximum, MaximizeError> {
        let n = function.ground_size();
        self.constraint.validate(n)?;
        let mut growth = function.grow(&Subset::empty(n));
        let mut found = Maximum::start(n, growth.value());
        let mut left = self.constraint.budget();
        let mut single: Option<(f64, usize)> = None;
        loop {
            let mut best: Option<(f64, usize, f64)> = None;
            let mut room = false;
            for e in (0..n).filter(|&e| !found.set.contains(e)) {
                let cost = self.constraint.cost(e);
                if cost > left {
                    continue;
                }
                room = true;
                let gain = finite(e, growth.gain(e))?;
                found.evaluations += 1;
                if best.is_none_or(|b| gain / cost > b.0) {
                    best = Some((gain / cost, e, gain));
                }
                if found.picks.is_empty() && single.is_none_or(|s| gain > s.0) {
                    single = Some((gain, e));
                }
            }
            let Some((_, e, gain)) = best.filter(|b| b.2 > 0.0) else {
                found.stop = if room {
                    MaximizeStop::NoGain
                } else {
                    MaximizeStop::Full
                };
                return Ok(better_single(found, single, function, n));
            };
            found.pick(e, gain);
            growth.insert(e);
            left -= self.constraint.cost(e);
        }
    }

    fn constraint(&self) -> &Constraint {
        &self.constraint
    }

    fn factor(&self, monotone: bool) -> Option<f64> {
        greedy_factor(&self.constraint, monotone)
    }
}

/// The best single element if it beats the greedy set: the second half of knapsack greedy.
pub(super) fn better_single(
    found: Maximum,
    single: Option<(f64, usize)>,
    function: &dyn SetFunction,
    n: usize,
) -> Maximum {
    let empty = found.value - found.gains.iter().sum::<f64>();
    match single {
        Some((gain, e)) if gain > found.gains.iter().sum() && gain > 0.0 => {
            let mut alone = Maximum::start(n, empty);
            alone.pick(e, gain);
            alone.value = function.value(&alone.set);
            Maximum {
                evaluations: found.evaluations,
                stop: found.stop,
                ..alone
            }
        }
        _ => found,
    }
}

pub(super) fn greedy_factor(constraint: &Constraint, monotone: bool) -> Option<f64> {
    let full = 1.0 - (-1.0_f64).exp();
    match constraint {
        _ if !monotone => None,
        Constraint::Cardinality(_) => Some(full),
        Constraint::Knapsack { .. } => Some(full / 2.0),
    }
}
