//! What can be said about a solution after the fact, without knowing the optimum.

/// Bounds that hold whatever the oracle did: lower ≤ τ ≤ value ≤ upper.
///
/// τ = min over X of max over Y of f(X ∪ Y). For any response Y, min over X of f(X ∪ Y) ≤ τ (weak
/// duality), so the best such minimum seen is a lower bound. The upper bound comes from
/// submodularity: max over |Y| ≤ k of f(X ∪ Y) ≤ f(X) + the k largest gains f(X ∪ {u}) − f(X).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Certificate {
    /// A lower bound on τ, the best value that any X can guarantee.
    pub lower_bound: f64,
    /// An upper bound on the value of the returned set against its worst response.
    pub upper_bound: f64,
}

impl Certificate {
    /// upper / lower: the returned set is within this factor of the best. 1 when both are zero,
    /// infinite when only the lower bound is not above zero.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        if self.lower_bound > 0.0 {
            self.upper_bound / self.lower_bound
        } else if self.upper_bound <= 0.0 {
            1.0
        } else {
            f64::INFINITY
        }
    }
}
