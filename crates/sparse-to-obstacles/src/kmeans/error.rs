//! What can be wrong with the input of K-means.

use thiserror::Error;

/// Why [`kmeans`](crate::kmeans) refused its input.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum KMeansError {
    /// The slice of points is empty.
    #[error("no points: K-means needs at least one")]
    NoPoints,
    /// `clusters` is zero.
    #[error("clusters is 0: ask for at least 1")]
    NoClusters,
    /// More clusters than points.
    #[error(
        "{clusters} clusters were asked for but there are only {points} points: lower `clusters`"
    )]
    TooManyClusters {
        /// Clusters asked for.
        clusters: usize,
        /// Points given.
        points: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("point {index} has a coordinate that is not finite: remove it")]
    NotFinite {
        /// Index into the input.
        index: usize,
    },
    /// A coordinate whose square overflows.
    #[error("point {index} has a coordinate beyond {largest:e}: rescale the input")]
    TooLarge {
        /// Index into the input.
        index: usize,
        /// Largest magnitude that is accepted.
        largest: f64,
    },
    /// `max_iterations` is zero.
    #[error("max_iterations is 0: allow at least 1")]
    NoIterations,
    /// `tolerance` is negative or not finite.
    #[error("tolerance is {tolerance}: it must be finite and at least 0")]
    Tolerance {
        /// The value given.
        tolerance: f64,
    },
    /// k-means++ without candidates, or with too many.
    #[error("trials is {trials}: k-means++ needs 1 to 1000 candidates per seed")]
    Trials {
        /// The value given.
        trials: usize,
    },
    /// k-means|| out of range.
    #[error(
        "rounds is {rounds} and oversampling {oversampling}: 1 to 1000 rounds and a finite factor \
         above 0 are needed"
    )]
    Oversampling {
        /// Rounds given.
        rounds: usize,
        /// Factor given.
        oversampling: f64,
    },
    /// A mini-batch without points.
    #[error("batch is 0: a mini-batch needs at least 1 point")]
    EmptyBatch,
}
