//! How much the points already in weigh, and why an iteration stopped.

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
}
