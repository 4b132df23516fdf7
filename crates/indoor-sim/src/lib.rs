#![doc = include_str!("../README.md")]

mod answer;
mod camera;
mod config_error;
mod drone;
mod physics;
mod random;
mod simulator;
mod slam;
mod telemetry;
mod truth;
mod world;

pub use camera::Camera;
pub use config_error::ConfigError;
pub use drone::{DroneConfig, Phase};
pub use simulator::{Refused, SimConfig, Simulator};
pub use slam::{Outlier, PointTruth, SlamConfig, SyntheticSlam};
pub use slam_bridge;
pub use tello_sdk;
pub use truth::{Collision, TrackPoint, Truth};
pub use world::{
    Door, FloorPlan, Furniture, Landmark, PRESETS, Reach, Room, Solid, SolidKind, Start,
    TextureConfig, World, WorldError, coverage, generate,
};
