//! Frame-to-keyframe odometry: the pose of each frame against the points of the newest keyframe.
//!
//! No optimisation over several frames yet, so errors of keyframes add up. With depth the unit is the metre;
//! without it, the median depth at the start.

mod config;
mod front_end;
mod keyframe;
mod map_builder;
mod sight;
mod telemetry;
mod tracker;

pub use config::{OdometryConfig, OdometryError, Tracker};
pub use telemetry::{FusedPose, TelemetryFusion};
pub use tracker::{Odometry, Tracked};
