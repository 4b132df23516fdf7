//! Stochastic greedy: each pick is the best of a random sample.
//!
//! Reference: Mirzasoleiman et al., "Lazier than lazy greedy", AAAI 2015. Samples of
//! (n / k) ln(1 / ε) elements give 1 − 1/e − ε in expectation with O(n ln(1 / ε)) gains in all.

use super::constraint::{Constraint, MaximizeError};
use super::random_greedy::cardinality;
use super::{MaximizeStop, Maximizer, Maximum, finite};
use crate::set_function::SetFunction;
use crate::subset::Subset;
use rand::{Rng, RngExt};

/// Stochastic greedy under a cardinality constraint. The same generator state gives the same set.
///
/// ```
/// use rand_pcg::{Pcg64, rand_core::SeedableRng};
/// use submodular_minimax::functions::{FacilityLocation, Kernel, Points};
/// use submodular_minimax::maximize::{Maximizer, StochasticGreedy};
/// let line: Vec<[f64; 3]> = (0..100).map(|i| [f64::from(i), 0.0, 0.0]).collect();
/// let function = FacilityLocation::new(Points::new(&line, Kernel::Linear { reach: 20.0 })?);
/// let mut rng = Pcg64::seed_from_u64(1);
/// let found = StochasticGreedy::cardinality(5, 0.1, &mut rng).maximize(&function)?;
/// assert!(found.picks.len() == 5 && found.evaluations < 300);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct StochasticGreedy<'r, R> {
    constraint: Constraint,
    epsilon: f64,
    rng: &'r mut R,
}

impl<'r, R: Rng> StochasticGreedy<'r, R> {
    /// At most `k` elements; `epsilon` between 0 and 1 is what the factor may lose, 0.1 is usual.
    pub fn cardinality(k: usize, epsilon: f64, rng: &'r mut R) -> Self {
        Self {
            constraint: Constraint::Cardinality(k),
            epsilon,
            rng,
        }
    }
}

impl<R: Rng> Maximizer for StochasticGreedy<'_, R> {
    fn maximize(&mut self, function: &dyn SetFunction) -> Result<Maximum, MaximizeError> {
        let n = function.ground_size();
        let k = cardinality(&self.constraint, n)?;
        if !(self.epsilon > 0.0 && self.epsilon < 1.0) {
            return Err(MaximizeError::Epsilon {
                epsilon: self.epsilon,
            });
        }
        let sample = (n as f64 / k.max(1) as f64 * (1.0 / self.epsilon).ln()).ceil() as usize;
        let mut growth = function.grow(&Subset::empty(n));
        let mut found = Maximum::start(n, growth.value());
        let mut rest: Vec<usize> = (0..n).collect();
        while found.picks.len() < k {
            let size = sample.clamp(1, rest.len());
            for i in 0..size {
                let j = self.rng.random_range(i..rest.len());
                rest.swap(i, j);
            }
            let mut best: Option<(f64, usize)> = None;
            for (at, &e) in rest[..size].iter().enumerate() {
                let gain = finite(e, growth.gain(e))?;
                if best.is_none_or(|b| gain > b.0 || (gain == b.0 && e < rest[b.1])) {
                    best = Some((gain, at));
                }
            }
            found.evaluations += size;
            let Some((gain, at)) = best.filter(|b| b.0 > 0.0) else {
                found.stop = MaximizeStop::NoGain;
                break;
            };
            let element = rest.swap_remove(at);
            found.pick(element, gain);
            growth.insert(element);
        }
        Ok(found)
    }

    fn constraint(&self) -> &Constraint {
        &self.constraint
    }

    fn factor(&self, monotone: bool) -> Option<f64> {
        monotone.then(|| 1.0 - (-1.0_f64).exp() - self.epsilon)
    }
}
