//! Sampling-based planners: one question in, one [`Plan`] out that says why the search ended.

mod config;
mod error;
mod plan;
mod query;
mod rrt;
mod rrt_connect;
mod tree;

pub use config::{ConfigError, RrtConfig};
pub use error::PlanError;
pub use plan::{Plan, Progress, Stop};
pub use rrt::{Rrt, rrt};
pub use rrt_connect::{RrtConnect, rrt_connect};
