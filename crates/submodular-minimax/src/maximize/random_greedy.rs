//! Random greedy: each pick is one of the k best, at random; made for non-monotone functions.
//!
//! Reference: Buchbinder, Feldman, Naor, Schwartz, "Submodular maximization with cardinality
//! constraints", SODA 2014: 1/e in expectation, 1 − 1/e for monotone functions. Cost: O(n k) gains.

use super::constraint::{Constraint, MaximizeError};
use super::{MaximizeStop, Maximizer, Maximum, finite};
use crate::set_function::SetFunction;
use crate::subset::Subset;
use rand::{Rng, RngExt};

/// Random greedy under a cardinality constraint. The same generator state gives the same set.
///
/// ```
/// use rand_pcg::{Pcg64, rand_core::SeedableRng};
/// use submodular_minimax::functions::{GraphCut, Sparse};
/// use submodular_minimax::maximize::{Maximizer, RandomGreedy};
/// let edges = vec![vec![(1, 1.0)], vec![(0, 1.0), (2, 1.0)], vec![(1, 1.0)]];
/// let cut = GraphCut::new(Sparse::new(edges, 3)?)?;
/// let mut rng = Pcg64::seed_from_u64(1);
/// let found = RandomGreedy::cardinality(2, &mut rng).maximize(&cut)?;
/// assert!(found.picks.len() <= 2 && found.value >= 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct RandomGreedy<'r, R> {
    constraint: Constraint,
    rng: &'r mut R,
}

impl<'r, R: Rng> RandomGreedy<'r, R> {
    /// At most `k` elements.
    pub fn cardinality(k: usize, rng: &'r mut R) -> Self {
        Self {
            constraint: Constraint::Cardinality(k),
            rng,
        }
    }
}

impl<R: Rng> Maximizer for RandomGreedy<'_, R> {
    fn maximize(&mut self, function: &dyn SetFunction) -> Result<Maximum, MaximizeError> {
        let n = function.ground_size();
        let k = cardinality(&self.constraint, n)?;
        let mut growth = function.grow(&Subset::empty(n));
        let mut found = Maximum::start(n, growth.value());
        for _ in 0..k {
            let mut gains = Vec::with_capacity(n);
            for e in (0..n).filter(|&e| !found.set.contains(e)) {
                gains.push((finite(e, growth.gain(e))?, e));
                found.evaluations += 1;
            }
            gains.retain(|entry| entry.0 > 0.0);
            gains.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            if gains.is_empty() {
                found.stop = MaximizeStop::NoGain;
                break;
            }
            // A draw beyond the useful elements is a dummy element of the paper: nothing is added.
            let draw = self.rng.random_range(0..k);
            if let Some(&(gain, element)) = gains.get(draw) {
                found.pick(element, gain);
                growth.insert(element);
            }
        }
        Ok(found)
    }

    fn constraint(&self) -> &Constraint {
        &self.constraint
    }

    fn factor(&self, monotone: bool) -> Option<f64> {
        let e = (-1.0_f64).exp();
        Some(if monotone { 1.0 - e } else { e })
    }
}

/// min(k, n), or an error for a constraint that is no cardinality.
pub(super) fn cardinality(constraint: &Constraint, n: usize) -> Result<usize, MaximizeError> {
    constraint.validate(n)?;
    match constraint {
        Constraint::Cardinality(k) => Ok((*k).min(n)),
        Constraint::Knapsack { .. } => Err(MaximizeError::KnapsackUnsupported),
    }
}
