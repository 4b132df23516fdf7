//! Maximisers of submodular functions: the oracle of the minimax algorithms.
//!
//! | maximiser | factor α (non-negative submodular f) |
//! | --- | --- |
//! | [`Greedy`], [`LazyGreedy`], k elements | 1 − 1/e if f is monotone with f(∅) = 0, else none |
//! | the same, knapsack | (1 − 1/e) / 2 if f is monotone with f(∅) = 0, else none |
//! | [`StochasticGreedy`] | 1 − 1/e − ε in expectation if f is monotone, else none |
//! | [`RandomGreedy`] | 1/e in expectation (1 − 1/e if monotone) |
//! | [`Exhaustive`] | 1 |

mod constraint;
mod exhaustive;
mod greedy;
mod lazy_greedy;
mod random_greedy;
mod stochastic_greedy;

pub use constraint::{Constraint, MaximizeError};
pub use exhaustive::Exhaustive;
pub use greedy::Greedy;
pub use lazy_greedy::LazyGreedy;
pub use random_greedy::RandomGreedy;
pub use stochastic_greedy::StochasticGreedy;

use crate::set_function::SetFunction;
use crate::subset::Subset;

/// Something that maximises set functions under a constraint.
pub trait Maximizer {
    /// A set of large value that keeps the constraint.
    ///
    /// # Errors
    /// A constraint that does not fit the function's ground set, a value that is not finite.
    fn maximize(&mut self, function: &dyn SetFunction) -> Result<Maximum, MaximizeError>;

    /// The constraint that every answer keeps.
    fn constraint(&self) -> &Constraint;

    /// α of the table above; `None` where nothing is guaranteed.
    fn factor(&self, monotone: bool) -> Option<f64>;
}

/// What a maximiser found.
#[derive(Debug, Clone, PartialEq)]
pub struct Maximum {
    /// The elements in the order they were picked.
    pub picks: Vec<usize>,
    /// The same as a set.
    pub set: Subset,
    /// f of the set.
    pub value: f64,
    /// What each pick added.
    pub gains: Vec<f64>,
    /// How many gains (values, for exhaustive search) were computed.
    pub evaluations: usize,
    /// Why it stopped.
    pub stop: MaximizeStop,
}

/// Why a maximiser stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum MaximizeStop {
    /// The constraint lets no further element in.
    Full,
    /// No further element has a positive gain.
    NoGain,
    /// Every set was tried.
    Enumerated,
}

impl Maximum {
    pub(crate) fn start(ground: usize, value: f64) -> Self {
        Self {
            picks: Vec::new(),
            set: Subset::empty(ground),
            value,
            gains: Vec::new(),
            evaluations: 0,
            stop: MaximizeStop::Full,
        }
    }

    pub(crate) fn pick(&mut self, element: usize, gain: f64) {
        self.picks.push(element);
        self.set.insert(element);
        self.gains.push(gain);
        self.value += gain;
    }
}

fn finite(element: usize, gain: f64) -> Result<f64, MaximizeError> {
    if gain.is_finite() {
        Ok(gain)
    } else {
        Err(MaximizeError::NonFinite { element, gain })
    }
}
