#![doc = include_str!("../README.md")]

pub mod baseline;
mod calibration;
mod config;
mod exit_search;
mod heading;
mod map_views;
mod mission;
mod reach;
mod route;
mod scene;
mod sight;
mod simulation;
mod stage;
mod telemetry;

pub use calibration::{Calibration, MoveKind};
pub use config::{ConfigError, ExplorationConfig, MissionConfig, PerceptionConfig};
pub use exit_search::{ExitCloud, ExitSearch, ExitSeeker};
pub use heading::LevelPose;
pub use map_views::map_views;
pub use mission::{
    CommandOutcome, Cycle, Event, Goal, Input, Logged, Mission, MissionRecord, Outcome, Output,
    Scan, TrailPose,
};
pub use reach::{Place, Reach, ReachLimits, Room};
pub use route::{Route, RouteRadii};
pub use scene::{Presence, Scene, SceneError};
pub use sight::Sight;
pub use simulation::{FlightSummary, SimulatedFlight, SimulationError};
pub use stage::{Stage, StageObserver};
pub use telemetry::{attitude_sample, flight_sample, velocity_frame};
