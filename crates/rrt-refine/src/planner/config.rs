//! Parameters that every planner shares, and what is wrong with them when they are refused.

/// Parameters of [`rrt`](crate::rrt) and [`rrt_connect`](crate::rrt_connect).
///
/// The exploration paper names RRT as its planner; what we know of it (not its full text) has no parameter of it, so none of these is the paper's; the
/// source of each is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RrtConfig {
    /// Longest edge that a tree grows by, in the unit of the space; positive. Default 1.5, meant for metres indoors: with
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
    /// is the shortest path. One check a goal until one is free, nearest goal first; the edge may be longer than `step_length`.
    pub try_straight: bool,
}

impl Default for RrtConfig {
    fn default() -> Self {
        Self {
            step_length: 1.5,
            goal_bias: 0.05,
            max_iterations: 10_000,
            max_nodes: 10_000,
            try_straight: true,
        }
    }
}

/// Parameters of [`rrt_star`](crate::rrt_star).
///
/// None is the exploration paper's, which does not use RRT*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RrtStarConfig {
    /// What it shares with RRT. `step_length` bounds the step to a new node; a better parent may be farther away.
    pub rrt: RrtConfig,
    /// Multiple of the number of neighbours that asymptotic optimality needs, e (1 + 1/D) ln n; 1 or more. Default 1.1
    /// (Karaman and Frazzoli 2011 ask for more than 1; motion planning libraries take 1.1).
    pub rewire_factor: f64,
    /// Sample only where the path can still get shorter, once there is one (Informed RRT*). Default false.
    pub informed: bool,
}

impl Default for RrtStarConfig {
    fn default() -> Self {
        Self {
            rrt: RrtConfig::default(),
            rewire_factor: 1.1,
            informed: false,
        }
    }
}

impl RrtStarConfig {
    /// Informed RRT* with the other defaults.
    pub fn informed() -> Self {
        Self {
            informed: true,
            ..Self::default()
        }
    }

    /// # Errors
    /// The first parameter that is out of its range.
    pub fn validate(&self) -> Result<(), ConfigError> {
        self.rrt.validate()?;
        // The upper end keeps the number of neighbours sensible.
        if !(1.0..=1000.0).contains(&self.rewire_factor) {
            return Err(ConfigError::RewireFactor {
                value: self.rewire_factor,
            });
        }
        Ok(())
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
    /// `rewire_factor` is outside 1 to 1000.
    #[error("rewire_factor is {value}; it is a multiple from 1 to 1000")]
    RewireFactor {
        /// The value.
        value: f64,
    },
    /// `attempts` is zero.
    #[error("attempts is {value}; at least 1 is needed for a path")]
    Attempts {
        /// The value.
        value: usize,
    },
    /// `min_gain` is not a share below 1.
    #[error("min_gain is {value}; it is a share from 0 to below 1")]
    MinGain {
        /// The value.
        value: f64,
    },
    /// `first_gain` is not a share below 1.
    #[error("first_gain is {value}; it is a share from 0 to below 1")]
    FirstGain {
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
    /// What the paper's words say: RRT from the start, without asking for the straight motion first.
    pub fn paper() -> Self {
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
