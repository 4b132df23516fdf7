//! Why outliers cannot be removed.

use crate::maximize::MaximizeError;
use crate::minimax::MinimaxError;
use crate::points::NonFiniteAt;
use thiserror::Error;

/// Why outliers cannot be removed.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum OutlierError {
    /// A point is NaN or infinite.
    #[error("point {index} is not finite: drop it (and its observations) before cleaning")]
    NonFinite {
        /// Index of the first such point.
        index: usize,
    },
    /// Points and observations disagree.
    #[error("{points} points but observations of {views}: pass one list of observers per point")]
    ViewsMismatch {
        /// How many points were given.
        points: usize,
        /// How many points the observations speak of.
        views: usize,
    },
    /// A camera that sees points is so far away that distances to it overflow.
    #[error(
        "camera position {viewpoint} lies {times:e} times the cloud's size away: drop that keyframe and its \
         observations"
    )]
    FarCamera {
        /// Index of the camera position.
        viewpoint: usize,
        /// Its largest coordinate, in sizes of the cloud.
        times: f64,
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
    /// The iterations of Algorithm 1 failed.
    #[error(transparent)]
    Minimax(#[from] MinimaxError),
}

impl From<MaximizeError> for OutlierError {
    fn from(error: MaximizeError) -> Self {
        Self::Minimax(error.into())
    }
}

impl From<NonFiniteAt> for OutlierError {
    fn from(at: NonFiniteAt) -> Self {
        Self::NonFinite { index: at.0 }
    }
}
