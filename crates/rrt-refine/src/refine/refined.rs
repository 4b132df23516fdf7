//! What a refiner answers.

use crate::path::Path;

/// A refined path and what it cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Refined<const D: usize> {
    /// The new path; the given one where nothing was gained.
    pub path: Path<D>,
    /// Motions checked.
    pub checks: usize,
    /// Length of the path that was given.
    pub length_before: f64,
    /// Why the refiner ended.
    pub stop: RefineStop,
}

/// Why a refiner ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RefineStop {
    /// The same refiner would change nothing more.
    Done,
    /// The checks, rounds or attempts it was allowed are used up.
    Budget,
}

impl<const D: usize> Refined<D> {
    /// Length of the new path over that of the old one, at most 1; 1 for a path without length.
    pub fn ratio(&self) -> f64 {
        if self.length_before > 0.0 {
            self.path.length() / self.length_before
        } else {
            1.0
        }
    }
}
