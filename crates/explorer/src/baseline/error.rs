//! Why a baseline cannot run.

use thiserror::Error;

/// Why a baseline cannot run.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum BaselineError {
    /// A point is NaN or infinite.
    #[error("point {index} is not finite: drop it before cleaning")]
    NonFinite {
        /// Index of the first such point.
        index: usize,
    },
    /// A setting is outside its range.
    #[error("{field} = {value} is out of range: it must be {range}")]
    Setting {
        /// The field of the config.
        field: &'static str,
        /// What it was.
        value: f64,
        /// What it must be.
        range: &'static str,
    },
}

/// An error unless `value` is finite and at least `least`.
pub(super) fn at_least(field: &'static str, value: f64, least: f64) -> Result<(), BaselineError> {
    if value.is_finite() && value >= least {
        return Ok(());
    }
    let range = if least == 0.0 {
        "finite and at least 0"
    } else {
        "finite and at least 1"
    };
    Err(BaselineError::Setting {
        field,
        value,
        range,
    })
}

/// An error unless `value` is finite and above zero.
pub(super) fn positive(field: &'static str, value: f64) -> Result<(), BaselineError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(BaselineError::Setting {
        field,
        value,
        range: "finite and above 0",
    })
}
