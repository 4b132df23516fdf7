//! Sampling-based planners: one question in, one [`Plan`] out that says why the search ended.

mod config;
mod cost_tree;
mod error;
mod informed;
mod plan;
mod problem;
mod query;
mod rrt;
mod rrt_connect;
mod rrt_star;
mod tree;

pub use config::{ConfigError, RrtConfig, RrtStarConfig};
pub use error::PlanError;
pub use plan::{Plan, Progress, Stop};
pub use query::Query;
pub use rrt::{Rrt, rrt};
pub use rrt_connect::{RrtConnect, rrt_connect};
pub use rrt_star::{RrtStar, rrt_star};
