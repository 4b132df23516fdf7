//! Drivers: sockets, clock and threads around a [`Session`](crate::Session).

mod blocking;
mod config;
mod error;
mod recorder;
mod video;
mod worker;

pub use blocking::Drone;
pub use config::DroneConfig;
pub use error::{ConnectError, DriveError};
pub use video::{VideoConfig, VideoStream};
