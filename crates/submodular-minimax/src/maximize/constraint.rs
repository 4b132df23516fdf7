//! Which sets are allowed: at most k elements, or elements of bounded total cost.

use crate::set_function::{Growth, SetFunction};
use crate::subset::Subset;
use thiserror::Error;

/// Which sets a maximiser may return.
///
/// ```
/// use submodular_minimax::functions::Modular;
/// use submodular_minimax::maximize::{Constraint, Greedy, Maximizer};
/// let worth = Modular { constant: 0.0, weights: vec![6.0, 5.0, 5.0] };
/// let constraint = Constraint::Knapsack { costs: vec![3.0, 2.0, 2.0], budget: 4.0 };
/// assert_eq!(Greedy { constraint }.maximize(&worth)?.picks, [1, 2]);
/// # Ok::<(), submodular_minimax::maximize::MaximizeError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Constraint {
    /// At most this many elements, at least 1; more than n is the same as n.
    Cardinality(usize),
    /// Σ of the costs at most the budget.
    Knapsack {
        /// One cost an element, above 0.
        costs: Vec<f64>,
        /// What the set may cost, above 0.
        budget: f64,
    },
}

/// Why a maximiser cannot run.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MaximizeError {
    /// k = 0.
    #[error("k = 0 allows the empty set only: ask for at least 1 element")]
    NoElements,
    /// The costs are not one an element.
    #[error("{costs} costs for {elements} elements: pass one cost per element")]
    Costs {
        /// How many costs were given.
        costs: usize,
        /// How many elements there are.
        elements: usize,
    },
    /// A cost or the budget is not finite and above 0.
    #[error("cost or budget {value} is out of range: it must be finite and above 0")]
    Cost {
        /// What it was.
        value: f64,
    },
    /// ε of stochastic greedy is not between 0 and 1.
    #[error("epsilon = {epsilon} is out of range: it must lie between 0 and 1, both excluded")]
    Epsilon {
        /// What it was.
        epsilon: f64,
    },
    /// The ground set is too large to enumerate.
    #[error("{elements} elements are too many to enumerate: at most {limit}")]
    TooLarge {
        /// How many there are.
        elements: usize,
        /// How many are allowed.
        limit: usize,
    },
    /// This maximiser knows cardinality constraints only.
    #[error("this maximiser takes a cardinality constraint only: use Greedy or LazyGreedy")]
    KnapsackUnsupported,
    /// The function returned a gain that is NaN or infinite.
    #[error("gain of element {element} is {gain}: the function must be finite")]
    NonFinite {
        /// Which element.
        element: usize,
        /// What it gave.
        gain: f64,
    },
}

impl Constraint {
    pub(super) fn validate(&self, elements: usize) -> Result<(), MaximizeError> {
        match self {
            Self::Cardinality(0) => Err(MaximizeError::NoElements),
            Self::Cardinality(_) => Ok(()),
            Self::Knapsack { costs, budget } => {
                if costs.len() != elements {
                    return Err(MaximizeError::Costs {
                        costs: costs.len(),
                        elements,
                    });
                }
                let bad = |value: &&f64| !(value.is_finite() && **value > 0.0);
                match costs.iter().chain([budget]).find(bad) {
                    Some(&value) => Err(MaximizeError::Cost { value }),
                    None => Ok(()),
                }
            }
        }
    }

    /// What an element uses up; 1 under a cardinality constraint.
    pub(super) fn cost(&self, element: usize) -> f64 {
        match self {
            Self::Cardinality(_) => 1.0,
            Self::Knapsack { costs, .. } => costs[element],
        }
    }

    pub(super) fn budget(&self) -> f64 {
        match self {
            Self::Cardinality(k) => *k as f64,
            Self::Knapsack { budget, .. } => *budget,
        }
    }

    /// Whether the set keeps the constraint.
    #[must_use]
    pub fn allows(&self, set: &Subset) -> bool {
        match self {
            Self::Cardinality(k) => set.len() <= *k,
            Self::Knapsack { costs, budget } => {
                set.iter()
                    .map(|e| costs.get(e).copied().unwrap_or(f64::INFINITY))
                    .sum::<f64>()
                    <= *budget
            }
        }
    }

    /// An upper bound on f over the allowed sets, for submodular f: f(∅) + the best fractional
    /// filling of the constraint by positive singleton gains.
    #[must_use]
    pub fn upper_bound(&self, function: &dyn SetFunction) -> f64 {
        let n = function.ground_size();
        if self.validate(n).is_err() {
            return f64::INFINITY;
        }
        let start = function.grow(&Subset::empty(n));
        let fill = |start: &dyn Growth| {
            let mut gains: Vec<(f64, f64)> = (0..n)
                .map(|e| (start.gain(e), self.cost(e)))
                .filter(|&(gain, cost)| gain > 0.0 && cost <= self.budget())
                .collect();
            gains.sort_by(|a, b| (b.0 / b.1).total_cmp(&(a.0 / a.1)));
            let mut left = self.budget();
            let mut sum = 0.0;
            for (gain, cost) in gains {
                sum += gain * (left / cost).clamp(0.0, 1.0);
                left -= cost;
            }
            sum
        };
        start.value() + fill(start.as_ref())
    }
}
