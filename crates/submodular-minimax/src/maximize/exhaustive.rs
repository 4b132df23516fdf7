//! Exhaustive maximisation, the reference for small ground sets. Cost: 2ⁿ values, n ≤ 20.

use super::constraint::{Constraint, MaximizeError};
use super::{MaximizeStop, Maximizer, Maximum, finite};
use crate::set_function::SetFunction;
use crate::subset::Subset;

/// Tries every allowed set; ties go to the smallest membership mask.
#[derive(Debug, Clone, PartialEq)]
pub struct Exhaustive {
    /// Which sets are allowed.
    pub constraint: Constraint,
}

impl Exhaustive {
    /// At most `k` elements.
    #[must_use]
    pub fn cardinality(k: usize) -> Self {
        Self {
            constraint: Constraint::Cardinality(k),
        }
    }
}

impl Maximizer for Exhaustive {
    fn maximize(&mut self, function: &dyn SetFunction) -> Result<Maximum, MaximizeError> {
        let n = function.ground_size();
        self.constraint.validate(n)?;
        if n > LIMIT {
            return Err(MaximizeError::TooLarge {
                elements: n,
                limit: LIMIT,
            });
        }
        let mut best = (f64::NEG_INFINITY, Subset::empty(n));
        let mut evaluations = 0;
        for mask in 0..1_u64 << n {
            let set = Subset::from_mask(n, mask);
            if self.constraint.allows(&set) {
                let value = finite(set.iter().next().unwrap_or(0), function.value(&set))?;
                evaluations += 1;
                if value > best.0 {
                    best = (value, set);
                }
            }
        }
        let mut found = Maximum::start(n, function.value(&Subset::empty(n)));
        let mut growth = function.grow(&Subset::empty(n));
        for element in best.1.iter() {
            found.pick(element, growth.gain(element));
            growth.insert(element);
        }
        Ok(Maximum {
            value: best.0,
            evaluations,
            stop: MaximizeStop::Enumerated,
            ..found
        })
    }

    fn constraint(&self) -> &Constraint {
        &self.constraint
    }

    fn factor(&self, _monotone: bool) -> Option<f64> {
        Some(1.0)
    }
}

const LIMIT: usize = 20;
