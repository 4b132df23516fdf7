//! Why a refiner refuses its parameters.

use crate::path::PathError;

/// Which parameter of a refiner is out of its range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RefineError {
    /// A length, angle or spacing is not a positive finite number.
    #[error("refiner: {name} is {value}; it must be positive and finite")]
    NotPositive {
        /// Name of the parameter.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A share, weight or clearance is negative or NaN.
    #[error("refiner: {name} is {value}; it must be 0 or more")]
    Negative {
        /// Name of the parameter.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The path cannot be cut as asked.
    #[error("refiner: {0}")]
    Path(#[from] PathError),
}

pub(super) fn positive(name: &'static str, value: f64) -> Result<(), RefineError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(RefineError::NotPositive { name, value })
    }
}

pub(super) fn not_negative(name: &'static str, value: f64) -> Result<(), RefineError> {
    if value >= 0.0 {
        Ok(())
    } else {
        Err(RefineError::Negative { name, value })
    }
}
