//! Why a ready-made function cannot be built.

use thiserror::Error;

/// Why a ready-made function cannot be built.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum FunctionError {
    /// A list is not as long as the ground set demands.
    #[error("{what} has {found} entries, but {expected} are needed")]
    Length {
        /// Which list.
        what: &'static str,
        /// How long it is.
        found: usize,
        /// How long it must be.
        expected: usize,
    },
    /// An entry is negative, NaN or infinite where the theory needs a finite non-negative one.
    #[error("{what}[{index}] = {value}: it must be finite and at least 0")]
    Entry {
        /// Which list.
        what: &'static str,
        /// Where.
        index: usize,
        /// What it was.
        value: f64,
    },
    /// An index points outside the ground set.
    #[error("{what}[{index}] names element {element}, but there are {size} (0-based)")]
    OutOfRange {
        /// Which list.
        what: &'static str,
        /// Where.
        index: usize,
        /// The element that was named.
        element: usize,
        /// How many elements there are.
        size: usize,
    },
    /// A matrix that must be symmetric is not.
    #[error("weight({row}, {column}) = {value} but weight({column}, {row}) = {mirrored}")]
    Asymmetric {
        /// Row.
        row: usize,
        /// Column.
        column: usize,
        /// The entry.
        value: f64,
        /// The entry across the diagonal.
        mirrored: f64,
    },
}

/// Errors unless `values` has `expected` finite non-negative entries.
pub(crate) fn non_negative(
    what: &'static str,
    values: &[f64],
    expected: usize,
) -> Result<(), FunctionError> {
    if values.len() != expected {
        return Err(FunctionError::Length {
            what,
            found: values.len(),
            expected,
        });
    }
    match values.iter().position(|v| !(v.is_finite() && *v >= 0.0)) {
        Some(index) => Err(FunctionError::Entry {
            what,
            index,
            value: values[index],
        }),
        None => Ok(()),
    }
}
