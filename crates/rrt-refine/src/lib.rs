#![doc = include_str!("../README.md")]

mod bounds;
mod euclid;
mod find_path;
mod motion;
pub mod nearest;
mod path;
mod planner;
pub mod refine;

pub use bounds::{Bounds, BoundsError};
pub use euclid::PointLike;
pub use find_path::{FindPathConfig, FoundPath, find_path};
pub use motion::MotionValidator;
pub use path::{ClearanceProfile, ClearanceSample, Leg, Path, PathError};
pub use planner::{
    ConfigError, Plan, PlanError, Progress, Query, Rrt, RrtConfig, RrtConnect, RrtStar,
    RrtStarConfig, Stop, rrt, rrt_connect, rrt_star,
};
pub use refine::{RefineError, RefineStop, Refined};
