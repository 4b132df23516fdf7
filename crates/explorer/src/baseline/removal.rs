//! What a baseline kept and removed.

/// What a baseline kept and removed, and how suspicious each point was.
#[derive(Debug, Clone, PartialEq)]
pub struct BaselineRemoval {
    /// Indices of the points that stay, ascending.
    pub kept: Vec<usize>,
    /// Indices of the points that go, ascending.
    pub removed: Vec<usize>,
    /// One score a point, higher is more outlying; each function says in which unit.
    pub scores: Vec<f64>,
}

impl BaselineRemoval {
    pub(super) fn new(scores: Vec<f64>, is_outlier: impl Fn(usize) -> bool) -> Self {
        let (removed, kept) = (0..scores.len()).partition(|&v| is_outlier(v));
        Self {
            kept,
            removed,
            scores,
        }
    }
}
