//! Emulated drones on UDP sockets, for clients that do not run in this process.
//!
//! Each drone has an address of its own (consecutive ones from [`ServeConfig::address`]), because clients tell drones
//! apart by source address; its state and video sockets are bound to that address too. One thread per drone.

use super::{Channel, Device, Emulator, EmulatorConfig, Kinematic, Summary, VideoSource};
use crate::binary::BinaryEmulator;
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::net::{Ipv4Addr, SocketAddr};
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use std::net::UdpSocket;
use std::thread::ScopedJoinHandle;
use std::time::Instant;

/// Which drones to serve.
#[derive(Debug, Clone, PartialEq)]
pub struct ServeConfig {
    /// Address of the first drone. Default 127.0.0.2; address 127.0.0.1 is the clients'.
    pub address: Ipv4Addr,
    /// Command port of every drone. Default 18889: most clients bind 8889 on all addresses themselves.
    pub command_port: u16,
    /// How many drones, on consecutive addresses. Default 1.
    pub count: u8,
    /// Whether they speak the binary protocol instead of the text protocol. Default false.
    pub binary: bool,
    /// What each drone is like; the seed grows by one from drone to drone.
    pub drone: EmulatorConfig,
}

impl Default for ServeConfig {
    fn default() -> Self {
        Self {
            address: Ipv4Addr::new(127, 0, 0, 2),
            command_port: 18_889,
            count: 1,
            binary: false,
            drone: EmulatorConfig::default(),
        }
    }
}

/// Why drones cannot be served.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ServeError {
    /// An address or port is in use or not this machine's.
    #[error(
        "cannot bind {address}: {source}; another program may hold the port, or the address is not this machine's"
    )]
    Bind {
        /// Which.
        address: SocketAddr,
        /// Why.
        source: std::io::Error,
    },
    /// The addresses run over the end of the range.
    #[error("{count} drones from {first} on do not fit in the address range")]
    Addresses {
        /// First address.
        first: Ipv4Addr,
        /// How many.
        count: u8,
    },
}

/// Makes the camera of the drone with this index; `None` for a drone without one.
pub type Cameras<'a> = &'a (dyn Fn(u8) -> Option<Box<dyn VideoSource>> + Sync);

/// Serves emulated drones without cameras until `stop` is set; returns within about 50 ms then, with what happened to
/// each drone.
///
/// # Errors
/// A socket cannot be bound; then nothing is served.
pub fn serve(config: &ServeConfig, stop: &AtomicBool) -> Result<Vec<Summary>, ServeError> {
    serve_with_cameras(config, &|_| None, stop)
}

/// Like [`serve`], with a camera for each drone.
///
/// # Errors
/// A socket cannot be bound; then nothing is served.
pub fn serve_with_cameras(
    config: &ServeConfig,
    cameras: Cameras<'_>,
    stop: &AtomicBool,
) -> Result<Vec<Summary>, ServeError> {
    Ok(DroneServer::bind(config)?.run(cameras, stop))
}

/// Drones whose sockets are bound.
#[derive(Debug)]
pub struct DroneServer {
    config: ServeConfig,
    sockets: Vec<DroneSockets>,
}

impl DroneServer {
    /// Binds the sockets of all drones; from here on clients can send to them.
    ///
    /// # Errors
    /// A socket cannot be bound.
    pub fn bind(config: &ServeConfig) -> Result<Self, ServeError> {
        let sockets = (0..config.count)
            .map(|index| DroneSockets::bind(config.address_of(index)?))
            .collect::<Result<_, _>>()?;
        let config = config.clone();
        Ok(Self { config, sockets })
    }

    /// Serves until `stop` is set, one thread a drone; returns within about 50 ms then, with what happened to each.
    pub fn run(&self, cameras: Cameras<'_>, stop: &AtomicBool) -> Vec<Summary> {
        let config = &self.config;
        std::thread::scope(|scope| {
            let threads: Vec<_> = (0_u8..)
                .zip(&self.sockets)
                .map(|(index, sockets)| {
                    scope.spawn(move || config.run(index, sockets, cameras(index), stop))
                })
                .collect();
            let join = |thread: ScopedJoinHandle<'_, Summary>| thread.join().unwrap_or_default();
            threads.into_iter().map(join).collect()
        })
    }
}

impl ServeConfig {
    /// The command address of the drone with this index.
    ///
    /// # Errors
    /// The address range ends before it.
    pub fn address_of(&self, index: u8) -> Result<SocketAddr, ServeError> {
        let [a, b, c, last] = self.address.octets();
        let last = last.checked_add(index).ok_or(ServeError::Addresses {
            first: self.address,
            count: self.count,
        })?;
        Ok(SocketAddr::from(([a, b, c, last], self.command_port)))
    }

    fn run(
        &self,
        index: u8,
        sockets: &DroneSockets,
        camera: Option<Box<dyn VideoSource>>,
        stop: &AtomicBool,
    ) -> Summary {
        let drone = EmulatorConfig {
            seed: self.drone.seed.wrapping_add(u64::from(index)),
            serial_number: alloc::format!("{}{index}", self.drone.serial_number),
            ..self.drone.clone()
        };
        let physics = Kinematic::new(drone.timing);
        if self.binary {
            let mut drone = BinaryEmulator::new(drone, physics);
            if let Some(camera) = camera {
                drone = drone.with_video(camera);
            }
            sockets.run(&mut drone, stop)
        } else {
            let mut drone = Emulator::new(drone, physics);
            if let Some(camera) = camera {
                drone = drone.with_video(camera);
            }
            sockets.run(&mut drone, stop)
        }
    }
}

/// The sockets of one drone, all on one address, because clients tell drones apart by it.
#[derive(Debug)]
pub struct DroneSockets {
    command: UdpSocket,
    other: UdpSocket,
    state: UdpSocket,
    video: UdpSocket,
}

impl DroneSockets {
    /// Binds them; the port is the command socket's.
    ///
    /// # Errors
    /// The address or port is in use or not this machine's.
    pub fn bind(address: SocketAddr) -> Result<Self, ServeError> {
        let bind = |port| {
            let address = SocketAddr::new(address.ip(), port);
            UdpSocket::bind(address).map_err(|source| ServeError::Bind { address, source })
        };
        Ok(Self {
            command: bind(address.port())?,
            other: bind(0)?,
            state: bind(0)?,
            video: bind(0)?,
        })
    }

    /// Lets a drone, of whatever physics, speak through them until `stop` is set; returns within about 50 ms then.
    pub fn run(&self, drone: &mut impl Device, stop: &AtomicBool) -> Summary {
        let start = Instant::now();
        let mut buffer = [0_u8; 2048];
        while !stop.load(Ordering::Relaxed) {
            while let Some(transmit) = drone.poll(start.elapsed()) {
                let socket = match transmit.channel {
                    Channel::Reply => &self.command,
                    Channel::ReplyFromOtherPort => &self.other,
                    Channel::State => &self.state,
                    Channel::Video => &self.video,
                };
                // A client that is gone is not the drone's concern.
                let _ = socket.send_to(&transmit.bytes, transmit.to);
            }
            let wait = drone.next_deadline().saturating_sub(start.elapsed());
            let wait = wait.clamp(Duration::from_millis(1), Duration::from_millis(50));
            let _ = self.command.set_read_timeout(Some(wait));
            // An error is a timeout, or the port-unreachable of an earlier datagram.
            if let Ok((length, from)) = self.command.recv_from(&mut buffer) {
                let bytes = buffer.get(..length).unwrap_or_default();
                drone.receive(start.elapsed(), from, bytes);
            }
        }
        drone.summary()
    }
}
