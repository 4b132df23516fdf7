//! What the removal kept and removed, how suspicious each point was and how sure the solver is.

use crate::minimax::{Certificate, StopReason};

/// Result of [`remove_outliers`](super::remove_outliers).
#[derive(Debug, Clone, PartialEq)]
pub struct OutlierRemoval {
    /// Indices of the points that stay, ascending.
    pub kept: Vec<usize>,
    /// Indices of the points that go, ascending.
    pub removed: Vec<usize>,
    /// One score a point, higher is more outlying; the removed ones are those at or above 0.
    ///
    /// It is the shortfall θ(v) − max over u of s(u, v) of a point that would join above
    /// θ = (1 + β) λ, in units of the score s. Points out of every representative's reach fall short by θ
    /// and, in reaches, the mean distance to the four nearest points, so that they too have an order.
    /// For the ranged reading, where s = 1 / (1 + badness), it is the log of how many times the badness
    /// exceeds what is allowed. Where there was nothing to measure by, all scores are −1.
    pub scores: Vec<f64>,
    /// Iterations of Algorithm 1; 1 for the closed form.
    pub iterations: usize,
    /// Bounds on how far the solution is from the best one.
    pub certificate: Certificate,
    /// Why the solver stopped.
    pub stop: StopReason,
}

impl OutlierRemoval {
    /// Everything is kept: no points, or no spacing to measure by, or a score that lets none join.
    pub(super) fn keep_all(n: usize, stop: StopReason) -> Self {
        Self {
            kept: (0..n).collect(),
            removed: Vec::new(),
            scores: vec![-1.0; n],
            iterations: 1,
            certificate: Certificate {
                lower_bound: 0.0,
                upper_bound: 0.0,
            },
            stop,
        }
    }
}
