//! Emulated drones on UDP sockets, for clients that do not run in this process.
//!
//! Each drone has an address of its own (consecutive ones from [`ServeConfig::address`]), because clients tell drones
//! apart by source address; its state and video sockets are bound to that address too. One thread per drone.

use super::{Channel, Emulator, EmulatorConfig, Kinematic, VideoSource};
use crate::binary::BinaryEmulator;
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::net::{IpAddr, Ipv4Addr, SocketAddr};
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use std::net::UdpSocket;
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

/// Serves emulated drones without cameras until `stop` is set; returns within about 50 ms then.
///
/// # Errors
/// A socket cannot be bound; then nothing is served.
pub fn serve(config: &ServeConfig, stop: &AtomicBool) -> Result<(), ServeError> {
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
) -> Result<(), ServeError> {
    let drones: Vec<Drone> = (0..config.count)
        .map(|index| Drone::bind(config, index))
        .collect::<Result<_, _>>()?;
    std::thread::scope(|scope| {
        for (index, drone) in (0_u8..).zip(drones) {
            if config.binary {
                scope.spawn(move || drone.run_binary(stop));
            } else {
                scope.spawn(move || drone.run(cameras(index), stop));
            }
        }
    });
    Ok(())
}

struct Drone {
    config: EmulatorConfig,
    command: UdpSocket,
    other: UdpSocket,
    state: UdpSocket,
    video: UdpSocket,
}

impl Drone {
    fn bind(config: &ServeConfig, index: u8) -> Result<Self, ServeError> {
        let too_many = ServeError::Addresses {
            first: config.address,
            count: config.count,
        };
        let [a, b, c, last] = config.address.octets();
        let last = last.checked_add(index).ok_or(too_many)?;
        let ip = IpAddr::V4(Ipv4Addr::new(a, b, c, last));
        let bind = |port| {
            let address = SocketAddr::new(ip, port);
            UdpSocket::bind(address).map_err(|source| ServeError::Bind { address, source })
        };
        let seed = config.drone.seed.wrapping_add(u64::from(index));
        let serial_number = alloc::format!("{}{index}", config.drone.serial_number);
        Ok(Self {
            config: EmulatorConfig {
                seed,
                serial_number,
                ..config.drone.clone()
            },
            command: bind(config.command_port)?,
            other: bind(0)?,
            state: bind(0)?,
            video: bind(0)?,
        })
    }

    fn run(self, camera: Option<Box<dyn VideoSource>>, stop: &AtomicBool) {
        let physics = Kinematic::new(self.config.timing);
        let mut drone = Emulator::new(self.config.clone(), physics);
        if let Some(camera) = camera {
            drone = drone.with_video(camera);
        }
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
    }

    /// The binary protocol: video is not sent.
    fn run_binary(self, stop: &AtomicBool) {
        let mut drone = BinaryEmulator::new(Kinematic::new(self.config.timing));
        let start = Instant::now();
        let mut client = None;
        let mut buffer = [0_u8; 2048];
        while !stop.load(Ordering::Relaxed) {
            while let (Some(bytes), Some(to)) = (drone.poll(start.elapsed()), client) {
                let _ = self.command.send_to(&bytes, to);
            }
            let wait = drone.next_deadline().saturating_sub(start.elapsed());
            let wait = wait.clamp(Duration::from_millis(1), Duration::from_millis(50));
            let _ = self.command.set_read_timeout(Some(wait));
            if let Ok((length, from)) = self.command.recv_from(&mut buffer) {
                client = Some(from);
                drone.receive(start.elapsed(), buffer.get(..length).unwrap_or_default());
            }
        }
    }
}
