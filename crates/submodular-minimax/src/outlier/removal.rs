//! What the removal kept and removed, how suspicious each point was and how sure the solver is.

use crate::minimax::{Certificate, StopReason};

/// Result of [`remove_outliers`](super::remove_outliers).
#[derive(Debug, Clone, PartialEq)]
pub struct OutlierRemoval {
    /// Indices of the points that stay, ascending.
    pub kept: Vec<usize>,
    /// Indices of the points that go, ascending.
    pub removed: Vec<usize>,
    /// One score a point, higher is more outlying, above 0 exactly for the removed ones.
    ///
    /// It is the shortfall θ(v) − max over u of s(u, v), in units of the score s.
    pub scores: Vec<f64>,
    /// Iterations of Algorithm 1; 1 for the closed form.
    pub iterations: usize,
    /// Bounds on how far the solution is from the best one.
    pub certificate: Certificate,
    /// Why the solver stopped.
    pub stop: StopReason,
}
