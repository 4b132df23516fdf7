//! Parameters that every planner shares, and what is wrong with them when they are refused.

/// Parameters of [`rrt`](crate::rrt) and [`rrt_connect`](crate::rrt_connect).
///
/// The exploration paper names RRT as its planner and prints no parameter of it, so none of these is the paper's; the
/// source of each is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RrtConfig {
    /// Longest edge that a tree grows by, in the unit of the space; positive. Default 1, meant for metres indoors: with
    /// swept checks a long motion costs little more than a short one.
    pub step_length: f64,
    /// Share of the samples that are a goal (for RRT-Connect: a root of the other tree), 0 to 1. Default 0.05, the value that
    /// motion planning libraries settled on. At 1 an obstacle in the way traps the search.
    pub goal_bias: f64,
    /// Most samples that one call draws; 0 draws none. Default 10,000.
    pub max_iterations: usize,
    /// Most nodes that the trees hold together; at least 1. Default 10,000.
    pub max_nodes: usize,
    /// Check the straight motion to each goal before growing a tree. Default true: in one room it is often free, and then it
    /// is the shortest path. The edge may be longer than `step_length`.
    pub try_straight: bool,
}

impl Default for RrtConfig {
    fn default() -> Self {
        Self {
            step_length: 1.0,
            goal_bias: 0.05,
            max_iterations: 10_000,
            max_nodes: 10_000,
            try_straight: true,
        }
    }
}

/// Which parameter of a planner is out of its range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConfigError {
    /// `step_length` is not a positive finite number.
    #[error("step_length is {value}; it must be positive and finite, in the unit of the space")]
    StepLength {
        /// The value.
        value: f64,
    },
    /// `goal_bias` is outside 0 to 1.
    #[error("goal_bias is {value}; it is a share from 0 to 1")]
    GoalBias {
        /// The value.
        value: f64,
    },
    /// `max_nodes` leaves no room for the start.
    #[error("max_nodes is {value}; at least 1 node is needed for the start")]
    MaxNodes {
        /// The value.
        value: usize,
    },
}

impl RrtConfig {
    /// Plain RRT as LaValle printed it: no straight attempt first and no goal bias but that of the default.
    pub fn plain() -> Self {
        Self {
            try_straight: false,
            ..Self::default()
        }
    }

    /// # Errors
    /// The first parameter that is out of its range.
    pub fn validate(&self) -> Result<(), ConfigError> {
        if !(self.step_length > 0.0 && self.step_length.is_finite()) {
            return Err(ConfigError::StepLength {
                value: self.step_length,
            });
        }
        if !(0.0..=1.0).contains(&self.goal_bias) {
            return Err(ConfigError::GoalBias {
                value: self.goal_bias,
            });
        }
        if self.max_nodes == 0 {
            return Err(ConfigError::MaxNodes {
                value: self.max_nodes,
            });
        }
        Ok(())
    }
}
