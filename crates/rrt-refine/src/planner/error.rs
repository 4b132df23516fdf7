//! Why a planner refuses a question.

use super::ConfigError;
use crate::refine::RefineError;

/// Why a planner refuses a question before it searches.
///
/// A search that finds nothing is no error: see [`Stop`](crate::Stop).
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// A parameter is out of its range.
    #[error("planner: {0}")]
    Config(#[from] ConfigError),
    /// A parameter of the refiner is out of its range.
    #[error(transparent)]
    Refine(#[from] RefineError),
    /// The start has a coordinate that is NaN or infinite.
    #[error("planner: the start has {value} on axis {axis}; coordinates must be finite")]
    StartNotFinite {
        /// Index of the axis.
        axis: usize,
        /// The coordinate.
        value: f64,
    },
    /// The start lies outside the bounds.
    #[error(
        "planner: the start has {value} on axis {axis}, the bounds go from {min} to {max}; widen the bounds"
    )]
    StartOutside {
        /// Index of the first axis on which it does.
        axis: usize,
        /// The coordinate.
        value: f64,
        /// Lower end of the bounds.
        min: f64,
        /// Upper end of the bounds.
        max: f64,
    },
    /// The start itself is not free.
    #[error(
        "planner: the start is not free; move it out of the obstacle or reduce the safety radius"
    )]
    StartNotFree,
    /// No goal was given.
    #[error("planner: no goal was given; give at least one")]
    NoGoal,
    /// A goal has a coordinate that is NaN or infinite.
    #[error("planner: goal {index} has {value} on axis {axis}; coordinates must be finite")]
    GoalNotFinite {
        /// Index of the goal.
        index: usize,
        /// Index of the axis.
        axis: usize,
        /// The coordinate.
        value: f64,
    },
    /// A goal lies outside the bounds.
    #[error(
        "planner: goal {index} has {value} on axis {axis}, the bounds go from {min} to {max}; widen the bounds"
    )]
    GoalOutside {
        /// Index of the goal.
        index: usize,
        /// Index of the first axis on which it does.
        axis: usize,
        /// The coordinate.
        value: f64,
        /// Lower end of the bounds.
        min: f64,
        /// Upper end of the bounds.
        max: f64,
    },
    /// Not one of the goals is free. Where some are, the others are left out of the search.
    #[error(
        "planner: none of the {goals} goals is free; move a goal out of the obstacle or reduce the safety radius"
    )]
    NoFreeGoal {
        /// How many goals were given.
        goals: usize,
    },
}
