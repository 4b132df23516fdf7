//! Why a trajectory could not be measured.

/// What stops an evaluation. Every variant names the numbers that caused it.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EvaluationError {
    /// A time stamp or coordinate is NaN, infinite, or too large to be squared.
    #[error(
        "entry {index} holds a number that is not finite or too large; remove it before evaluating"
    )]
    NonFinite {
        /// Index into the slice that was handed in.
        index: usize,
    },
    /// Two slices that belong together differ in length.
    #[error("{source_len} source points cannot be aligned with {target_len} target points")]
    LengthMismatch {
        /// Points to be moved.
        source_len: usize,
        /// Points to be met.
        target_len: usize,
    },
    /// Too few matched samples remain.
    #[error(
        "{pairs} matching pairs found, at least {needed} needed; check the clocks of the two files \
         or allow a greater time difference"
    )]
    TooFewPairs {
        /// What was found.
        pairs: usize,
        /// What is needed.
        needed: usize,
    },
    /// The points lie on one line or in one place, or the orientations cancel, so that a rotation or scale cannot be told.
    #[error(
        "the alignment is not unique: the trajectory does not leave one line or place, or its orientations cancel \
         (spread ratio {ratio:e})"
    )]
    Degenerate {
        /// Second over first singular value of the cross covariance (or the variance when that is zero).
        ratio: f64,
    },
    /// Along the rotation that the orientations give, the positions run the other way.
    #[error(
        "the positions run against the orientations (the best scale is {scale:.3}); check that both trajectories \
         are of the same body, or align by positions"
    )]
    Scale {
        /// Factor that the positions ask for, not positive.
        scale: f64,
    },
    /// A parameter is outside its range.
    #[error("{name} is {value}, but must be {range}")]
    Parameter {
        /// Field of the configuration.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
}
