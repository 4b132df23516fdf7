//! How much the points already in weigh, and why an iteration stopped.

use super::solution::MinimaxError;

/// β of Iterative-X-Growing: how much f(X ∪ Xᵢ₋₁) weighs against f(X ∪ Yᵢ).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Beta {
    /// √|N₁|, which gives the a-priori factor O(√n / α).
    Sqrt,
    /// A fixed number above 0; the exploration paper takes 1, for which the factor is O(n / α).
    Fixed(f64),
}

impl Beta {
    /// The number for a ground set of `n` elements, at least 1 for [`Beta::Sqrt`].
    #[must_use]
    pub fn value(self, n: usize) -> f64 {
        match self {
            Self::Sqrt => (n.max(1) as f64).sqrt(),
            Self::Fixed(beta) => beta,
        }
    }
}

/// Why an iteration stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum StopReason {
    /// No element wants to join any more: the algorithm's own end.
    Converged,
    /// Every element has joined.
    Exhausted,
    /// The closed form was evaluated; there was nothing to iterate.
    ClosedForm,
    /// The allowed number of iterations was reached first.
    IterationLimit,
    /// Of [`remove_outliers`](crate::remove_outliers) alone: fewer than five points, or most of them identical, so that
    /// there is no spacing to measure by and all are kept.
    NoSpacing,
}

/// Settings of the iterating minimax algorithms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MinimaxConfig {
    /// β; default √|N₁|, the weight with the best a-priori guarantee. The exploration paper takes 1.
    pub beta: Beta,
    /// Iterations at most, at least 1. X grows in each, so |N₁| + 1 is always enough; the default.
    pub max_iterations: usize,
}

impl Default for MinimaxConfig {
    fn default() -> Self {
        Self {
            beta: Beta::Sqrt,
            max_iterations: usize::MAX,
        }
    }
}

impl MinimaxConfig {
    /// β = 1 as the exploration paper prints it.
    #[must_use]
    pub fn paper() -> Self {
        Self {
            beta: Beta::Fixed(1.0),
            ..Self::default()
        }
    }

    /// Checks every field's range.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn validate(&self) -> Result<(), MinimaxError> {
        let setting = |field, value, range| {
            Err(MinimaxError::Setting {
                field,
                value,
                range,
            })
        };
        match self.beta {
            Beta::Fixed(beta) if !(beta.is_finite() && beta > 0.0) => {
                setting("beta", beta, "finite and above 0")
            }
            _ if self.max_iterations == 0 => setting("max_iterations", 0.0, "at least 1"),
            _ => Ok(()),
        }
    }
}
