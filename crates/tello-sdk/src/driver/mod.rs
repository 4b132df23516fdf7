//! Drivers: sockets, clock and threads around a [`Session`](crate::Session).

mod blocking;
mod config;
mod discover;
mod error;
mod hub;
mod recorder;
mod video;
mod worker;

pub use blocking::Drone;
pub use config::DroneConfig;
pub use discover::{Found, discover};
pub use error::{ConnectError, DriveError};
pub use hub::StateHub;
pub use video::{VideoConfig, VideoStream};
