//! Drivers: sockets, clock and threads around a [`Session`](crate::Session).

#[cfg(feature = "tokio")]
mod asynchronous;
mod binary;
mod blocking;
mod config;
mod connect;
mod discover;
mod engine;
mod error;
mod hub;
mod pilot;
mod recorder;
mod socket;
mod swarm;
mod video;

#[cfg(feature = "tokio")]
pub use asynchronous::AsyncDrone;
pub use binary::{BinaryDrone, BinaryDroneConfig};

pub use blocking::{Drone, Lander};
pub use config::DroneConfig;
pub use discover::{Found, discover, subnet};
pub use error::{ConnectError, DriveError};
pub use hub::{StateHub, VideoHub};
pub use swarm::together;
pub use video::{VideoConfig, VideoStream};
