//! Fusion of the drone's own velocity and attitude with visual odometry: an extended Kalman filter whose process
//! noise grows as the battery empties and as the last visual fix ages.

mod config;
mod displacement;
mod ekf;
mod error;
mod measurement;
mod process_noise;
mod state;
mod update;

pub use config::EkfConfig;
pub use ekf::{Ekf, Outcome};
pub use error::FusionError;
pub use measurement::{AnchoredOdometry, AttitudeSample, FlightSample, VelocityFrame, VisualPose};
pub use process_noise::ProcessNoise;
pub use state::{NavigationState, StateCovariance};
