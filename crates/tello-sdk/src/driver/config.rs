//! Where the drone is, and which local sockets are used.

use crate::safety::PreflightConfig;
use crate::session::SessionConfig;
use alloc::string::String;
use core::net::{Ipv4Addr, SocketAddr};
use core::time::Duration;
use std::path::PathBuf;

/// Settings of a connection.
#[derive(Debug, Clone, PartialEq)]
pub struct DroneConfig {
    /// The drone's command address. Default 192.168.10.1:8889, a drone in its own network.
    pub drone: SocketAddr,
    /// Local command socket. Default any address, port chosen by the system.
    pub command_bind: SocketAddr,
    /// Local state socket. Default any address, port 8890.
    pub state_bind: SocketAddr,
    /// Network interface that both sockets are bound to, by name (Linux): for several drones with the same address.
    /// Default any.
    pub interface: Option<String>,
    /// The session's settings.
    pub session: SessionConfig,
    /// What must hold before [`Drone::take_off`](super::Drone::take_off).
    pub preflight: PreflightConfig,
    /// How long connecting waits for the answer to `command` and for the first state line. Default 5 s.
    pub connect_timeout: Duration,
    /// How long a dropped connection of a flying drone tries to land it before the process may go on. Default 20 s.
    pub landing_timeout: Duration,
    /// File to record every datagram and request into (see [`record`](crate::record)). Default none.
    pub record: Option<PathBuf>,
}

impl Default for DroneConfig {
    fn default() -> Self {
        let any = |port| SocketAddr::from((Ipv4Addr::UNSPECIFIED, port));
        Self {
            drone: SocketAddr::from(([192, 168, 10, 1], 8889)),
            command_bind: any(0),
            state_bind: any(8890),
            interface: None,
            session: SessionConfig::default(),
            preflight: PreflightConfig::default(),
            connect_timeout: Duration::from_secs(5),
            landing_timeout: Duration::from_secs(20),
            record: None,
        }
    }
}

impl DroneConfig {
    /// A drone at another address, everything else by default.
    #[must_use]
    pub fn at(drone: SocketAddr) -> Self {
        Self {
            drone,
            ..Self::default()
        }
    }
}
