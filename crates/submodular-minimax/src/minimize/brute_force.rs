//! Exhaustive minimisation, the reference for small ground sets. Cost: 2ⁿ values, n ≤ 20.

use super::{MinimizeError, MinimizeStop, Minimizer, Minimum};
use crate::set_function::SetFunction;
use crate::subset::Subset;

/// Tries every set; among equals the one with fewest elements, then the smallest mask.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct BruteForce;

impl Minimizer for BruteForce {
    fn minimize(&self, function: &dyn SetFunction) -> Result<Minimum, MinimizeError> {
        let n = function.ground_size();
        if n > LIMIT {
            return Err(MinimizeError::TooLarge {
                elements: n,
                limit: LIMIT,
            });
        }
        let mut best = (f64::INFINITY, Subset::empty(n));
        for mask in 0..1_u64 << n {
            let set = Subset::from_mask(n, mask);
            let value = function.value(&set);
            if !value.is_finite() {
                return Err(MinimizeError::NonFinite {
                    value,
                    elements: set.len(),
                });
            }
            if value < best.0 || (value == best.0 && set.len() < best.1.len()) {
                best = (value, set);
            }
        }
        let (value, set) = best;
        let (iterations, stop) = (1 << n, MinimizeStop::Optimal);
        Ok(Minimum {
            set,
            value,
            lower_bound: value,
            iterations,
            stop,
        })
    }
}

const LIMIT: usize = 20;
