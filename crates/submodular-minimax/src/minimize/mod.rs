//! Minimisers of submodular functions without constraint.

mod brute_force;
mod min_norm_point;
mod modular;

pub use brute_force::BruteForce;
pub use min_norm_point::MinNormPoint;
pub use modular::ModularMinimizer;

use crate::set_function::SetFunction;
use crate::subset::Subset;
use thiserror::Error;

/// Something that minimises set functions.
pub trait Minimizer {
    /// A set of least value, as exact as [`Minimum::gap`] says.
    ///
    /// # Errors
    /// A function this minimiser cannot handle, a value that is not finite.
    fn minimize(&self, function: &dyn SetFunction) -> Result<Minimum, MinimizeError>;
}

/// What a minimiser found.
#[derive(Debug, Clone, PartialEq)]
pub struct Minimum {
    /// The set.
    pub set: Subset,
    /// f of the set.
    pub value: f64,
    /// No set is below this.
    pub lower_bound: f64,
    /// Major iterations, or sets tried, or 1 for a closed form.
    pub iterations: usize,
    /// Why it stopped.
    pub stop: MinimizeStop,
}

impl Minimum {
    /// value − lower bound, at least 0: how far from the least value the set can be.
    #[must_use]
    pub fn gap(&self) -> f64 {
        (self.value - self.lower_bound).max(0.0)
    }
}

/// Why a minimiser stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum MinimizeStop {
    /// The answer is exact up to the tolerance.
    Optimal,
    /// The iterations were used up; [`Minimum::gap`] says what is left.
    IterationLimit,
}

/// Why a minimiser cannot run.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MinimizeError {
    /// The ground set is too large to enumerate.
    #[error("{elements} elements are too many to enumerate: at most {limit}, use MinNormPoint")]
    TooLarge {
        /// How many there are.
        elements: usize,
        /// How many are allowed.
        limit: usize,
    },
    /// The function does not say that it is modular.
    #[error("the function has no modular form: use MinNormPoint")]
    NotModular,
    /// A value of the function is NaN or infinite.
    #[error("the function is {value} on a set of {elements} elements: it must be finite")]
    NonFinite {
        /// The value.
        value: f64,
        /// The size of the set.
        elements: usize,
    },
    /// A setting is outside its range.
    #[error("{field} = {value} is out of range: it must be {range}")]
    Setting {
        /// The field.
        field: &'static str,
        /// What it was.
        value: f64,
        /// What it must be.
        range: &'static str,
    },
}
