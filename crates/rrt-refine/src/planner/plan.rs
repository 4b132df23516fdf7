//! What a planner answers: the path, if any, why it stopped, and what it cost.

use crate::path::Path;

/// Outcome of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan<const D: usize> {
    /// A free path from the start to a goal, or `None` where the search ended without one. One vertex when the start is a goal.
    pub path: Option<Path<D>>,
    /// Which of the caller's goals the path ends at.
    pub goal: Option<usize>,
    /// Why the search ended.
    pub stop: Stop,
    /// Samples drawn so far, over all calls.
    pub iterations: usize,
    /// Nodes in the tree, or in both trees together.
    pub nodes: usize,
    /// Motions checked so far, those of single points included.
    pub checks: usize,
}

impl<const D: usize> Plan<D> {
    /// Length of the path, in the unit of the space.
    pub fn length(&self) -> Option<f64> {
        self.path.as_ref().map(Path::length)
    }
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stop {
    /// A goal was reached.
    Reached,
    /// The straight motion to the goal is free (or the start is a goal): no path is shorter, so there is nothing to improve.
    Straight,
    /// The iterations of this call are used up.
    Iterations,
    /// The trees hold as many nodes as they may.
    Nodes,
    /// The caller's closure said so.
    Asked,
}

/// How far a search has come; handed to the caller's closure before each sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Samples drawn so far, over all calls.
    pub iterations: usize,
    /// Nodes in the tree, or in both trees together.
    pub nodes: usize,
    /// Motions checked so far.
    pub checks: usize,
    /// Length of the best path so far.
    pub length: Option<f64>,
}
